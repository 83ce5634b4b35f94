#include "studio/cohort/gather.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "core/model/errors.h"
#include "recordings/session_reader.h"
#include "studio/compare/session_track.h"
#include "studio/loading/loaded_scene.h"
#include "studio/session/anonymise.h"

namespace ctpm::cohort {
namespace {

namespace fs = std::filesystem;
using recordings::SessionReader;

/// All session files below a folder, in the order of their names.
std::vector<fs::path> files_below(const std::string& folder) {
  std::vector<fs::path> files;
  std::error_code failure;
  for (auto at = fs::recursive_directory_iterator(folder, failure), end = fs::recursive_directory_iterator();
       !failure && at != end; at.increment(failure))
    if (at->is_regular_file(failure) && at->path().extension() == ".ctpm") files.push_back(at->path());
  std::ranges::sort(files);
  return files;
}

/// Why a folder gave no session.
Error without_sessions(const std::string& folder, const char* otherwise) {
  std::error_code failure;
  fs::directory_iterator(folder, failure);
  if (failure == std::errc::no_such_file_or_directory) return {folder, "does not exist", ""};
  return {folder, failure ? "cannot be read: " + failure.message() : otherwise, ""};
}

std::string person_of(const SessionReader& session, const fs::path& file, const std::string& folder) {
  const auto& metadata = session.start().metadata;
  if (const auto named = metadata.find(session::trainee_key); named != metadata.end()) return named->second;
  const fs::path below = file.lexically_relative(folder);
  return below.has_parent_path() ? below.begin()->string() : file.stem().string();
}

/// The scene of a session, as it is told from others.
struct Scene {
  std::uint64_t with_names = 0, without_names = 0;
  bool is_anonymised = false;
};

Scene scene_of(const SessionReader& session) {
  const Model& model = session.start().model;
  return {compare::scene_hash(model), compare::scene_hash(model, compare::Names::do_not_count),
          session::begins_at_elapsed_time(session)};
}

/// As compare::check_same_scene().
bool are_same(const Scene& a, const Scene& b) {
  return a.is_anonymised || b.is_anonymised ? a.without_names == b.without_names : a.with_names == b.with_names;
}

/// Collects the sessions and everything that is wrong with them.
class Gatherer {
 public:
  explicit Gatherer(const scenes::CourseSpec& course) : course_(course), scenes_(course.tasks.size()) {}

  void add_experts(std::size_t task) {
    const std::string& folder = course_.tasks[task].experts;
    std::size_t count = 0;
    for (const fs::path& file : files_below(folder)) {
      const Result<SessionReader> session = open(file, errors_);
      if (!session) continue;
      ++count;
      add(found_.experts, *session, file, folder, task);
      const Scene scene = scene_of(*session);
      if (count == 1)
        scenes_[task] = scene, first_[task] = file.string();
      else if (!are_same(scene, *scenes_[task]))
        errors_.push_back(
            {file.string(), "is of another scene than " + first_[task], "the experts of a task work in one scene"});
    }
    if (count == 1)
      errors_.push_back({folder, "holds one expert's session, which cannot tell how much experts differ",
                         "at least two are needed for a mean and a spread"});
    if (count == 0) errors_.push_back(without_sessions(folder, "holds no session that can be read"));
  }

  void add_trainees(const std::string& folder) {
    const std::vector<fs::path> files = files_below(folder);
    if (files.empty()) errors_.push_back(without_sessions(folder, "holds no session"));
    for (const fs::path& file : files) {
      const Result<SessionReader> session = open(file, found_.damaged);
      if (!session) continue;
      const Scene scene = scene_of(*session);
      std::vector<std::size_t> tasks;
      for (std::size_t i = 0; i < scenes_.size(); ++i)
        if (scenes_[i] && are_same(*scenes_[i], scene)) tasks.push_back(i);
      const std::size_t candidates = tasks.size();
      if (candidates > 1)
        std::erase_if(tasks, [&](std::size_t i) {
          return file.lexically_relative(folder).string().find(course_.tasks[i].name) == std::string::npos;
        });
      if (tasks.size() == 1)
        add(found_.trainees, *session, file, folder, tasks[0]);
      else if (candidates == 0)
        found_.left_out.push_back(file.string() + " is of no task: no expert works in its scene");
      else
        errors_.push_back({file.string(), "may be of several tasks, because they are in one scene",
                           "name its folder or the file after the task"});
    }
  }

