#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/film/schedule.h"
#include "studio/video/captions.h"

namespace ctpm::film {

/// What happens at a moment of a session, in words.
struct Moment {
  std::int64_t tick = 0;
  std::string text;
  enum class Kind { title, contact, force, deepest, cut, loose, damage, inside_out } kind = Kind::title;
  std::string largest = {};  ///< of force and deepest: how much it is
};

/// Everything that happens, in order of time. The largest force and depth are those of the whole session, or where it
/// is damaged elsewhere those of `part`. Errors: `part` is damaged.
Result<std::vector<Moment>> all_moments(recordings::SessionReader& session, const session::TickRange& part);

/// The parts of a session around its moments of some kinds, as ScheduleOptions::slow: words out of cut, damage and
/// worst (the largest force and depth), with commas between. Errors: another word.
Result<std::vector<std::array<double, 2>>> slow_parts(const std::vector<Moment>& all, const std::string& words,
                                                      double tick);

/// Seconds of a film at its own speed for which a moment's words are shown.
inline constexpr double kCaptionSeconds = 2.5;

/// Those that a film tells of which begins in tick `from`, apart enough to be read, and the title before them.
std::vector<Moment> told_moments(const std::vector<Moment>& all, const std::string& title, double tick,
                                 std::int64_t from);

/// The words at a tick, `shown` ticks long unless others follow; empty: none.
std::string words_at(const std::vector<Moment>& moments, std::int64_t tick, std::int64_t shown);

/// The same as captions of a film of `fps` frames per second.
std::vector<video::Caption> captions_of(const std::vector<Moment>& moments, const FrameTicks& ticks, std::int64_t shown,
                                        double fps);

/// Those of two halves as one track: "left: ..." above "right: ...". A chapter begins where one of them begins.
std::vector<video::Caption> captions_of_pair(const std::vector<video::Caption>& left,
                                             const std::vector<video::Caption>& right);

}  // namespace ctpm::film
