#pragma once

#include <array>
#include <cstdint>
#include <limits>
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
  std::string largest = {};    ///< of force and deepest: how much it is
  std::int64_t left = kNever;  ///< of contact and cut: the last tick in which the tool touches
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
};

/// Everything that happens, in order of time. The largest force and depth are those of the whole session, or where it
/// is damaged elsewhere those of `part`. Errors: `part` is damaged.
Result<std::vector<Moment>> all_moments(recordings::SessionReader& session, const session::TickRange& part);

/// The parts of a session around its moments of some kinds, as ScheduleOptions::slow: words out of cut, damage and
/// worst (the largest force and depth), with commas between. Errors: another word.
Result<std::vector<std::array<double, 2>>> slow_parts(const std::vector<Moment>& all, const std::string& words,
                                                      double tick);

/// Seconds of a film at its own speed for which a moment's words are shown. Those of a contact or a cut are untrue once
/// the tool has left, and go soon after that, but not before they can be read: about 20 characters a second.
inline constexpr double kCaptionSeconds = 2.5, kCaptionAfterContact = 0.5, kShortestCaption = 1.2;

/// Those that a film tells of which begins in tick `from`, apart enough to be read, and the title before them.
std::vector<Moment> told_moments(const std::vector<Moment>& all, const std::string& title, double tick,
                                 std::int64_t from);

/// The words at a tick of a film whose words are shown for `shown` ticks (kCaptionSeconds) unless others follow or the
/// tool leaves; empty: none.
std::string words_at(const std::vector<Moment>& moments, std::int64_t tick, std::int64_t shown);

/// The words of the last of them after tick `from` and before `tick`; empty: there is none.
std::string words_between(const std::vector<Moment>& moments, std::int64_t from, std::int64_t tick);

/// The same as captions of a film of `fps` frames per second.
std::vector<video::Caption> captions_of(const std::vector<Moment>& moments, const FrameTicks& ticks, std::int64_t shown,
                                        double fps);

/// Whose session it is: the trainee whom it names, else its file.
std::string name_of(const recordings::SessionReader& session);

/// Those of two halves as one track, with whose they are: "left (Ana): ..." above "right (Ben): ...". A chapter begins
/// where one of them begins.
std::vector<video::Caption> captions_of_pair(const std::vector<video::Caption>& left,
                                             const std::vector<video::Caption>& right,
                                             const std::array<std::string, 2>& names);

}  // namespace ctpm::film
