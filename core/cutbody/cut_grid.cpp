#include "core/cutbody/cut_grid.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/cutting/beyond_skin.h"
#include "core/cutting/blade_geometry.h"
#include "core/cutting/lattice_frame.h"

namespace ctpm::cutbody {
namespace {

/// Crossings of the cut and of the organ's surface stay this far from an edge's ends, so that no two vertices coincide.
constexpr float kFromEnd = 0.03f, kOuterFromEnd = 0.002f;

/// Where the edge p-q crosses a triangle, from 0 at p to 1 at q; negative: nowhere. A node in the triangle's plane
/// counts as above it, so that no node is parted from both sides. Edges that touch the triangle's rim are crossed.
double crossing_of(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 normal = cross(b - a, c - a);
  const double at_p = dot(normal, p - a), at_q = dot(normal, q - a);
  if ((at_p >= 0) == (at_q >= 0)) return -1;
  const auto volume = [&](Vec3 u, Vec3 v) { return dot(q - p, cross(u - p, v - p)); };
  const double ab = volume(a, b), bc = volume(b, c), ca = volume(c, a);
  if (!((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0))) return -1;
  return at_p / (at_p - at_q);
}

/// The lattice cells from which to which an organ's spheres and its surface reach.
std::pair<LatticeCell, LatticeCell> cells_of(const Model& model, std::size_t index,
                                             const cutting::LatticeFrame& frame) {
  const OrganRange& organ = model.organs[index];
  const auto first = std::size_t(organ.first), last = first + std::size_t(organ.count);
  LatticeCell low = model.cell[first], high = low;
  for (std::size_t i = first; i < last; ++i)
    for (std::size_t a = 0; a < 3; ++a)
      low[a] = std::min(low[a], model.cell[i][a]), high[a] = std::max(high[a], model.cell[i][a]);
  for (const Vec3& v : model.surfaces[index].vertex)
    for (std::size_t a = 0; a < 3; ++a) {
      constexpr double kFarthest = 1 << 21;  // beyond any cell that is stored
      const double at = std::clamp(dot(v - frame.origin, frame.axis[a]) / organ.spacing, -kFarthest, kFarthest);
      low[a] = std::min(low[a], std::int32_t(std::floor(at))), high[a] = std::max(high[a], std::int32_t(std::ceil(at)));
    }
  return {low, high};
}

}  // namespace

CutGrid::Node CutGrid::blocks_of(const Model& model, std::size_t organ) {
  const auto [low, high] = cells_of(model, organ, cutting::lattice_frame(model, model.organs[organ]));
  return {high[0] - low[0] + 3, high[1] - low[1] + 3, high[2] - low[2] + 3};
}

CutGrid::CutGrid(const Model& model, std::size_t organ)
    : model_(model),
      organ_(std::int32_t(organ)),
      map_(model),
      depth_(model, map_, organ),
      torn_tissue_(model, organ, depth_) {
  find_frame(model, model.organs[organ]);
  find_surface();
  place_spheres(model, model.organs[organ]);
  box_ = last_box_ = {extent_, {-1, -1, -1}};
}

/// The grid's axes are those of the lattice. It reaches a spacing beyond the spheres, and beyond the organ's surface.
void CutGrid::find_frame(const Model& model, const OrganRange& organ) {
  step_ = organ.spacing / kPerSpacing;
  const cutting::LatticeFrame frame = cutting::lattice_frame(model, organ);
  const auto [low, high] = cells_of(model, std::size_t(organ_), frame);
  origin_ = frame.origin, first_cell_ = low;
  for (std::size_t a = 0; a < 3; ++a) {
    axis_[a] = frame.axis[a];
    origin_ += organ.spacing * (low[a] - 1) * frame.axis[a];
    extent_[a] = kPerSpacing * (high[a] - low[a] + 2) + 1, blocks_[a] = high[a] - low[a] + 3;
  }
}

CutGrid::Index CutGrid::block_at(Vec3 rest) const {
  Index block = 0;
  for (std::size_t a = 3; a-- > 0;) {
    const double at = dot(rest - origin_, axis_[a]) / (kPerSpacing * step_);
    if (!(at >= 0 && at < blocks_[a])) return -1;
    block = block * blocks_[a] + Index(at);
  }
  return block;
}

std::vector<CutGrid::Index> CutGrid::corners_around(Vec3 rest) const {
  Node low;
  for (std::size_t a = 0; a < 3; ++a) {
    const double at = dot(rest - origin_, axis_[a]) / step_;
    if (!(at >= 0 && at < extent_[a])) return {};
    low[a] = Index(at);
  }
  std::vector<Index> corners;
  for (int d = 0; d < kDirections; ++d)
    if (const Node corner{low[0] + (d & 1), low[1] + (d >> 1 & 1), low[2] + (d >> 2)}; contains(corner))
      corners.push_back(at(corner));
  return corners;
}

/// Which nodes are in tissue, and where edges leave it.
void CutGrid::find_surface() {
  constexpr int kHalvings = 12;
  const auto organ = std::size_t(organ_);
  const auto nodes = std::size_t(extent_[0]) * std::size_t(extent_[1]) * std::size_t(extent_[2]);
  in_tissue_.assign(nodes, 0), parted_.assign(nodes, 0);
  for (Index i = 0; i < Index(nodes); ++i) in_tissue_[std::size_t(i)] = depth_.at(organ, rest(i)) > 0;
  for (Index i = 0; i < Index(nodes); ++i)
    for (int d = 1; d < kDirections; ++d) {
      const Node n = node(i), other{n[0] + (d & 1), n[1] + (d >> 1 & 1), n[2] + (d >> 2)};
      if (!contains(other) || in_tissue(i) == in_tissue(at(other))) continue;
      const Vec3 p = rest(i), q = rest(at(other));
      double inside = in_tissue(i) ? 0 : 1, outside = 1 - inside;
      for (int h = 0; h < kHalvings; ++h) {
        const double middle = 0.5 * (inside + outside);
        (depth_.at(organ, p + middle * (q - p)) > 0 ? inside : outside) = middle;
      }
      outer_[edge(i, d)] = {std::clamp(float(0.5 * (inside + outside)), kOuterFromEnd, 1 - kOuterFromEnd)};
      parted_[std::size_t(i)] |= std::uint8_t(1 << d);
    }
}

/// The lattice covers the organ: a sphere outside the tissue belongs to a node inside.
void CutGrid::place_spheres(const Model& model, const OrganRange& organ) {
  for (Index s = 0; s < organ.count; ++s) {
    const LatticeCell cell = model.cell[std::size_t(organ.first + s)];
    Node node;
    for (std::size_t a = 0; a < 3; ++a) node[a] = kPerSpacing * (cell[a] - first_cell_[a] + 1);
    own_node_.push_back(at(node));
    home_.push_back(find_home(s));
  }
  node_of_sphere_ = home_;
}

/// The node in tissue that is the fewest edges from a sphere, none of which the swept surface crosses; of such nodes
/// the nearest one.
CutGrid::Index CutGrid::find_home(Index sphere) const {
  const Index own = own_node_[std::size_t(sphere)];
  if (in_tissue(own)) return own;
  constexpr Index kReach = 2 * kPerSpacing;
  const Node here = node(own);
  const auto squared_distance = [&](Index i) {
    const Node n = node(i);
    Index sum = 0;
    for (std::size_t a = 0; a < 3; ++a) sum += (n[a] - here[a]) * (n[a] - here[a]);
    return sum;
  };
  constexpr Index kSide = 2 * kReach + 1;
  std::vector<std::uint8_t> seen(std::size_t(kSide * kSide * kSide), 0);
  const auto was_seen = [&](Index i) -> std::uint8_t& {
    const Node n = node(i);
    return seen[std::size_t(n[0] - here[0] + kReach +
                            kSide * (n[1] - here[1] + kReach + kSide * (n[2] - here[2] + kReach)))];
  };
  std::vector<Index> front{own};
  was_seen(own) = 1;
  for (Index hops = 0; hops < kReach && !front.empty(); ++hops) {
    std::vector<Index> next;
    Index best = -1;
    const auto go = [&](Index to, std::size_t by) {
      const auto is_cut = [&] {
        return is_parted(Index(by / kDirections), int(by % kDirections)) && cuts_.contains(by) && !torn_.contains(by);
      };
      if (was_seen(to) != 0 || is_cut() || (!outside_.empty() && outside_.contains(by))) return;
      was_seen(to) = 1, next.push_back(to);
      if (!in_tissue(to)) return;
      if (best < 0 || std::pair(squared_distance(to), to) < std::pair(squared_distance(best), best)) best = to;
    };
    for (const Index from : front)
      for_each_edge(from, [&](Index to, Index lower, int direction) { go(to, edge(lower, direction)); });
    if (best >= 0) return best;
    front = std::move(next);
  }
  return -1;
}

/// Finds the homes again of spheres outside the tissue near edges whose crossings changed.
void CutGrid::find_homes_outside() {
  constexpr Index kReach = 2 * kPerSpacing;
  const NodeBox changed = box_;
  for (Index s = 0; s < Index(own_node_.size()); ++s) {
    const Node own = node(own_node_[std::size_t(s)]);
    bool is_near = !in_tissue(own_node_[std::size_t(s)]);
    for (std::size_t a = 0; a < 3; ++a)
      is_near = is_near && own[a] >= changed.low[a] - kReach && own[a] <= changed.high[a] + kReach;
    if (is_near) home_[std::size_t(s)] = find_home(s);
  }
}

/// Puts all spheres at their homes but the strays.
void CutGrid::move_strays(const std::vector<TornTissue::Tear::Stray>& strays) {
  std::vector<Index> nodes = home_;
  for (const auto& [sphere, node] : strays) nodes[std::size_t(sphere)] = node;
  if (nodes == node_of_sphere_) return;
  for (std::size_t s = 0; s < nodes.size(); ++s)
    for (const Index i : {nodes[s], node_of_sphere_[s]})
      if (nodes[s] != node_of_sphere_[s] && i >= 0) box_.add(node(i));
  node_of_sphere_ = std::move(nodes), changed_ = true;
}

/// Severs what a row of the swept surface crosses.
void CutGrid::sever_row(const State& state, std::size_t row) {
  auto [from, to, newly] = cutting::swept_row(state, row);
  std::array<bool, kEdgeNodes> is_outside{};
  bool any = false;
  for (std::uint8_t& organ : newly) {
    if (organ != organ_ + 1) organ = 0;
    any = any || organ != 0;
  }
  if (!any) return;
  const auto organ = std::size_t(organ_);
  for (std::size_t n = 0; n < kEdgeNodes; ++n)
    if (newly[n] != 0 || (n > 0 && newly[n - 1] != 0))
      is_outside[n] = depth_.at(organ, from[n]) <= 0 && depth_.at(organ, to[n]) <= 0;
  const bool may_move = row + 1 == cutting::swept_rows(state);
  torn_tissue_.sever(from, to, newly, may_move);
  for (const bool outside : {false, true}) {
    for (std::size_t n = 0; n + 1 < kEdgeNodes; ++n) {
      if (newly[n] == 0) continue;
      sever(from[n], from[n + 1], to[n], outside, may_move), sever(from[n + 1], to[n + 1], to[n], outside, may_move);
    }
    for (cutting::Front* front : {&from, &to})
      cutting::go_on_outside(depth_, organ, newly, is_outside, kPerSpacing * step_, *front);
  }
}

/// Severs the edges in tissue that a triangle of the swept surface crosses, or those that leave it or are outside.
void CutGrid::sever(Vec3 a, Vec3 b, Vec3 c, bool outside, bool may_move) {
  Node from, to;
  double least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (const Vec3 corner : {a, b, c})
    for (std::size_t x = 0; x < 3; ++x) {
      const double at = dot(corner - origin_, axis_[x]) / step_;
      least[x] = std::min(least[x], at), most[x] = std::max(most[x], at);
    }
  for (std::size_t x = 0; x < 3; ++x) {
    if (!(most[x] > -1 && least[x] < extent_[x])) return;
    from[x] = std::max(0, Index(std::floor(least[x])) - 1), to[x] = std::min(extent_[x] - 1, Index(std::ceil(most[x])));
  }
  if (!outside) {
    // Walls are put onto the triangle even where it crosses no other edge than the one before it.
    changed_ = true;
    for (const Node& corner : {from, to}) {
      box_.add(corner);
      if (may_move) last_box_.add(corner);
    }
  }
  for (Index k = from[2]; k <= to[2]; ++k)
    for (Index j = from[1]; j <= to[1]; ++j)
      for (Index i = from[0]; i <= to[0]; ++i)
        for (int d = 1; d < kDirections; ++d) {
          const Node n{i, j, k}, other{i + (d & 1), j + (d >> 1 & 1), k + (d >> 2)};
          if (!contains(other)) continue;
          const Index p = at(n), q = at(other);
          const int ends_in = int(in_tissue(p)) + int(in_tissue(q));
          if (outside ? ends_in == 2 : ends_in == 0) continue;
          const double along = crossing_of(rest(p), rest(q), a, b, c);
          if (along < 0) continue;
          if (outside)
            sever_outside(p, d, may_move);
          else
            sever_edge(p, d, std::clamp(float(along), kFromEnd, 1 - kFromEnd), cross(b - a, c - a), may_move);
        }
}

void CutGrid::sever_edge(Index node, int direction, float along, Vec3 normal, bool may_move) {
  const std::size_t e = edge(node, direction);
  if (torn_.contains(e)) join(e);
  const auto [found, is_new] = cuts_.try_emplace(e, Cut{along, along, normal, normal});
  Cut& cut = found->second;
  if (!is_new && along >= cut.low && along <= cut.high) return;
  if (may_move) by_last_.emplace_back(e, is_new ? std::nullopt : std::optional(cut));
  if (along < cut.low) cut.low = along, cut.normal_low = normal;
  if (along > cut.high) cut.high = along, cut.normal_high = normal;
  parted_[std::size_t(node)] |= std::uint8_t(1 << direction);
  if (in_tissue(node) && in_tissue(end(node, direction))) anything_cut_ = true;
  changed_ = true;
  box_.add(this->node(node)), box_.add(this->node(end(node, direction)));
}

void CutGrid::sever_outside(Index node, int direction, bool may_move) {
  if (!outside_.insert(edge(node, direction)).second) return;
  if (may_move) outside_by_last_.push_back(edge(node, direction));
  box_.add(this->node(node));
}

/// Tears the tissue where the network has come apart, and mends what is no longer torn.
void CutGrid::tear(const State& state) {
  const TornTissue::Tear tear = torn_tissue_.find(*this, state);
  move_strays(tear.stray);
  std::unordered_map<std::size_t, Vec3> wanted;
  for (const auto& [node, direction] : tear.edge)
    wanted.emplace(edge(node, direction), rest(end(node, direction)) - rest(node));
  const std::vector<std::size_t> before(torn_.begin(), torn_.end());
  for (const std::size_t e : before)
    if (!wanted.contains(e)) join(e);
  for (const auto& [e, normal] : wanted)
    if (!torn_.contains(e)) part(e, normal);
}

void CutGrid::part(std::size_t e, Vec3 normal) {
  const auto node = Index(e / kDirections);
  const int direction = int(e % kDirections);
  torn_.insert(e), cuts_[e] = {0.5f, 0.5f, normal, normal};
  parted_[std::size_t(node)] |= std::uint8_t(1 << direction);
  anything_cut_ = changed_ = true;
  box_.add(this->node(node)), box_.add(this->node(end(node, direction)));
}

void CutGrid::join(std::size_t e) {
  const auto node = Index(e / kDirections);
  const int direction = int(e % kDirections);
  torn_.erase(e), cuts_.erase(e);
  parted_[std::size_t(node)] &= std::uint8_t(~(1 << direction));
  changed_ = true;
  box_.add(this->node(node)), box_.add(this->node(end(node, direction)));
}

void CutGrid::take_back_last_row() {
  torn_tissue_.take_back();
  if (last_box_.low[0] <= last_box_.high[0]) box_.add(last_box_.low), box_.add(last_box_.high);
  last_box_ = {extent_, {-1, -1, -1}};
  for (const std::size_t e : outside_by_last_) outside_.erase(e), box_.add(node(Index(e / kDirections)));
  outside_by_last_.clear();
  for (auto change = by_last_.rbegin(); change != by_last_.rend(); ++change) {
    const auto& [e, before] = *change;
    const auto node = Index(e / kDirections);
    const int direction = int(e % kDirections);
    if (before)
      cuts_.at(e) = *before;
    else
      cuts_.erase(e);
    if (!before && !outer_.contains(e)) parted_[std::size_t(node)] &= std::uint8_t(~(1 << direction));
    changed_ = true;
    box_.add(this->node(node)), box_.add(this->node(end(node, direction)));
  }
  by_last_.clear();
}

void CutGrid::reset() {
  if (anything_cut_ || !cuts_.empty()) box_ = {{0, 0, 0}, extent_};
  changed_ = changed_ || anything_cut_;
  for (const auto& [e, cut] : cuts_)
    if (!outer_.contains(e)) parted_[e / kDirections] &= std::uint8_t(~(1 << int(e % kDirections)));
  cuts_.clear(), by_last_.clear(), outside_.clear(), outside_by_last_.clear(), torn_.clear(), torn_tissue_.reset();
  anything_cut_ = false, rows_ = 0;
}

void CutGrid::NodeBox::add(Node n) {
  for (std::size_t x = 0; x < 3; ++x) low[x] = std::min(low[x], n[x]), high[x] = std::max(high[x], n[x]);
}

std::optional<CutGrid::Crossing> CutGrid::cut_crossing(Index node, int direction, bool nearest_to_upper) const {
  const auto found = cuts_.find(edge(node, direction));
  if (found == cuts_.end()) return std::nullopt;
  const Cut& cut = found->second;
  return nearest_to_upper ? Crossing{cut.high, cut.normal_high} : Crossing{cut.low, cut.normal_low};
}

CutGrid::Crossing CutGrid::outer_crossing(Index node, int direction) const {
  const Outer& outer = outer_.at(edge(node, direction));
  const std::atomic_ref known(outer.triangle);
  Index triangle = known.load(std::memory_order_relaxed);
  if (triangle == kUnknown) {
    const Vec3 p = rest(node);
    triangle = nearest_triangle(p + double(outer.along) * (rest(end(node, direction)) - p));
    known.store(triangle, std::memory_order_relaxed);
  }
  return {outer.along, triangle < 0 ? Vec3{} : normal_of(triangle)};
}

Vec3 CutGrid::normal_of(Index triangle) const {
  const Surface& surface = model_.surfaces[std::size_t(organ_)];
  const auto& t = surface.triangle[std::size_t(triangle)];
  const Vec3 a = surface.vertex[std::size_t(t[0])];
  return cross(surface.vertex[std::size_t(t[1])] - a, surface.vertex[std::size_t(t[2])] - a);
}

bool CutGrid::update(const State& state) {
  const std::size_t rows = cutting::swept_rows(state);
  const auto place = [&](std::size_t row, std::size_t node) { return state.swept[row * kEdgeNodes + node]; };
  changed_ = false;
  const auto is_row = [&](std::size_t row, const cutting::Front& front) {
    for (std::size_t n = 0; n < kEdgeNodes; ++n)
      if (!(place(row, n) == front[n])) return false;
    return true;
  };
  if (rows == rows_ && (rows == 0 || (is_row(rows - 1, last_) && torn_tissue_.knows_severed(state)))) return false;
  if (rows < rows_ || (rows_ > 1 && !is_row(rows_ - 2, before_))) reset();
  // The last row has moved: what it severed is found again, so that the result depends on `state` alone.
  take_back_last_row();
  for (std::size_t row = std::max<std::size_t>(rows_, 2) - 1; row < rows; ++row) sever_row(state, row);
  find_homes_outside();
  tear(state);
  rows_ = rows;
  for (std::size_t n = 0; n < kEdgeNodes; ++n) {
    if (rows > 1) before_[n] = place(rows - 2, n);
    if (rows > 0) last_[n] = place(rows - 1, n);
  }
  return changed_;
}

std::vector<std::uint8_t> CutGrid::cut_blocks() const {
  std::vector<std::uint8_t> blocks(std::size_t(block_count()), 0);
  for (const auto& [e, cut] : cuts_) {
    const auto from = Index(e / kDirections), to = end(from, int(e % kDirections));
    blocks[std::size_t(block(from))] = blocks[std::size_t(block(to))] = 1;
  }
  return blocks;
}

std::vector<std::uint8_t> CutGrid::widened(const std::vector<std::uint8_t>& blocks) const {
  std::vector<std::uint8_t> wider(blocks.size(), 0);
  for (Index k = 0; k < blocks_[2]; ++k)
    for (Index j = 0; j < blocks_[1]; ++j)
      for (Index i = 0; i < blocks_[0]; ++i) {
        if (!blocks[std::size_t(i + blocks_[0] * (j + blocks_[1] * k))]) continue;
        for (Index z = std::max(0, k - 1); z <= std::min(blocks_[2] - 1, k + 1); ++z)
          for (Index y = std::max(0, j - 1); y <= std::min(blocks_[1] - 1, j + 1); ++y)
            for (Index x = std::max(0, i - 1); x <= std::min(blocks_[0] - 1, i + 1); ++x)
              wider[std::size_t(x + blocks_[0] * (y + blocks_[1] * z))] = 1;
      }
  return wider;
}

std::vector<CutGrid::Index> CutGrid::find_pieces() const {
  std::vector<Index> root(in_tissue_.size(), -1);
  const auto find = [&](Index n) {
    while (root[std::size_t(n)] != n) n = root[std::size_t(n)] = root[std::size_t(root[std::size_t(n)])];
    return n;
  };
  for (Index i = 0; i < count(); ++i) {
    if (in_tissue(i)) root[std::size_t(i)] = i;
    const Node n = node(i);
    for (int d = 1; d < kDirections && in_tissue(i); ++d) {
      const Node before{n[0] - (d & 1), n[1] - (d >> 1 & 1), n[2] - (d >> 2)};
      if (!contains(before) || !in_tissue(at(before)) || is_parted(at(before), d)) continue;
      const Index a = find(i), b = find(at(before));
      root[std::size_t(std::max(a, b))] = std::min(a, b);
    }
  }
  for (Index i = 0; i < count(); ++i)
    if (in_tissue(i)) root[std::size_t(i)] = find(i);
  return root;
}

CutGrid::NodeBox CutGrid::take_changed() {
  const NodeBox box = box_;
  box_ = {extent_, {-1, -1, -1}};
  return box;
}

}  // namespace ctpm::cutbody
