#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/result.h"

namespace ctpm::scenes {

/// What an educator declares about one measure of a task, beforehand. In the measure's own unit.
struct MarkSpec {
  std::string measure;              ///< key of a measure of studio/compare
  std::optional<double> low, high;  ///< the range in which values are shown and learned
  std::optional<double> pass_at_least, pass_at_most;
  friend bool operator==(const MarkSpec&, const MarkSpec&) = default;
};

/// One thing to learn: a scene, the sessions of those who can do it, and what is expected.
struct TaskSpec {
  std::string name;
  std::string scene;                  ///< path of the scene file, from the course's folder
  std::string experts;                ///< path of the folder with the experts' sessions, from the course's folder
  std::optional<double> force_limit;  ///< [N]; unset: that of the scene
  std::vector<MarkSpec> marks;
  friend bool operator==(const TaskSpec&, const TaskSpec&) = default;
};

/// The parameters of a cumulative sum of failures, fixed before anybody is measured.
struct LearningSpec {
  double acceptable = 0.1;    ///< share of failed attempts of somebody who has learned it
  double unacceptable = 0.3;  ///< share of failed attempts of somebody who has not
  double false_alarm = 0.1;   ///< chance to call the one unacceptable
  double missed = 0.1;        ///< chance to call the other acceptable
  friend bool operator==(const LearningSpec&, const LearningSpec&) = default;
};

/// How intervals of means are found: by drawing sessions again, with replacement.
struct IntervalSpec {
  double confidence = 0.95;
  std::int32_t resamples = 2000;
  std::int32_t seed = 1;
  friend bool operator==(const IntervalSpec&, const IntervalSpec&) = default;
};

/// A course as its educator wrote it.
struct CourseSpec {
  std::string name;
  std::string evidence;  ///< where it is shown that the marks tell skill apart; empty: nowhere
  std::vector<TaskSpec> tasks;
  LearningSpec learning;
  IntervalSpec intervals;
  friend bool operator==(const CourseSpec&, const CourseSpec&) = default;
};

/// Reads a course. Reports every error at once, each with `file:line:col`: those of the text and its values; two tasks
/// of one name; ranges and marks that contradict each other; a measure that is not one of `measures`.
Result<CourseSpec> read_course(std::string_view text, const std::string& file_name,
                               const std::vector<std::string>& measures);

/// Reads a course file. Errors: also scenes and folders of experts that do not exist. The paths of the result are
/// relative to the program's working directory.
Result<CourseSpec> load_course(const std::string& path, const std::vector<std::string>& measures);

/// Whether a file says that it is a course; false for what cannot be read.
bool is_course(const std::string& path);

}  // namespace ctpm::scenes
