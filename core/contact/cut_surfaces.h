#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/cutbody/cut_patches.h"
#include "core/cutbody/cut_points.h"
#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::contact {

/// The surfaces that cuts open, as they are touched: patches (cutbody::CutPatches) that stand for parts of the organs'
/// own surfaces near a cut. A cut is touched when the blade has left it: while a blade goes on cutting, the surface
/// that it sweeps is not.
class CutSurfaces {
 public:
  /// `model` must outlive the CutSurfaces. Nothing is built until something is cut, or a blade is held.
  explicit CutSurfaces(const Model& model);

  /// Follows the cuts of `state` at the start of a tick. `cuts`: a blade is held.
  void begin_tick(const State& state, bool cuts);

  /// Whether anything that can be touched is cut.
  bool any() const { return is_cut_; }
  const cutbody::CutPoints& points() const { return points_; }

  /// Whether patches stand for the organ's own surface at one of its vertices, numbered through all organs.
  bool hides(std::int32_t vertex) const { return is_cut_ && hidden_[std::size_t(vertex)] != 0; }
  /// The same at a place of its surface at rest.
  bool covers(std::size_t organ, Vec3 rest) const { return organs_[organ] && organs_[organ]->covers(rest); }

  /// Begins a round with the spheres at `position` [m], which must outlive it.
  void begin(const Vec3Array& position);
  /// Calls `visit(patch)` for the patches that may meet `region`, in a fixed order.
  template <class Region, class Visit>
  void near(const Region& region, Visit&& visit) {
    if (!is_cut_) return;
    for (auto& organ : organs_)
      if (organ) organ->near(region, visit);
  }
  /// The same for one organ.
  template <class Region, class Visit>
  void near(std::size_t organ, const Region& region, Visit&& visit) {
    if (is_cut_ && organs_[organ]) organs_[organ]->near(region, visit);
  }
  /// The patch that a point of a cut belongs to; null: it is not there any more.
  cutbody::CutPatch* patch(const cutbody::CutPoints::Place& place);

 private:
  void find_hidden();

  const Model& model_;
  cutbody::CutPoints points_;
  std::vector<std::optional<cutbody::CutPatches>> organs_;  ///< empty where an organ's cuts are not touched
  bool is_cut_ = false;
  std::vector<std::uint8_t> hidden_;  ///< (vertex_count through all organs, or empty)
};

}  // namespace ctpm::contact
