#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "scenes/scene_file.h"
#include "scenes/sweep.h"
#include "studio/sweep/samples.h"

namespace ctpm::sweep {

/// The texts of one session's files, with their values in place.
struct TaskFiles {
  std::string scene_path, scene_text;
  std::string script_path, script_text;  ///< empty: the script that presses and cuts at the organs' tops
};

/// One session of a sweep.
struct Task {
  std::string id;                  ///< 16 hexadecimal digits, of all that its ticks follow from
  std::vector<std::string> shown;  ///< value of each column (column_count)
};

/// What a sweep does, and in what order.
struct Plan {
  std::string file;                  ///< of the sweep, absolute; empty: `command` is run on each session
  std::vector<std::string> command;  ///< see plan_each()
  std::string name;
  std::vector<std::string> columns;
  std::vector<bool> is_number;  ///< whether all values of a column are numbers (column_count)
  std::vector<Task> tasks;
};

/// Reads the files that a sweep varies, each once, and makes those of its sessions.
class Sweep {
 public:
  /// Reads the sweep. Errors: those of the file.
  static Result<Sweep> load(const std::string& file);

  const scenes::SweepSpec& spec() const { return text_.spec; }
  const std::string& file() const { return file_; }
  std::size_t task_count() const { return samples_.size(); }

  /// The files of one session. Errors: a file that cannot be read; a key that has no place in it.
  Result<TaskFiles> files_of(std::size_t task);

  /// The errors of a session's files at the places that people can see: the sweep's where it sets the value, else those
  /// of the files as they were written, with the values of the session.
  Errors said(const Errors& errors, std::size_t task) const;

  /// Number that names a session by its content: the texts of scene and script, the bytes of meshes, the duration and
  /// the physics revision. `scene` is what the scene's text says. Error: a mesh that is missing.
  Result<std::string> id_of(const TaskFiles& files, const scenes::SceneSpec& scene);

  /// All sessions. Checks each scene and script as `ctpm check` does before its meshes are read. Errors: all that is
  /// wrong with any of them, each once, at the value of the sweep that makes it wrong if one does; sessions that are
  /// the same.
  Result<Plan> plan();

 private:
  /// The files of one session as far as they can be read, and why not.
  struct ReadFiles {
    TaskFiles files;
    Errors of_scene, of_script;
  };

  Sweep() = default;
  ReadFiles read_files(std::size_t task);
  Result<std::string> text_of(const std::string& path, const std::vector<std::string>& pointers,
                              const std::vector<std::string>& values);
  Errors problems_of(std::size_t task, const ReadFiles& read, const Result<scenes::SceneDraft>& draft) const;
  Error placed(const Error& error, std::size_t task) const;
  Error with_values(Error error, std::size_t task) const;
  std::string described(std::size_t task) const;
  Plan empty_plan() const;
  Result<std::string> checked_id(std::size_t task);
  bool has_seeds() const { return text_.spec.method == scenes::SweepMethod::latin_hypercube; }

  std::string file_;
  scenes::SweepText text_;
  std::vector<Sample> samples_;
  std::map<std::string, Result<scenes::ValueSlots>> texts_;  ///< by path
  std::map<std::string, Result<std::uint64_t>> mesh_hash_;   ///< by path
};

/// Writes the plan to `folder`, which is made if missing, as manifest.json for the program and manifest.csv for people.
/// Errors: the folder holds another sweep; it cannot be written.
Result<Done> write_plan(const Plan& plan, const std::string& folder);

/// Errors: there is no plan, or it cannot be read.
Result<Plan> read_plan(const std::string& folder);

}  // namespace ctpm::sweep
