#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "scenes/course.h"
#include "scenes/scene_file.h"

namespace ctpm::cohort {

/// A session file, and whose it is: the pseudonym that it holds, else the folder below the one that was named, else its
/// name.
struct FoundSession {
  std::string file, session_id, person;
  double begun_s = 0;       ///< when, in seconds since 1970, or since the first if `is_elapsed`
  bool is_elapsed = false;  ///< wall-clock times were taken out of it
  std::size_t task = 0;     ///< of the course
  std::size_t attempt = 0;  ///< from 1, of this person in this task, in the order of time
};

/// All sessions of a course, each with its task.
struct Gathered {
  std::vector<FoundSession> experts, trainees;  ///< by task, person and time
  std::vector<std::string> left_out;            ///< sessions of trainees that belong to no task, and why
  Errors damaged;                               ///< sessions and folders of trainees that cannot be read
};

/// Finds the sessions below the folders of experts and of trainees. Errors: experts' sessions that cannot be read;
/// experts of one task in two scenes, or with other forbidden zones; a task with fewer than two experts; a session that
/// occurs twice; two tasks in one scene between which the path of a session does not choose; a folder without any
/// session.
Result<Gathered> gather(const scenes::CourseSpec& course, const std::string& trainees);

/// The experts' sessions alone. Errors: those of gather() that concern them.
Result<Gathered> gather_experts(const scenes::CourseSpec& course);

/// What is wrong with a course that can be read, and what is odd about it.
struct CourseFindings {
  Errors errors, warnings;
};

/// Compares the scene of each task, as its file is now, with that of the experts' sessions. Errors: scenes that cannot
/// be loaded; warnings: tasks whose experts worked in another scene, or with other forbidden zones.
CourseFindings find_other_scenes(const scenes::CourseSpec& course, const scenes::LoadOptions& options = {});

/// A course of one task that nobody has written: all measures of the experts in a folder, and no pass marks.
scenes::CourseSpec course_of_folder(const std::string& experts);

}  // namespace ctpm::cohort
