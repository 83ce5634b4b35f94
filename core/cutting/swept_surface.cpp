#include "core/cutting/swept_surface.h"

#include <algorithm>
#include <cmath>

namespace ctpm::cutting {
namespace {

constexpr SweptQuad kNothingSwept{-1, {}, {}, {}, {}};
constexpr double kLongestRow = 1e-3, kInLine = 2e-5;  // [m]
constexpr double kRounding = 1 + 1e-6;                // of squared distances that are compared

/// Whether the surface newly swept goes through a node.
bool borders(const NewlySwept& newly, std::size_t node) {
  return newly[node] != 0 || (node > 0 && newly[node - 1] != 0);
}

/// Nodes of which nothing is asked are 0, so that sessions stay small.
void push_row(State& state, const Front& front, const NewlySwept& newly, const NewlySwept& next) {
  for (std::size_t n = 0; n < kEdgeNodes; ++n) {
    state.swept.push_back(borders(newly, n) || borders(next, n) ? front[n] : Vec3{});
    state.swept_organ.push_back(newly[n]);
  }
}

Box box_of(const SweptQuad& q) { return Box(q.from, q.to, q.from2, q.to2); }

std::optional<Box> box_of_row(const State& state, std::size_t row) {
  std::optional<Box> box;
  for (std::size_t n = 0; row > 0 && n + 1 < kEdgeNodes; ++n) {
    const SweptQuad quad = swept_quad(state, row, n);
    if (quad.organ < 0) continue;
    const Box own = box_of(quad);
    if (box) box->add(own.low), box->add(own.high);
    if (!box) box = own;
  }
  return box;
}

/// Calls `look_at(point)` for the nearest points to a place of parts of the swept surface that may be within `reach`,
/// which may become less, until it says that it has seen enough.
template <class LookAt>
void for_each_near(const State& state, const SweptBoxes& boxes, std::int32_t organ, Vec3 rest, const double& reach,
                   LookAt&& look_at) {
  for (std::size_t row = 1; row < swept_rows(state); ++row) {
    const std::optional<Box> box = row < boxes.size() ? boxes[row] : box_of_row(state, row);
    if (!box || !box->grown(reach).meets(Box(rest))) continue;
    for (std::size_t n = 0; n + 1 < kEdgeNodes; ++n) {
      const SweptQuad q = swept_quad(state, row, n);
      if (q.organ != organ || !box_of(q).grown(reach).meets(Box(rest))) continue;
      if (look_at(nearest_in_triangle(rest, q.from, q.to, q.from2))) return;
      if (look_at(nearest_in_triangle(rest, q.to, q.to2, q.from2))) return;
    }
  }
}

/// Squared distance of a place from a box [m^2].
double squared_gap(const Box& box, Vec3 p) {
  const auto along = [](double low, double high, double x) { return std::max({low - x, x - high, 0.0}); };
  const double x = along(box.low.x, box.high.x, p.x), y = along(box.low.y, box.high.y, p.y),
               z = along(box.low.z, box.high.z, p.z);
  return x * x + y * y + z * z;
}

double squared_distance(Vec3 p, const SweptQuad& q) {
  const Vec3 a = nearest_in_triangle(p, q.from, q.to, q.from2) - p,
             b = nearest_in_triangle(p, q.to, q.to2, q.from2) - p;
  return std::min(dot(a, a), dot(b, b));
}

}  // namespace

SweptQuad swept_quad(const State& state, std::size_t row, std::size_t node) {
  const std::size_t at = row * kEdgeNodes + node, before = at - kEdgeNodes;
  if (state.swept_organ[at] == 0) return kNothingSwept;
  return {state.swept_organ[at] - 1, state.swept[before], state.swept[before + 1], state.swept[at],
          state.swept[at + 1]};
}

SweptRow swept_row(const State& state, std::size_t row) {
  SweptRow swept;
  for (std::size_t n = 0; n < kEdgeNodes; ++n) {
    const std::size_t at = row * kEdgeNodes + n;
    swept.from[n] = state.swept[at - kEdgeNodes], swept.to[n] = state.swept[at], swept.newly[n] = state.swept_organ[at];
  }
  return swept;
}

bool sweeps_same(const State& a, const State& b, std::int32_t organ) {
  const auto at = [&](const State& state, std::size_t row, std::size_t node) {
    const SweptQuad quad = row < swept_rows(state) ? swept_quad(state, row, node) : kNothingSwept;
    return quad.organ == organ ? quad : kNothingSwept;
  };
  for (std::size_t row = 1; row < std::max(swept_rows(a), swept_rows(b)); ++row)
    for (std::size_t node = 0; node + 1 < kEdgeNodes; ++node)
      if (!(at(a, row, node) == at(b, row, node))) return false;
  return true;
}

Vec3 stored_place(Vec3 rest) {
  constexpr double kUnit = 1.0 / 131072;  // [m], a power of 2
  const auto stored = [](double x) { return kUnit * std::floor(x / kUnit + 0.5); };
  return {stored(rest.x), stored(rest.y), stored(rest.z)};
}

void add_swept(State& state, const Front& exact_from, const Front& exact_to, const NewlySwept& newly) {
  Front from, to;
  for (std::size_t n = 0; n < kEdgeNodes; ++n) from[n] = stored_place(exact_from[n]), to[n] = stored_place(exact_to[n]);
  const std::size_t rows = swept_rows(state), last = (rows - 1) * kEdgeNodes;
  // Nodes that border on what is newly swept must go on from the last row, which may not have asked for them yet.
  const auto is_asked = [&](std::size_t n) {
    return state.swept_organ[last + n] != 0 || (n > 0 && state.swept_organ[last + n - 1] != 0);
  };
  // A sheet of which the last row is open, or will be, does not move: another one goes on from it.
  const auto opened = std::size_t(std::max(state.open_cuts.rows, state.opening_cuts.rows));
  bool goes_on = rows > opened;
  for (std::size_t n = 0; n < kEdgeNodes && goes_on; ++n)
    goes_on = !borders(newly, n) || !is_asked(n) || state.swept[last + n] == from[n];
  for (std::size_t n = 0; n < kEdgeNodes && goes_on; ++n)
    if (borders(newly, n) && !is_asked(n)) state.swept.set(last + n, from[n]);
  bool is_in_line = goes_on && rows > 1;
  for (std::size_t n = 0; n < kEdgeNodes && is_in_line; ++n) {
    const bool was_swept = state.swept_organ[last + n] != 0;
    if (was_swept && newly[n] != 0) is_in_line = state.swept_organ[last + n] == newly[n];
    const bool matters = borders(newly, n) || is_asked(n);
    if (!matters || !is_in_line) continue;
    // A part that rests while others go on must not be drawn along.
    if (was_swept && newly[n] == 0 && !(to[n] == state.swept[last + n] && to[n + 1] == state.swept[last + n + 1]))
      is_in_line = false;
    if (!was_swept && newly[n] != 0 &&
        !(state.swept[last - kEdgeNodes + n] == from[n] && state.swept[last - kEdgeNodes + n + 1] == from[n + 1]))
      is_in_line = false;
    const Vec3 begin = state.swept[last - kEdgeNodes + n], way = to[n] - begin, middle = state.swept[last + n] - begin;
    const double length2 = dot(way, way), along = length2 > 0 ? dot(middle, way) / length2 : 0.0;
    if (length2 > kLongestRow * kLongestRow || along < 0 || along > 1 || norm(middle - along * way) > kInLine)
      is_in_line = false;
  }
  if (is_in_line) {
    for (std::size_t n = 0; n < kEdgeNodes; ++n) {
      if (newly[n] != 0) state.swept_organ[last + n] = newly[n];
      state.swept.set(last + n, is_asked(n) ? to[n] : Vec3{});
    }
    return;
  }
  if (rows + 2 > kMostSweptRows) return;
  if (!goes_on) push_row(state, from, {}, newly);
  push_row(state, to, newly, {});
}

SweptBoxes boxes_of_rows(const State& state) {
  SweptBoxes boxes;
  for (std::size_t row = 0; row + 1 < swept_rows(state); ++row) boxes.push_back(box_of_row(state, row));
  return boxes;
}

bool is_near_swept(const State& state, const SweptBoxes& boxes, std::int32_t organ, Vec3 rest, double reach) {
  bool is_near = false;
  for_each_near(state, boxes, organ, rest, reach,
                [&](Vec3 point) { return is_near = is_near || norm(point - rest) < reach; });
  return is_near;
}

std::optional<Vec3> nearest_swept(const State& state, const SweptBoxes& boxes, std::int32_t organ, Vec3 rest,
                                  double reach) {
  std::optional<Vec3> nearest;
  for_each_near(state, boxes, organ, rest, reach, [&](Vec3 point) {
    if (const double distance = norm(point - rest); distance < reach) reach = distance, nearest = point;
    return false;
  });
  return nearest;
}

bool is_crossed(const State& state, const SweptBoxes& boxes, std::int32_t organ, Vec3 p, Vec3 q) {
  const Box line(p, q);
  for (std::size_t row = 1; row < swept_rows(state); ++row) {
    const std::optional<Box> box = row < boxes.size() ? boxes[row] : box_of_row(state, row);
    if (!box || !box->meets(line)) continue;
    for (std::size_t n = 0; n + 1 < kEdgeNodes; ++n) {
      const SweptQuad s = swept_quad(state, row, n);
      if (s.organ == organ && box_of(s).meets(line) && meet_sweep(p, q, s.from, s.to, s.from2, s.to2)) return true;
    }
  }
  return false;
}

SweptIndex::SweptIndex(const Model& model) {
  if (model.sphere_count() == 0) return;
  Box box(model.rest_position[0]);
  double spacing = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) box.add(model.rest_position[i]);
  for (const OrganRange& organ : model.organs) spacing = std::max(spacing, organ.spacing);
  box = box.grown(spacing);
  low_ = box.low;
  const Vec3 size = box.high - box.low;
  extent_ = {1 + std::int64_t(size.x / kBucket), 1 + std::int64_t(size.y / kBucket),
             1 + std::int64_t(size.z / kBucket)};
  head_.assign(std::size_t(extent_[0] * extent_[1] * extent_[2]), -1);
  const std::size_t points = kMostSweptRows * kEdgeNodes;
  entries_.reserve(2 * points);
}

