#include "studio/server/scene_files.h"

#include <fcntl.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "importers/formats.h"
#include "scenes/text_strings.h"
#include "studio/output/files.h"
#include "studio/server/scene_list.h"

namespace ctpm::server {

namespace fs = std::filesystem;

namespace {

using Moves = std::vector<std::pair<fs::path, fs::path>>;  ///< from, to

/// A file itself, and no link to one.
bool is_own_file(const fs::path& path) {
  std::error_code failure;
  return fs::symlink_status(path, failure).type() == fs::file_type::regular && !failure;
}

bool is_taken(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

/// Never over a file that is there. Returns errno, 0: it was moved.
int move_file(const fs::path& from, const fs::path& to) {
  int outcome = ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE);
  // Some file systems, of a network or another machine, know no such move.
  if (outcome != 0 && errno == EINVAL && !is_taken(to)) outcome = ::rename(from.c_str(), to.c_str());
  return outcome == 0 ? 0 : errno;
}

/// Moves all of them, or none.
Result<Done> move_all(const Folder& folder, const Moves& moves) {
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const int failure = move_file(moves[i].first, moves[i].second);
    if (failure == 0) continue;
    const fs::path where = failure == EEXIST ? moves[i].second : moves[i].first;
    while (i-- > 0) move_file(moves[i].second, moves[i].first);
    return Error{folder.relative(where.string()), std::generic_category().message(failure) + "; nothing was moved", ""};
  }
  return Done{};
}

/// The script that an import wrote beside a scene.
fs::path script_of(const fs::path& scene) { return fs::path(scene).replace_extension(".script.json"); }

/// The file that a text in `from` names by `value`.
fs::path named_by(const fs::path& from, const std::string& value) {
  return (from.parent_path() / value).lexically_normal();
}

bool is_mesh_name(const std::string& value) {
  const std::vector<std::string> endings = importers::readable_endings();
  std::string lower = value;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return std::any_of(endings.begin(), endings.end(),
                     [&](const std::string& ending) { return lower.ends_with(ending); });
}

/// A JSON file of the folder that may name others.
struct NamingFile {
  fs::path file;
  std::string path, text;
  std::vector<scenes::TextString> strings;
  bool is_scene = false;

  /// Courses and sweeps say by its path which scene they are of.
  bool names_scenes() const {
    return std::any_of(strings.begin(), strings.end(), [](const scenes::TextString& string) {
      return string.value == "ctpm-course" || string.value == "ctpm-sweep";
    });
  }
};

/// All JSON files but links. Error: one cannot be read, or there are more than are listed: then who names a file is not
/// known.
Result<std::vector<NamingFile>> naming_files(const Folder& folder) {
  const std::vector<FolderEntry> all = folder.list(".json");
  if (all.size() >= Folder::kMostListed)
    return Error{"", "the folder has too many files to tell what names a scene", ""};
  std::set<std::string> listed;
  for (const FolderEntry& entry : scenes_of(folder)) listed.insert(entry.path);
  std::vector<NamingFile> files;
  for (const FolderEntry& entry : all) {
    const fs::path file = folder.root() / entry.path;
    if (!is_own_file(file)) continue;
    Result<std::string> text = output::read_text_file(file.string());
    if (!text) return text.errors();
    std::vector<scenes::TextString> strings = scenes::strings_of(*text);
    files.push_back({file, entry.path, std::move(*text), std::move(strings), listed.contains(entry.path)});
  }
  return files;
}

/// The first of the others that uses a mesh; empty: none. A sweep names meshes as its scene does, wherever that lies.
std::string user_of_mesh(const fs::path& mesh, const std::vector<NamingFile>& others) {
  for (const NamingFile& other : others)
    for (const scenes::TextString& string : other.strings)
      if (other.is_scene ? named_by(other.file, string.value) == mesh
                         : fs::path(string.value).filename() == mesh.filename())
        return other.path;
  return "";
}

/// Why a mesh stays when its scene goes; empty: it goes too.
std::string why_mesh_stays(const Folder& folder, const fs::path& mesh, const std::vector<NamingFile>& others) {
  const Result<std::string> found = folder.find(folder.relative(mesh.string()));
  if (!found) return "it lies outside the folder";
  if (*found != mesh.string() || !is_own_file(mesh)) return "it is a link";
  const std::string user = user_of_mesh(mesh, others);
  return user.empty() ? "" : user + " uses it";
}

/// Makes a folder for what goes, with a name that none had. Errors: it cannot be made; a link leads away from it.
Result<fs::path> make_removed_folder(const Folder& folder) {
  const fs::path all = folder.root() / kRemoved;
  std::error_code failure;
  fs::create_directory(all, failure);
  if (failure || !fs::is_directory(fs::symlink_status(all, failure)))
    return Error{kRemoved, "cannot be made a folder; nothing was removed", ""};
  for (int number = 1;; ++number) {
    const fs::path made = all / std::to_string(number);
    if (fs::create_directory(made, failure)) return made;
    if (failure) return Error{kRemoved, failure.message() + "; nothing was removed", ""};
  }
}

/// Removes empty folders, from the innermost on; what holds something stays.
void remove_empty(const fs::path& top) {
  std::vector<fs::path> folders{top};
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(top, ignored))
    if (entry.is_directory(ignored) && !entry.is_symlink(ignored)) folders.push_back(entry.path());
  for (auto it = folders.rbegin(); it != folders.rend(); ++it) fs::remove(*it, ignored);
}

/// New names of files by their old ones.
using Names = std::map<fs::path, fs::path>;

