#include "core/cutbody/cut_patches.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/cutbody/cut_mesh.h"
#include "core/cutbody/cut_points.h"
#include "core/cutbody/side_binding.h"
#include "core/cutting/swept_surface.h"

namespace ctpm::cutbody {
namespace {

using Triangle = std::array<std::int32_t, 3>;

/// Bins of so many blocks along each axis: what is in one follows spheres in the bins around it (our choice; bindings
/// reach two blocks, or three where two do not span space).
constexpr CutGrid::Index kPerBin = 3;

/// At rest, vertices lie at most so many steps of the grid outside their block: walls are put onto the swept surface.
constexpr double kMargin = 2;

/// Vertices of two walls are opposite if they are nearer than this at rest, in steps of the grid, and face each other.
constexpr double kSamePlace = 0.35, kFacing = -0.3;

/// Radius of a facet of a patch, in spacings (our choice): it ends where the block ends, so that about as many facets
/// lie on a wall as on skin.
constexpr double kFacetRadius = 1;

/// Radius within which a ball's pressure is gathered, in spacings (our choice): about the size of the triangles of
/// organs' own surfaces.
constexpr double kGatherRadius = 0.25;

/// Where the areas around a vertex cancel to less than this part, both walls meet in it.
constexpr double kCancelled = 0.5;

CutGrid::Node bins_of(const CutGrid& grid) {
  CutGrid::Node bins;
  for (std::size_t a = 0; a < 3; ++a) bins[a] = (grid.extent()[a] - 1) / (kPerBin * CutGrid::kPerSpacing) + 1;
  return bins;
}

CutGrid::Index bin_of(const CutGrid& grid, CutGrid::Node node) {
  const CutGrid::Node bins = bins_of(grid);
  for (CutGrid::Index& n : node) n /= kPerBin * CutGrid::kPerSpacing;
  return node[0] + bins[0] * (node[1] + bins[1] * node[2]);
}

/// Areas around each vertex: as vectors, and their sizes.
struct Areas {
  std::vector<Vec3> sum;
  std::vector<double> size;

  explicit Areas(const Surface& part) : sum(part.vertex.size()), size(part.vertex.size(), 0) {
    for (const Triangle& t : part.triangle) {
      const Vec3 a = part.vertex[std::size_t(t[0])];
      const Vec3 area = cross(part.vertex[std::size_t(t[1])] - a, part.vertex[std::size_t(t[2])] - a);
      for (const std::int32_t v : t) sum[std::size_t(v)] += area, size[std::size_t(v)] += norm(area);
    }
  }
};

/// The surface of a block, and what is known of its vertices.
struct BlockSurface {
  Surface part;
  std::vector<std::int32_t> piece;
  std::int32_t first_wall = 0;

  /// For each vertex of a wall the one at its place on the other wall: itself where both end; -1: none.
  std::vector<std::int32_t> find_opposite(double same_place) const {
    const Areas areas(part);
    std::vector<std::int32_t> opposite(part.vertex.size(), -1);
    for (auto v = std::size_t(first_wall); v < opposite.size(); ++v) {
      const double own = norm(areas.sum[v]);
      if (own < kCancelled * areas.size[v]) {
        opposite[v] = std::int32_t(v);
        continue;
      }
      double least = same_place;
      for (auto u = std::size_t(first_wall); u < opposite.size(); ++u) {
        const double distance = norm(part.vertex[u] - part.vertex[v]);
        if (u == v || distance >= least) continue;
        if (dot(areas.sum[u], areas.sum[v]) > kFacing * norm(areas.sum[u]) * own) continue;
        least = distance, opposite[v] = std::int32_t(u);
      }
    }
    return opposite;
  }
};

}  // namespace

double CutPatch::opening(std::int32_t vertex) {
  const Opposite& other = opposite[std::size_t(vertex)];
  if (other.patch == nullptr) return std::numeric_limits<double>::infinity();
  const auto place = [&](std::int32_t v) { return body.surface.place(v); };
  const Vec3 apart = other.patch->body.surface.place(other.vertex) - place(vertex);
  return std::max(0.0, dot(apart, body.facets.normal(vertex, place)));
}

struct CutPatches::Parts {
  Parts(const Model& model, std::size_t organ) : grid(model, organ), binding(model, grid) {
    const OrganRange& range = model.organs[organ];
    for (std::int32_t s = 0; s < range.count; ++s) {
      const Index node = grid.node_of_sphere(s);
      bin_of_sphere.push_back(node < 0 ? -1 : bin_of(grid, grid.node(node)));
    }
  }

