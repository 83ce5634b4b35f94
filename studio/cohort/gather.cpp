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

void add_files_below(const fs::path& folder, std::vector<fs::path>& files, Errors& unread) {
  std::error_code failure, ignored;
  for (auto at = fs::directory_iterator(folder, failure), end = fs::directory_iterator(); !failure && at != end;
       at.increment(failure)) {
    const bool is_link = at->is_symlink(ignored);
    if (at->is_directory(ignored) && !is_link) add_files_below(at->path(), files, unread);
    // A link that leads nowhere is told when it is opened.
    const bool is_file = at->is_regular_file(ignored) || (is_link && !at->exists(ignored));
    if (is_file && at->path().extension() == ".ctpm") files.push_back(at->path());
  }
  if (failure)
    unread.push_back(
        {folder.string(),
         failure == std::errc::no_such_file_or_directory ? "does not exist" : "cannot be read: " + failure.message(),
         ""});
}

/// All session files below a folder, in the order of their names. `unread` gets the folders that cannot be read.
std::vector<fs::path> files_below(const std::string& folder, Errors& unread) {
  std::vector<fs::path> files;
  add_files_below(folder, files, unread);
  std::ranges::sort(files);
  return files;
}

/// Whether the path of a session names a task.
bool names_task(const fs::path& path, const std::string& task) { return path.string().find(task) != std::string::npos; }

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
  std::optional<std::vector<scenes::ZoneSpec>> zones;  ///< that it forbids, without their names; none: not known
};

/// Forbidden zones without their names, which anonymised sessions lack.
std::vector<scenes::ZoneSpec> without_names(std::vector<scenes::ZoneSpec> zones) {
  for (scenes::ZoneSpec& zone : zones) zone.name.clear();
  return zones;
}

Scene scene_of(const SessionReader& session) {
  const Model& model = session.start().model;
  const Result<scenes::SceneText> text = scenes::read_scene(session.start().scene_text, session.path());
  return {compare::scene_hash(model), compare::scene_hash(model, compare::Names::do_not_count),
          session::begins_at_elapsed_time(session),
          text ? std::optional(without_names(text->spec.forbidden)) : std::nullopt};
}

bool forbid_the_same(const Scene& a, const Scene& b) { return !a.zones || !b.zones || *a.zones == *b.zones; }

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
    Errors unread;
    for (const fs::path& file : files_below(folder, unread)) {
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
      else if (!forbid_the_same(scene, *scenes_[task]))
        errors_.push_back(
            {file.string(), "forbids other zones than " + first_[task], "the experts of a task work in one scene"});
    }
    append(errors_, unread);
    if (!unread.empty()) return;
    if (count == 1)
      errors_.push_back({folder, "holds one expert's session, which cannot tell how much experts differ",
                         "at least two are needed for a mean and a spread"});
    if (count == 0) errors_.push_back({folder, "holds no session that can be read", ""});
  }

  void add_trainees(const std::string& folder) {
    Errors unread;
    const std::vector<fs::path> files = files_below(folder, unread);
    if (files.empty()) append(errors_, unread.empty() ? Errors{{folder, "holds no session", ""}} : unread);
    append(found_.damaged, unread);
    for (const fs::path& file : files) {
      const Result<SessionReader> session = open(file, found_.damaged);
      if (!session) continue;
      const Scene scene = scene_of(*session);
      std::vector<std::size_t> tasks;
      for (std::size_t i = 0; i < scenes_.size(); ++i)
        if (scenes_[i] && are_same(*scenes_[i], scene)) tasks.push_back(i);
      const std::vector<std::size_t> candidates = tasks;
      if (candidates.size() > 1) choose_by_path(tasks, file.lexically_relative(folder));
      if (candidates.empty())
        found_.left_out.push_back(file.string() + " is of no task: no expert works in its scene");
      else if (tasks.size() != 1)
        errors_.push_back({file.string(), "may be of the tasks " + names_of(candidates) + ", which are in one scene",
                           "name its folder or the file after the task"});
      else if (!forbid_the_same(scene, *scenes_[tasks[0]]))
        found_.left_out.push_back(file.string() +
                                  " was recorded with other forbidden zones than the experts' sessions");
      else
        add(found_.trainees, *session, file, folder, tasks[0]);
    }
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
  /// Keeps the tasks that a path names; of names that are part of another one, the longest.
  void choose_by_path(std::vector<std::size_t>& tasks, const fs::path& path) const {
    const auto name = [&](std::size_t i) -> const std::string& { return course_.tasks[i].name; };
    std::erase_if(tasks, [&](std::size_t i) { return !names_task(path, name(i)); });
    const std::vector<std::size_t> named = tasks;
    std::erase_if(tasks, [&](std::size_t i) {
      return std::ranges::any_of(named, [&](std::size_t k) {
        return name(k).size() > name(i).size() && name(k).find(name(i)) != std::string::npos;
      });
    });
  }

  std::string names_of(const std::vector<std::size_t>& tasks) const {
    std::string names;
    for (const std::size_t i : tasks) names += (names.empty() ? "'" : ", '") + course_.tasks[i].name + "'";
    return names;
  }

  static Result<SessionReader> open(const fs::path& file, Errors& errors) {
    Result<SessionReader> session = SessionReader::open(file.string());
    append(errors, session);
    return session;
  }

  void add(std::vector<FoundSession>& sessions, const SessionReader& session, const fs::path& file,
           const std::string& folder, std::size_t task) {
    const auto [other, is_new] = seen_.emplace(session.session_id(), file.string());
    std::error_code ignored;
    if (!is_new && &sessions == &found_.experts && fs::equivalent(file, other->second, ignored))
      errors_.push_back({file.string(),
                         "is in the experts' folder of two tasks, also of '" + course_.tasks[task].name + "'",
                         "each task has experts of its own"});
    else if (!is_new)
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

Result<Gathered> gather_experts(const scenes::CourseSpec& course) {
  Gatherer gatherer(course);
  for (std::size_t i = 0; i < course.tasks.size(); ++i) gatherer.add_experts(i);
  return gatherer.finish();
}

CourseFindings find_other_scenes(const scenes::CourseSpec& course, const scenes::LoadOptions& options) {
  CourseFindings found;
  for (const scenes::TaskSpec& task : course.tasks) {
    const Result<loading::LoadedScene> scene = loading::load_whole_scene(task.scene, options);
    append(found.errors, scene);
    Errors unread;
    const std::vector<fs::path> files = files_below(task.experts, unread);
    if (!scene || files.empty()) continue;
    const Result<SessionReader> expert = SessionReader::open(files.front().string());
    if (!expert) continue;
    const compare::Names names =
        session::begins_at_elapsed_time(*expert) ? compare::Names::do_not_count : compare::Names::count;
    const std::string reason = compare::scene_difference(expert->start().model, scene->built.model, names);
    if (const Scene theirs = scene_of(*expert);
        reason.empty() && theirs.zones && *theirs.zones != without_names(scene->scene.spec.forbidden))
      found.warnings.push_back({task.scene,
                                "forbids other zones than when the experts of the task '" + task.name +
                                    "' worked in it: those of the sessions count, as in " + files.front().string(),
                                "sessions that are recorded in it now are left out"});
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
