#include "studio/render/expert_cut.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/cutting/blade_geometry.h"
#include "core/cutting/cutting.h"
#include "core/cutting/swept_surface.h"
#include "core/model/box.h"
#include "core/surface/line_hit.h"

namespace ctpm::render {
namespace {

constexpr double kCell = 4e-3;        // in which triangles and places are looked for [m]
constexpr double kLeastPiece = 1e-6;  // of a line [m]
constexpr double kNear = 1.5e-3;      // how far the outside of a cut organ is from its own surface at most [m]
constexpr double kAside = 0.3e-3;     // a cut so near to the expert's leaves the line whole, on one of its lips [m]
constexpr double kTorn = 2,
                 kTornBy = 1e-3;  // a part of the line that is longer than that many times and [m] spans a wound

using Corners = std::array<Vec3, 3>;

Corners corners_of(const Surface& surface, std::size_t triangle) {
  const auto& t = surface.triangle[triangle];
  return {surface.vertex[std::size_t(t[0])], surface.vertex[std::size_t(t[1])], surface.vertex[std::size_t(t[2])]};
}

/// What lies in each cell of space that a box of it meets.
class Cells {
 public:
  void add(const Box& box, std::size_t thing) {
    for_each(box, [&](std::int64_t cell) { things_[cell].push_back(thing); });
  }
  /// Visits what may be in a box, a thing perhaps several times.
  template <class Visit>
  void near(const Box& box, Visit&& visit) const {
    for_each(box, [&](std::int64_t cell) {
      if (const auto found = things_.find(cell); found != things_.end())
        for (const std::size_t thing : found->second) visit(thing);
    });
  }

 private:
  template <class Visit>
  static void for_each(const Box& box, Visit&& visit) {
    const auto at = [](double x) { return std::int64_t(std::floor(x / kCell)); };
    for (std::int64_t i = at(box.low.x); i <= at(box.high.x); ++i)
      for (std::int64_t j = at(box.low.y); j <= at(box.high.y); ++j)
        for (std::int64_t k = at(box.low.z); k <= at(box.high.z); ++k) visit((i * 1'000'003 + j) * 1'000'003 + k);
  }
  std::unordered_map<std::int64_t, std::vector<std::size_t>> things_;
};

/// Where the edges of a triangle go through another one.
void add_crossings(const Corners& edges, const Corners& through, std::vector<Vec3>& places) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 from = edges[i], along = edges[(i + 1) % 3] - from;
    const double length = norm(along);
    if (!(length > 0)) continue;
    const auto hit = surface::meet_line(from, along / length, length, through[0], through[1], through[2]);
    if (hit) places.push_back(from + hit->distance / length * along);
  }
}

/// The line that two triangles have in common.
std::optional<std::array<Vec3, 2>> common_line(const Corners& a, const Corners& b) {
  std::vector<Vec3> places;
  add_crossings(a, b, places), add_crossings(b, a, places);
  std::array<Vec3, 2> line{};
  double longest = kLeastPiece;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = i + 1; j < places.size(); ++j)
      if (const double length = norm(places[j] - places[i]); length > longest)
        longest = length, line = {places[i], places[j]};
  return longest > kLeastPiece ? std::optional(line) : std::nullopt;
}

Vec3 normal_of(const Corners& t) {
  const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
  return normal / std::max(norm(normal), 1e-30);
}

/// The parts of the line in which a part of the swept surface goes through an organ's own surface.
void add_pieces(const cutting::SweptQuad& quad, const Surface& surface, const Cells& cells,
                std::vector<ExpertCut::Piece>& line) {
  for (const Corners& swept : {Corners{quad.from, quad.to, quad.from2}, {quad.to, quad.to2, quad.from2}}) {
    std::vector<std::size_t> candidates;
    cells.near(Box(swept[0], swept[1], swept[2]), [&](std::size_t triangle) { candidates.push_back(triangle); });
    std::ranges::sort(candidates);
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    for (const std::size_t triangle : candidates) {
      const Corners skin = corners_of(surface, triangle);
      const auto common = common_line(swept, skin);
      if (!common) continue;
      // Across the line within the skin; on which side of the cut, the order of its nodes and rows says.
      const Vec3 across = normal_of(swept), out = normal_of(skin), side = across - dot(across, out) * out;
      line.push_back({quad.organ, (*common)[0], (*common)[1], side / std::max(norm(side), 1e-30)});
    }
  }
}

}  // namespace

