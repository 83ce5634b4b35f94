#include <filesystem>
#include <mutex>

#include "recordings/byte_hash.h"
#include "recordings/session_reader.h"
#include "studio/output/files.h"
#include "studio/output/json_writer.h"
#include "studio/server/call_table.h"

// Notes lie beside a session, in NAME.notes.json; the session itself never changes.
namespace ctpm::server {
namespace {

constexpr const char* kFormat = "ctpm-notes";
constexpr double kVersion = 1;
constexpr std::size_t kLongestNote = 10000;

struct Note {
  double time_s = 0;
  std::string text;
};

struct Notes {
  std::string revision;  ///< of the file; "none": there is none
  std::vector<Note> notes;
};

std::string file_of(const std::string& session) {
  return std::filesystem::path(session).replace_extension(".notes.json").string();
}

std::vector<Note> take_notes(Parameters& parameters) {
  std::vector<Note> notes;
  for (Parameters& given : parameters.objects("notes")) {
    Note note{given.number("time_s", 0, 1e9), given.text("text")};
    if (note.text.size() > kLongestNote) given.refuse("text", "has at most " + std::to_string(kLongestNote) + " bytes");
    notes.push_back(std::move(note));
  }
  return notes;
}

/// The notes beside a session; none if there is no file.
Result<Notes> load(const std::string& session) {
  const std::string file = file_of(session);
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return Notes{"none", {}};
  const Result<std::string> text = output::read_text_file(file);
  if (!text) return text.errors();
  Result<Parameters> content = Parameters::parse(*text);
  if (!content) return Error{file, "is no file of notes", ""};
  if (content->text("format") != kFormat || content->number("version", 1, 1e6) != kVersion)
    return Error{file, "is no file of notes that this program can read", ""};
  content->text_if("session_id");
  recordings::ByteHash hash;
  hash.add(text->data(), text->size());
  Notes notes{recordings::hash_text(hash.value()), take_notes(*content)};
  if (Errors errors = content->errors(); !errors.empty()) {
    for (Error& error : errors) error.where = file + error.where;
    return errors;
  }
  return notes;
}

void write_list(output::JsonWriter& json, const std::vector<Note>& notes) {
  json.key("notes").begin_list();
  for (const Note& note : notes)
    json.begin_object().member("time_s", note.time_s).member("text", std::string_view(note.text)).end_object();
  json.end_list();
}

std::string to_json(const Notes& notes) {
  output::JsonWriter json;
  json.begin_object().member("revision", std::string_view(notes.revision));
  write_list(json, notes.notes);
  return json.end_object().text();
}

}  // namespace

Result<std::string> read_notes(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = context.folder.find(path);
  if (!file) return file.errors();
  const Result<Notes> notes = load(*file);
  if (!notes) return notes.errors();
  return to_json(*notes);
}

Result<std::string> write_notes(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path"), revision = parameters.text("revision");
  const std::vector<Note> given = take_notes(parameters);
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = context.folder.find(path);
  if (!file) return file.errors();
  const Result<recordings::SessionReader> session = recordings::SessionReader::open(*file);
  if (!session) return session.errors();
  static std::mutex writing;  // of two pages that write at the same time the later one is refused
  const std::lock_guard lock(writing);
  const Result<Notes> present = load(*file);
  if (!present) return present.errors();
  if (present->revision != revision)
    return Error{path, "its notes were changed by somebody else; nothing was written", "read them again"};
  output::JsonWriter json;
  json.begin_object().member("format", kFormat).member("version", std::int64_t(kVersion));
  json.member("session_id", session->session_id());
  write_list(json, given);
  if (const Result<Done> written = output::write_text_file(file_of(*file), json.end_object().text()); !written)
    return written.errors();
  const Result<Notes> now = load(*file);
  if (!now) return now.errors();
  return to_json(*now);
}

}  // namespace ctpm::server
