#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <map>
#include <thread>

#include "core/stepping/step.h"
#include "core/surface/surface.h"
#include "studio/render/cut_surface.h"
#include "studio/render/lips.h"
#include "studio/render/organ_mesh.h"
#include "tests/core/topology.h"
#include "tests/studio/render/scene.h"

namespace ctpm::render_test {
namespace {

double area(const Surface& surface, std::size_t triangles) {
  double sum = 0;
  for (std::size_t i = 0; i < triangles; ++i) {
    const auto& t = surface.triangle[i];
    const Vec3 a = surface.vertex[std::size_t(t[0])], b = surface.vertex[std::size_t(t[1])],
               c = surface.vertex[std::size_t(t[2])];
    sum += 0.5 * norm(cross(b - a, c - a));
  }
  return sum;
}

TEST(CutSurface, WithoutACutIsTheWholeSurface) {
  const auto scene = make_blob_scene();
  render::CutSurface cut_surface(scene->model, 0);
  EXPECT_FALSE(cut_surface.update(rest_state(scene->model)));
  EXPECT_EQ(cut_surface.surface().triangle, scene->model.surfaces[0].triangle);
  const State severed = cut_along_y(scene->model, 0, 0.1, 0);
  EXPECT_TRUE(cut_surface.update(severed));
  EXPECT_FALSE(cut_surface.update(severed));
  EXPECT_TRUE(cut_surface.update(rest_state(scene->model)));
  EXPECT_EQ(cut_surface.surface().triangle, scene->model.surfaces[0].triangle);
  EXPECT_EQ(cut_surface.outer_triangle_count(), scene->model.surfaces[0].triangle.size());
}

TEST(CutSurface, FollowedAheadInAnotherThreadItIsTheSame) {
  const auto scene = make_blob_scene();
  std::vector<State> states{rest_state(scene->model)};
  for (const double to : {0.0, 0.01, 0.01, 0.02}) states.push_back(cut_along_y(scene->model, -0.01, to, 0));
  render::CutSurface alone(scene->model, 0), ahead(scene->model, 0);
  std::thread([&] {
    for (const State& state : states) ahead.follow_ahead(state);
  }).join();
  states.push_back(cut_along_y(scene->model, -0.01, 0.03, 0));  // nobody followed this one
  states.push_back(states[2]);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const bool changes = alone.update(states[i]);
    EXPECT_EQ(ahead.update(states[i]), changes) << i;
    EXPECT_FALSE(ahead.update(states[i])) << i;
    EXPECT_EQ(ahead.surface().vertex, alone.surface().vertex) << i;
    EXPECT_EQ(ahead.surface().triangle, alone.surface().triangle) << i;
    EXPECT_EQ(ahead.surface().binding.weight, alone.surface().binding.weight) << i;
    EXPECT_EQ(ahead.outer_triangle_count(), alone.outer_triangle_count()) << i;
    EXPECT_EQ(ahead.is_lip(), alone.is_lip()) << i;
    EXPECT_EQ(ahead.rind(), alone.rind()) << i;
  }
}

TEST(CutSurface, TheOuterSurfaceKeepsItsArea) {
  const auto scene = make_blob_scene();
  const double whole = area(scene->model.surfaces[0], scene->model.surfaces[0].triangle.size());
  for (const double bottom : {-0.1, 0.0, 0.01}) {
    render::CutSurface cut_surface(scene->model, 0);
    State state = cut_along_y(scene->model, 0.001, 0.02, bottom);
    cut(scene->model, state, {{-0.1, 0, bottom}, {-0.1, 0.01, 0.1}},
        {{0.1, 0, bottom}, {0.1, 0.01, 0.1}});  // a second cut, across
    cut_surface.update(state);
    EXPECT_GT(cut_surface.outer_triangle_count(), scene->model.surfaces[0].triangle.size());
    EXPECT_GT(cut_surface.surface().triangle.size(), cut_surface.outer_triangle_count());
    EXPECT_NEAR(area(cut_surface.surface(), cut_surface.outer_triangle_count()), whole, 0.02 * whole);
  }
}

/// The largest change of length of any edge of any triangle [m].
double worst_stretch(const render::CutSurface& cut_surface, const State& state) {
  std::vector<Vec3> moved;
  const Surface& surface = cut_surface.surface();
  surface::deform_surface(surface, state.position, 0, moved);
  double worst = 0;
  for (const auto& t : surface.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t a = std::size_t(t[i]), b = std::size_t(t[(i + 1) % 3]);
      worst = std::max(worst, std::abs(norm(moved[a] - moved[b]) - norm(surface.vertex[a] - surface.vertex[b])));
    }
  return worst;
}

TEST(CutSurface, PiecesOfAFullCutMoveApartWithoutStretchingATriangle) {
  constexpr double kOff = 0.0003;
  const auto scene = make_blob_scene();
  for (const double lean : {0.0, 0.4, 1.0}) {  // the plane x = lean y + 0.3 mm, in which no sphere lies
    State state = rest_state(scene->model);
    const double from = -0.1 * lean + kOff, to = 0.1 * lean + kOff;
    cut(scene->model, state, {{from, -0.1, -0.1}, {from, -0.1, 0.1}}, {{to, 0.1, -0.1}, {to, 0.1, 0.1}});
    render::CutSurface cut_surface(scene->model, 0);
    ASSERT_TRUE(cut_surface.update(state));
    spread(state, scene->model, [&](Vec3 p) { return p.x > lean * p.y + kOff ? Vec3{0.05, 0.01, 0} : Vec3{}; });
    EXPECT_LT(worst_stretch(cut_surface, state), 1e-10) << "lean " << lean;  // rounding only
  }
}

/// A full cut at `x` and a side cut that meets it leave no triangle from one piece to the other.
void expect_nothing_spans(const std::vector<double>& xs) {
  const auto scene = make_blob_scene();
  for (const double x : xs)
    for (const double y : {-0.01, 0.0, 0.013})
      for (const double bottom : {0.018, 0.0}) {
        State state = rest_state(scene->model);
        cut(scene->model, state, {{x, -0.1, -0.1}, {x, -0.1, 0.1}}, {{x, 0.1, -0.1}, {x, 0.1, 0.1}});
        cut(scene->model, state, {{x - 0.0001, y, bottom}, {x - 0.0001, y, 0.1}},
            {{x + 0.009, y + 0.002, bottom}, {x + 0.009, y + 0.002, 0.1}});
        render::CutSurface cut_surface(scene->model, 0);
        ASSERT_TRUE(cut_surface.update(state));
        spread(state, scene->model, [&](Vec3 p) { return p.x > x ? Vec3{0.05, 0.01, 0} : Vec3{}; });
        EXPECT_LT(worst_stretch(cut_surface, state), 1e-10) << "side cut at " << x << ", " << y << " to " << bottom;
      }
}

TEST(CutSurface, NothingSpansThePiecesWhereASideCutMeetsTheCut) { expect_nothing_spans({0.002, 0.0042}); }

TEST(CutSurface, SlowNothingSpansThePiecesAtMorePlaces) { expect_nothing_spans({0.0, 0.0028}); }

testing::Triangles welded(const Surface& surface) {
  const std::vector<std::int32_t> number = surface::welded(surface);
  testing::Triangles triangles;
  for (const auto& t : surface.triangle)
    triangles.push_back({number[std::size_t(t[0])], number[std::size_t(t[1])], number[std::size_t(t[2])]});
  return triangles;
}

int open_edges(const Surface& surface) { return testing::open_edges(welded(surface)); }

/// Ways of a blade: each entry is where its edge is, one after the other.
using Way = std::vector<Edge>;

Edge upright(double x, double y, double bottom) { return {{x, y, bottom}, {x, y, 0.1}}; }

struct NamedWays {
  const char* name;
  std::vector<Way> ways;
};

std::vector<NamedWays> cuts_of_all_kinds() {
  Way curved, waving;
  for (int i = 0; i <= 40; ++i) {
    const double a = std::numbers::pi * i / 40;
    curved.push_back(upright(0.03 * std::cos(a), -0.02 + 0.03 * std::sin(a), 0.002));
    waving.push_back(upright(-0.09 + 0.0045 * i, 0.004 * std::sin(8 * a), -0.1));
  }
  const Way across{upright(0.0013, -0.1, -0.1), upright(0.0013, 0.1, -0.1)};
  const Way shallow{upright(0.0013, -0.1, 0.008), upright(0.0013, 0.1, 0.008)};
  const Way partial{upright(-0.0021, -0.1, -0.004), upright(0.0043, 0.012, -0.004)};
  const Way other{upright(-0.1, 0.0034, 0.003), upright(0.02, 0.0047, 0.003)};
  const Way inside{upright(-0.02, 0.0, 0.006), upright(0.02, 0.003, 0.006)};
  const Way flat{{{-0.1, -0.1, 0.011}, {-0.1, 0.1, 0.009}}, {{0.1, -0.1, 0.012}, {0.1, 0.1, 0.008}}};
  return {{"full", {across}},
          {"shallow", {shallow}},
          {"partial", {partial}},
          {"inside", {inside}},
          {"repeated", {partial, partial, across}},
          {"crossing", {partial, other}},
          {"crossing, one full", {across, other}},
          {"curved", {curved}},
          {"waving", {waving}},
          {"a slice off the top", {flat}},
          {"all", {across, other, curved, waving, flat}}};
}

State cut_along(const Model& model, const std::vector<Way>& ways) {
  State state = rest_state(model);
  for (const Way& way : ways)
    for (std::size_t i = 0; i + 1 < way.size(); ++i) cut(model, state, way[i], way[i + 1]);
  return state;
}

/// A lens 8 mm thick, filled with one sheet of spheres.
FilledOrgan lens_of_one_sheet() {
  const Shape lens = [](Vec3 p) {
    return (std::sqrt((p.x * p.x + p.y * p.y) / 0.0025 + p.z * p.z / 1.6e-5) - 1) * 0.004;
  };
  FilledOrgan organ;
  organ.sphere_radius = 0.003, organ.spacing = 0.009, organ.surface = star_surface(lens, 40);
  for (int j = -6; j < 6; ++j)
    for (int i = -6; i < 6; ++i) {
      const Vec3 p = organ.spacing * Vec3{i + 0.5, j + 0.5, 0};
      if (lens(p) > -0.0008) continue;
      organ.centre.push_back(p), organ.cell.push_back({i, j, 0});
      organ.layer.push_back(1), organ.depth.push_back(-lens(p));
    }
  surface::bind_surface(organ);
  return organ;
}

/// How many of these cuts severed anything; the surface is watertight after each.
int watertight_cuts(const Model& model, const std::vector<NamedWays>& cuts) {
  EXPECT_EQ(open_edges(model.surfaces[0]), 0);
  int severed = 0;
  for (const NamedWays& kind : cuts) {
    const State state = cut_along(model, kind.ways);
    render::CutSurface cut_surface(model, 0);
    if (!cut_surface.update(state)) continue;
    ++severed;
    EXPECT_EQ(open_edges(cut_surface.surface()), 0) << kind.name << ", " << model.sphere_count() << " spheres";
  }
  return severed;
}

/// Those of them that end in the organ, where another one ends.
std::vector<NamedWays> crossing_cuts() {
  std::vector<NamedWays> some = cuts_of_all_kinds();
  std::erase_if(some, [](const NamedWays& kind) { return kind.name != std::string("crossing"); });
  return some;
}

TEST(CutSurface, IsWatertightWhateverTheCut) {
  EXPECT_GT(watertight_cuts(make_blob_scene()->model, cuts_of_all_kinds()), 9);
  EXPECT_EQ(watertight_cuts(make_scene(lens_of_one_sheet())->model, crossing_cuts()), 1);
}

TEST(CutSurface, SlowIsWatertightWhateverTheCutOfASheetAndOfSmallSpheres) {
  EXPECT_GT(watertight_cuts(make_scene(lens_of_one_sheet())->model, cuts_of_all_kinds()), 7);
  EXPECT_GT(watertight_cuts(make_blob_scene(0.0025, 50)->model, cuts_of_all_kinds()), 8);
}

/// Cuts right through at places, each upright and leaning.
void expect_walls_where_the_blade_passed(std::initializer_list<double> places) {
  const auto scene = make_blob_scene();
  for (const double x : places)
    for (const double lean : {0.0, 0.3}) {
      State state = rest_state(scene->model);
      cut(scene->model, state, {{x - 0.1 * lean, -0.1, -0.1}, {x - 0.1 * lean, -0.1, 0.1}},
          {{x + 0.1 * lean, 0.1, -0.1}, {x + 0.1 * lean, 0.1, 0.1}});
      render::CutSurface cut_surface(scene->model, 0);
      ASSERT_TRUE(cut_surface.update(state));
      const Surface& surface = cut_surface.surface();
      std::vector<double> off;
      const double scale = 1 / std::sqrt(1 + lean * lean);
      for (std::size_t v = 0; v < surface.vertex.size(); ++v)
        if (v >= cut_surface.outer_vertex_count() || cut_surface.is_lip()[v])
          off.push_back(std::abs(surface.vertex[v].x - x - lean * surface.vertex[v].y) * scale);
      std::sort(off.begin(), off.end());
      // Spheres are 9 mm apart; where the blade passed is kept to 0.04 mm.
      EXPECT_LT(off[off.size() / 2], 1e-4) << "half of them, at " << x << " leaning " << lean;
      EXPECT_LT(off[off.size() * 95 / 100], 5e-4) << "nearly all, at " << x << " leaning " << lean;
      EXPECT_LT(off.back(), 3e-3) << "all, at " << x << " leaning " << lean;
    }
}

TEST(CutSurface, WallAndLipsStandWhereTheBladePassed) { expect_walls_where_the_blade_passed({-0.0035, 0.002}); }

TEST(CutSurface, SlowWallAndLipsStandWhereTheBladePassedElsewhere) {
  expect_walls_where_the_blade_passed({-0.001, 0.0, 0.004});
}

TEST(CutSurface, HowNearALipIsDoesNotDependOnTheTrianglesBesideIt) {
  const auto scene = make_blob_scene(0.003, 60);
  const State state = cut_along_y(scene->model, 0.001, 0.02, -0.005);
  render::CutSurface cut_surface(scene->model, 0);
  ASSERT_TRUE(cut_surface.update(state));
  const Surface& surface = cut_surface.surface();
  constexpr double kReach = 0.004;
  const std::vector<float> nearness = render::nearness_to_lips(surface, cut_surface.is_lip(), kReach);
  ASSERT_EQ(nearness.size(), surface.vertex.size());
  std::vector<Vec3> lip;
  for (std::size_t v = 0; v < cut_surface.outer_vertex_count(); ++v)
    if (cut_surface.is_lip()[v]) lip.push_back(surface.vertex[v]);
  double worst = 0;
  int between = 0;
  for (std::size_t v = 0; v < cut_surface.outer_vertex_count(); ++v) {
    double least = render::kLipsKnown * kReach;
    for (const Vec3& p : lip) least = std::min(least, norm(p - surface.vertex[v]));
    // Between two vertices of the edge it may be nearer than either.
    worst = std::max(worst, std::abs(nearness[v] - (1 - least / kReach)));
    between += nearness[v] > 0.1 && nearness[v] < 0.9;
  }
  EXPECT_LT(worst, 0.12);
  EXPECT_GT(between, 100) << "triangles beside the cut are smaller than the reach";
  // Within a triangle too, however far it goes beyond the reach, so that what oozes has no spikes.
  double off = 0;
  for (std::size_t t = 0; t < cut_surface.outer_triangle_count(); ++t) {
    const auto& corner = surface.triangle[t];
    Vec3 middle{};
    double read = 0;
    for (const std::int32_t v : corner)
      middle += (1.0 / 3) * surface.vertex[std::size_t(v)], read += nearness[std::size_t(v)] / 3;
    double least = render::kLipsKnown * kReach;
    for (const Vec3& p : lip) least = std::min(least, norm(p - middle));
    if (least < kReach) off = std::max(off, read - (1 - least / kReach));
  }
  EXPECT_LT(off, 0.25);
}

/// Outward normal of the blob at a place on it.
Vec3 blob_normal(Vec3 p) {
  constexpr double h = 1e-6;
  const auto slope = [&](Vec3 d) { return blob(p + h * d) - blob(p - h * d); };
  const Vec3 n{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
  return n / norm(n);
}

TEST(CutSurface, NormalsAndColourContinueOverTheClosedCut) {
  const auto scene = make_blob_scene(0.003, 60);
  const State rest = rest_state(scene->model);
  State state = cut_along_y(scene->model, 0.001, 0.02, -0.005);
  cut(scene->model, state, {{-0.1, 0, 0}, {-0.1, 0.01, 0.1}}, {{0.1, 0, 0}, {0.1, 0.01, 0.1}});
  render::CutSurface cut_surface(scene->model, 0);
  ASSERT_TRUE(cut_surface.update(state));
  const Surface &whole = scene->model.surfaces[0], &surface = cut_surface.surface();
  contact::DrawnSurfaces drawn(scene->model);
  render::OrganMesh uncut, mesh;
  uncut.set_surface(whole, {}, {}, {}), uncut.update(drawn, 0, whole, rest);
  mesh.set_surface(surface, render::nearness_to_lips(surface, cut_surface.is_lip(), 0.003), cut_surface.rind(),
                   cut_surface.at_rest()),
      mesh.update(drawn, 0, surface, state);
  const auto normal = [](const render::OrganMesh& m, std::size_t v) {
    const float* f = &m.vertices()[v * render::kOrganVertexFloats];
    return Vec3{f[3], f[4], f[5]};
  };
  const auto stain = [](const render::OrganMesh& m, std::size_t v) {
    return m.vertices()[v * render::kOrganVertexFloats + 10];
  };
  const auto degrees = [](Vec3 a, Vec3 b) { return std::asin(norm(cross(a, b))) * 180 / std::numbers::pi; };
  double worst_uncut = 0, worst_kept = 0;
  std::vector<double> of_lips;
  std::size_t kept = 0;
  std::map<std::array<double, 3>, std::size_t> own;  // place -> vertex
  for (std::size_t v = 0; v < whole.vertex.size(); ++v) {
    own[{whole.vertex[v].x, whole.vertex[v].y, whole.vertex[v].z}] = v;
    worst_uncut = std::max(worst_uncut, degrees(normal(uncut, v), blob_normal(whole.vertex[v])));
  }
  std::map<std::array<double, 3>, std::pair<int, float>> lips;  // place -> how many copies, and their stain
  for (std::size_t v = 0; v < cut_surface.outer_vertex_count(); ++v) {
    const auto same = own.find({surface.vertex[v].x, surface.vertex[v].y, surface.vertex[v].z});
    if (same != own.end() && !cut_surface.is_lip()[v]) {
      worst_kept = std::max(worst_kept, degrees(normal(mesh, v), normal(uncut, same->second))), ++kept;
      EXPECT_EQ(stain(mesh, v), stain(uncut, same->second)) << v;
    }
    if (!cut_surface.is_lip()[v]) continue;
    const Vec3 p = surface.vertex[v];
    of_lips.push_back(degrees(normal(mesh, v), blob_normal(p)));
    auto& [copies, colour] = lips.try_emplace({p.x, p.y, p.z}, 0, stain(mesh, v)).first->second;
    ++copies;
    EXPECT_EQ(stain(mesh, v), colour) << "the other lip at the same place";
  }
  int paired = 0;
  for (const auto& [place, copies] : lips) paired += copies.first >= 2;
  EXPECT_GT(paired, 60);
  // A lip has triangles on one side only. From triangle to triangle the surface turns by 3 to 6 degrees.
  EXPECT_LT(worst_uncut, 1);
  EXPECT_GT(kept, whole.vertex.size() / 2);
  EXPECT_LT(worst_kept, 3) << "vertices that are still there";
  std::sort(of_lips.begin(), of_lips.end());
  EXPECT_LT(of_lips[of_lips.size() * 99 / 100], 4) << "nearly all vertices on its lips";
}

}  // namespace
}  // namespace ctpm::render_test
