// Cuts of every kind through the shipped organs at rest: what is drawn is closed, whole, and where the blade was.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/cutbody/cut_body.h"
#include "core/cutting/blade_geometry.h"
#include "core/cutting/swept_surface.h"
#include "studio/fidelity/recipes.h"
#include "studio/fidelity/topology.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm::fidelity {
namespace {

using Way = std::function<cutting::Front(double)>;

/// The box of an organ at rest, in which the cuts are laid.
struct Place {
  Vec3 middle, half;  ///< [m]
  double spacing;     ///< [m]

  cutting::Front line(Vec3 tip, Vec3 heel) const {
    cutting::Front front;
    for (std::size_t n = 0; n < kEdgeNodes; ++n) front[n] = tip + double(n) / double(kEdgeNodes - 1) * (heel - tip);
    return front;
  }
  /// An edge along z at a place of the box, from -1 to 1, down to `bottom` of the box.
  cutting::Front upright(double x, double y, double bottom) const {
    const Vec3 at = middle + Vec3{x * half.x, y * half.y, 0};
    return line({at.x, at.y, middle.z + bottom * half.z}, {at.x, at.y, middle.z + kAbove * half.z});
  }
  double spacings(double count) const { return count * spacing / half.x; }

  static constexpr double kAbove = 1.2, kBelow = -1.2;
};

constexpr double kEnd = 1.2;  // beyond the box

std::vector<std::pair<const char*, std::vector<Way>>> ways_of(const Place& place) {
  const auto along = [](double t) { return kEnd * (2 * t - 1); };
  const auto straight = [=](double x, double bottom) -> Way {
    return [=](double t) { return place.upright(x, along(t), bottom); };
  };
  const auto round = [=](double size, double bottom) -> Way {
    return [=](double t) {
      const double a = 1.03 * 2 * std::numbers::pi * t;
      return place.upright(0.1 + size * std::cos(a), size * std::sin(a), bottom);
    };
  };
  const Way curve = [=](double t) { return place.upright(0.15 * std::sin(along(t) * std::numbers::pi), along(t), 0); };
  const Way across = [=](double t) { return place.upright(along(t), 0.03, 0); };
  const Way cap = [=](double t) {
    const Vec3 m = place.middle, h = place.half;
    const double y = m.y + along(t) * h.y;
    return place.line({m.x - kEnd * h.x, y, m.z + 0.52 * h.z}, {m.x + kEnd * h.x, y, m.z + 0.57 * h.z});
  };
  const Way under = [=](double t) {
    const Vec3 m = place.middle, h = place.half;
    const double y = m.y + 0.6 * (2 * t - 1) * h.y, z = m.z + 0.3 * h.z;
    return place.line({m.x - 0.5 * h.x, y, z}, {m.x + 0.7 * h.x, y, z});
  };
  // 1 mm at 8 Hz, and 30 mm/s.
  const Way tremor = [=](double t) {
    const double way = along(t) * place.half.y;
    return place.upright(0.04 + 1e-3 / place.half.x * std::sin(2 * std::numbers::pi * 8 * way / 30e-3), along(t), 0);
  };
  const auto parallel = [=](double apart) -> std::vector<Way> {
    return {straight(0.04, Place::kBelow), straight(0.04 + place.spacings(apart), Place::kBelow)};
  };
  return {{"straight", {straight(0.04, 0)}},
          {"in half", {straight(0.04, Place::kBelow)}},
          {"S", {curve}},
          {"closed ellipse", {round(0.35, 0)}},
          {"X", {straight(0.04, 0), across}},
          {"cap", {cap}},
          {"disc", {round(0.35, 0.25), under}},
          {"parallel, 1 spacing", parallel(1.0)},
          {"parallel, 0.5 spacings", parallel(0.5)},
          {"parallel, 0.3 spacings", parallel(0.3)},
          {"tremor", {tremor}}};
}

State cut_along(const Model& model, const std::vector<Way>& ways) {
  constexpr int kSteps = 240;
  State state = rest_state(model);
  cutting::NewlySwept newly;
  newly.fill(1), newly.back() = 0;
  for (const Way& way : ways)
    for (int i = 0; i < kSteps; ++i)
      cutting::add_swept(state, way(double(i) / kSteps), way(double(i + 1) / kSteps), newly);
  return state;
}

/// Largest distance of a wall's vertices from the swept surface [m].
double farthest_wall(const cutbody::CutBody& body, const State& state) {
  double farthest = 0;
  for (std::size_t v = body.outer_vertex_count(); v < body.surface().vertex.size(); v += 2) {
    const Vec3 p = body.surface().vertex[v];
    double nearest = INFINITY;
    cutting::for_each_swept(state, [&](const cutting::SweptQuad& q) {
      if (!cutting::Box(q.from, q.to, q.from2, q.to2).grown(nearest).meets(cutting::Box(p))) return;
      nearest = std::min({nearest, norm(cutting::nearest_in_triangle(p, q.from, q.to, q.from2) - p),
                          norm(cutting::nearest_in_triangle(p, q.to, q.to2, q.from2) - p)});
    });
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

}  // namespace

Result<Model> load_organ(const std::string& path, double finer) {
  Result<loading::LoadedScene> loaded = loading::load_whole_scene(path, {}, [&](scenes::SceneSpec& scene) {
    scene.organs[0].fill.radius /= finer, scene.organs[0].fill.gap /= finer;
  });
  if (!loaded) return loaded.errors();
  return std::move(loaded->built.model);
}

Result<CutsResult> measure_cuts(const std::string& shipped, bool is_quick) {
  CutsResult result;
  for (const char* organ : is_quick ? std::vector{"kidney"} : std::vector{"kidney", "skin", "liver"})
    for (const double finer : is_quick ? std::vector{1.0} : std::vector{1.0, 2.0}) {
      const Result<Model> model = load_organ(shipped + "/" + organ + ".json", finer);
      if (!model) return model.errors();
      const std::vector<Vec3>& vertex = model->surfaces[0].vertex;
      Vec3 low = vertex[0], high = low;
      for (const Vec3& v : vertex)
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)},
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
      const Place place{0.5 * (low + high), 0.5 * (high - low), model->organs[0].spacing};
      const auto ways = ways_of(place);
      std::vector<CutsResult::Row> rows(ways.size());
      in_parallel(ways.size(), [&](std::size_t i) {
        CutsResult::Row& row = rows[i];
        row.organ = organ, row.cut = ways[i].first, row.radius = model->organs[0].sphere_radius;
        const State state = cut_along(*model, ways[i].second);
        cutbody::CutBody body(*model, 0);
        (void)body.update(state);
        row.pieces = body.piece_count(), row.triangles = body.surface().triangle.size();
        const Topology topology = topology_of(body);
        row.components = topology.components, row.open_edges = topology.open_edges;
        row.off = farthest_wall(body, state) / place.spacing;
      });
      result.rows.insert(result.rows.end(), rows.begin(), rows.end());
    }
  return result;
}

