#include "studio/server/removed_scenes.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/model/errors.h"
#include "studio/output/files.h"
#include "studio/server/file_moves.h"
#include "studio/server/naming_files.h"
#include "studio/server/scene_list.h"

namespace ctpm::server {

namespace fs = std::filesystem;

namespace {

bool is_number(const std::string& name) {
  return !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
}

bool is_own_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(fs::symlink_status(path, ignored));
}

/// Makes a folder for what goes, with a name that none has. Errors: it cannot be made; a link leads away from it.
Result<fs::path> make_removed_folder(const Folder& folder) {
  const fs::path all = folder.root() / kRemoved;
  std::error_code failure;
  fs::create_directory(all, failure);
  if (failure || !is_own_folder(all)) return Error{kRemoved, "cannot be made a folder; nothing was removed", ""};
  for (int number = 1;; ++number) {
    const fs::path made = all / std::to_string(number);
    if (fs::create_directory(made, failure)) return made;
    if (failure) return Error{kRemoved, failure.message() + "; nothing was removed", ""};
  }
}

/// The folder of a removal. Error: there is none of that number.
Result<fs::path> find_removed_folder(const Folder& folder, const std::string& removed) {
  const fs::path all = folder.root() / kRemoved, found = all / removed;
  if (!is_number(removed) || !is_own_folder(all) || !is_own_folder(found))
    return Error{removed, "nothing was removed under that number", ""};
  return found;
}

/// The files below a folder but links, by path.
std::vector<fs::path> own_files(const fs::path& top) {
  std::vector<fs::path> files;
  std::error_code failure;
  fs::recursive_directory_iterator it(top, fs::directory_options::skip_permission_denied, failure), end;
  for (; !failure && it != end; it.increment(failure))
    if (is_own_file(it->path())) files.push_back(it->path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string path_in(const fs::path& top, const fs::path& file) { return file.lexically_relative(top).generic_string(); }

/// Removes empty folders, from the innermost on; what holds something stays.
void remove_empty(const fs::path& top) {
  std::vector<fs::path> folders{top};
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(top, ignored))
    if (entry.is_directory(ignored) && !entry.is_symlink(ignored)) folders.push_back(entry.path());
  for (auto it = folders.rbegin(); it != folders.rend(); ++it) fs::remove(*it, ignored);
}

/// The scene among the files of a removal, as one that names its meshes from where it was; its path is empty if there
/// is none.
NamingFile scene_among(const Folder& folder, const fs::path& top, const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    const std::string path = path_in(top, file);
    if (!may_name_scene(path)) continue;
    const Result<std::string> text = output::read_text_file(file.string());
    return {folder.root() / path, path, "", text ? scenes::strings_of(*text) : std::vector<scenes::TextString>{}, true};
  }
  return {};
}

}  // namespace

Result<std::string> remove_files(const Folder& folder, const std::vector<std::string>& paths) {
  const Result<fs::path> removed = make_removed_folder(folder);
  if (!removed) return removed.errors();
  Moves moves;
  std::error_code ignored;
  for (const std::string& path : paths) {
    moves.emplace_back(folder.root() / path, *removed / path);
    fs::create_directories(moves.back().second.parent_path(), ignored);
  }
  if (const Result<Done> moved = move_all(folder, moves); !moved) {
    remove_empty(*removed);
    return moved.errors();
  }
  return removed->filename().string();
}

Result<std::vector<RemovedScene>> removed_scenes(const Folder& folder) {
  const fs::path all = folder.root() / kRemoved;
  std::vector<RemovedScene> found;
  if (!is_own_folder(all)) return found;
  std::vector<NamingFile> removed;  // of each that was found
  std::error_code failure;
  fs::directory_iterator it(all, failure), end;
  for (; !failure && it != end; it.increment(failure)) {
    const fs::path top = it->path();
    const std::vector<fs::path> files = own_files(top);
    if (!is_number(top.filename().string()) || !is_own_folder(top) || files.empty()) continue;
    std::error_code ignored;
    removed.push_back(scene_among(folder, top, files));
    RemovedScene one{top.filename().string(), removed.back().path, unix_seconds(fs::last_write_time(top, ignored)), {}};
    for (const fs::path& file : files) one.files.push_back({path_in(top, file), fs::file_size(file, ignored), ""});
    found.push_back(std::move(one));
  }
  if (found.empty()) return found;
  const Result<std::vector<NamingFile>> naming = naming_files(folder);
  if (!naming) return naming.errors();
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::vector<NamingFile> others = *naming;
    for (std::size_t k = 0; k < removed.size(); ++k)
      if (k != i) others.push_back(removed[k]);
    for (RemovedScene::File& file : found[i].files)
      if (!file.path.ends_with(".json")) file.used_by = user_of_mesh(folder.root() / file.path, others);
  }
  std::sort(found.begin(), found.end(), [](const RemovedScene& a, const RemovedScene& b) {
    return std::pair(-a.removed_s, a.removed) < std::pair(-b.removed_s, b.removed);
  });
  return found;
}

Result<std::vector<std::string>> restore_removed(const Folder& folder, const std::string& removed) {
  const Result<fs::path> from = find_removed_folder(folder, removed);
  if (!from) return from.errors();
  Moves moves;
  std::vector<std::string> paths;
  Errors errors;
  for (const fs::path& file : own_files(*from)) {
    const std::string path = path_in(*from, file);
    const Result<std::string> place = folder.place(path);
    if (!place)
      append(errors, place);
    else if (is_taken(*place))
      errors.push_back({path, "exists already; nothing was brought back", "rename it first"});
    else
      moves.emplace_back(file, *place), paths.push_back(path);
  }
  if (!errors.empty()) return errors;
  if (const Result<Done> moved = move_all(folder, moves); !moved) return moved.errors();
  remove_empty(*from);
  return paths;
}

Result<Done> delete_removed(const Folder& folder, const std::string& removed, const std::vector<std::string>& listed) {
  const Result<fs::path> from = find_removed_folder(folder, removed);
  if (!from) return from.errors();
  const std::vector<fs::path> files = own_files(*from);
  std::vector<std::string> paths;
  for (const fs::path& file : files) paths.push_back(path_in(*from, file));
  if (!std::is_permutation(listed.begin(), listed.end(), paths.begin(), paths.end()))
    return Error{removed, "holds other files than these; nothing was deleted", "look again what goes: scene.removed"};
  for (const fs::path& file : files) {
    std::error_code failure;
    if (!fs::remove(file, failure) && failure)
      return Error{folder.relative(file.string()), failure.message() + "; it was not deleted", ""};
  }
  remove_empty(*from);
  return Done{};
}

}  // namespace ctpm::server