/// The strings of a course or a sweep that name one of the files, with the new names.
std::vector<scenes::TextString> renamed_in(const NamingFile& other, const Names& names) {
  std::vector<scenes::TextString> changed;
  if (!other.names_scenes()) return changed;
  for (scenes::TextString string : other.strings)
    if (const auto it = names.find(named_by(other.file, string.value)); it != names.end()) {
      string.value = (fs::path(string.value).parent_path() / it->second.filename()).generic_string();
      changed.push_back(std::move(string));
    }
  return changed;
}

/// Writes the new names into all of them. After an error they have their old texts.
Result<Done> rewrite_all(const std::vector<NamingFile>& files, const Names& names) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string text = scenes::with_strings(files[i].text, renamed_in(files[i], names));
    const Result<Done> written = output::write_text_file(files[i].file.string(), text);
    if (written) continue;
    while (i-- > 0) (void)output::write_text_file(files[i].file.string(), files[i].text);
    return written.errors();
  }
  return Done{};
}

}  // namespace

Result<Removal> plan_removal(const Folder& folder, const std::string& scene) {
  const Result<std::string> found = find_listed_scene(folder, scene);
  if (!found) return found.errors();
  Result<std::vector<NamingFile>> all = naming_files(folder);
  if (!all) return all.errors();
  const fs::path file = *found, script = script_of(file);
  std::vector<NamingFile> others;
  std::vector<scenes::TextString> own;
  for (NamingFile& one : *all)
    if (one.file == file)
      own = std::move(one.strings);
    else if (one.file != script)
      others.push_back(std::move(one));
  Removal removal{{scene}, {}};
  if (is_own_file(script)) removal.goes.push_back(folder.relative(script.string()));
  std::set<fs::path> seen;
  for (const scenes::TextString& string : own) {
    const fs::path mesh = named_by(file, string.value);
    if (!is_mesh_name(string.value) || !is_taken(mesh) || !seen.insert(mesh).second) continue;
    const std::string why = why_mesh_stays(folder, mesh, others);
    if (why.empty())
      removal.goes.push_back(folder.relative(mesh.string()));
    else
      removal.stays.push_back({folder.relative(mesh.string()), why});
  }
  for (const NamingFile& other : others)
    if (!renamed_in(other, {{file, {}}, {script, {}}}).empty())
      removal.stays.push_back({other.path, "it names the scene, and will miss it"});
  return removal;
}

Result<std::string> remove_scene(const Folder& folder, const Removal& removal) {
  const Result<fs::path> removed = make_removed_folder(folder);
  if (!removed) return removed.errors();
  Moves moves;
  std::error_code ignored;
  for (const std::string& path : removal.goes) {
    moves.emplace_back(folder.root() / path, *removed / path);
    fs::create_directories(moves.back().second.parent_path(), ignored);
  }
  if (const Result<Done> moved = move_all(folder, moves); !moved) {
    remove_empty(*removed);
    return moved.errors();
  }
  return removed->filename().string();
}

Result<std::vector<std::string>> restore_scene(const Folder& folder, const std::string& removed) {
  const fs::path all = folder.root() / kRemoved, from = all / removed;
  std::error_code failure;
  const bool is_number = !removed.empty() && removed.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number || !fs::is_directory(fs::symlink_status(all, failure)) ||
      !fs::is_directory(fs::symlink_status(from, failure)))
    return Error{removed, "nothing was removed under that number", ""};
  Moves moves;
  std::vector<std::string> paths;
  Errors errors;
  for (const auto& entry : fs::recursive_directory_iterator(from, failure)) {
    if (!is_own_file(entry.path())) continue;
    const std::string path = entry.path().lexically_relative(from).generic_string();
    const Result<std::string> place = folder.place(path);
    if (!place)
      errors.insert(errors.end(), place.errors().begin(), place.errors().end());
    else if (is_taken(*place))
      errors.push_back({path, "exists already; nothing was brought back", "rename it first"});
    else
      moves.emplace_back(entry.path(), *place), paths.push_back(path);
  }
  if (!errors.empty()) return errors;
  if (const Result<Done> moved = move_all(folder, moves); !moved) return moved.errors();
  remove_empty(from);
  std::sort(paths.begin(), paths.end());
  return paths;
}

Result<Renamed> rename_scene(const Folder& folder, const std::string& scene, const std::string& to) {
  const Result<std::string> found = find_listed_scene(folder, scene), place = place_of_scene(folder, to);
  for (const auto* path : {&found, &place})
    if (!*path) return path->errors();
  const fs::path file = *found, named = *place;
  if (file.parent_path() != named.parent_path() || !may_name_scene(to))
    return Error{to, "is no name for this scene", "it stays in its folder, where its meshes lie beside it"};
  Names names{{file, named}};
  if (is_own_file(script_of(file))) names.emplace(script_of(file), script_of(named));
  Renamed renamed;
  Moves forth, back;
  for (const auto& [from, target] : names) {
    const std::string path = folder.relative(target.string());
    if (is_taken(target)) return Error{path, "exists already", "choose another name"};
    forth.emplace_back(from, target), back.emplace_back(target, from), renamed.moved.push_back(path);
  }
  Result<std::vector<NamingFile>> naming = naming_files(folder);
  if (!naming) return naming.errors();
  std::erase_if(*naming, [&](const NamingFile& other) { return renamed_in(other, names).empty(); });
  if (const Result<Done> moved = move_all(folder, forth); !moved) return moved.errors();
  if (const Result<Done> rewritten = rewrite_all(*naming, names); !rewritten) {
    (void)move_all(folder, back);
    return rewritten.errors();
  }
  for (const NamingFile& other : *naming) renamed.rewritten.push_back(other.path);
  return renamed;
}

}  // namespace ctpm::server
