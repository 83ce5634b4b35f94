#include "studio/compare/session_measures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "studio/compare/measure_table.h"
#include "studio/compare/moments.h"
#include "studio/compare/slip.h"
#include "studio/output/number_text.h"

namespace ctpm::compare {
namespace {

constexpr double kMillimetres = 1e3, kMillijoules = 1e3;
constexpr double kCutPathSpacing = 0.5e-3;  // distance of the points of cut paths that are compared [m]

/// The stations of a stroke: its ends, the points where the tool met and left the tissue, and the deepest point.
/// Ascending indices within the stroke.
std::vector<std::size_t> stations_of(const SessionTrack& track, const Spell& stroke) {
  std::vector<std::size_t> at{stroke.first};
  std::size_t deepest = stroke.first;
  for (std::size_t i = stroke.first; i < stroke.last; ++i) {
    if (track.works(i) && at.size() == 1) at.push_back(i);
    if (track.works(i)) at.resize(2), at.push_back(i);
    if (track.depth[i] > track.depth[deepest]) deepest = i;
  }
  at.push_back(deepest), at.push_back(stroke.last - 1);
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  for (std::size_t& i : at) i -= stroke.first;
  return at;
}

/// The tip's way in a stroke, tick by tick, without what a device adds to it.
Path way_of_hand(const SessionTrack& track, const Spell& stroke) {
  return low_passed({track.tip.data() + stroke.first, stroke.last - stroke.first}, 1 / track.tick);
}

/// Measures of the motion of one session.
struct Motion {
  double path_length = 0, idle_time = 0;  // [m], [s]
  std::optional<double> economy, spectral_arc_length, log_dimensionless_jerk;
};

/// A weighted mean that skips strokes without a value.
struct WeightedMean {
  double sum = 0, weight = 0;
  void add(std::optional<double> value, double w) {
    if (value) sum += w * *value, weight += w;
  }
  std::optional<double> value() const { return weight > 0 ? std::optional(sum / weight) : std::nullopt; }
};

/// Measures each stroke by itself, because the tool jumps between strokes. Smoothness is defined for movements between
/// rests and measured for each. Its means are weighted by time, the economy's by length.
Motion motion_of(const SessionTrack& track) {
  Motion motion;
  WeightedMean economy, arc_length, jerk;
  for (const Spell& stroke : track.strokes) {
    const Path path = way_of_hand(track, stroke);
    const double length = path_length(path);
    motion.path_length += length;
    economy.add(economy_of_motion(path, stations_of(track, stroke)), length);
    const HandMotion hand = hand_motion(track, stroke);
    for (const Spell& idle : hand.idle) motion.idle_time += double(idle.last - idle.first) / hand.rate_hz;
    const std::vector<double> speed = speed_along(low_passed(hand.path, hand.rate_hz), hand.rate_hz);
    for (const Spell& movement : movements_of(speed)) {
      const auto part = std::span(speed).subspan(movement.first, movement.last - movement.first);
      arc_length.add(spectral_arc_length(part, hand.rate_hz), double(part.size()));
      jerk.add(log_dimensionless_jerk(part, hand.rate_hz), double(part.size()));
    }
  }
  motion.economy = economy.value(), motion.spectral_arc_length = arc_length.value();
  motion.log_dimensionless_jerk = jerk.value();
  return motion;
}

/// Measures of the forces of one session.
struct Force {
  double peak = 0, time_above = 0, impulse_above = 0;  // [N], [s], [N s]
  std::optional<double> mean;                          // [N]; none: the tool never moved against a force
};

Force force_of(const SessionTrack& track, double limit) {
  Force force;
  for (const double f : track.force) {
    force.peak = std::max(force.peak, f);
    if (f > limit) force.time_above += track.tick, force.impulse_above += (f - limit) * track.tick;
  }
  WeightedMean along_way;
  for (const Spell& stroke : track.strokes) {
    const Path path = way_of_hand(track, stroke);
    for (std::size_t i = 1; i < path.size(); ++i)
      if (const double f = track.force[stroke.first + i]; f > 0) along_way.add(f, norm(path[i] - path[i - 1]));
  }
  force.mean = along_way.value();
  return force;
}

double completion_time(const SessionTrack& track) {
  return track.seconds(track.strokes.back().last - track.strokes.front().first);
}

double time_beyond(const SessionTrack& track, double depth) {
  return track.seconds(
      std::size_t(std::count_if(track.depth.begin(), track.depth.end(), [&](double d) { return d > depth; })));
}

using Values = std::vector<SessionValue>;

void add_motion(Values& values, const SessionTrack& track) {
  const Motion motion = motion_of(track);
  values.push_back({&kCompletionTime, completion_time(track)});
  values.push_back({&kPathLength, kMillimetres * motion.path_length});
  values.push_back({&kEconomy, motion.economy});
  values.push_back({&kSparc, motion.spectral_arc_length});
  values.push_back({&kJerk, motion.log_dimensionless_jerk});
  values.push_back({&kIdle, motion.idle_time});
}

void add_force(Values& values, const SessionTrack& track, std::optional<double> limit) {
  const Force force = force_of(track, limit.value_or(INFINITY));
  values.push_back({&kPeakForce, force.peak});
  values.push_back({&kMeanForce, force.mean, force.mean ? "" : "the tool never moved against a force"});
  if (track.other_force.empty())
    values.push_back({&kOtherPeakForce, {}, "one hand holds all tools"});
  else
    values.push_back({&kOtherPeakForce, *std::max_element(track.other_force.begin(), track.other_force.end())});
  if (limit) {
    values.push_back({&kTimeAbove, force.time_above});
    values.push_back({&kImpulseAbove, force.impulse_above});
  } else {
    for (const Measure* measure : {&kTimeAbove, &kImpulseAbove}) values.push_back({measure, {}, kNoForceLimit});
  }
}

/// What the tool did in the ticks that `counts` chooses, by the part of the force that is above `limit` [N].
template <class Counts>
StructureLoad load_in(const SessionTrack& track, Counts&& counts, double limit = 0) {
  StructureLoad load;
  for (std::size_t i = 0; i < track.tick_count(); ++i) {
    if (!counts(i)) continue;
    const double force = track.force[i], share = force > limit ? 1 - limit / force : 0;
    load.seconds += track.tick, load.peak = std::max(load.peak, force);
    load.impulse += share * force * track.tick;
    if (!track.work.empty()) load.work += share * std::max(0.0, track.work[i]);
  }
  return load;
}

void add_load(Values& values, const SessionTrack& track, std::optional<double> limit) {
  const auto always = [](std::size_t) { return true; };
  const StructureLoad all = load_in(track, always);
  values.push_back({&kImpulse, all.impulse});
  const auto add_work = [&](const Measure& measure, double joules) {
    if (track.work.empty())
      values.push_back({&measure, {}, "the direction of the force is not known"});
    else
      values.push_back({&measure, kMillijoules * joules});
  };
  add_work(kWork, all.work);
  if (limit)
    add_work(kWorkAbove, load_in(track, always, *limit).work);
  else
    values.push_back({&kWorkAbove, {}, kNoForceLimit});
  if (track.zones.empty()) {
    for (const Measure* measure : {&kZoneTime, &kZoneImpulse, &kZoneWork})
      values.push_back({measure, {}, "the scene forbids no zone"});
    return;
  }
  const StructureLoad zones = load_in(track, [&](std::size_t i) { return track.zone[i] >= 0; });
  values.push_back({&kZoneTime, zones.seconds});
  values.push_back({&kZoneImpulse, zones.impulse});
  add_work(kZoneWork, zones.work);
}

void add_depth(Values& values, const SessionTrack& track, double damage_depth) {
  const double depth = *std::max_element(track.depth.begin(), track.depth.end());
  if (depth > 0)
    values.push_back({&kDepth, kMillimetres * depth});
  else
    values.push_back(
        {&kDepth,
         {},
         track.cuts.empty() ? "no tissue was pushed" : "a blade cuts: see depth of the cut along the blade"});
  if (damage_depth > 0)
    values.push_back({&kBeyondDamage, time_beyond(track, damage_depth)});
  else
    values.push_back({&kBeyondDamage, {}, "no organ has a damage limit"});
}

void add_cut(Values& values, const SessionTrack& track) {
  if (track.severed_at.empty())
    values.push_back({&kSevered, {}, "the session was not replayed"});
  else
    values.push_back({&kSevered, double(std::ranges::count_if(track.severed_at, [](auto tick) { return tick >= 0; }))});
  const auto add_size = [&](const Measure& measure, double session::CutSize::*size, double scale) {
    if (track.cut)
      values.push_back({&measure, scale * (*track.cut).*size});
    else
      values.push_back({&measure, {}, "nothing was cut, or no organ has a surface"});
  };
  add_size(kCutDepth, &session::CutSize::depth, kMillimetres);
  add_size(kCutAlongBlade, &session::CutSize::along_blade, kMillimetres);
  add_size(kCutLength, &session::CutSize::length, kMillimetres);
  add_size(kCutArea, &session::CutSize::area, kMillimetres * kMillimetres);
}

}  // namespace

std::vector<SessionValue> measure_session(const SessionTrack& track, std::optional<double> force_limit,
                                          double damage_depth) {
  Values values;
  add_motion(values, track);
  add_force(values, track, force_limit);
  add_load(values, track, force_limit);
  add_depth(values, track, damage_depth);
  add_cut(values, track);
  return values;
}

std::optional<std::vector<StructureLoad>> loads_of(const SessionTrack& track, const Model& model) {
  if (track.organ.empty()) return std::nullopt;
  std::vector<StructureLoad> loads;
  const auto add = [&](const std::string& name, bool is_zone, const std::vector<std::int32_t>& where,
                       std::size_t index) {
    loads.push_back(load_in(track, [&](std::size_t i) { return where[i] == std::int32_t(index); }));
    loads.back().name = name, loads.back().is_zone = is_zone;
  };
  for (std::size_t i = 0; i < model.organs.size(); ++i) add(model.organs[i].name, false, track.organ, i);
  for (std::size_t i = 0; i < track.zones.size(); ++i) add(track.zones[i], true, track.zone, i);
  return loads;
}

std::vector<SessionValue> measure_cut_pair(const SessionTrack& expert, const SessionTrack& trainee) {
  double both = 0, expert_only = 0, trainee_only = 0;
  for (std::size_t i = 0; i < expert.severed_at.size(); ++i) {
    const bool in_a = expert.severed_at[i] >= 0, in_b = trainee.severed_at[i] >= 0;
    both += in_a && in_b, expert_only += in_a && !in_b, trainee_only += in_b && !in_a;
  }
  Values values{{&kSeveredBoth, both},
                {&kSeveredExpert, expert_only},
                {&kSeveredTrainee, trainee_only},
                {&kOverlap, 2 * both / (2 * both + expert_only + trainee_only)}};
  if (expert.cuts.empty() || trainee.cuts.empty()) {
    const std::string note = std::string("the ") + (expert.cuts.empty() ? "expert" : "trainee") + " did not cut";
    for (const Measure* measure : {&kCutMean, &kCutHausdorff}) values.push_back({measure, {}, note});
  } else {
    const PathDistance distance = distance_between(cut_paths(expert), cut_paths(trainee), kCutPathSpacing);
    values.push_back({&kCutMean, kMillimetres * distance.mean});
    values.push_back({&kCutHausdorff, kMillimetres * distance.hausdorff});
  }
  return values;
}

std::vector<SessionValue> measure_aligned(const Alignment& alignment) {
  return {{&kAlignedMean, kMillimetres * alignment.mean}, {&kAlignedLargest, kMillimetres * alignment.largest}};
}

void refuse_times(std::vector<SessionValue>& values, const SessionTrack& track) {
  if (track.is_timed) return;
  for (SessionValue& value : values)
    if (depends_on_time(value.measure->key))
      value.value.reset(), value.note = "the session lacks " + output::fixed(track.slip, 3) + " s of real time";
}

double damage_depth_of(const Model& model) {
  double least = 0;
  for (const OrganRange& organ : model.organs)
    if (organ.damage_depth > 0 && (least == 0 || organ.damage_depth < least)) least = organ.damage_depth;
  return least;
}

}  // namespace ctpm::compare
