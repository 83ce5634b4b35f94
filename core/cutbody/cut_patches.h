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

/// The surface of an organ near its cuts as CutBody draws it, in patches that are made when they are asked for, one for
/// each piece of tissue in each block of the grid that is within two blocks of a cut: covers(). Elsewhere the organ's
/// own surface stands. Both fit together: no part of the body's surface is in both or in none. A function of the Model
/// and of the swept surface alone, however it was followed.
class CutPatches {
 public:
  using Index = CutGrid::Index;

  /// Patches move within the range of the spheres around them, widened on each side by this part of it: weights may be
  /// negative. A vertex moves at most kStretch times as far as the farthest sphere.
  static constexpr double kWiden = 1, kStretch = 1 + 2 * kWiden;

  /// `model` must outlive the CutPatches, and so must `watch`, if it is not null. The organ must have a surface.
  CutPatches(const Model& model, std::size_t organ, StageWatch* watch = nullptr);
  ~CutPatches();
  CutPatches(CutPatches&&) noexcept;

  /// Does at once what the first cut needs: a grid over the organ.
  void prepare();

  /// Follows the swept surface of `state`. Where it is the same in this organ, patches stay, and what would make new
  /// ones fast is forgotten.
  void follow(std::shared_ptr<const State> state);
  /// Makes the patches that nobody has asked for yet, until it is told to stop. One other thread may ask for patches
  /// meanwhile: it makes them itself, and waits for one only if this call is making it.
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
  /// How many blocks are covered; within what box what is in one of them is now [m]; its patches, in the round.
  std::size_t covered_count() const { return covered_.size(); }
  Box box_of(std::size_t covered) {
    if (found_in_ != round_) find_displacements();
    return covered_[covered].rest.moved(displacements_[std::size_t(covered_[covered].bin)]);
  }
  const std::vector<std::unique_ptr<CutPatch>>& patches(std::size_t covered) { return made(covered_[covered]); }
  /// Begins the round for a patch that near() visited before.
  void begin(const CutPatch& patch) { (void)made(covered_[std::size_t(index_of_[std::size_t(patch.block)])]); }
  /// The patch that a vertex of a block is in; null: there is none.
  CutPatch* patch(Index block, std::int32_t vertex);

 private:
  struct Parts;
  enum class Making : std::uint8_t { not_yet, now, done };
  /// A block that is covered.
  struct Covered {
    Index block, bin;
    Box rest{Vec3{}};                 ///< around it [m]
    Making making = Making::not_yet;  ///< of its patches; read and written as an atomic
    std::vector<std::unique_ptr<CutPatch>> patches{};
    std::uint32_t round = 0;  ///< in which they were placed
  };
  /// Where some spheres are, from rest.
  struct Range {
    bool any = false;
    Box box{Vec3{}};
    void add(Vec3 by) {
      if (any) return box.add(by);
      any = true, box = Box(by);
    }
    void add(const Range& other) {
      if (other.any) add(other.box.low), add(other.box.high);
    }
  };
  void cover();
  void find_displacements();
  std::vector<std::unique_ptr<CutPatch>>& made(Covered& covered);
  bool make_once(Covered& covered, SideBinding& binding);
  std::vector<std::unique_ptr<CutPatch>> make(Index block, SideBinding& binding);

  const Model& model_;
  const std::size_t organ_;
  StageWatch* watch_;
  std::unique_ptr<Parts> parts_;  ///< made by prepare()
  std::vector<Covered> covered_;  ///< by block
  std::vector<Index> piece_;      ///< of each node of the grid
  std::vector<Index> piece_of_sphere_;
  bool has_pieces_ = false;
  std::vector<std::int32_t> index_of_;  ///< of a block in covered_; -1: not covered (block_count, or empty)
  Box all_{Vec3{}};                     ///< around them at rest [m]
  std::uint32_t round_ = 0, found_in_ = 0;
  const Vec3Array* position_ = nullptr;
  /// Of each bin in round `found_in_`: where its spheres are, and within which box the displacements of what is in it
  /// lie [m].
  std::vector<Range> ranges_;
  std::vector<Box> displacements_;
  Box all_displacements_{Vec3{}};
};

template <class Region, class Visit>
void CutPatches::near(const Region& region, Visit&& visit) {
  if (!is_cut()) return;
  if (found_in_ != round_) find_displacements();
  if (!region.meets(all_.moved(all_displacements_))) return;
  for (std::size_t covered = 0; covered < covered_.size(); ++covered) {
    if (!region.meets(box_of(covered))) continue;
    for (const auto& patch : patches(covered)) visit(*patch);
  }
}

}  // namespace ctpm::cutbody
