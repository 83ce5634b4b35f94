#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/model/result.h"
#include "core/model/vec3.h"
#include "studio/output/json_writer.h"

// Pieces of the JSON that the server sends. PROTOCOL.md lists all messages.
namespace ctpm::server {

/// Writes a list of errors: where, message, hint.
void write_errors(output::JsonWriter& json, const Errors& errors);

/// The same as JSON.
std::string errors_json(const Errors& errors);

/// Writes [x, y, z].
void write_vector(output::JsonWriter& json, Vec3 v);

/// `text` with each byte that is not UTF-8 replaced by '?': names of files and organs may hold anything.
std::string as_utf8(std::string text);

/// The answer to a call. `result` is JSON.
std::string answer(std::int64_t id, const std::string& result);
std::string answer(std::int64_t id, const Errors& errors);

/// Progress of a call that goes on.
std::string progress_of(std::int64_t id, std::int64_t done, std::int64_t total);

/// An event that no call asked for; `content` is a JSON object.
std::string event_text(std::string_view name, const std::string& content);

/// Event: a stage cannot show a moment.
std::string stage_failed(std::uint32_t stage, const Errors& errors);

}  // namespace ctpm::server