std::int64_t SweptIndex::bucket_of(Vec3 rest) const {
  const Vec3 at = (rest - low_) / kBucket;
  if (!(at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < double(extent_[0]) && at.y < double(extent_[1]) &&
        at.z < double(extent_[2])))
    return -1;
  return std::int64_t(at.x) + extent_[0] * (std::int64_t(at.y) + extent_[1] * std::int64_t(at.z));
}

/// Two swept surfaces that agree in one row, to the bit, agree in those before it.
bool SweptIndex::goes_on_from(const State& state) const {
  if (swept_rows(state) < rows_) return false;
  const std::size_t from = rows_ > 0 ? (rows_ - 1) * kEdgeNodes : 0;
  for (std::size_t n = from; n < rows_ * kEdgeNodes; ++n)
    if (!(state.swept[n] == last_[n - from]) || state.swept_organ[n] != last_organ_[n - from]) return false;
  return true;
}

void SweptIndex::update(const State& state) {
  if (!goes_on_from(state)) {
    std::fill(head_.begin(), head_.end(), -1);
    entries_.clear(), rows_ = 0;
  }
  for (; rows_ + 1 < swept_rows(state); ++rows_) insert(state, rows_);
}

void SweptIndex::insert(const State& state, std::size_t row) {
  for (std::size_t n = 0; n < kEdgeNodes; ++n) {
    const std::size_t at = row * kEdgeNodes + n;
    last_[n] = state.swept[at], last_organ_[n] = state.swept_organ[at];
    if (row == 0 || n + 1 == kEdgeNodes || state.swept_organ[at] == 0) continue;
    const SweptQuad quad = swept_quad(state, row, n);
    const Box box = Box(quad.from, quad.to, quad.from2, quad.to2).grown(kFar);
    const auto cell = [&](double x, double low, std::int64_t extent) {
      return std::clamp(std::int64_t((x - low) / kBucket), std::int64_t{0}, extent - 1);
    };
    for (std::int64_t k = cell(box.low.z, low_.z, extent_[2]); k <= cell(box.high.z, low_.z, extent_[2]); ++k)
      for (std::int64_t j = cell(box.low.y, low_.y, extent_[1]); j <= cell(box.high.y, low_.y, extent_[1]); ++j)
        for (std::int64_t i = cell(box.low.x, low_.x, extent_[0]); i <= cell(box.high.x, low_.x, extent_[0]); ++i) {
          std::int32_t& head = head_[std::size_t(i + extent_[0] * (j + extent_[1] * k))];
          entries_.push_back({std::int32_t(row), std::int32_t(n), head});
          head = std::int32_t(entries_.size()) - 1;
        }
  }
}

double SweptIndex::distance(const State& state, std::int32_t organ, Vec3 rest, double enough) const {
  double least2 = kFar * kFar;
  const double enough2 = enough * enough;
  const auto look_at = [&](std::size_t row, std::size_t node) {
    if (state.swept_organ[row * kEdgeNodes + node] != organ + 1) return;
    const SweptQuad quad = swept_quad(state, row, node);
    // Its box is mostly farther than what was found.
    if (squared_gap(box_of(quad), rest) <= kRounding * least2) least2 = std::min(least2, squared_distance(rest, quad));
  };
  const std::int64_t bucket = bucket_of(rest);
  if (bucket >= 0)
    for (std::int32_t e = head_[std::size_t(bucket)]; e >= 0 && least2 >= enough2; e = entries_[std::size_t(e)].next)
      look_at(std::size_t(entries_[std::size_t(e)].row), std::size_t(entries_[std::size_t(e)].node));
  for (std::size_t row = std::max<std::size_t>(rows_, 1); row < swept_rows(state); ++row)
    for (std::size_t node = 0; node + 1 < kEdgeNodes && least2 >= enough2; ++node) look_at(row, node);
  return std::sqrt(least2);
}

}  // namespace ctpm::cutting
