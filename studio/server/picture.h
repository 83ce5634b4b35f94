#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/contact/drawn_surfaces.h"
#include "core/model/model.h"
#include "core/model/state.h"
#include "core/stepping/step.h"
#include "studio/render/expert_cut.h"
#include "studio/server/drawn_cuts.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::server {

/// What a frame says of the second hand.
struct SecondHandFacts {
  stepping::HandReport report;
  Vec3 hand;  ///< as FrameFacts::hand [m]
};

/// What a frame says besides where the surfaces are. PROTOCOL.md gives its bytes.
struct FrameFacts {
  std::uint32_t request = 0;    ///< number of the request that it answers; 0: none
  bool is_same = true;          ///< the replay is as recorded so far
  bool is_live = false;         ///< of a running session
  bool is_glimpse = false;      ///< the tissue is between two States that are known; the replayed picture follows
  std::int64_t tick = 0;        ///< ticks done
  Vec3 force;                   ///< of the tissue on the tool [N]
  double depth = 0;             ///< of a ball in the organ, of a blade along it; of a glimpse's blade 0 [m]
  std::int32_t contacts = 0;    ///< spheres touched
  std::int64_t severed = 0;     ///< elements severed so far
  Vec3 hand;                    ///< position of the hand that leads the tool [m]; of a replay: the tool's
  double tick_time = 0;         ///< computing time of the last tick [s]; 0: not measured
  std::int64_t late_ticks = 0;  ///< so far
  double tick_p99 = 0;          ///< of the computing times of the last ticks [s]; 0: not known
  double slip = 0;              ///< TickRecord::slip of the last tick [s]
  SecondHandFacts second;       ///< written of a Model with two hands
};

/// One moment as bytes for a page.
struct Picture {
  std::uint32_t stage = 0;                       ///< where the page shows it
  std::uint32_t topology = 0;                    ///< number of the triangles that the frame belongs to; never reused
  std::shared_ptr<const std::string> triangles;  ///< message of that topology
  std::string frame;                             ///< message; its count of missed frames is still 0
  std::string drawing = {}, expert = {};         ///< messages that are sent before the frame; empty: none
};

/// Byte offset of the count of missed frames in a frame.
inline constexpr std::size_t kMissedOffset = 12;

/// Turns States of one Model into pictures. Follows a few cuts at once, because a cut takes longer to draw than a
/// moment to show.
class PictureMaker {
 public:
  /// `model` must outlive this. `cuts`: what others drew of the same session, for the same stage.
  PictureMaker(const Model& model, std::uint32_t stage, std::shared_ptr<DrawnCuts> cuts);
  PictureMaker(const Model& model, std::uint32_t stage)
      : PictureMaker(model, stage, std::make_shared<DrawnCuts>(model, stage)) {}

  /// Whose cut is shown on the organs in the pictures that follow; null: nobody's. It is of the same scene.
  void show(std::shared_ptr<const render::ExpertCut> expert) { expert_ = std::move(expert); }

  /// The picture of a State. A cut that was not drawn yet is drawn now.
  Picture make(const State& state, const FrameFacts& facts);

  /// The picture of a State with what was drawn already of its cut: quick.
  Picture make_glimpse(State state, const FrameFacts& facts);

 private:
  struct Follower {
    CutFollower follower;
    std::uint64_t used = 0;
  };
  std::shared_ptr<const DrawnCut> draw(const State& state);
  Picture make(const State& state, const FrameFacts& facts, const std::shared_ptr<const DrawnCut>& drawn);
  std::string expert_message(const State& state, std::uint32_t request, const DrawnCut& drawn);

  const Model& model_;
  std::uint32_t stage_;
  std::shared_ptr<DrawnCuts> cuts_;
  contact::DrawnSurfaces places_;
  std::vector<Follower> followers_;
  std::uint64_t uses_ = 0;
  std::vector<std::vector<Vec3>> vertex_;  ///< of each organ
  std::shared_ptr<const render::ExpertCut> expert_;
  render::ExpertMarker marker_;
};

/// Number of elements that are severed in a State.
std::int64_t severed_in(const State& state);

/// Message with the shapes of a Model's tools and obstacles, in the Model's order.
std::string shapes_message(const Model& model, std::uint32_t stage);

/// Message with the spheres of a Model at rest, and of which of its organ's tissues each is.
std::string spheres_message(const Model& model, const std::vector<views::OrganTissues>& tissues, std::uint32_t stage);

}  // namespace ctpm::server
