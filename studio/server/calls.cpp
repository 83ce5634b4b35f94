#include "studio/server/calls.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "studio/server/call_table.h"
#include "studio/server/scene_list.h"

namespace ctpm::server {
namespace {

using Call = Result<std::string> (*)(Parameters&, const CallContext&);

constexpr std::pair<const char*, Call> kCalls[] = {
    {"folder.list", list_folder},
    {"session.open", open_session},
    {"session.close", close_session},
    {"session.draw", draw_session},
    {"session.timeline", session_timeline},
    {"session.verify", verify_session},
    {"session.compare", compare_sessions},
    {"session.export", export_session},
    {"session.export_name", name_export},
    {"session.export_moment", export_moment},
    {"notes.read", read_notes},
    {"notes.write", write_notes},
    {"session.motion", session_motion},
    {"scene.read", read_scene},
    {"scene.write", write_scene},
    {"scene.rename", rename_scene_file},
    {"scene.removal", plan_scene_removal},
    {"scene.remove", remove_scene_files},
    {"scene.removed", list_removed_scenes},
    {"scene.restore", restore_scene_files},
    {"scene.delete", delete_scene_files},
    {"scene.check", check_scene},
    {"scene.show", show_scene},
    {"scene.close", close_scene},
    {"scene.hold", hold_scenes},
    {"scene.import_name", name_import},
    {"scene.import", import_mesh},
    {"scene.fit", fit_organ},
    {"scene.presets", list_presets},
    {"scene.schema", show_schema},
    {"scene.measure", measure_scene},
    {"scene.scatter", measure_scatter},
    {"train.begin", begin_training},
    {"train.end", end_training},
    {"scene.formats", list_formats},
    {"session.comparable", are_comparable},
    {"session.scenes", scenes_of_sessions},
};

void write_entries(output::JsonWriter& json, const char* key, const std::vector<FolderEntry>& entries) {
  json.key(key).begin_list();
  for (const FolderEntry& entry : entries)
    json.begin_object()
        .member("path", std::string_view(entry.path))
        .member("bytes", std::int64_t(entry.bytes))
        .member("modified_s", entry.modified_s)
        .end_object();
  json.end_list();
}

}  // namespace

Result<std::string> run_call(const std::string& name, Parameters& parameters, const CallContext& context) {
  const auto found =
      std::find_if(std::begin(kCalls), std::end(kCalls), [&](const auto& known) { return name == known.first; });
  if (found == std::end(kCalls)) return Error{name, "there is no such call", ""};
  Result<std::string> result = found->second(parameters, context);
  if (result) return result;
  Errors errors = result.errors();
  for (Error& error : errors)
    for (std::string* text : {&error.where, &error.message, &error.hint}) *text = context.folder.shown(*text);
  return errors;
}

Result<std::string> list_folder(Parameters& parameters, const CallContext& context) {
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  output::JsonWriter json;
  json.begin_object().member("folder", context.folder.root().string());
  write_entries(json, "sessions", context.folder.list(".ctpm"));
  write_entries(json, "scenes", scenes_of(context.folder));
  return json.end_object().text();
}

}  // namespace ctpm::server
