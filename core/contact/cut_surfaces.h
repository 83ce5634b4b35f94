#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "core/cutbody/cut_patches.h"
#include "core/cutbody/cut_points.h"
#include "core/cutting/swept_surface.h"
#include "core/model/box.h"
#include "core/model/model.h"
#include "core/model/stage.h"
#include "core/model/state.h"
#include "core/model/state_view.h"

namespace ctpm::contact {

/// The surfaces that cuts open, as they are touched: patches (cutbody::CutPatches) that stand for parts of the organs'
/// own surfaces near a cut. A cut is touched when the blade has left it: while a blade goes on cutting, the surface
/// that it sweeps is not.
///
/// A thread of their own follows the cut and makes the patches, which takes longer than a tick. Ticks wait for it where
/// something may touch the cut, so that results do not depend on how fast it is.
class CutSurfaces {
 public:
  /// `model` must outlive the CutSurfaces, and so must `watch`, if it is not null. Nothing is built until something is
  /// cut, or prepare() is called.
  explicit CutSurfaces(const Model& model, StageWatch* watch = nullptr);
  CutSurfaces(const CutSurfaces&) = delete;
  CutSurfaces& operator=(const CutSurfaces&) = delete;

  /// Builds at once what the first cut needs.
  void prepare();

  /// Follows the cuts of `state` from the start of a tick on. `cuts`: a blade is held.
  void begin_tick(const State& state, bool cuts);

  /// Waits for the cuts if something in `region` may touch them, or touched them at the start of the substep; what is
  /// farther may go on as if nothing were cut. `organs`: their surfaces, in a round. Returns whether it waited.
  bool wait_near(const Box& region, const StateView& state, const surface::NearSurface& organs);

  /// Whether anything that can be touched is cut.
  bool any() const { return is_cut_; }
  const cutbody::CutPoints& points() const { return points_; }
  /// Number in State::touched of a patch's first vertex.
  std::int32_t first_point(std::int32_t kind, const cutbody::CutPatch& patch) const {
    return points_.at(kind, std::size_t(patch.body.organ), patch.block) + patch.body.first_vertex;
  }

  /// For each vertex through all organs, whether patches stand there for the organ's own surface (vertex_count, or
  /// empty).
  const std::vector<std::uint8_t>& hidden() const { return hidden_; }
  /// Whether they do at one of them.
  bool hides(std::int32_t vertex) const { return is_cut_ && hidden_[std::size_t(vertex)] != 0; }
  /// The same at a place of its surface at rest.
  bool covers(std::size_t organ, Vec3 rest) const { return organs_[organ] && organs_[organ]->covers(rest); }

  /// How often what is cut has changed, or begun to.
  std::uint32_t version() const { return version_; }
  /// Whether the cuts of an organ are touched and leave more than one piece.
  bool has_pieces(std::size_t organ) const { return is_cut_ && organs_[organ] && organs_[organ]->has_pieces(); }
  /// Lowest node of the piece that each sphere of an organ belongs to; see cutbody::CutPatches. Only where it is cut.
  const std::vector<std::int32_t>& piece_of_sphere(std::size_t organ) const {
    return organs_[organ]->piece_of_sphere();
  }

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
  /// Calls `visit(patch)` for all patches, in the same order; the round has not begun for them.
  template <class Visit>
  void for_each(Visit&& visit) {
    if (!is_cut_) return;
    for (auto& organ : organs_)
      if (organ) organ->for_each(visit);
  }
  /// The patches of an organ; null: nothing of it is cut that is touched.
  cutbody::CutPatches* patches(std::size_t organ) {
    return is_cut_ && organs_[organ] && organs_[organ]->is_cut() ? &*organs_[organ] : nullptr;
  }
  /// Begins the round for a patch that near() visited before: what is cut has not changed since.
  void begin(const cutbody::CutPatch& patch) { organs_[std::size_t(patch.body.organ)]->begin(patch); }
  /// The patch that a point of a cut belongs to; null: it is not there any more.
  cutbody::CutPatch* patch(const cutbody::CutPoints::Place& place);

 private:
  bool rests(const State& state);
  void start(const State& state, std::size_t rows);
  void wait();
  std::vector<std::uint8_t> find_hidden() const;

  const Model& model_;
  StageWatch* watch_;
  cutbody::CutPoints points_;
  std::vector<std::optional<cutbody::CutPatches>> organs_;  ///< empty where an organ's cuts are not touched
  double spacing_ = 0;                                      ///< the largest of all organs [m]
  bool is_cut_ = false;
  std::uint32_t version_ = 0;
  std::vector<std::uint8_t> hidden_;  ///< (vertex_count through all organs, or empty)
  const Vec3Array* position_ = nullptr;

  std::size_t seen_points_ = 0;  ///< of the swept surface in the last tick, and its last row
  cutting::Front seen_{};
  int rested_ = 0;                         ///< ticks since the blade cut
  std::shared_ptr<const State> followed_;  ///< only with a swept surface; null: nothing was cut
  /// What will be in hidden_. While it is valid the worker has organs_ to itself.
  std::future<std::vector<std::uint8_t>> follows_;
  std::jthread worker_;
};

}  // namespace ctpm::contact
