#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include "core/contact/open_cuts.h"
#include "core/cutbody/cut_patches.h"
#include "core/cutbody/cut_points.h"
#include "core/model/box.h"
#include "core/model/model.h"
#include "core/model/stage.h"
#include "core/model/state.h"
#include "core/model/state_view.h"

namespace ctpm::contact {

/// The surfaces that cuts open, as they are touched: patches (cutbody::CutPatches) that stand for parts of the organs'
/// own surfaces near a cut: those of State::open_cuts.
///
/// A thread of their own follows cuts that will open and makes their patches, which takes longer than a tick. Where it
/// has not done so by then, ticks wait for it if something may touch the cut, so that results do not depend on how fast
/// it is.
class CutSurfaces {
 public:
  /// `model` must outlive the CutSurfaces, and so must `watch`, if it is not null. Nothing is built until something is
  /// cut, or prepare() is called.
  explicit CutSurfaces(const Model& model, StageWatch* watch = nullptr);
  CutSurfaces(const CutSurfaces&) = delete;
  CutSurfaces& operator=(const CutSurfaces&) = delete;
  ~CutSurfaces();

  /// Builds at once what the first cut needs; what the second one needs is then built beside the ticks.
  void prepare();

  /// Whether begin_tick() will change `state`.
  bool changes(const State& state, bool cuts) const { return open_ && changes_open_cuts(cuts, state); }
  /// Opens cuts of `state` and follows them from the start of a tick on. `cuts`: a blade is held.
  void begin_tick(State& state, bool cuts);

  /// Waits for the cuts if something in `region` may touch them, or touched them at the start of the substep; what is
  /// farther may go on as if nothing were cut. `organs`: their surfaces, in a round. Returns whether it waited.
  bool wait_near(const Box& region, const StateView& state, const surface::NearSurface& organs);

  /// Whether anything that can be touched is cut.
  bool any() const { return open_ && open_->is_cut; }
  const cutbody::CutPoints& points() const { return points_; }
  /// Number in State::touched of a patch's first vertex.
  std::int32_t first_point(std::int32_t kind, const cutbody::CutPatch& patch) const {
    return points_.at(kind, std::size_t(patch.body.organ), patch.block) + patch.body.first_vertex;
  }

  /// For each vertex through all organs, whether patches stand there for the organ's own surface. Only where any().
  const std::vector<std::uint8_t>& hidden() const { return open_->hidden; }
  /// Whether they do at one of them.
  bool hides(std::int32_t vertex) const { return any() && open_->hidden[std::size_t(vertex)] != 0; }
  /// The same at a place of its surface at rest.
  bool covers(std::size_t organ, Vec3 rest) const {
    const cutbody::CutPatches* cut = patches(organ);
    return cut != nullptr && cut->covers(rest);
  }

  /// How often what is cut has changed, or begun to.
  std::uint32_t version() const { return version_; }
  /// Whether the cuts of an organ are touched and leave more than one piece.
  bool has_pieces(std::size_t organ) const {
    const cutbody::CutPatches* cut = patches(organ);
    return cut != nullptr && cut->has_pieces();
  }
  /// Lowest node of the piece that each sphere of an organ belongs to; see cutbody::CutPatches. Only where it is cut.
  const std::vector<std::int32_t>& piece_of_sphere(std::size_t organ) const {
    return open_->organs[organ]->piece_of_sphere();
  }

  /// Begins a round with the spheres at `position` [m], which must outlive it.
  void begin(const Vec3Array& position);
  /// Calls `visit(patch)` for the patches that may meet `region`, in a fixed order.
  template <class Region, class Visit>
  void near(const Region& region, Visit&& visit) {
    for (std::size_t organ = 0; any() && organ < open_->organs.size(); ++organ) near(organ, region, visit);
  }
  /// The same for one organ.
  template <class Region, class Visit>
  void near(std::size_t organ, const Region& region, Visit&& visit) {
    if (cutbody::CutPatches* cut = patches(organ)) cut->near(region, visit);
  }
  /// Calls `visit(patch)` for all patches, in the same order; the round has not begun for them.
  template <class Visit>
  void for_each(Visit&& visit) {
    for (std::size_t organ = 0; any() && organ < open_->organs.size(); ++organ)
      if (cutbody::CutPatches* cut = patches(organ)) cut->for_each(visit);
  }
  /// The patches of an organ; null: nothing of it is cut that is touched.
  cutbody::CutPatches* patches(std::size_t organ) const {
    if (!any() || !open_->organs[organ] || !open_->organs[organ]->is_cut()) return nullptr;
    return &*open_->organs[organ];
  }
  /// Begins the round for a patch that near() visited before: what is cut has not changed since.
  void begin(const cutbody::CutPatch& patch) { open_->organs[std::size_t(patch.body.organ)]->begin(patch); }
  /// The patch that a point of a cut belongs to; null: it is not there any more.
  cutbody::CutPatch* patch(const cutbody::CutPoints::Place& place);

 private:
  /// Cuts as they are touched.
  struct Followed {
    std::vector<std::optional<cutbody::CutPatches>> organs;  ///< empty where an organ's cuts are not touched
    std::shared_ptr<const State> of;  ///< only with the cuts' swept surface and severed elements; null: nothing was cut
    /// What will be in `hidden`. While it is valid the worker has `organs` to itself; later it may only prepare those
    /// in which nothing is cut yet.
    std::future<std::vector<std::uint8_t>> follows;
    std::stop_source stop;  ///< of the worker's making of patches
    bool is_cut = false;
    std::vector<std::uint8_t> hidden{};  ///< (vertex_count through all organs, or empty)
  };
  void start(Followed& followed, const State& state, const TouchedCuts& cuts);
  void wait();
  std::vector<std::uint8_t> find_hidden(const Followed& followed) const;

  const Model& model_;
  StageWatch* watch_;
  cutbody::CutPoints points_;
  std::unique_ptr<Followed> open_, opening_;  ///< null where nothing can touch cuts
  bool is_prepared_ = false;
  std::uint32_t version_ = 0;
  const Vec3Array* position_ = nullptr;
  std::jthread worker_;
};

}  // namespace ctpm::contact
