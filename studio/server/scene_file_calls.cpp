// Scenes in the folder's list: renamed, removed, brought back and deleted.

#include <algorithm>

#include "studio/output/json_writer.h"
#include "studio/server/call_table.h"
#include "studio/server/desks.h"
#include "studio/server/removed_scenes.h"
#include "studio/server/scene_files.h"
#include "studio/server/scene_list.h"

namespace ctpm::server {
namespace {

void write_paths(output::JsonWriter& json, const char* key, const std::vector<std::string>& paths) {
  json.key(key).begin_list();
  for (const std::string& path : paths) json.value(std::string_view(path));
  json.end_list();
}

/// Errors: the scene is not listed; somebody works with it.
Result<std::string> find_unused(const CallContext& context, const std::string& scene) {
  const Result<std::string> file = find_listed_scene(context.folder, scene);
  if (!file) return file.errors();
  if (const std::string use = context.desks ? context.desks->use_of(*file, context.desk) : ""; !use.empty())
    return Error{scene, use, ""};
  return *file;
}

}  // namespace

Result<std::string> rename_scene_file(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path"), to = parameters.text("to");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = find_unused(context, path);
  if (!file) return file.errors();
  const Result<Renamed> renamed = rename_scene(context.folder, path, to);
  if (!renamed) return renamed.errors();
  if (context.desk) context.desk->forget(*file);
  output::JsonWriter json;
  json.begin_object();
  write_paths(json, "moved", renamed->moved);
  write_paths(json, "rewritten", renamed->rewritten);
  return json.end_object().text();
}

Result<std::string> plan_scene_removal(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  if (const Result<std::string> file = find_unused(context, path); !file) return file.errors();
  const Result<Removal> removal = plan_removal(context.folder, path);
  if (!removal) return removal.errors();
  output::JsonWriter json;
  json.begin_object();
  write_paths(json, "goes", removal->goes);
  json.key("stays").begin_list();
  for (const Removal::Kept& kept : removal->stays)
    json.begin_object()
        .member("path", std::string_view(kept.path))
        .member("why", std::string_view(kept.why))
        .end_object();
  return json.end_list().end_object().text();
}

Result<std::string> remove_scene_files(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path");
  std::vector<std::string> listed = parameters.texts_if("files");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = find_unused(context, path);
  if (!file) return file.errors();
  const Result<Removal> removal = plan_removal(context.folder, path);
  if (!removal) return removal.errors();
  if (!std::is_permutation(listed.begin(), listed.end(), removal->goes.begin(), removal->goes.end()))
    return Error{path, "other files than these would go; nothing was removed", "look again what goes: scene.removal"};
  const Result<std::string> removed = remove_files(context.folder, removal->goes);
  if (!removed) return removed.errors();
  if (context.desk) context.desk->forget(*file);
  output::JsonWriter json;
  json.begin_object().member("removed", std::string_view(*removed));
  return json.member("folder", kRemoved + std::string("/") + *removed).end_object().text();
}

Result<std::string> list_removed_scenes(Parameters& parameters, const CallContext& context) {
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::vector<RemovedScene>> all = removed_scenes(context.folder);
  if (!all) return all.errors();
  output::JsonWriter json;
  json.begin_list();
  for (const RemovedScene& one : *all) {
    json.begin_object().member("removed", std::string_view(one.removed)).member("path", std::string_view(one.path));
    json.member("removed_s", one.removed_s).key("files").begin_list();
    for (const RemovedScene::File& file : one.files)
      json.begin_object()
          .member("path", std::string_view(file.path))
          .member("bytes", std::int64_t(file.bytes))
          .member("used_by", std::string_view(file.used_by))
          .end_object();
    json.end_list().end_object();
  }
  return json.end_list().text();
}

Result<std::string> restore_scene_files(Parameters& parameters, const CallContext& context) {
  const std::string removed = parameters.text("removed");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::vector<std::string>> files = restore_removed(context.folder, removed);
  if (!files) return files.errors();
  output::JsonWriter json;
  json.begin_object();
  write_paths(json, "files", *files);
  return json.end_object().text();
}

Result<std::string> delete_scene_files(Parameters& parameters, const CallContext& context) {
  const std::string removed = parameters.text("removed");
  const std::vector<std::string> listed = parameters.texts_if("files");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<Done> deleted = delete_removed(context.folder, removed, listed);
  if (!deleted) return deleted.errors();
  output::JsonWriter json;
  json.begin_object();
  write_paths(json, "deleted", listed);
  return json.end_object().text();
}

}  // namespace ctpm::server
