#include "studio/sweep/plan.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "core/model/errors.h"
#include "recordings/byte_hash.h"
#include "recordings/session.h"
#include "scenes/script.h"
#include "studio/output/files.h"

namespace ctpm::sweep {
namespace {

namespace fs = std::filesystem;

/// A path that stands in a file, from the working directory.
std::string beside(const std::string& file, const std::string& path) {
  return (fs::path(file).parent_path() / path).lexically_normal().string();
}

bool is_motion(const std::string& path) { return fs::path(path).extension() == ".csv"; }

/// Why the files cannot be read that a sweep with refused values names.
Errors unreadable_files(const scenes::SweepDraft& draft, const std::string& file) {
  Errors errors;
  const scenes::SweepSpec& sweep = draft.sweep.spec;
  for (const auto& [pointer, path] : {std::pair("/scene", sweep.scene), std::pair("/script", sweep.script)})
    if (!path.empty() && draft.problems.is_good(pointer)) append(errors, output::read_text_file(beside(file, path)));
  return errors;
}

/// The pointer at which an error's message begins; empty if it begins with none.
std::string pointer_in(const std::string& message) {
  const std::size_t end = message.find(": ");
  return message.starts_with("/") && end != std::string::npos ? message.substr(0, end) : "";
}

}  // namespace

Result<Sweep> Sweep::load(const std::string& file) {
  const Result<std::string> text = output::read_text_file(file);
  if (!text) return text.errors();
  Result<scenes::SweepDraft> read = scenes::read_sweep_draft(*text, file);
  if (!read) return read.errors();
  if (!read->problems.is_empty()) {
    Errors errors = read->problems.errors();
    append(errors, unreadable_files(*read, file));
    return errors;
  }
  Sweep sweep;
  sweep.file_ = file;
  sweep.text_ = std::move(read->sweep);
  sweep.samples_ = samples_of(sweep.text_.spec);
  return sweep;
}

Result<std::string> Sweep::text_of(const std::string& path, const std::vector<std::string>& pointers,
                                   const std::vector<std::string>& values) {
  auto found = texts_.find(path);
  if (found == texts_.end()) {
    const Result<std::string> text = output::read_text_file(path);
    const bool has_slots = !pointers.empty();
    // A text without values that vary need not be JSON: it may be a motion.
    if (!text)
      found = texts_.emplace(path, text.errors()).first;
    else
      found =
          texts_.emplace(path, has_slots ? scenes::ValueSlots::find(*text, path, pointers) : scenes::ValueSlots(*text))
              .first;
  }
  if (!found->second) return found->second.errors();
  return found->second->with(values);
}

Sweep::ReadFiles Sweep::read_files(std::size_t task) {
  const scenes::SweepSpec& sweep = text_.spec;
  const Sample& sample = samples_[task];
  std::string path[2] = {sweep.scene, sweep.script};
  std::vector<std::string> pointers[2], values[2];
  for (std::size_t i = 0; i < sweep.vary.size(); ++i) {
    const std::size_t of = sweep.vary[i].of == scenes::SweepTarget::scene ? 0 : 1;
    if (sweep.vary[i].key.empty())
      path[of] = sample.values[i].shown;
    else
      pointers[of].push_back(sweep.vary[i].key), values[of].push_back(sample.values[i].json);
  }
  ReadFiles read;
  TaskFiles& files = read.files;
  std::string *const paths[] = {&files.scene_path, &files.script_path}, *const texts[] = {&files.scene_text,
                                                                                          &files.script_text};
  for (const std::size_t of : {0, 1}) {
    if (path[of].empty()) continue;
    *paths[of] = beside(file_, path[of]);
    Result<std::string> text = text_of(*paths[of], pointers[of], values[of]);
    if (text)
      *texts[of] = std::move(*text);
    else
      (of == 0 ? read.of_scene : read.of_script) = text.errors();
  }
  return read;
}

Result<TaskFiles> Sweep::files_of(std::size_t task) {
  ReadFiles read = read_files(task);
  Errors errors = std::move(read.of_scene);
  append(errors, std::move(read.of_script));
  if (!errors.empty()) return errors;
  return std::move(read.files);
}

Result<std::string> Sweep::id_of(const TaskFiles& files, const scenes::SceneSpec& scene) {
  std::string content = "ctpm-task 1\n" + std::to_string(kPhysicsRevision) + "\n";
  const auto add = [&](const std::string& text) { content += std::to_string(text.size()) + ":" + text + "\n"; };
  add(files.scene_text), add(files.script_text), add(files.script_path.empty() ? "default" : "given");
  add(text_.spec.duration ? std::to_string(*text_.spec.duration) : "");
  std::vector<std::string> meshes;
  for (const scenes::OrganSpec& organ : scene.organs) meshes.push_back(organ.mesh);
  for (const scenes::ObstacleSpec& obstacle : scene.obstacles) meshes.push_back(obstacle.mesh);
  for (const std::string& mesh : meshes) {
    if (mesh.empty()) continue;
    const std::string path = scenes::mesh_path(files.scene_path, mesh);
    auto found = mesh_hash_.find(path);
    if (found == mesh_hash_.end()) found = mesh_hash_.emplace(path, recordings::file_hash(path)).first;
    if (!found->second) return found->second.errors();
    add(recordings::hash_text(*found->second));
  }
  recordings::ByteHash hash;
  hash.add(content.data(), content.size());
  return recordings::hash_text(hash.value());
}

Errors Sweep::problems_of(std::size_t task, const ReadFiles& read, const Result<scenes::SceneDraft>& draft) const {
  const TaskFiles& files = read.files;
  Errors found = draft ? draft->problems.errors() : draft.errors();
  append(found, read.of_script);
  if (read.of_script.empty() && !files.script_path.empty() && !is_motion(files.script_path))
    append(found, scenes::check_script(files.script_text, files.script_path,
                                       draft ? *draft : scenes::unknown_scene(files.scene_path)));
  for (Error& error : found) error = placed(error, task);
  return found;
}

std::string Sweep::described(std::size_t task) const {
  std::string text;
  for (std::size_t i = 0; i < samples_[task].values.size(); ++i)
    text += (i == 0 ? "" : ", ") + text_.spec.vary[i].column() + " = " + samples_[task].values[i].shown;
  return text;
}

/// An error at a value that the sweep sets stands where the sweep says it, another one of a text with such values where
/// its author wrote it.
Error Sweep::placed(const Error& error, std::size_t task) const {
  const std::string pointer = pointer_in(error.message);
  if (pointer.empty()) return error;
  for (std::size_t i = 0; i < text_.spec.vary.size(); ++i) {
    const scenes::SweepAxis& axis = text_.spec.vary[i];
    if (axis.key.empty() || (pointer != axis.key && !pointer.starts_with(axis.key + "/"))) continue;
    const int index = samples_[task].index[i];
    std::string at = "/vary/" + std::to_string(i);
    if (index >= 0) at += "/values/" + std::to_string(index);
    return text_.places.error_at(at, error.message.substr(pointer.size() + 2), error.hint);
  }
  for (const auto& [path, slots] : texts_)
    if (slots && slots->places().file_name() == path && error.where.starts_with(path + ":"))
      return slots->places().error_at(pointer, error.message.substr(pointer.size() + 2), error.hint);
  return error;
}

/// What an error does not say of the session that has it.
Error Sweep::with_values(Error error, std::size_t task) const {
  if (!error.where.starts_with(file_ + ":")) error.message += " (with " + described(task) + ")";
  return error;
}

Errors Sweep::said(const Errors& errors, std::size_t task) const {
  Errors said;
  for (const Error& error : errors) said.push_back(with_values(placed(error, task), task));
  return said;
}

Plan Sweep::empty_plan() const {
  Plan plan;
  plan.file = fs::absolute(file_).lexically_normal().string(), plan.name = text_.spec.name;
  for (const scenes::SweepAxis& axis : text_.spec.vary) {
    plan.columns.push_back(axis.column());
    plan.is_number.push_back(std::all_of(axis.values.begin(), axis.values.end(),
                                         [](const scenes::SweepValue& value) { return value.number.has_value(); }));
  }
  if (has_seeds()) plan.columns.push_back("seed"), plan.is_number.push_back(false);
  return plan;
}

Result<std::string> Sweep::checked_id(std::size_t task) {
  const ReadFiles read = read_files(task);
  const TaskFiles& files = read.files;
  const Result<scenes::SceneDraft> draft = read.of_scene.empty()
                                               ? scenes::load_draft(files.scene_path, {.text = files.scene_text})
                                               : Result<scenes::SceneDraft>(read.of_scene);
  if (Errors found = problems_of(task, read, draft); !found.empty()) return found;
  return id_of(files, draft->scene.spec);
}

Result<Plan> Sweep::plan() {
  constexpr std::size_t kMostErrors = 100;
  Plan plan = empty_plan();
  Errors errors;
  std::set<std::string> said;
  std::map<std::string, std::size_t> known;
  for (std::size_t task = 0; task < samples_.size(); ++task) {
    Result<std::string> id = checked_id(task);
    if (id)
      if (const auto [same, is_new] = known.emplace(*id, task); !is_new)
        id = Error{
            file_,
            "session " + std::to_string(task + 1) + " is the same as session " + std::to_string(same->second + 1), ""};
    if (!id) {
      for (const Error& error : id.errors()) {
        // What depends on more than one value is said with the first ones that show it.
        if (errors.size() >= kMostErrors || !said.insert(error.where + error.message).second) continue;
        errors.push_back(with_values(error, task));
      }
      continue;
    }
    plan.tasks.push_back({*id, {}});
    for (const scenes::SweepValue& value : samples_[task].values) plan.tasks.back().shown.push_back(value.shown);
    if (has_seeds()) plan.tasks.back().shown.push_back(samples_[task].seed);
  }
  if (!errors.empty()) return errors;
  return plan;
}

}  // namespace ctpm::sweep
