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

/// Bins of spheres are so many blocks along each axis (our choice: small ones bound patches better, large ones faster).
constexpr CutGrid::Index kPerBin = 3;

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

/// What a thread that makes patches binds them with.
struct CutPatches::Binder {
  std::optional<SideBinding> binding;     ///< once it was needed
  std::vector<CutGrid::NodeBox> changed;  ///< what it has not been told of

  SideBinding& up_to_date(const Model& model, const CutGrid& grid) {
    if (!binding) binding.emplace(model, grid), changed.clear();
    for (const CutGrid::NodeBox& box : std::exchange(changed, {})) binding->update(box);
    return *binding;
  }
};

struct CutPatches::Parts {
  Parts(const Model& model, std::size_t organ) : grid(model, organ) {
    const CutGrid::Node bins = bins_of(grid);
    by_bin.resize(std::size_t(bins[0] * bins[1] * bins[2] + 1));
    for (std::int32_t s = 0; s < model.organs[organ].count; ++s) {
      const Index node = grid.node_of_sphere(s);
      bin_of_sphere.push_back(node < 0 ? Index(by_bin.size()) - 1 : bin_of(grid, grid.node(node)));
      by_bin[std::size_t(bin_of_sphere.back())].push_back(s);
    }
  }

  CutGrid grid;
  Binder ahead, asked;  ///< of make_all(), and of who asks for patches
  std::vector<Index> bin_of_sphere;
  std::vector<std::vector<Index>> by_bin;  ///< the spheres in each bin; in the last those that are in no tissue
  std::shared_ptr<const State> seen;       ///< what is followed
};

CutPatches::CutPatches(const Model& model, std::size_t organ, StageWatch* watch)
    : model_(model), organ_(organ), watch_(watch) {}
CutPatches::~CutPatches() = default;
CutPatches::CutPatches(CutPatches&&) noexcept = default;

void CutPatches::prepare() {
  if (parts_) return;
  parts_ = std::make_unique<Parts>(model_, organ_);
  for (Binder* binder : {&parts_->ahead, &parts_->asked}) (void)binder->up_to_date(model_, parts_->grid);
}

void CutPatches::follow(std::shared_ptr<const State> state) {
  const bool was_followed = parts_ && parts_->seen;
  if (cutting::sweeps_same(was_followed ? *parts_->seen : State{}, *state, std::int32_t(organ_)) &&
      (!is_cut() || severs_same(*parts_->seen, *state))) {
    if (was_followed)
      for (Binder* binder : {&parts_->ahead, &parts_->asked})
        if (binder->binding) binder->binding->forget();
    return;
  }
  if (!parts_) parts_ = std::make_unique<Parts>(model_, organ_);
  try {
    parts_->seen = std::move(state);
    (void)parts_->grid.update(*parts_->seen);
    const CutGrid::NodeBox changed = parts_->grid.take_changed();
    for (Binder* binder : {&parts_->ahead, &parts_->asked}) binder->changed.push_back(changed);
    cover();
  } catch (...) {
    parts_.reset(), covered_.clear();  // they may be half done
    throw;
  }
}

/// Whether two States know the same elements of the organ to be severed.
bool CutPatches::severs_same(const State& a, const State& b) const {
  const OrganRange& organ = model_.organs[organ_];
  const auto is_severed = [](const State& state, std::size_t e) {
    return !state.axial_severed.empty() && state.axial_severed[e] != 0;
  };
  for (std::size_t e = 0; e < model_.axial.size(); ++e)
    if (const std::int32_t sphere = model_.axial.a[e] - organ.first; sphere >= 0 && sphere < organ.count)
      if (is_severed(a, e) != is_severed(b, e)) return false;
  return true;
}

void CutPatches::make_all(const std::stop_token& stop) {
  for (Covered& covered : covered_) {
    if (stop.stop_requested()) return;
    (void)make_once(covered, parts_->ahead);
  }
}

/// Makes all patches that are not made yet, from the other end than make_all(): what both bind lies between two blocks.
void CutPatches::make_rest() {
  if (are_made_) return;
  const InStage stage(watch_, Stage::cut_surface);
  for (auto covered = covered_.rbegin(); covered != covered_.rend(); ++covered)
    (void)make_once(*covered, parts_->asked);
  for (Covered& covered : covered_)
    while (!make_once(covered, parts_->asked))
      std::atomic_ref(covered.making).wait(Making::now, std::memory_order_acquire);
  find_bins();
  are_made_ = true;
}