ExpertCut::ExpertCut(const Model& model, const State& end) : severed_(end.axial_severed) {
  std::vector<Cells> cells(model.surfaces.size());
  for (std::size_t organ = 0; organ < model.surfaces.size(); ++organ)
    for (std::size_t t = 0; t < model.surfaces[organ].triangle.size(); ++t) {
      const Corners corners = corners_of(model.surfaces[organ], t);
      cells[organ].add(Box(corners[0], corners[1], corners[2]), t);
    }
  cutting::for_each_swept(end, [&](const cutting::SweptQuad& quad) {
    const auto organ = std::size_t(quad.organ);
    if (organ < model.surfaces.size()) add_pieces(quad, model.surfaces[organ], cells[organ], line_);
  });
}

std::vector<Vec3> strays_of(const Model& model, const ExpertCut& expert, const State& state) {
  std::vector<Vec3> places;
  for (std::size_t e = 0; e < state.axial_severed.size(); ++e) {
    if (!state.axial_severed[e] || expert.severed(e)) continue;
    const double along = state.axial_crossing.empty() ? 0.5 : cutting::crossing_of(state.axial_crossing[e]);
    const Vec3 a = state.position[std::size_t(model.axial.a[e])], b = state.position[std::size_t(model.axial.b[e])];
    places.push_back(a + along * (b - a));
  }
  return places;
}

/// The nearest outer triangle of each end, a little to the one side of the cut.
void ExpertMarker::bind(std::span<const DrawnOrgan> organs) {
  const std::vector<ExpertCut::Piece>& line = expert_->line();
  ends_.assign(line.size(), {});
  for (std::size_t organ = 0; organ < organs.size(); ++organ) {
    std::vector<Vec3> place;  // two of each piece
    std::vector<double> nearest(2 * line.size(), kNear);
    Cells cells;
    std::optional<Box> all;  // most triangles are far from the line
    for (const ExpertCut::Piece& piece : line)
      for (const Vec3 end : {piece.from, piece.to}) {
        place.push_back(end + kAside * piece.side);
        if (std::size_t(piece.organ) != organ) continue;
        const Box around = Box(place.back()).grown(kNear);
        cells.add(around, place.size() - 1);
        if (!all) all = around;
        all->add(around.low), all->add(around.high);
      }
    const Surface& surface = *organs[organ].surface;
    for (std::size_t t = 0; all && t < organs[organ].outer_triangles; ++t) {
      const Corners c = corners_of(surface, t);
      const Box box(c[0], c[1], c[2]);
      if (!all->meets(box)) continue;
      cells.near(box, [&](std::size_t i) {
        if (!box.meets(Box(place[i]).grown(nearest[i]))) return;
        const Vec3 p = cutting::nearest_in_triangle(place[i], c[0], c[1], c[2]);
        const double distance = norm(p - place[i]);
        const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
        const double square = dot(normal, normal);
        if (distance >= nearest[i] || !(square > 0)) return;
        nearest[i] = distance;
        const double b = dot(normal, cross(p - c[0], c[2] - c[0])) / square,
                     third = dot(normal, cross(c[1] - c[0], p - c[0])) / square;
        ends_[i / 2][i % 2] = {std::int32_t(t), {1 - b - third, b, third}};
      });
    }
  }
}

ExpertMarks ExpertMarker::place(const Model& model, const std::shared_ptr<const ExpertCut>& expert,
                                std::span<const DrawnOrgan> organs, std::uint64_t version, const State& state) {
  if (expert != expert_ || version_ != version) {
    expert_ = expert, version_ = version;
    bind(organs);
  }
  ExpertMarks marks{{}, strays_of(model, *expert, state)};
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const ExpertCut::Piece& piece = expert->line()[i];
    const DrawnOrgan& organ = organs[std::size_t(piece.organ)];
    const auto place_of = [&](const End& end) {
      Vec3 place;
      for (std::size_t k = 0; k < 3; ++k)
        place += end.weight[k] * (*organ.place)[std::size_t(organ.surface->triangle[std::size_t(end.triangle)][k])];
      return place;
    };
    const auto& [from, to] = ends_[i];
    if (from.triangle < 0 || to.triangle < 0) continue;
    const std::array<Vec3, 2> ends{place_of(from), place_of(to)};
    if (norm(ends[1] - ends[0]) > kTorn * norm(piece.to - piece.from) + kTornBy) continue;
    marks.line.push_back(ends);
  }
  return marks;
}

}  // namespace ctpm::render
