#pragma once

#include "scenes/course.h"
#include "scenes/key_types.h"

// Every key of a course with its type, unit, range and sentence, as scene_keys.h for scenes. Internal to scenes.
namespace ctpm::scenes {

inline constexpr const char* course_format_name = "ctpm-course";
inline constexpr int course_format_version = 1;

namespace course_ranges {
inline constexpr Range value = within(-1e9, 1e9);
inline constexpr Range share = between(0, 1);
}  // namespace course_ranges

inline RecordInfo info_of(const MarkSpec&) {
  return {"mark", "What is expected of one measure, in the measure's own unit, which is part of its name."};
}
template <class V>
void describe_fields(V& v, MarkSpec& mark) {
  v.text(required("measure", "Key of the measure, as the JSON of `ctpm compare` names it."), mark.measure);
  v.number(Key{"low", "Lower end of the range that the educator declares.", false, "none is drawn"}, mark.low,
           units::none, course_ranges::value);
  v.number(Key{"high", "Upper end of that range.", false, "none is drawn"}, mark.high, units::none,
           course_ranges::value);
  v.number(Key{"pass_at_least", "Pass mark: an attempt with a lower value fails.", false, "nobody fails so"},
           mark.pass_at_least, units::none, course_ranges::value);
  v.number(Key{"pass_at_most", "Pass mark: an attempt with a higher value fails.", false, "nobody fails so"},
           mark.pass_at_most, units::none, course_ranges::value);
}

inline RecordInfo info_of(const TaskSpec&) {
  return {"task", "One thing to learn: a scene, sessions of those who can do it, and what is expected."};
}
template <class V>
void describe_fields(V& v, TaskSpec& task) {
  v.text(required("name", "Name of the task; of two tasks in one scene, a session's path must hold it."), task.name);
  v.text(required("scene", "Path of the scene file, from the course's folder."), task.scene);
  v.text(required("experts", "Path of the folder with the experts' sessions, from the course's folder."), task.experts);
  v.number(Key{"force_limit_n", "Force that should not be passed.", false, "that of the scene, if it has one"},
           task.force_limit, units::newton, above(0, 1000));
  v.list(Key{"marks", "What is expected.", false, "every measure is shown, and nobody passes or fails"}, task.marks, 1);
}

inline RecordInfo info_of(const LearningSpec&) {
  return {"learning",
          "When somebody has learned a task: a cumulative sum of failed attempts (CUSUM) falls below its lower limit. "
          "Its parameters are fixed here, before anybody is measured."};
}
template <class V>
void describe_fields(V& v, LearningSpec& learning) {
  v.number(Key{"acceptable_failures", "Share of failed attempts of somebody who has learned it."}, learning.acceptable,
           units::none, course_ranges::share);
  v.number(Key{"unacceptable_failures", "Share of failed attempts of somebody who has not."}, learning.unacceptable,
           units::none, course_ranges::share);
  v.number(Key{"false_alarm", "Chance to call the first one unacceptable."}, learning.false_alarm, units::none,
           between(0, 0.5));
  v.number(Key{"missed", "Chance to call the second one acceptable."}, learning.missed, units::none, between(0, 0.5));
}

inline RecordInfo info_of(const IntervalSpec&) {
  return {"intervals", "How intervals of means are found: by drawing values again, with replacement (bootstrap)."};
}
template <class V>
void describe_fields(V& v, IntervalSpec& intervals) {
  v.number(Key{"confidence", "Share of such intervals that hold the true mean."}, intervals.confidence, units::none,
           between(0.5, 1));
  v.integer(Key{"resamples", "How often is drawn."}, intervals.resamples, within(100, 100000));
  v.integer(Key{"seed", "Of the random numbers: the same seed gives the same intervals everywhere."}, intervals.seed,
            within(0, 2147483647));
}

inline RecordInfo info_of(const CourseSpec&) { return {"course", "The whole file."}; }
template <class V>
void describe_fields(V& v, CourseSpec& course) {
  v.constant(required("format", "Says that this is a course."), course_format_name);
  v.constant(required("version", "Version of the format."), course_format_version);
  v.text(required("name", "Name of the course."), course.name);
  v.text(Key{"evidence", "Where it is shown that these marks tell skill apart (a study that can be cited).", false,
             "every page says \"not validated\""},
         course.evidence);
  v.list(required("tasks", "The tasks, in the order of the reports."), course.tasks, 1);
  v.record(Key{"learning", "When a task is learned.", false, "as if its keys were not written"}, course.learning);
  v.record(Key{"intervals", "Intervals of means.", false, "as if its keys were not written"}, course.intervals);
}

}  // namespace ctpm::scenes