/// Makes the patches of a block. Returns whether they are made; else another thread makes them now.
bool CutPatches::make_once(Covered& covered, Binder& binder) {
  const std::atomic_ref making(covered.making);
  Making was = Making::not_yet;
  if (!making.compare_exchange_strong(was, Making::now, std::memory_order_acquire)) return was == Making::done;
  try {
    covered.patches = make(covered.block, binder.up_to_date(model_, parts_->grid));
  } catch (...) {
    binder.binding.reset();  // it may be half done
    making.store(Making::not_yet, std::memory_order_release), making.notify_all();
    throw;
  }
  making.store(Making::done, std::memory_order_release), making.notify_all();
  return true;
}

void CutPatches::cover() {
  const CutGrid& grid = parts_->grid;
  covered_.clear(), index_of_.clear(), piece_.clear(), piece_of_sphere_.clear(), has_pieces_ = are_made_ = false;
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
    index_of_[std::size_t(block)] = Index(covered_.size());
    covered_.push_back({block});
  }
}

bool CutPatches::covers(Vec3 rest) const {
  if (!is_cut()) return false;
  const Index block = parts_->grid.block_at(rest);
  return block >= 0 && index_of_[std::size_t(block)] >= 0;
}

void CutPatches::begin(const Vec3Array& position) { position_ = &position, ++round_; }

/// Finds the bins of the spheres that each patch follows.
void CutPatches::find_bins() {
  bounded_.clear(), found_in_ = 0;
  const auto first_sphere = model_.organs[organ_].first;
  std::vector<const CutPatch*> seen(parts_->by_bin.size());  // the last patch that followed a sphere in it
  for (Covered& covered : covered_)
    for (const auto& patch : covered.patches) {
      const surface::NearSurface& surface = patch->body.surface;
      if (surface.empty()) continue;
      Bounded& bounded = bounded_.emplace_back(Bounded{patch.get()});
      for (const surface::NearSurface::Bound& group : surface.groups())
        surface.for_each_sphere(group, [&](std::int32_t sphere) {
          const Index bin = parts_->bin_of_sphere[std::size_t(sphere - first_sphere)];
          if (std::exchange(seen[std::size_t(bin)], patch.get()) != patch.get()) bounded.bins.push_back(bin);
        });
    }
}

/// Finds within what boxes the patches are: a patch moves within the range of the spheres that it follows.
void CutPatches::find_boxes() {
  found_in_ = round_;
  const auto moved = [&](Index sphere) {
    const auto i = std::size_t(model_.organs[organ_].first + sphere);
    return (*position_)[i] - model_.rest_position[i];
  };
  ranges_.resize(parts_->by_bin.size(), Box{Vec3{}});
  for (std::size_t bin = 0; bin < ranges_.size(); ++bin) {
    const std::vector<Index>& spheres = parts_->by_bin[bin];
    if (!spheres.empty()) ranges_[bin] = Box(moved(spheres.front()));
    for (const Index sphere : spheres) ranges_[bin].add(moved(sphere));
  }
  for (Bounded& bounded : bounded_) {
    Box range = ranges_[std::size_t(bounded.bins.front())];
    for (const Index bin : bounded.bins) {
      const Box& other = ranges_[std::size_t(bin)];
      range.add(other.low), range.add(other.high);
    }
    const surface::NearSurface& surface = bounded.patch->body.surface;
    bounded.box = surface.rest_box().moved(surface.displacements_within(range));
    if (&bounded == &bounded_.front()) all_ = bounded.box;
    all_.add(bounded.box.low), all_.add(bounded.box.high);
  }
}

CutPatch* CutPatches::patch(Index block, std::int32_t vertex) {
  if (!is_cut() || block < 0 || std::size_t(block) >= index_of_.size()) return nullptr;
  const Index index = index_of_[std::size_t(block)];
  if (index < 0) return nullptr;
  make_rest();
  Covered& covered = covered_[std::size_t(index)];
  begin(covered);
  for (const auto& patch : covered.patches) {
    const std::int32_t own = vertex - patch->body.first_vertex;
    if (own >= 0 && std::size_t(own) < patch->body.surface.vertex_count()) return patch.get();
  }
  return nullptr;
}

void CutPatches::begin(Covered& covered) {
  if (std::exchange(covered.round, round_) == round_) return;
  for (const auto& patch : covered.patches) patch->body.surface.begin(*position_);
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