  CutGrid grid;
  SideBinding binding;                          ///< of who asks for patches
  std::optional<SideBinding> ahead;             ///< of make_all(), once it was called
  std::vector<CutGrid::NodeBox> ahead_changed;  ///< what `ahead` has not been told of
  std::vector<Index> bin_of_sphere;
  std::shared_ptr<const State> seen;  ///< what is followed
};

CutPatches::CutPatches(const Model& model, std::size_t organ, StageWatch* watch)
    : model_(model), organ_(organ), watch_(watch) {}
CutPatches::~CutPatches() = default;
CutPatches::CutPatches(CutPatches&&) noexcept = default;

void CutPatches::prepare() {
  if (!parts_) parts_ = std::make_unique<Parts>(model_, organ_);
}

void CutPatches::follow(std::shared_ptr<const State> state) {
  const bool was_followed = parts_ && parts_->seen;
  if (cutting::sweeps_same(was_followed ? *parts_->seen : State{}, *state, std::int32_t(organ_))) {
    if (was_followed) parts_->binding.forget();
    if (was_followed && parts_->ahead) parts_->ahead->forget();
    return;
  }
  prepare();
  parts_->seen = std::move(state);
  (void)parts_->grid.update(*parts_->seen);
  const CutGrid::NodeBox changed = parts_->grid.take_changed();
  parts_->binding.update(changed), parts_->ahead_changed.push_back(changed);
  cover();
}

void CutPatches::make_all(const std::stop_token& stop) {
  if (!is_cut() || stop.stop_requested()) return;
  std::optional<SideBinding>& ahead = parts_->ahead;
  try {
    if (!ahead) ahead.emplace(model_, parts_->grid), parts_->ahead_changed.clear();
    for (const CutGrid::NodeBox& changed : std::exchange(parts_->ahead_changed, {})) ahead->update(changed);
    for (Covered& covered : covered_)
      if (!stop.stop_requested()) (void)make_once(covered, *ahead);
  } catch (...) {
    ahead.reset();  // it may be half done
    throw;
  }
}

/// Makes the patches of a block. Returns whether they are made; else another thread makes them now.
bool CutPatches::make_once(Covered& covered, SideBinding& binding) {
  const std::atomic_ref making(covered.making);
  Making was = Making::not_yet;
  if (!making.compare_exchange_strong(was, Making::now, std::memory_order_acquire)) return was == Making::done;
  try {
    covered.patches = make(covered.block, binding);
  } catch (...) {
    making.store(Making::not_yet, std::memory_order_release), making.notify_all();
    throw;
  }
  making.store(Making::done, std::memory_order_release), making.notify_all();
  return true;
}

void CutPatches::cover() {
  const CutGrid& grid = parts_->grid;
  covered_.clear(), index_of_.clear(), piece_.clear(), piece_of_sphere_.clear(), has_pieces_ = false;
  if (!grid.anything_cut()) return;
  piece_ = grid.find_pieces();
  for (std::int32_t s = 0; s < model_.organs[organ_].count; ++s) {
    const Index node = grid.node_of_sphere(s);
    piece_of_sphere_.push_back(node < 0 ? -1 : piece_[std::size_t(node)]);
  }
  const Index first = *std::find_if(piece_.begin(), piece_.end(), [](Index piece) { return piece >= 0; });
  has_pieces_ = std::any_of(piece_.begin(), piece_.end(), [&](Index piece) { return piece >= 0 && piece != first; });
  const std::vector<std::uint8_t> blocks = grid.widened(grid.widened(grid.cut_blocks()));
  index_of_.assign(blocks.size(), -1);
  for (Index block = 0; block < grid.block_count(); ++block) {
    if (!blocks[std::size_t(block)]) continue;
    const CutGrid::Node low = grid.first_node(block);
    CutGrid::Node high = low;
    for (std::size_t a = 0; a < 3; ++a) high[a] += CutGrid::kPerSpacing;
    // The lattice may be turned in the scene.
    const Vec3 x = grid.place({high[0], low[1], low[2]}) - grid.place(low),
               y = grid.place({low[0], high[1], low[2]}) - grid.place(low),
               z = grid.place({low[0], low[1], high[2]}) - grid.place(low), at = grid.place(low);
    const Box rest = Box(at, at + x, at + y, at + z, at + x + y, at + x + z, at + y + z, at + x + y + z)
                         .grown(kMargin * grid.step());
    if (covered_.empty()) all_ = rest;
    all_.add(rest.low), all_.add(rest.high);
    index_of_[std::size_t(block)] = Index(covered_.size());
    covered_.push_back({block, bin_of(grid, low), rest});
  }
}

bool CutPatches::covers(Vec3 rest) const {
  if (!is_cut()) return false;
  const Index block = parts_->grid.block_at(rest);
  return block >= 0 && index_of_[std::size_t(block)] >= 0;
}

void CutPatches::begin(const Vec3Array& position) { position_ = &position, ++round_; }

/// Finds for each bin within what range the spheres in it and in those around it have moved.
void CutPatches::find_displacements() {
  const CutGrid::Node bins = bins_of(parts_->grid);
  ranges_.assign(std::size_t(bins[0]) * std::size_t(bins[1]) * std::size_t(bins[2]), {});
  const OrganRange& organ = model_.organs[organ_];
  Range all;
  for (std::int32_t s = 0; s < organ.count; ++s) {
    const auto i = std::size_t(organ.first + s);
    const Vec3 by = (*position_)[i] - model_.rest_position[i];
    all.add(by);
    if (const Index bin = parts_->bin_of_sphere[std::size_t(s)]; bin >= 0) ranges_[std::size_t(bin)].add(by);
  }
  const auto widened = [](const Range& range) {
    const Vec3 margin = kWiden * (range.box.high - range.box.low);
    return Box(range.box.low - margin, range.box.high + margin);
  };
  all_displacements_ = widened(all);
  displacements_.clear();
  for (Index k = 0; k < bins[2]; ++k)
    for (Index j = 0; j < bins[1]; ++j)
      for (Index i = 0; i < bins[0]; ++i) {
        Range around;
        for (Index z = std::max(0, k - 1); z <= std::min(bins[2] - 1, k + 1); ++z)
          for (Index y = std::max(0, j - 1); y <= std::min(bins[1] - 1, j + 1); ++y)
            for (Index x = std::max(0, i - 1); x <= std::min(bins[0] - 1, i + 1); ++x)
              around.add(ranges_[std::size_t(x + bins[0] * (y + bins[1] * z))]);
        displacements_.push_back(around.any ? widened(around) : all_displacements_);
      }
  found_in_ = round_;
}

CutPatch* CutPatches::patch(Index block, std::int32_t vertex) {
  if (!is_cut() || block < 0 || std::size_t(block) >= index_of_.size()) return nullptr;
  const Index index = index_of_[std::size_t(block)];
  if (index < 0) return nullptr;
  for (const auto& patch : made(covered_[std::size_t(index)])) {
    const std::int32_t own = vertex - patch->body.first_vertex;
    if (own >= 0 && std::size_t(own) < patch->body.surface.vertex_count()) return patch.get();
  }
  return nullptr;
}

std::vector<std::unique_ptr<CutPatch>>& CutPatches::made(Covered& covered) {
  const std::atomic_ref making(covered.making);
  if (making.load(std::memory_order_acquire) != Making::done) {
    const InStage stage(watch_, Stage::cut_surface);
    while (!make_once(covered, parts_->binding)) making.wait(Making::now, std::memory_order_acquire);
  }
  if (std::exchange(covered.round, round_) != round_)
    for (const auto& patch : covered.patches) patch->body.surface.begin(*position_);
  return covered.patches;
}

/// The surface in a block. What is at its border is as in the blocks around it.
static BlockSurface surface_of_block(const CutGrid& grid, CutGrid::Index block,
                                     const std::vector<CutGrid::Index>& piece, SideBinding& binding,
                                     const State& seen) {
  const CutMesh mesh = make_mesh_around(grid, block);
  const std::size_t count = mesh.vertex.size();
  std::vector<std::uint8_t> is_outer(count, 0), is_wall(count, 0);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (const auto v : mesh.triangle[t]) (t < mesh.outer_triangles ? is_outer : is_wall)[std::size_t(v)] = 1;

  BlockSurface result;
  Surface& part = result.part;
  part.binding.first.push_back(0);
  SideBinding::Writer writer(binding, part.binding);
  std::vector<CutGrid::Index> number(count, -1);
  const auto add = [&](CutGrid::Index v, bool in_wall) {
    const auto i = std::size_t(v);
    if (number[i] >= 0 || part.vertex.size() == std::size_t(CutPoints::kPerBlock)) return number[i];
    const SideBinding::Bound& bound =
        binding.bind(mesh.vertex[i], !in_wall || is_outer[i] != 0, in_wall || is_wall[i] != 0, seen);
    part.vertex.push_back(bound.rest), result.piece.push_back(piece[std::size_t(mesh.vertex[i].side)]);
    writer.add(bound.binding);
    return number[i] = std::int32_t(part.vertex.size()) - 1;
  };
  const auto add_triangles = [&](std::size_t first, std::size_t last, bool in_wall) {
    for (std::size_t t = first; t < last; ++t) {
      if (grid.block(mesh.cube[t]) != block) continue;
      Triangle corners;
      for (std::size_t c = 0; c < 3; ++c) corners[c] = add(mesh.triangle[t][c], in_wall);
      if (*std::min_element(corners.begin(), corners.end()) >= 0) part.triangle.push_back(corners);
    }
  };
  add_triangles(0, mesh.outer_triangles, false);
  result.first_wall = std::int32_t(part.vertex.size());
  std::fill(number.begin(), number.end(), -1);
  add_triangles(mesh.outer_triangles, mesh.triangle.size(), true);
  return result;
}

std::vector<std::unique_ptr<CutPatch>> CutPatches::make(Index block, SideBinding& binding) {
  const BlockSurface all = surface_of_block(parts_->grid, block, piece_, binding, *parts_->seen);
  std::vector<std::int32_t> pieces(all.piece);
  std::sort(pieces.begin(), pieces.end());
  pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
  std::vector<std::unique_ptr<CutPatch>> patches;
  std::vector<CutPatch::Opposite> place(all.piece.size());  // where each vertex is now
  std::int32_t first_vertex = 0;
  for (const std::int32_t piece : pieces) {
    Surface part;
    std::int32_t first_wall = 0;
    part.binding.first.push_back(0);
    const SurfaceBinding& from = all.part.binding;
    std::vector<std::size_t> vertices;
    for (std::size_t v = 0; v < all.piece.size(); ++v) {
      if (all.piece[v] != piece) continue;
      place[v].vertex = std::int32_t(vertices.size()), vertices.push_back(v);
      first_wall += std::int32_t(v) < all.first_wall;
      part.vertex.push_back(all.part.vertex[v]);
      for (auto e = std::size_t(from.first[v]); e < std::size_t(from.first[v + 1]); ++e)
        part.binding.sphere.push_back(from.sphere[e]), part.binding.weight.push_back(from.weight[e]);
      part.binding.first.push_back(std::int32_t(part.binding.sphere.size()));
    }
    part.binding.frame = from.frame;
    for (const TurnedOffset& offset : from.turned)
      if (all.piece[std::size_t(offset.vertex)] == piece)
        part.binding.turned.push_back({place[std::size_t(offset.vertex)].vertex, offset.frame, offset.offset});
    for (const Triangle& t : all.part.triangle) {
      const auto number = [&](std::size_t c) { return place[std::size_t(t[c])].vertex; };
      if (all.piece[std::size_t(t[0])] == piece) part.triangle.push_back({number(0), number(1), number(2)});
    }
    surface::Body body{std::int32_t(organ_), first_vertex, surface::NearSurface(model_, organ_, part),
                       surface::Facets(part, kFacetRadius * model_.organs[organ_].spacing)};
    patches.push_back(std::make_unique<CutPatch>(CutPatch{std::move(body), block, piece, first_wall}));
    patches.back()->gathering.add(part, kGatherRadius * model_.organs[organ_].spacing);
    for (const std::size_t v : vertices) place[v].patch = patches.back().get();
    first_vertex += std::int32_t(vertices.size());
  }
  const std::vector<std::int32_t> opposite = all.find_opposite(kSamePlace * parts_->grid.step());
  for (std::size_t v = 0; v < place.size(); ++v)
    place[v].patch->opposite.push_back(opposite[v] < 0 ? CutPatch::Opposite{} : place[std::size_t(opposite[v])]);
  return patches;
}

}  // namespace ctpm::cutbody
