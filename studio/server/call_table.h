#pragma once

#include <string>

#include "studio/server/calls.h"
#include "studio/server/text.h"

// One function for each call; PROTOCOL.md says what they take and return. Each checks its parameters first.
namespace ctpm::server {

Result<std::string> list_folder(Parameters& parameters, const CallContext& context);
Result<std::string> open_session(Parameters& parameters, const CallContext& context);
Result<std::string> close_session(Parameters& parameters, const CallContext& context);
Result<std::string> session_timeline(Parameters& parameters, const CallContext& context);
Result<std::string> verify_session(Parameters& parameters, const CallContext& context);
Result<std::string> compare_sessions(Parameters& parameters, const CallContext& context);
Result<std::string> export_session(Parameters& parameters, const CallContext& context);
Result<std::string> session_motion(Parameters& parameters, const CallContext& context);
Result<std::string> begin_training(Parameters& parameters, const CallContext& context);
Result<std::string> end_training(Parameters& parameters, const CallContext& context);
Result<std::string> read_scene(Parameters& parameters, const CallContext& context);
Result<std::string> write_scene(Parameters& parameters, const CallContext& context);
Result<std::string> check_scene(Parameters& parameters, const CallContext& context);
Result<std::string> show_scene(Parameters& parameters, const CallContext& context);
Result<std::string> import_mesh(Parameters& parameters, const CallContext& context);
Result<std::string> list_presets(Parameters& parameters, const CallContext& context);
Result<std::string> read_notes(Parameters& parameters, const CallContext& context);
Result<std::string> write_notes(Parameters& parameters, const CallContext& context);

}  // namespace ctpm::server
