#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "core/model/state.h"
#include "recordings/replay.h"
#include "recordings/session_reader.h"
#include "scenes/scene_spec.h"
#include "studio/render/overlay.h"
#include "studio/session/cut_measures.h"
#include "studio/session/time_range.h"

namespace ctpm::film {

/// One moment of a session, ready to be drawn.
struct Shot {
  State state;
  render::OverlayData overlay;
  std::vector<Inputs> moments;     ///< argument of following_camera()
  std::optional<Hand> ghost = {};  ///< another session's tool
  double share = 0;                ///< of the whole session that has passed
};

/// What happens to the ticks between two shots: they are replayed, or, for moments that stand alone, left out where a
/// keyframe allows it. Then each shot is compared with the recording since that keyframe.
enum class Between { replayed, left_out };

/// Replays a session and gives one Shot for each frame.
class SessionFilm {
 public:
  /// `range` is the part to show; forces before it come from the recording. With `allow_diverged` the range is verified
  /// first if all of it is replayed, so that every shot can say that the replay differs. Errors: a damaged session or
  /// scene.
  static Result<std::unique_ptr<SessionFilm>> create(recordings::SessionReader& reader, const session::TickRange& range,
                                                     bool allow_diverged, Between between = Between::replayed);

  /// The shot of the State before `tick`. Ticks must not decrease from call to call. Errors: a damaged session; a
  /// replay that differs, unless allowed.
  Result<Shot> shoot(std::int64_t tick);

  /// Pieces of tissue that came loose from the session's start to the last shot.
  std::int64_t pieces_loose() const { return overlay_.loose; }

  /// Tissue cells that are inside out in the last shot.
  std::int32_t cells_inside_out() const { return overlay_.inside_out; }

  /// The overlay of the last shot; before the first, what is known of all.
  const render::OverlayData& overlay() const { return overlay_; }

  const scenes::SceneSpec& scene() const { return scene_; }
  const Model& model() const { return reader_.start().model; }
  const recordings::SessionReader& reader() const { return reader_; }
  const session::TickRange& range() const { return range_; }
  std::int64_t first_different_tick() const { return first_different_; }  ///< -1: none
  bool is_same() const { return first_different_ < 0; }
  std::string verdict() const;  ///< up to the last shot, in words

 private:
  SessionFilm(recordings::SessionReader& reader, scenes::SceneSpec scene, const session::TickRange& range,
              bool allow_diverged, Between between, recordings::ReplayCursor cursor);
  Result<Done> begin();
  Result<Done> start_at(std::int64_t tick);
  Result<Done> leap_towards(std::int64_t tick);
  void show_loads(const stepping::HandReport& first, const stepping::HandReport& second);
  void take_tick();
  void keep_inputs(const Inputs& inputs);
  void show_cut_depth();
  void keep_worst(double force, double depth);
  void look_back(const std::vector<recordings::Event>& events, std::int64_t begin, std::int64_t end);
  bool holds_blade(const Hand& hand) const;
  Error differs() const;

  recordings::SessionReader& reader_;
  scenes::SceneSpec scene_;
  session::TickRange range_;
  bool allow_diverged_;
  Between between_;
  recordings::ReplayCursor cursor_;
  render::OverlayData overlay_;
  session::CutMeasures cut_;
  std::int64_t plot_every_ = 1;  ///< ticks between two points of the force plot
  std::deque<Inputs> inputs_;    ///< of the last ticks, as many as a following camera needs
  std::int64_t first_different_ = -1;
};

/// Display name of the structure of a scene's first organ.
std::string structure_name(const scenes::SceneSpec& scene);

}  // namespace ctpm::film
