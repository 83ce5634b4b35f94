#include "studio/compare/moments.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <ranges>
#include <utility>

namespace ctpm::compare {
namespace {

constexpr double kHandRate = 100;    // [Hz]
constexpr double kIdleSpeed = 5e-3;  // [m/s]
constexpr double kIdleLeast = 0.3;   // [s]
constexpr double kSameMoment = 0.3;  // shorter gaps do not end a moment [s]
constexpr double kPauseAllowed = 1;  // [s]
constexpr double kMillimetres = 1e3;
constexpr double kNotable = 0.1;    // what lasts for this time has half the severity of what lasts [s]
constexpr double kTrifle = 0.05;    // severity below which a limit is as good as kept
constexpr std::size_t kInTurn = 3;  // moments of a kind before others have their turn

/// How bad it is to be `beyond` a limit, in limits, for `seconds`: a tick of it is next to nothing.
double severity_of(double beyond, double seconds) { return beyond * seconds / (seconds + kNotable); }

/// One moment for each run of values above `limit`; `time[i]` is when `value[i]` was.
std::vector<Moment> moments_above(MomentKind kind, const std::vector<double>& value, const std::vector<double>& time,
                                  double limit, std::size_t gap, double scale, const char* unit) {
  std::vector<bool> is_above;
  for (const double v : value) is_above.push_back(v > limit);
  std::vector<Moment> moments;
  for (const Spell& spell : spells_of(is_above, 1, gap)) {
    const auto worst =
        std::max_element(value.begin() + std::ptrdiff_t(spell.first), value.begin() + std::ptrdiff_t(spell.last));
    const double from = time[spell.first], to = time[spell.last - 1];
    moments.push_back({kind, from, to, time[std::size_t(worst - value.begin())], scale * *worst, scale * limit, unit,
                       severity_of(*worst / limit - 1, to - from)});
  }
  return moments;
}

void append(std::vector<Moment>& all, const std::vector<Moment>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Whether the tool touches or cuts between each of these times and the next.
std::vector<bool> work_at(const SessionTrack& track, const std::vector<double>& time) {
  const auto tick_at = [&](std::size_t i) { return std::size_t(std::llround(time[i] / track.tick)); };
  std::vector<bool> works;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const std::size_t last = i + 1 < time.size() ? tick_at(i + 1) : track.tick_count();
    works.push_back(false);
    for (std::size_t tick = tick_at(i); tick < last && !works.back(); ++tick) works.back() = track.works(tick);
  }
  return works;
}

bool meet(const Moment& a, const Moment& b) { return a.from_s <= b.to_s && b.from_s <= a.to_s; }

/// Measured without time: who waits before the work is not off the path in it. Who is below the path for pressing too
/// deep or too hard, which is one of `presses`, hears that once: a moment that meets one counts only if the tool would
/// be off the path even if it were no deeper than the expert's ever was.
std::vector<Moment> deviations(const Comparison& comparison, const SessionTrack& expert, const SessionTrack& trainee,
                               const std::vector<Moment>& presses) {
  const std::vector<bool> by_expert = work_at(expert, comparison.expert_time);
  const bool is_all_work = std::ranges::find(by_expert, true) == by_expert.end();
  const std::vector<double>& time = comparison.trainee_time;
  const std::vector<bool> works = work_at(trainee, time);
  std::vector<double> distance(time.size(), 0.0);
  for (std::size_t i = 0; i < time.size(); ++i)
    if (is_all_work || works[i]) distance[i] = distance_from(comparison.trainee_path[i], {&comparison.expert_path, 1});
  const double step = time.size() > 1 ? time[1] - time[0] : kSameMoment;
  std::vector<Moment> moments = moments_above(MomentKind::deviation, distance, time, comparison.path_limit,
                                              std::size_t(std::ceil(kSameMoment / step)), kMillimetres, "mm");
  const double deepest = expert.depth.empty() ? 0 : std::ranges::max(expert.depth);
  const auto is_aside = [&](std::size_t i) {
    const double deeper = trainee.depth[std::size_t(std::llround(time[i] / trainee.tick))] - deepest;
    return distance[i] - std::max(0.0, deeper) > comparison.path_limit;
  };
  std::erase_if(moments, [&](const Moment& off) {
    if (std::ranges::none_of(presses, [&](const Moment& press) { return meet(off, press); })) return false;
    for (std::size_t i = 0; i < time.size(); ++i)
      if (time[i] >= off.from_s && time[i] <= off.to_s && is_aside(i)) return false;
    return true;
  });
  return moments;
}

/// Idle spells of a session, in seconds.
struct Pause {
  double from_s, to_s;
};

/// When the tool touches or cuts for the last time, or the session's end if it never does [s].
double end_of_work(const SessionTrack& track) {
  std::size_t last = track.tick_count();
  while (last > 0 && !track.works(last - 1)) --last;
  return track.seconds(last > 0 ? last : track.tick_count());
}

/// From the first motion on until the work is done: who reads what is to be done, or has done it, does not pause.
std::vector<Pause> pauses_of(const SessionTrack& track) {
  const double end = end_of_work(track);
  std::vector<Pause> pauses;
  for (const Spell& stroke : track.strokes) {
    const HandMotion hand = hand_motion(track, stroke);
    const double start = track.seconds(stroke.first);
    for (const Spell& idle : hand.idle) {
      if (&stroke == &track.strokes.front() && idle.first == 0) continue;
      const double from = start + double(idle.first) / hand.rate_hz,
                   to = std::min(end, start + double(idle.last) / hand.rate_hz);
      if (from < to) pauses.push_back({from, to});
    }
  }
  return pauses;
}

std::vector<Moment> long_pauses(const SessionTrack& expert, const SessionTrack& trainee) {
  double allowed = kPauseAllowed;
  for (const Pause& pause : pauses_of(expert)) allowed = std::max(allowed, pause.to_s - pause.from_s);
  std::vector<Moment> moments;
  for (const Pause& pause : pauses_of(trainee)) {
    const double length = pause.to_s - pause.from_s;
    if (length > allowed)
      moments.push_back({MomentKind::pause, pause.from_s, pause.to_s, pause.from_s, length, allowed, "s",
                         severity_of(length / allowed - 1, length)});
  }
  return moments;
}

std::vector<Moment> stray_cuts(const SessionTrack& expert, const SessionTrack& trainee) {
  const auto by_expert =
      std::count_if(expert.severed_at.begin(), expert.severed_at.end(), [](std::int64_t tick) { return tick >= 0; });
  std::vector<Moment> moments;
  for (const Spell& cut : trainee.cuts) {
    std::vector<std::int64_t> ticks;  // in which elements were severed that the expert left whole
    for (std::size_t i = 0; i < trainee.severed_at.size(); ++i) {
      const std::int64_t tick = trainee.severed_at[i];
      if (tick >= std::int64_t(cut.first) && tick < std::int64_t(cut.last) && expert.severed_at[i] < 0)
        ticks.push_back(tick);
    }
    if (ticks.empty()) continue;
    const auto [first, last] = std::minmax_element(ticks.begin(), ticks.end());
    const double count = double(ticks.size()), end = trainee.seconds(std::size_t(*last));
    // What is cut stays cut: in the end all of it is seen.
    moments.push_back({MomentKind::stray_cut, trainee.seconds(std::size_t(*first)), end, end, count, 0, "elements",
                       count / std::max(1.0, double(by_expert))});
  }
  return moments;
}

std::vector<Moment> times_in_zones(const SessionTrack& trainee, std::size_t gap) {
  std::vector<Moment> moments;
  for (std::size_t zone = 0; zone < trainee.zones.size(); ++zone) {
    std::vector<bool> is_in;
    for (const std::int32_t in : trainee.zone) is_in.push_back(in == std::int32_t(zone));
    for (const Spell& spell : spells_of(is_in, 1, gap)) {
      const double from = trainee.seconds(spell.first), to = trainee.seconds(spell.last);
      moments.push_back({MomentKind::zone, from, to, from, to - from, 0, "s", to - from});
    }
  }
  return moments;
}

void put_in_order(std::vector<Moment>& moments) {
  std::ranges::stable_sort(moments, std::greater<>(), &Moment::severity);
  std::ranges::stable_sort(moments, {}, concern_of);
  std::map<MomentKind, std::size_t> seen;
  std::vector<std::pair<std::size_t, Moment>> turns;
  for (const Moment& moment : moments) {
    const std::size_t turn = seen[moment.kind]++ / kInTurn;
    turns.emplace_back(concern_of(moment) == Concern::trifle ? moments.size() : turn, moment);
  }
  std::ranges::stable_sort(turns, {}, &std::pair<std::size_t, Moment>::first);
  std::ranges::copy(turns | std::views::values, moments.begin());
}

}  // namespace

const char* to_word(MomentKind kind) {
  switch (kind) {
    case MomentKind::zone:
      return "in a forbidden zone";
    case MomentKind::stray_cut:
      return "cut where the expert did not";
    case MomentKind::force:
      return "force above the limit";
    case MomentKind::depth:
      return "deeper than the damage limit";
    case MomentKind::deviation:
      return "away from the expert's path";
    case MomentKind::pause:
      return "long pause";
  }
  return "";
}

Concern concern_of(const Moment& moment) {
  // Where a tool should not have been is no trifle.
  if (moment.kind == MomentKind::zone) return Concern::forbidden;
  if (moment.severity < kTrifle) return Concern::trifle;
  if (moment.kind == MomentKind::deviation) return Concern::accuracy;
  return moment.kind == MomentKind::pause ? Concern::economy : Concern::harm;
}

HandMotion hand_motion(const SessionTrack& track, const Spell& stroke) {
  HandMotion hand;
  const auto ticks = std::max<std::size_t>(1, std::size_t(std::llround(1 / (kHandRate * track.tick))));
  hand.rate_hz = 1 / track.seconds(ticks);
  hand.path = mean_of_each({track.tip.data() + stroke.first, stroke.last - stroke.first}, ticks);
  std::vector<bool> is_slow;
  for (const double speed : speed_along(hand.path, hand.rate_hz)) is_slow.push_back(speed < kIdleSpeed);
  const auto least = std::size_t(std::ceil(kIdleLeast * hand.rate_hz));
  hand.idle = spells_of(is_slow, least);
  return hand;
}

std::vector<Moment> worst_moments(const Comparison& comparison, const SessionTrack& expert,
                                  const SessionTrack& trainee) {
  std::vector<double> time;
  for (std::size_t i = 0; i < trainee.tick_count(); ++i) time.push_back(trainee.seconds(i));
  const auto gap = std::size_t(std::llround(kSameMoment / trainee.tick));
  std::vector<Moment> moments;
  if (comparison.force_limit)
    append(moments, moments_above(MomentKind::force, trainee.force, time, *comparison.force_limit, gap, 1, "N"));
  if (comparison.damage_depth > 0)
    append(moments,
           moments_above(MomentKind::depth, trainee.depth, time, comparison.damage_depth, gap, kMillimetres, "mm"));
  append(moments, deviations(comparison, expert, trainee, moments));
  if (expert.is_timed && trainee.is_timed) append(moments, long_pauses(expert, trainee));
  append(moments, stray_cuts(expert, trainee));
  append(moments, times_in_zones(trainee, gap));
  put_in_order(moments);
  return moments;
}

}  // namespace ctpm::compare
