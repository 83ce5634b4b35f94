#pragma once

#include <string>

#include "recordings/session_reader.h"
#include "studio/server/calls.h"
#include "studio/server/text.h"

// One function for each call; PROTOCOL.md says what they take and return. Each checks its parameters first.
namespace ctpm::server {

/// Opens the session of that path in the folder.
inline Result<recordings::SessionReader> open_reader(const CallContext& context, const std::string& path) {
  const Result<std::string> file = context.folder.find(path);
  if (!file) return file.errors();
  return recordings::SessionReader::open(*file);
}

Result<std::string> list_folder(Parameters& parameters, const CallContext& context);
Result<std::string> scenes_of_sessions(Parameters& parameters, const CallContext& context);
Result<std::string> open_session(Parameters& parameters, const CallContext& context);
Result<std::string> close_session(Parameters& parameters, const CallContext& context);
Result<std::string> draw_session(Parameters& parameters, const CallContext& context);
Result<std::string> session_timeline(Parameters& parameters, const CallContext& context);
Result<std::string> verify_session(Parameters& parameters, const CallContext& context);
Result<std::string> are_comparable(Parameters& parameters, const CallContext& context);
Result<std::string> compare_sessions(Parameters& parameters, const CallContext& context);
Result<std::string> name_export(Parameters& parameters, const CallContext& context);
Result<std::string> export_moment(Parameters& parameters, const CallContext& context);
Result<std::string> export_session(Parameters& parameters, const CallContext& context);
Result<std::string> session_motion(Parameters& parameters, const CallContext& context);
Result<std::string> begin_training(Parameters& parameters, const CallContext& context);
Result<std::string> end_training(Parameters& parameters, const CallContext& context);
Result<std::string> read_scene(Parameters& parameters, const CallContext& context);
Result<std::string> write_scene(Parameters& parameters, const CallContext& context);
Result<std::string> rename_scene_file(Parameters& parameters, const CallContext& context);
Result<std::string> plan_scene_removal(Parameters& parameters, const CallContext& context);
Result<std::string> remove_scene_files(Parameters& parameters, const CallContext& context);
Result<std::string> list_removed_scenes(Parameters& parameters, const CallContext& context);
Result<std::string> restore_scene_files(Parameters& parameters, const CallContext& context);
Result<std::string> delete_scene_files(Parameters& parameters, const CallContext& context);
Result<std::string> check_scene(Parameters& parameters, const CallContext& context);
Result<std::string> show_scene(Parameters& parameters, const CallContext& context);
Result<std::string> close_scene(Parameters& parameters, const CallContext& context);
Result<std::string> hold_scenes(Parameters& parameters, const CallContext& context);
Result<std::string> name_import(Parameters& parameters, const CallContext& context);
Result<std::string> import_mesh(Parameters& parameters, const CallContext& context);
Result<std::string> fit_organ(Parameters& parameters, const CallContext& context);
Result<std::string> show_schema(Parameters& parameters, const CallContext& context);
Result<std::string> measure_scene(Parameters& parameters, const CallContext& context);
Result<std::string> measure_scatter(Parameters& parameters, const CallContext& context);
Result<std::string> list_formats(Parameters& parameters, const CallContext& context);
Result<std::string> list_presets(Parameters& parameters, const CallContext& context);
Result<std::string> read_notes(Parameters& parameters, const CallContext& context);
Result<std::string> write_notes(Parameters& parameters, const CallContext& context);

}  // namespace ctpm::server
