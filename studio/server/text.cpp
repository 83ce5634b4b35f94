#include "studio/server/text.h"

#include <algorithm>
#include <cstdint>

#include "studio/output/option_name.h"

namespace ctpm::server {
namespace {

/// Bytes of the UTF-8 character that begins at `at`; 0: none does.
std::size_t character_at(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? std::uint8_t(text[i]) : std::uint8_t(0); };
  const std::uint8_t first = byte(at);
  const std::size_t size = first < 0x80   ? 1
                           : first < 0xc2 ? 0
                           : first < 0xe0 ? 2
                           : first < 0xf0 ? 3
                           : first < 0xf5 ? 4
                                          : 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte(at + i) & 0xc0) != 0x80) return 0;
  const std::uint8_t second = byte(at + 1);
  const bool is_overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool is_surrogate = first == 0xed && second >= 0xa0, is_beyond = first == 0xf4 && second >= 0x90;
  return is_overlong || is_surrogate || is_beyond ? 0 : size;
}

/// The name by which a call knows a field of an option struct: "camera" for "look.camera".
std::string parameter_name(std::string_view field) { return std::string(field.substr(field.rfind('.') + 1)); }

}  // namespace

std::string as_utf8(std::string text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = character_at(text, at);
    if (size == 0) text[at] = '?';
    at += std::max<std::size_t>(size, 1);
  }
  return text;
}

void write_errors(output::JsonWriter& json, const Errors& errors) {
  json.begin_list();
  for (const Error& error : output::name_options(errors, parameter_name))
    json.begin_object()
        .member("where", std::string_view(error.where))
        .member("message", std::string_view(error.message))
        .member("hint", std::string_view(error.hint))
        .end_object();
  json.end_list();
}

std::string errors_json(const Errors& errors) {
  output::JsonWriter json;
  write_errors(json, errors);
  return json.text();
}

void write_vector(output::JsonWriter& json, Vec3 v) { json.begin_list().value(v.x).value(v.y).value(v.z).end_list(); }

std::string answer(std::int64_t id, const std::string& result) {
  return "{\"id\": " + std::to_string(id) + ", \"result\": " + result + "}";
}

std::string answer(std::int64_t id, const Errors& errors) {
  output::JsonWriter json;
  write_errors(json, errors);
  return "{\"id\": " + std::to_string(id) + ", \"errors\": " + json.text() + "}";
}

std::string progress_of(std::int64_t id, std::int64_t done, std::int64_t total) {
  return "{\"id\": " + std::to_string(id) + ", \"progress\": {\"done\": " + std::to_string(done) +
         ", \"total\": " + std::to_string(total) + "}}";
}

std::string event_text(std::string_view name, const std::string& content) {
  output::JsonWriter json;
  json.value(name);
  return "{\"event\": " + json.text() + ", \"content\": " + content + "}";
}

std::string stage_failed(std::uint32_t stage, const Errors& errors) {
  output::JsonWriter json;
  json.begin_object().member("stage", std::int64_t(stage)).key("errors");
  write_errors(json, errors);
  return event_text("stage_failed", json.end_object().text());
}

}  // namespace ctpm::server
