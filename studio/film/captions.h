#pragma once

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
};

/// Seconds of a film at its own speed for which a moment's words are shown.
inline constexpr double kCaptionSeconds = 2.5;

/// The moments that a film tells of, in order of time and apart enough to be read: its title, contacts, cuts, the
/// largest force and depth, damage, pieces. Errors: a damaged session.
Result<std::vector<Moment>> moments_of(recordings::SessionReader& session, const std::string& scene_name);

/// The words at a tick, `shown` ticks long unless others follow; empty: none.
std::string words_at(const std::vector<Moment>& moments, std::int64_t tick, std::int64_t shown);

/// The same as captions of a film of `fps` frames per second.
std::vector<video::Caption> captions_of(const std::vector<Moment>& moments, const FrameTicks& ticks, std::int64_t shown,
                                        double fps);

}  // namespace ctpm::film