Chapter chapter_of(const CutsResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "cuts", section.title = "Cuts of every kind";
  section.paragraphs = {
      "The shipped organs at rest, cut by edges that go through them on eleven ways. The drawn surface should be "
      "closed, "
      "with as many components as there are pieces of tissue, and its walls should lie on what the edge swept."};
  reports::Table table;
  table.columns = {{"organ", "organ"},
                   {"radius_mm", "r [mm]"},
                   {"cut", "cut"},
                   {"pieces", "pieces"},
                   {"components", "components"},
                   {"open_edges", "open edges"},
                   {"off_spacings", "walls off [spacings]", 3},
                   {"triangles", "triangles"}};
  for (const CutsResult::Row& row : result.rows) {
    table.rows.push_back({row.organ, 1e3 * row.radius, row.cut, double(row.pieces), double(row.components),
                          double(row.open_edges), row.off, double(row.triangles)});
    Figure figure{.recipe = "cuts", .radius = row.radius, .source = "a body has a closed surface"};
    const std::string where = ", " + row.organ + ", " + row.cut;
    figure.name = "components of the surface beyond the pieces" + where;
    figure.measured = row.components - row.pieces, figure.reference = 0, figure.goal = Goal{0, 0};
    chapter.figures.push_back(figure);
    figure.name = "open edges" + where, figure.measured = row.open_edges;
    chapter.figures.push_back(figure);
    figure.name = "walls off the swept surface" + where, figure.measured = row.off, figure.unit = "spacings";
    figure.reference = {}, figure.source = "the blade's way", figure.goal = Goal{{}, 0.1};
    chapter.figures.push_back(figure);
  }
  section.tables = {table};
  return chapter;
}

}  // namespace ctpm::fidelity
