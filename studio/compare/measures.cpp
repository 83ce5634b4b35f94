#include "studio/compare/measures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/model/box.h"
#include "studio/compare/matched_moments.h"
#include "studio/compare/measure_table.h"
#include "studio/compare/moments.h"
#include "studio/compare/reach.h"
#include "studio/compare/session_measures.h"
#include "studio/compare/way.h"

namespace ctpm::compare {
namespace {

/// The measures of each session beside each other, and those of the pair of cuts behind the first that is of a cut.
void add_values(Comparison& comparison, const SessionTrack& expert, const SessionTrack& trainee) {
  const std::vector<SessionValue> a = measure_session(expert, comparison.force_limit, comparison.damage_depth),
                                  b = measure_session(trainee, comparison.force_limit, comparison.damage_depth);
  const auto add_pair = [&](const std::vector<SessionValue>& values) {
    for (const SessionValue& value : values)
      comparison.values.push_back({.measure = value.measure, .trainee = value.value, .note = value.note});
  };
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Measure* measure = a[i].measure;
    const bool is_of_cut = measure == &kSevered || measure == &kCutDepth || measure == &kCutAlongBlade ||
                           measure == &kCutLength || measure == &kCutArea;
    if (is_of_cut && expert.cuts.empty() && trainee.cuts.empty()) continue;
    const bool is_of_some =
        measure == &kOtherPeakForce || measure == &kZoneTime || measure == &kZoneImpulse || measure == &kZoneWork;
    if (is_of_some && !(a[i].value && b[i].value)) continue;
    const bool no_limit = b[i].note == kNoForceLimit;
    comparison.values.push_back({measure, a[i].value, b[i].value,
                                 no_limit ? "no limit: the expert met no force, and none is given" : b[i].note});
    if (measure == &kSevered) add_pair(measure_cut_pair(expert, trainee));
  }
}

/// Lower is no better where the trainee reached less.
void set_less_done(Comparison& comparison) {
  if (shortfalls_of(comparison.values, comparison.damage_depth).empty()) return;
  for (MeasuredValue& value : comparison.values) value.less_done = value.measure->grows_with_work;
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
  using enum Direction;
  return direction == lower ? "lower" : direction == higher ? "higher" : "as the expert";
}

Comparison compare_sessions(const SessionTrack& expert, const SessionTrack& trainee,
                            const recordings::SessionStart& scene, const CompareOptions& options) {
  Comparison comparison;
  set_force_limit(comparison, expert, options);
  comparison.damage_depth = damage_depth_of(scene.model);
  for (const OrganRange& organ : scene.model.organs) {
    double& limit = comparison.path_limit;
    if (limit == 0 || 0.5 * organ.spacing < limit) limit = 0.5 * organ.spacing;
  }
  add_values(comparison, expert, trainee);
  set_less_done(comparison);

  TimedPath expert_path = tool_path(expert), trainee_path = tool_path(trainee);
  comparison.expert_path = std::move(expert_path.place), comparison.expert_time = std::move(expert_path.time);
  comparison.trainee_path = std::move(trainee_path.place), comparison.trainee_time = std::move(trainee_path.time);
  comparison.alignment = align_paths(comparison.expert_path, comparison.trainee_path);
  for (const SessionValue& value : measure_aligned(comparison.alignment))
    comparison.values.push_back({.measure = value.measure, .trainee = value.value});
  comparison.moments = worst_moments(comparison, expert, trainee);
  Box box(scene.model.rest_position[0]);
  for (std::size_t i = 1; i < scene.model.sphere_count(); ++i) box.add(scene.model.rest_position[i]);
  comparison.way = way_of(expert, trainee, 0.5 * (box.low + box.high), comparison.path_limit);
  return comparison;
}

}  // namespace ctpm::compare
