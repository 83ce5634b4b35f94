#include "studio/film/schedule.h"

#include <algorithm>
#include <cmath>

#include "studio/output/number_text.h"
#include "studio/output/option_name.h"

namespace ctpm::film {
namespace {

using Sessions = std::vector<recordings::SessionReader*>;

double length_of(const recordings::SessionReader& session) {
  return double(session.tick_count()) * session.start().model.tick;
}

/// The same interval of time of each session, up to its end.
Result<std::vector<FrameTicks>> by_the_clock(const Sessions& sessions, const ScheduleOptions& options) {
  const auto longer = [](const recordings::SessionReader* a, const recordings::SessionReader* b) {
    return length_of(*a) < length_of(*b);
  };
  const recordings::SessionReader& longest = **std::max_element(sessions.begin(), sessions.end(), longer);
  const double tick = longest.start().model.tick;
  const Result<session::TickRange> shown = options.range.in_ticks(longest.path(), tick, longest.tick_count());
  if (!shown) return shown.errors();
  std::vector<FrameTicks> all(sessions.size());
  std::int64_t frames = 0;
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    const double own = sessions[i]->start().model.tick;
    const auto there = [&](std::int64_t of_longest) {
      return std::min<std::int64_t>(sessions[i]->tick_count(), std::llround(double(of_longest) * tick / own));
    };
    all[i].range = {there(shown->from), there(shown->to)};
    const session::TickRange range = all[i].range;
    const double ticks_a_frame = options.frame_s / own;
    all[i].ended = std::int64_t(std::ceil(double(range.to - range.from) / ticks_a_frame));
    all[i].tick = [range, ticks_a_frame](std::int64_t frame) {
      return std::min<std::int64_t>(range.to, range.from + std::llround(double(frame + 1) * ticks_a_frame));
    };
    all[i].share = [](std::int64_t) { return 1.0; };
    frames = std::max(frames, all[i].ended);
  }
  for (FrameTicks& ticks : all) ticks.frame_count = frames;
  return all;
}

/// Film time and the time of both sessions, in which each is linear from knot to knot [s].
struct Knot {
  double film = 0;
  std::array<double, 2> session{};
};

/// From both starts by way of the matched moments to both ends.
std::vector<Knot> knots_of(const Sessions& sessions, std::vector<std::array<double, 2>> matched) {
  matched.push_back({length_of(*sessions[0]), length_of(*sessions[1])});
  std::vector<Knot> knots(1);
  for (const std::array<double, 2>& next : matched) {
    const Knot& last = knots.back();
    const double longer = std::max(next[0] - last.session[0], next[1] - last.session[1]);
    if (longer > 0) knots.push_back({last.film + longer, next});
  }
  return knots;
}

/// The first knot, but not the very first, at or after `at` in what never decreases over the knots.
template <class From>
std::size_t next_knot(const std::vector<Knot>& knots, double at, From&& from) {
  std::size_t i = 1;
  while (i + 1 < knots.size() && at > from(knots[i])) ++i;
  return i;
}

/// The value of `to` where `from` is `at`.
template <class From, class To>
double along(const std::vector<Knot>& knots, double at, From&& from, To&& to) {
  const std::size_t i = next_knot(knots, at, from);
  const double begin = from(knots[i - 1]), end = from(knots[i]);
  const double share = end > begin ? std::clamp((at - begin) / (end - begin), 0.0, 1.0) : 1;
  return to(knots[i - 1]) + share * (to(knots[i]) - to(knots[i - 1]));
}

/// Through the parts that are slow, to the end.
std::vector<Knot> knots_of_slow(const recordings::SessionReader& session,
                                const std::vector<std::array<double, 2>>& slow) {
  std::vector<Knot> knots(1);
  const double end = length_of(session);
  const auto go_on = [&](double to, double slower) {
    const double passed = std::min(to, end) - knots.back().session[0];
    if (passed > 0) knots.push_back({knots.back().film + slower * passed, {knots.back().session[0] + passed, 0}});
  };
  for (const auto& [from, to] : slow) go_on(from, 1), go_on(to, kSlower);
  go_on(end, 1);
  return knots;
}

Result<std::vector<FrameTicks>> by_knots(const Sessions& sessions, const std::vector<Knot>& knots,
                                         const ScheduleOptions& options) {
  const double first_tick = sessions[0]->start().model.tick;
  const Result<session::TickRange> shown =
      options.range.in_ticks(sessions[0]->path(), first_tick, sessions[0]->tick_count());
  if (!shown) return shown.errors();
  if (knots.size() < 2) return by_the_clock(sessions, options);  // of no ticks
  const auto film = [](const Knot& knot) { return knot.film; };
  const auto of = [](std::size_t i) { return [i](const Knot& knot) { return knot.session[i]; }; };
  const double begin = shown->from == 0 ? 0.0 : along(knots, double(shown->from) * first_tick, of(0), film);
  const double end = shown->to == sessions[0]->tick_count() ? knots.back().film
                                                            : along(knots, double(shown->to) * first_tick, of(0), film);
  const auto frames = std::int64_t(std::ceil((end - begin) / options.frame_s * (1 - 1e-12)));
  std::vector<FrameTicks> all;
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    const auto tick_at = [knots, film, own = of(i), tick = sessions[i]->start().model.tick,
                          count = sessions[i]->tick_count()](double time) {
      return std::clamp<std::int64_t>(std::llround(along(knots, time, film, own) / tick), 0, count);
    };
    const auto time_of = [=, frame_s = options.frame_s](std::int64_t frame) {
      return std::min(end, begin + double(frame + 1) * frame_s);
    };
    const auto share_at = [knots, film, own = of(i)](double time) {
      const std::size_t next = next_knot(knots, time, film);
      return (own(knots[next]) - own(knots[next - 1])) / (knots[next].film - knots[next - 1].film);
    };
    const auto waits = std::find_if(knots.begin() + 1, knots.end(), [&](const Knot& k) { return k.session[i] > 0; });
    const auto begun = std::int64_t(std::floor((std::prev(waits)->film - begin) / options.frame_s * (1 + 1e-9)));
    const double over = along(knots, length_of(*sessions[i]) * (1 - 1e-9), of(i), film);
    const auto ended = std::int64_t(std::ceil((over - begin) / options.frame_s * (1 - 1e-9)));
    all.push_back({{tick_at(begin), tick_at(end)},
                   frames,
                   std::clamp<std::int64_t>(begun, 0, frames),
                   std::clamp<std::int64_t>(ended, 0, frames),
                   [=](std::int64_t frame) { return tick_at(time_of(frame)); },
                   [=](std::int64_t frame) { return share_at(time_of(frame)); }});
  }
  return all;
}

}  // namespace

