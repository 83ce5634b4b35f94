#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>
#include <vector>

#include "core/cutbody/cut_grid.h"
#include "core/model/box.h"
#include "core/model/model.h"
#include "core/model/stage.h"
#include "core/model/state.h"
#include "core/surface/bodies.h"
#include "core/surface/gathering.h"

namespace ctpm::cutbody {

class SideBinding;

/// What cuts make of the surface of one piece of tissue in one block of the grid, as a body that is touched.
struct CutPatch {
  /// A vertex of another wall, or of the same one.
  struct Opposite {
    CutPatch* patch = nullptr;
    std::int32_t vertex = -1;
  };

  surface::Body body;  ///< its first vertex is counted within the block
  std::int32_t block;
  std::int32_t piece;                ///< lowest node of the grid that is in it
  std::int32_t first_wall;           ///< the first of the vertices that belong to walls
  std::vector<Opposite> opposite{};  ///< at the place of a vertex at rest; a vertex is its own where both walls end

  surface::Gathering gathering{};  ///< of a ball's pressure

  /// How far the wall at a vertex is from the other one [m]; 0 where they touch or overlap, infinite where nothing is
  /// on the other side.
  double opening(std::int32_t vertex);
};

/// The surface of an organ near its cuts as CutBody draws it, in patches: one for each piece of tissue in each block of
/// the grid that is within two blocks of a cut: covers(). Elsewhere the organ's own surface stands. Both fit together:
/// no part of the body's surface is in both or in none. A function of the Model, of the swept surface
/// and of the severed elements alone, however they were followed.
class CutPatches {
 public:
  using Index = CutGrid::Index;

  /// `model` must outlive the CutPatches, and so must `watch`, if it is not null. The organ must have a surface.
  CutPatches(const Model& model, std::size_t organ, StageWatch* watch = nullptr);
  ~CutPatches();
  CutPatches(CutPatches&&) noexcept;

  /// Does at once what the first cut needs: a grid over the organ.
  void prepare();

  /// Follows the swept surface of `state` and what it has severed. Where both are the same in this organ, patches stay,
  /// and what would make new ones fast is forgotten.
  void follow(std::shared_ptr<const State> state);
  /// Makes patches until it is told to stop. One other thread may ask for patches meanwhile, and helps to make them:
  /// what spheres they follow, and so how far they may move, is known only when all are made.
  void make_all(const std::stop_token& stop);
  bool is_cut() const { return !covered_.empty(); }
  /// For each sphere of the organ the lowest node of its piece; -1: it is in none (sphere_count, or empty).
  const std::vector<Index>& piece_of_sphere() const { return piece_of_sphere_; }
  /// Whether the cuts leave more than one piece.
  bool has_pieces() const { return has_pieces_; }

  /// Whether patches stand for the organ's own surface at a place at rest.
  bool covers(Vec3 rest) const;

  /// Begins a round with the spheres at `position` [m], which must outlive it.
  void begin(const Vec3Array& position);
  /// Calls `visit(patch)` for the patches that may meet `region`, by ascending block. `region`: anything with
  /// `meets(Box)`.
  template <class Region, class Visit>
  void near(const Region& region, Visit&& visit);
  /// The same for all patches, for which the round has not begun.
  template <class Visit>
  void for_each(Visit&& visit);
  /// Begins the round for a patch that was visited before.
  void begin(const CutPatch& patch) { begin(covered_[std::size_t(index_of_[std::size_t(patch.block)])]); }
  /// The patch that a vertex of a block is in; null: there is none.
  CutPatch* patch(Index block, std::int32_t vertex);

 private:
  struct Binder;
  struct Parts;
  enum class Making : std::uint8_t { not_yet, now, done };
  /// A block that is covered.
  struct Covered {
    Index block;
    Making making = Making::not_yet;  ///< of its patches; read and written as an atomic
    std::vector<std::unique_ptr<CutPatch>> patches{};
    std::uint32_t round = 0;  ///< in which they were placed
  };
  struct Bounded {
    CutPatch* patch;
    std::vector<Index> bins{};  ///< of the spheres that it follows
    Box box{Vec3{}};            ///< within which it is now [m]
  };
  bool severs_same(const State& a, const State& b) const;
  void cover();
  void make_rest();
  bool make_once(Covered& covered, Binder& binder);
  std::vector<std::unique_ptr<CutPatch>> make(Index block, SideBinding& binding);
  void find_bins();
  void find_boxes();
  void begin(Covered& covered);

  const Model& model_;
  const std::size_t organ_;
  StageWatch* watch_;
  std::unique_ptr<Parts> parts_;  ///< made by prepare()
  std::vector<Covered> covered_;  ///< by block
  std::vector<Index> piece_;      ///< of each node of the grid
  std::vector<Index> piece_of_sphere_;
  bool has_pieces_ = false;
  std::vector<std::int32_t> index_of_;  ///< of a block in covered_; -1: not covered (block_count, or empty)
  bool are_made_ = false;               ///< all patches
  std::vector<Bounded> bounded_;        ///< of them, by block
  std::uint32_t round_ = 0, found_in_ = 0;
  const Vec3Array* position_ = nullptr;
  std::vector<Box> ranges_;  ///< of the displacements of each bin's spheres in round `found_in_` [m]
  Box all_{Vec3{}};          ///< around all patches in it [m]
};

template <class Region, class Visit>
void CutPatches::near(const Region& region, Visit&& visit) {
  if (!is_cut()) return;
  make_rest();
  if (found_in_ != round_) find_boxes();
  if (!region.meets(all_)) return;
  for (const Bounded& bounded : bounded_) {
    if (!region.meets(bounded.box)) continue;
    begin(*bounded.patch);
    visit(*bounded.patch);
  }
}

template <class Visit>
void CutPatches::for_each(Visit&& visit) {
  if (!is_cut()) return;
  make_rest();
  for (const Bounded& bounded : bounded_) visit(*bounded.patch);
}

}  // namespace ctpm::cutbody