  Result<Done> experts_checked() const {
    if (!errors_.empty()) return errors_;
    return Done{};
  }

  Result<Gathered> finish() {
    if (!errors_.empty()) return errors_;
    for (auto* sessions : {&found_.experts, &found_.trainees}) {
      std::ranges::sort(*sessions, {},
                        [](const FoundSession& s) { return std::tuple(s.task, s.person, s.begun_s, s.file); });
      std::map<std::pair<std::size_t, std::string>, std::size_t> attempts;
      for (FoundSession& s : *sessions) s.attempt = ++attempts[{s.task, s.person}];
    }
    return std::move(found_);
  }

 private:
  static Result<SessionReader> open(const fs::path& file, Errors& errors) {
    Result<SessionReader> session = SessionReader::open(file.string());
    append(errors, session);
    return session;
  }

  void add(std::vector<FoundSession>& sessions, const SessionReader& session, const fs::path& file,
           const std::string& folder, std::size_t task) {
    const auto [other, is_new] = seen_.emplace(session.session_id(), file.string());
    if (!is_new)
      errors_.push_back({file.string(), "is the same session as " + other->second, "every session counts once"});
    sessions.push_back({file.string(), session.session_id(), person_of(session, file, folder), session.created_unix_s(),
                        session::begins_at_elapsed_time(session), task});
  }

  const scenes::CourseSpec& course_;
  std::vector<std::optional<Scene>> scenes_;  ///< of each task
  std::map<std::size_t, std::string> first_;
  std::map<std::string, std::string> seen_;
  Gathered found_;
  Errors errors_;
};

}  // namespace

Result<Gathered> gather(const scenes::CourseSpec& course, const std::string& trainees) {
  Gatherer gatherer(course);
  for (std::size_t i = 0; i < course.tasks.size(); ++i) gatherer.add_experts(i);
  gatherer.add_trainees(trainees);
  return gatherer.finish();
}

Result<Done> check_experts(const scenes::CourseSpec& course) {
  Gatherer gatherer(course);
  for (std::size_t i = 0; i < course.tasks.size(); ++i) gatherer.add_experts(i);
  return gatherer.experts_checked();
}

SceneFindings find_other_scenes(const scenes::CourseSpec& course, const scenes::LoadOptions& options) {
  SceneFindings found;
  for (const scenes::TaskSpec& task : course.tasks) {
    const Result<loading::LoadedScene> scene = loading::load_whole_scene(task.scene, options);
    append(found.errors, scene);
    const std::vector<fs::path> files = files_below(task.experts);
    if (!scene || files.empty()) continue;
    const Result<SessionReader> expert = SessionReader::open(files.front().string());
    if (!expert) continue;
    const compare::Names names =
        session::begins_at_elapsed_time(*expert) ? compare::Names::do_not_count : compare::Names::count;
    const std::string reason = compare::scene_difference(expert->start().model, scene->built.model, names);
    if (!reason.empty())
      found.warnings.push_back({task.scene,
                                "is not the scene in which the experts of the task '" + task.name +
                                    "' worked: " + reason + ", in " + files.front().string(),
                                "sessions that are recorded in it now belong to no task"});
  }
  return found;
}

scenes::CourseSpec course_of_folder(const std::string& experts) {
  scenes::CourseSpec course;
  course.name = fs::path(experts).lexically_normal().filename().string();
  if (course.name.empty()) course.name = fs::path(experts).lexically_normal().parent_path().filename().string();
  course.tasks.push_back({.name = course.name, .scene = "", .experts = experts, .force_limit = {}, .marks = {}});
  return course;
}

}  // namespace ctpm::cohort