Result<std::vector<FrameTicks>> schedule(const Sessions& sessions, const ScheduleOptions& options) {
  if (sessions.size() == 2 && !options.matched.empty())
    return by_knots(sessions, knots_of(sessions, options.matched), options);
  if (sessions.size() == 1 && !options.slow.empty())
    return by_knots(sessions, knots_of_slow(*sessions[0], options.slow), options);
  return by_the_clock(sessions, options);
}

Result<std::vector<FrameTicks>> schedule_moment(const Sessions& sessions, double at_s,
                                                const std::vector<std::array<double, 2>>& matched) {
  const double tick = sessions[0]->start().model.tick;
  const std::int64_t at = std::llround(at_s / tick);
  if (!(at_s >= 0) || at > sessions[0]->tick_count())
    return Error{output::option_name("export.at_s"),
                 "got " + output::short_number(at_s) + ", must be in [0, " +
                     output::short_number(length_of(*sessions[0])) + "] s, as " + sessions[0]->path() + " is",
                 ""};
  Result<std::vector<FrameTicks>> all = schedule(sessions, {{}, tick, matched, {}});
  if (!all) return all;
  // The first frame in which the first session is there; before all frames everything stands at its start.
  std::int64_t low = -1, high = (*all)[0].frame_count - 1;
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    if ((middle < 0 ? 0 : (*all)[0].tick(middle)) < at)
      low = middle + 1;
    else
      high = middle;
  }
  for (FrameTicks& ticks : *all) {
    const std::int64_t there = low < 0 ? 0 : ticks.tick(low);
    const double share = low < 0 ? 1.0 : ticks.share(low);
    ticks = {{std::max<std::int64_t>(0, there - 1), there},
             1,
             std::max<std::int64_t>(low, 0) >= ticks.begun ? 0 : 1,
             low >= ticks.ended ? 0 : 1,
             [there](std::int64_t) { return there; },
             [share](std::int64_t) { return share; }};
  }
  return all;
}

}  // namespace ctpm::film
