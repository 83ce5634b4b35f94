#include "studio/compare/measures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/model/box.h"
#include "studio/compare/matched_moments.h"
#include "studio/compare/moments.h"
#include "studio/compare/way.h"

namespace ctpm::compare {
namespace {

constexpr double kMillimetres = 1e3;
constexpr double kCutPathSpacing = 0.5e-3;  // distance of the points of cut paths that are compared [m]

constexpr const char* kCotin =
    "Cotin et al., Metrics for laparoscopic skills trainers: the weakest link! MICCAI 2002, 35-43";
constexpr const char* kGallagher =
    "Gallagher and Satava, Virtual reality as a metric for the assessment of laparoscopic psychomotor "
    "skills, "
    "Surg Endosc 16, 2002, 1746-1752";
constexpr const char* kBalasubramanian =
    "Balasubramanian et al., On the analysis of movement smoothness, J NeuroEng Rehabil 12:112, 2015";
constexpr const char* kDAngelo =
    "D'Angelo et al., Idle time: an underdeveloped performance metric for assessing surgical skill, Am J "
    "Surg "
    "209, 2015, 645-651; the limits are this program's";
constexpr const char* kHoreman =
    "Horeman et al., Force parameters for skills assessment in laparoscopy, IEEE Trans Haptics 5, 2012, "
    "312-322";
constexpr const char* kTrejos =
    "Trejos et al., Development of force-based metrics for skills assessment in minimally invasive surgery, "
    "Surg Endosc 28, 2014, 2106-2119";
constexpr const char* kDice =
    "Dice, Measures of the amount of ecologic association between species, Ecology 26, 1945, 297-302";
constexpr const char* kHeimann =
    "Heimann et al., Comparison and evaluation of methods for liver segmentation from CT datasets, IEEE "
    "Trans "
    "Med Imaging 28, 2009, 1251-1265: average symmetric distance";
constexpr const char* kHuttenlocher =
    "Huttenlocher et al., Comparing images using the Hausdorff distance, IEEE Trans Pattern Anal 15, 1993, "
    "850-863";
constexpr const char* kSakoe =
    "Sakoe and Chiba, Dynamic programming algorithm optimization for spoken word recognition, IEEE Trans "
    "Acoust Speech 26, 1978, 43-49";
constexpr const char* kScene = "the scene's damage_depth_mm";
constexpr const char* kNetwork = "the scene's network";

using enum Direction;
// Differences that rounding, or the 100 Hz of hands, can make.
constexpr double kTimeRounding = 0.02, kLengthRounding = 0.1, kForceRounding = 0.01;  // [s], [mm], [N]
constexpr Measure kCompletionTime{"completion_time_s",
                                  "completion time",
                                  "s",
                                  lower,
                                  "from taking the first tool to putting the last one away",
                                  kCotin,
                                  kTimeRounding};
constexpr Measure kPathLength{
    "path_length_mm", "path length",      "mm", lower, "way of the tool's tip while it is held",
    kCotin,           5 * kLengthRounding};
constexpr Measure kEconomy{"economy_of_motion",
                           "economy of motion",
                           "1",
                           higher,
                           "straight lines from taking the tool over touching, deepest point or ends of the "
                           "cut, and leaving, to putting it away, divided by the way between",
                           kGallagher,
                           0.01};
constexpr Measure kSparc{"spectral_arc_length",
                         "smoothness, spectral arc length",
                         "1",
                         higher,
                         "of the tip's speed in each movement between two rests; nearer to 0 is smoother",
                         kBalasubramanian,
                         0.02};
constexpr Measure kJerk{"log_dimensionless_jerk",
                        "smoothness, log dimensionless jerk",
                        "1",
                        higher,
                        "of the tip's speed in each movement between two rests; larger is smoother",
                        kBalasubramanian,
                        0.1};
constexpr Measure kIdle{
    "idle_time_s", "idle time",      "s", lower, "a tool in the hand, slower than 5 mm/s for at least 0.3 s",
    kDAngelo,      2 * kTimeRounding};
constexpr Measure kPeakForce{"peak_force_n", "peak force",  "N", lower, "largest force between tool and tissue",
                             kHoreman,       kForceRounding};
constexpr Measure kMeanForce{"mean_force_n",
                             "mean force",
                             "N",
                             lower,
                             "over the way of the tool against a force, so that resting in the tissue does not count",
                             kHoreman,
                             kForceRounding};
constexpr Measure kOtherPeakForce{"other_hand_peak_force_n",
                                  "peak force of the other hand",
                                  "N",
                                  lower,
                                  "the same of the hand that does not cut",
                                  kHoreman,
                                  kForceRounding};
constexpr Measure kTimeAbove{"time_above_force_limit_s",
                             "time above the force limit",
                             "s",
                             lower,
                             "with a force above the limit",
                             kTrejos,
                             kTimeRounding};
constexpr Measure kImpulseAbove{"impulse_above_force_limit_n_s",
                                "impulse above the force limit",
                                "N s",
                                lower,
                                "integral over time of what is above the limit",
                                kTrejos,
                                kTimeRounding* kForceRounding};
constexpr Measure kDepth{
    "largest_depth_mm", "largest depth", "mm", nearer, "how far a tool without a blade pushes the tissue from rest",
    kNetwork,           kLengthRounding};
constexpr Measure kBeyondDamage{"time_beyond_damage_depth_s",
                                "time beyond the damage depth",
                                "s",
                                lower,
                                "with tissue pushed deeper than it can bear",
                                kScene,
                                kTimeRounding};
constexpr Measure kSevered{
    "elements_severed", "elements severed", "1", nearer, "springs and constraints of the network", kNetwork};
constexpr Measure kSeveredBoth{
    "elements_severed_by_both", "elements severed by both", "1", higher, "the same elements", kNetwork};
constexpr Measure kSeveredExpert{"elements_severed_by_expert_only",
                                 "elements only the expert severed",
                                 "1",
                                 lower,
                                 "left whole by the trainee",
                                 kNetwork};
constexpr Measure kSeveredTrainee{"elements_severed_by_trainee_only",
                                  "elements only the trainee severed",
                                  "1",
                                  lower,
                                  "left whole by the expert",
                                  kNetwork};
constexpr Measure kOverlap{"cut_overlap",
                           "overlap of the cuts",
                           "1",
                           higher,
                           "Dice coefficient of the severed elements: 1 the same, 0 none in common",
                           kDice};
constexpr Measure kCutMean{"cut_path_mean_distance_mm",
                           "mean distance of the cut paths",
                           "mm",
                           lower,
                           "of points on either path from the other, where elements were severed",
                           kHeimann};
constexpr Measure kCutHausdorff{"cut_path_hausdorff_mm",
                                "Hausdorff distance of the cut paths",
                                "mm",
                                lower,
                                "the farthest that a point of either path is from the other",
                                kHuttenlocher};
constexpr Measure kCutDepth{
    "cut_depth_mm", "depth of the cut", "mm", nearer, "of the deepest place that the blade's edge cut, at rest",
    kNetwork,       kLengthRounding};
constexpr Measure kCutLength{
    "cut_length_mm", "length of the cut", "mm", nearer, "along the surface at rest, of all cuts",
    kNetwork,        kLengthRounding};
constexpr Measure kCutArea{
    "cut_area_mm2", "area of the cut", "mm^2", nearer, "that the blade's edge swept in the tissue at rest", kNetwork};
constexpr Measure kAlignedMean{"aligned_deviation_mean_mm",
                               "mean deviation of the aligned paths",
                               "mm",
                               lower,
                               "of the tip from the expert's, whatever the pace",
                               kSakoe};
constexpr Measure kAlignedLargest{"aligned_deviation_largest_mm",
                                  "largest deviation of the aligned paths",
                                  "mm",
                                  lower,
                                  "of the tip from the expert's, whatever the pace",
                                  kSakoe};

/// The stations of a stroke: its ends, the points where the tool met and left the tissue, and the deepest point.
/// Ascending indices within the stroke.
std::vector<std::size_t> stations_of(const SessionTrack& track, const Spell& stroke) {
  std::vector<std::size_t> at{stroke.first};
  std::size_t deepest = stroke.first;
  for (std::size_t i = stroke.first; i < stroke.last; ++i) {
    const bool works = track.force[i] > 0 || track.severed[i] > 0;
    if (works && at.size() == 1) at.push_back(i);
    if (works) at.resize(2), at.push_back(i);
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

void add_motion(Comparison& comparison, const SessionTrack& expert, const SessionTrack& trainee) {
  const Motion a = motion_of(expert), b = motion_of(trainee);
  comparison.values.push_back({&kCompletionTime, completion_time(expert), completion_time(trainee)});
  comparison.values.push_back({&kPathLength, kMillimetres * a.path_length, kMillimetres * b.path_length});
  comparison.values.push_back({&kEconomy, a.economy, b.economy});
  comparison.values.push_back({&kSparc, a.spectral_arc_length, b.spectral_arc_length});
  comparison.values.push_back({&kJerk, a.log_dimensionless_jerk, b.log_dimensionless_jerk});
  comparison.values.push_back({&kIdle, a.idle_time, b.idle_time});
}

void add_force(Comparison& comparison, const SessionTrack& expert, const SessionTrack& trainee) {
  const double limit = comparison.force_limit.value_or(INFINITY);
  const Force a = force_of(expert, limit), b = force_of(trainee, limit);
  comparison.values.push_back({&kPeakForce, a.peak, b.peak});
  comparison.values.push_back({&kMeanForce, a.mean, b.mean});
  if (!b.mean) comparison.values.back().note = "the tool never moved against a force";
  if (!expert.other_force.empty() && !trainee.other_force.empty())
    comparison.values.push_back({&kOtherPeakForce,
                                 *std::max_element(expert.other_force.begin(), expert.other_force.end()),
                                 *std::max_element(trainee.other_force.begin(), trainee.other_force.end())});
  if (comparison.force_limit) {
    comparison.values.push_back({&kTimeAbove, a.time_above, b.time_above});
    comparison.values.push_back({&kImpulseAbove, a.impulse_above, b.impulse_above});
  } else {
    for (const Measure* measure : {&kTimeAbove, &kImpulseAbove})
      comparison.values.push_back({.measure = measure, .note = "no limit: the expert met no force, and none is given"});
  }
}

void add_depth(Comparison& comparison, const SessionTrack& expert, const SessionTrack& trainee) {
  const auto deepest = [](const SessionTrack& track) {
    const double depth = *std::max_element(track.depth.begin(), track.depth.end());
    return depth > 0 ? std::optional(kMillimetres * depth) : std::nullopt;
  };
  comparison.values.push_back({&kDepth, deepest(expert), deepest(trainee)});
  if (!comparison.values.back().trainee)
    comparison.values.back().note =
        trainee.cuts.empty() ? "no tissue was pushed" : "a blade cuts: see depth of the cut";
  if (comparison.damage_depth > 0)
    comparison.values.push_back(
        {&kBeyondDamage, time_beyond(expert, comparison.damage_depth), time_beyond(trainee, comparison.damage_depth)});
  else
    comparison.values.push_back({.measure = &kBeyondDamage, .note = "no organ has a damage limit"});
}

void add_cut(Comparison& comparison, const SessionTrack& expert, const SessionTrack& trainee) {
  if (expert.cuts.empty() && trainee.cuts.empty()) return;
  double both = 0, expert_only = 0, trainee_only = 0;
  for (std::size_t i = 0; i < expert.severed_at.size(); ++i) {
    const bool in_a = expert.severed_at[i] >= 0, in_b = trainee.severed_at[i] >= 0;
    both += in_a && in_b, expert_only += in_a && !in_b, trainee_only += in_b && !in_a;
  }
  auto& values = comparison.values;
  values.push_back({&kSevered, both + expert_only, both + trainee_only});
  values.push_back({.measure = &kSeveredBoth, .trainee = both});
  values.push_back({.measure = &kSeveredExpert, .trainee = expert_only});
  values.push_back({.measure = &kSeveredTrainee, .trainee = trainee_only});
  values.push_back({.measure = &kOverlap, .trainee = 2 * both / (2 * both + expert_only + trainee_only)});
  if (expert.cuts.empty() || trainee.cuts.empty()) {
    const std::string note = std::string("the ") + (expert.cuts.empty() ? "expert" : "trainee") + " did not cut";
    for (const Measure* measure : {&kCutMean, &kCutHausdorff}) values.push_back({.measure = measure, .note = note});
  } else {
    const PathDistance distance = distance_between(cut_paths(expert), cut_paths(trainee), kCutPathSpacing);
    values.push_back({.measure = &kCutMean, .trainee = kMillimetres * distance.mean});
    values.push_back({.measure = &kCutHausdorff, .trainee = kMillimetres * distance.hausdorff});
  }
  const auto add_size = [&](const Measure& measure, double session::CutSize::*size, double scale) {
    const auto of = [&](const SessionTrack& track) {
      return track.cut ? std::optional(scale * (*track.cut).*size) : std::nullopt;
    };
    values.push_back({&measure, of(expert), of(trainee)});
    if (!trainee.cut) values.back().note = "nothing was cut, or no organ has a surface";
  };
  add_size(kCutDepth, &session::CutSize::depth, kMillimetres);
  add_size(kCutLength, &session::CutSize::length, kMillimetres);
  add_size(kCutArea, &session::CutSize::area, kMillimetres * kMillimetres);
}

/// The force limit: the given one, else the scene's, else the expert's peak and what rounding adds to it.
void set_force_limit(Comparison& comparison, const SessionTrack& expert, const CompareOptions& options) {
  const double expert_peak = *std::max_element(expert.force.begin(), expert.force.end());
  if (options.force_limit)
    comparison.force_limit = options.force_limit, comparison.force_limit_from = "given";
  else if (options.damage_force > 0)
    comparison.force_limit = options.damage_force, comparison.force_limit_from = "the scene";
  else if (expert_peak > 0)
    comparison.force_limit = (1 + kSameShare) * expert_peak,
    comparison.force_limit_from = "1 % above the expert's peak";
}

}  // namespace

const char* to_word(Direction direction) {
  return direction == lower ? "lower" : direction == higher ? "higher" : "as the expert";
}

Comparison compare_sessions(const SessionTrack& expert, const SessionTrack& trainee,
                            const recordings::SessionStart& scene, const CompareOptions& options) {
  Comparison comparison;
  set_force_limit(comparison, expert, options);
  for (const OrganRange& organ : scene.model.organs) {
    double& depth = comparison.damage_depth;
    if (organ.damage_depth > 0 && (depth == 0 || organ.damage_depth < depth)) depth = organ.damage_depth;
    double& limit = comparison.path_limit;
    if (limit == 0 || 0.5 * organ.spacing < limit) limit = 0.5 * organ.spacing;
  }
  add_motion(comparison, expert, trainee);
  add_force(comparison, expert, trainee);
  add_depth(comparison, expert, trainee);
  add_cut(comparison, expert, trainee);

  TimedPath expert_path = tool_path(expert), trainee_path = tool_path(trainee);
  comparison.expert_path = std::move(expert_path.place), comparison.expert_time = std::move(expert_path.time);
  comparison.trainee_path = std::move(trainee_path.place), comparison.trainee_time = std::move(trainee_path.time);
  comparison.alignment = align_paths(comparison.expert_path, comparison.trainee_path);
  comparison.values.push_back({.measure = &kAlignedMean, .trainee = kMillimetres * comparison.alignment.mean});
  comparison.values.push_back({.measure = &kAlignedLargest, .trainee = kMillimetres * comparison.alignment.largest});
  comparison.moments = worst_moments(comparison, expert, trainee);
  Box box(scene.model.rest_position[0]);
  for (std::size_t i = 1; i < scene.model.sphere_count(); ++i) box.add(scene.model.rest_position[i]);
  comparison.way = way_of(expert, trainee, 0.5 * (box.low + box.high), comparison.path_limit);
  return comparison;
}

}  // namespace ctpm::compare
