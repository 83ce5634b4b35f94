#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/server/cuts_ahead.h"
#include "studio/server/drawing.h"
#include "studio/server/drawn_cuts.h"
#include "studio/server/known_files.h"
#include "studio/server/moments.h"
#include "studio/server/outbox.h"
#include "studio/server/picture.h"
#include "studio/server/spare_cursors.h"
#include "studio/session/tool_depth.h"

namespace ctpm::server {

class Seeker;

/// A session on the page: shows any of its moments on request. One thread replays; another shows by a glimpse what
/// takes longer, and waits for nothing.
class Stage {
 public:
  /// Opens `file` as stage `number` of the page behind `outbox` and sends the shapes of its tools. Errors: the session
  /// cannot be read.
  static Result<std::unique_ptr<Stage>> open(const std::string& file, std::uint32_t number,
                                             std::shared_ptr<Outbox> outbox);
  ~Stage();

  /// Asks for the State before `tick`, which is moved into the session; a newer request replaces one that waits.
  void show(std::int64_t tick, std::uint32_t request);

  /// The browser is done with the picture of a request, and leaves the processors to what else is to be shown of it.
  void ready(std::uint32_t request);

  /// Draws the replayed pictures that follow here too, beside their frames; without a size no longer. Elements have the
  /// range of colours that a film of all `shown` stages has. Errors: those of plan_drawing(); a damaged session.
  Result<DrawingPlan> draw_as(const DrawingRequest& request, const std::vector<std::shared_ptr<Stage>>& shown);

  /// Share of the session that can be reached with a short replay, in [0, 1].
  double prepared() const { return moments_->share(); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kPatience{30};  ///< with a replay before a glimpse is shown
  /// The longest that a replay waits for a browser without a GPU to draw a glimpse: one that says when it is done, and
  /// one that does not.
  static constexpr std::chrono::milliseconds kDrawing{250}, kUsualDrawing{60};

  /// Gives the turn back.
  struct EndTurn {
    void operator()(std::counting_semaphore<>* turns) const { turns->release(); }
  };
  using Turn = std::unique_ptr<std::counting_semaphore<>, EndTurn>;

  struct Wish {
    std::int64_t tick = 0;
    std::uint32_t request = 0;
  };
  Stage(recordings::SessionReader reader, std::unique_ptr<Moments> moments, std::uint32_t number,
        std::shared_ptr<Outbox> outbox);
  void replay();
  void glance();
  void end_glance();
  void wait_for_glimpse(const Wish& wish);
  Turn wait_for_turn();
  const State* told();
  std::shared_ptr<const render::ExpertCut> expert_of(const std::string& file);
  std::shared_ptr<const render::ExpertCut> expert();
  Result<double> full_scale(render::ElementQuantity quantity);
  Result<bool> follow_plan(Drawing& drawing);
  std::optional<Wish> next();
  std::optional<Wish> next_glimpse();
  bool is_outdated();
  void show(Picture picture, const Wish& wish, bool is_glimpse);
  FrameFacts facts(const Seeker& seeker, std::uint32_t request, session::ToolDepth& depth);

  recordings::SessionReader reader_;
  std::unique_ptr<Moments> moments_;
  std::uint32_t number_;
  std::shared_ptr<Outbox> outbox_;
  std::shared_ptr<DrawnCuts> cuts_;
  CutsAhead ahead_;
  SpareCursors spares_;
  std::mutex mutex_;
  std::condition_variable news_;
  Wish newest_;
  bool is_wanted_ = false;                                    ///< `newest_` waits for the replay
  bool wants_glimpse_ = false;                                ///< `newest_` waits for a glimpse
  Clock::time_point glimpse_due_ = Clock::time_point::max();  ///< of `newest_`, if it is not replayed before
  bool is_glancing_ = false;                                  ///< a glimpse is on its way
  bool is_replaying_ = false;                                 ///< a request that is not answered yet
  std::uint32_t glimpsed_ = 0, drawn_ = 0;                    ///< requests: of the last glimpse, of what was drawn last
  bool follows_page_ = false;                                 ///< the page says what it has drawn
  std::optional<DrawingPlan> plan_;                           ///< nothing is drawn before the first one
  bool is_plan_new_ = false;                                  ///< the replay does not follow it yet
  std::map<render::ElementQuantity, double> full_scales_;     ///< of a film of this session alone
  struct KnownExpert {
    std::string file;
    std::optional<KnownFiles::Stamp> stamp;
    std::shared_ptr<const render::ExpertCut> cut;
  };
  KnownExpert known_expert_;  ///< the last one
  std::mutex told_mutex_;
  std::unique_ptr<const State> told_;  ///< once it was asked for
  bool ends_ = false;
  std::thread replay_thread_, glimpse_thread_;
};

}  // namespace ctpm::server
