#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/film/captions.h"
#include "studio/film/export_video.h"
#include "studio/film/ghost.h"
#include "studio/film/inset.h"
#include "studio/film/schedule.h"
#include "studio/film/session_film.h"
#include "studio/render/overlay.h"
#include "studio/render/renderer.h"
#include "studio/render/strip.h"
#include "studio/views/look.h"

namespace ctpm::film {

/// One session of the film with its replay, renderer and overlay.
struct Reel {
  std::unique_ptr<SessionFilm> film;
  views::Look look;
  std::unique_ptr<render::Renderer> renderer;
  std::unique_ptr<render::Overlay> overlay;
  FrameTicks ticks;
  std::vector<Moment> moments;
  std::string caption;      ///< in place of their words for all of the film; empty: none
  std::int64_t told = 0;    ///< ticks for which a moment's words are shown
  double speed = 1;         ///< of the film
  bool shows_pace = false;  ///< where it is not that of the clock
  render::OverlayLevel level = render::OverlayLevel::full;
  std::string role;  ///< of a pair, whose it is: render::OverlayData::role
  std::optional<Ghost> ghost;
  std::vector<Inset> insets;
  int taken_right = 0;  ///< by them [pixels]
  std::optional<render::Strip> strip;
  int strip_height = 0;  ///< [pixels]

  /// The shot of a frame. A session that has not begun or has ended stands still and says so. Errors: see
  /// SessionFilm::shoot.
  Result<Shot> shoot(std::int64_t frame) const;
};

/// The level of that name; none if there is none of that name.
std::optional<render::OverlayLevel> level_of(const std::string& name);

/// The State that tells views::find_look() what happened in a session, so that a part is seen as the whole is: the last
/// keyframe where something is cut, else the one before the deepest press of `all`; with the inputs of that press.
/// Where the session is damaged there, the last keyframe up to the end of `part`. Errors: that is damaged, too.
Result<State> telling_state(recordings::SessionReader& session, const session::TickRange& part,
                            const std::vector<Moment>& all);

/// How a scene of that size and place is seen.
struct Seen {
  render::Bounds rest;
  views::Look look;
};
Seen seen_in(const Reel& reel);

/// `first`: how the first session of the film is seen; all of the same scene are seen like it, wherever their wounds
/// are. Errors: a damaged session, a look that the scene does not have, no OpenGL 3.3.
Result<Reel> make_reel(recordings::SessionReader& session, FrameTicks ticks, const render::PictureSize& size,
                       const ExportOptions& options, const std::optional<Seen>& first = {},
                       Between between = Between::replayed);

/// What goes in step: the sessions and the ghost of ExportOptions, which does so as another half would.
std::vector<recordings::SessionReader*> in_step_with(std::vector<recordings::SessionReader*> sessions,
                                                     const ExportOptions& options);

/// All sessions that stand side by side, and the ghost. `ticks`: of in_step_with() them. Errors: as make_reel(), of all
/// of them.
Result<std::vector<Reel>> make_reels(const std::vector<recordings::SessionReader*>& sessions,
                                     std::vector<FrameTicks> ticks, const ExportOptions& options,
                                     Between between = Between::replayed);

/// The value of the last colour of elements in a film of these sessions [the legend's unit]; 0: there are no elements.
/// Errors: a damaged session.
Result<double> full_scale_of(const std::vector<recordings::SessionReader*>& sessions, render::ElementQuantity quantity);

/// Gives the elements of all reels one range of colours, that of the sessions unless one is given. Errors: a damaged
/// session.
Result<Done> colour_alike(std::span<Reel> reels, const std::vector<recordings::SessionReader*>& sessions);

/// The largest force of whole sessions that can be read [N]: a plot whose axis ends there stands still, whatever part
/// is shown.
double largest_force(const std::vector<recordings::SessionReader*>& sessions);

/// One session at one moment; its plot goes up to `top_force` [N] at least.
render::Frame draw_shot(Reel& reel, Shot& shot, double top_force);

/// All sessions at one moment, side by side; their plots have one scale.
render::Frame draw_shots(std::vector<Reel>& reels, std::vector<Shot>& shots, double top_force);

}  // namespace ctpm::film
