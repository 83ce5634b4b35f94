#include "studio/server/scene_files.h"

#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "importers/formats.h"
#include "studio/output/files.h"
#include "studio/server/file_moves.h"
#include "studio/server/naming_files.h"
#include "studio/server/scene_list.h"

namespace ctpm::server {

namespace fs = std::filesystem;

namespace {

/// The script that an import wrote beside a scene.
fs::path script_of(const fs::path& scene) { return fs::path(scene).replace_extension(".script.json"); }

/// Why a mesh stays when its scene goes; empty: it goes too.
std::string why_mesh_stays(const Folder& folder, const fs::path& mesh, const std::vector<NamingFile>& others) {
  const Result<std::string> found = folder.find(folder.relative(mesh.string()));
  if (!found) return "it lies outside the folder";
  if (*found != mesh.string() || !is_own_file(mesh)) return "it is a link";
  const std::string user = user_of_mesh(mesh, others);
  return user.empty() ? "" : user + " uses it";
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
    if (!importers::has_readable_ending(string.value) || !is_taken(mesh) || !seen.insert(mesh).second) continue;
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
