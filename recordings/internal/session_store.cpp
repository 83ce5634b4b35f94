#include "recordings/internal/session_store.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sstream>

#include "recordings/internal/field_codec.h"
#include "recordings/internal/legacy_fields.h"
#include "recordings/internal/legacy_values.h"
#include "recordings/internal/model_check.h"
#include "recordings/internal/schema.h"
#include "recordings/internal/statistics.h"

namespace ctpm::recordings::session_file {
namespace {

constexpr std::size_t sqlite_header_size = 100;             // [bytes]
constexpr double latest_unix_s = 1e11;                      // the year 5138
constexpr std::int64_t last_place = 1'000'000'000'000'000;  // ticks and events; sums stay within 64 bits

bool is_id(const std::string& id) {
  return id.size() == 32 && id.find_first_not_of("0123456789abcdef") == std::string::npos;
}

// Sessions need a twentieth of it.
constexpr std::uint64_t free_memory = 64ull << 20, memory_per_byte = 64;  // [bytes], [1]

/// SessionStore::memory_limit() of the file at `path` with its log.
std::uint64_t memory_limit_of(const std::string& path) {
  std::uint64_t size = 0;
  for (const char* ending : {"", "-wal"}) {
    struct stat info {};
    if (::stat((path + ending).c_str(), &info) == 0) size += static_cast<std::uint64_t>(info.st_size);
  }
  return std::min(max_part_size, free_memory + memory_per_byte * size);
}

/// Adds the file's path to the errors of a check.
Errors at_file(const std::string& path, const Errors& errors) {
  Errors placed;
  for (const Error& error : errors) placed.push_back({path, error.where + ": " + error.message, ""});
  return placed;
}

std::uint32_t big_endian(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 | bytes[3];
}

/// Rejects files that are not sessions with a clear message, before SQLite opens them. Returns whether the file names a
/// log that is missing.
Result<bool> check_file(const std::string& path, bool salvage) {
  // Without O_NONBLOCK, opening a pipe waits for somebody who writes to it.
  const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) {
    if (errno == ENOENT) return Error{path, "does not exist", ""};
    return Error{path, std::string("cannot be opened: ") + std::strerror(errno), ""};
  }
  struct stat info {};
  std::uint8_t header[sqlite_header_size] = {};
  const bool known = ::fstat(file, &info) == 0;
  const ssize_t got = known && S_ISREG(info.st_mode) ? ::pread(file, header, sizeof header, 0) : -1;
  ::close(file);
  if (!known || !S_ISREG(info.st_mode)) return Error{path, "is not a session file: it is not a regular file", ""};
  if (got == 0) return Error{path, "is not a session file: it is empty", ""};
  static constexpr char magic[16] = "SQLite format 3";
  if (got < 16 || std::memcmp(header, magic, sizeof magic) != 0)
    return Error{path, "is not a session file: it does not begin like one",
                 path.ends_with(".ctpm") ? "if it was one, try to recover it" : ""};
  if (got < static_cast<ssize_t>(sizeof header))
    return Error{path, "is cut short: " + std::to_string(got) + " bytes are left", "try to recover it"};

  // The size in the header is valid only if the last writer updated it.
  const std::uint64_t stated = std::uint64_t{big_endian(header + 28)} * 4096;
  const bool valid = big_endian(header + 24) == big_endian(header + 92);
  if (!salvage && valid && static_cast<std::uint64_t>(info.st_size) < stated &&
      ::access((path + "-wal").c_str(), F_OK) != 0)
    return Error{path,
                 "is cut short: " + std::to_string(info.st_size) + " of " + std::to_string(stated) + " bytes are left",
                 "try to recover it"};
  constexpr std::uint8_t with_log = 2;  // SQLite's journal mode
  return header[18] == with_log && ::access((path + "-wal").c_str(), F_OK) != 0;
}

}  // namespace

Error SessionStore::database_error(const std::string& what) const { return error(what + ": " + database_.problem()); }

Result<SessionStore> SessionStore::open(const std::string& path, bool salvage) {
  const auto lacks_log = check_file(path, salvage);
  if (!lacks_log) return lacks_log.errors();
  auto database = Database::open(path, salvage ? Database::Access::salvage : Database::Access::read);
  if (!database) return database.errors();
  SessionStore store;
  store.database_ = std::move(*database);
  store.lacks_log_ = *lacks_log;
  store.memory_limit_ = memory_limit_of(path);
  if (auto r = store.check_header(salvage); !r) return r.errors();
  if (auto r = store.check_schema(); !r) return r.errors();
  if (auto r = store.prepare(); !r) return r.errors();
  if (auto r = store.read_identity(); !r) return r.errors();
  return store;
}

Result<Done> SessionStore::check_header(bool salvage) {
  const auto number = [&](const char* pragma) -> Result<std::int64_t> {
    auto statement = database_.prepare(pragma);
    if (!statement || statement->step() != Statement::Outcome::row) return database_error("is damaged at its header");
    return statement->integer(0);
  };
  const auto application = number("PRAGMA application_id");
  if (!application) return application.errors();
  if (*application != application_id && !salvage) return error("is not a session file: it is another SQLite database");
  const auto version = number("PRAGMA user_version");
  if (!version) return version.errors();
  version_ = static_cast<int>(*version);
  if (version_ > format_version && !salvage)
    return Error{database_.path(),
                 "is of format version " + std::to_string(version_) + ", this program reads up to " +
                     std::to_string(format_version),
                 "use a newer program"};
  if (version_ < 1 && !salvage)
    return error("is of format version " + std::to_string(version_) + ", which never existed");
  return Done{};
}

Result<Done> SessionStore::check_schema() {
  auto statement = database_.prepare("SELECT type, name, sql FROM sqlite_schema ORDER BY rowid");
  if (!statement) return database_error("is damaged at its list of tables");
  std::size_t seen = 0;
  Statement::Outcome outcome;
  while ((outcome = statement->step()) == Statement::Outcome::row) {
    if (seen >= tables.size() || statement->text(0) != "table" || statement->text(1) != tables[seen].name ||
        statement->text(2) != tables[seen].sql)
      return error("is damaged or no session file: its tables are not those of a session");
    ++seen;
  }
  if (outcome == Statement::Outcome::failed) return database_error("is damaged at its list of tables");
  if (seen != tables.size()) return error("is damaged or no session file: tables are missing");
  return Done{};
}

Result<Done> SessionStore::prepare() {
  const auto one = [&](Statement& statement, const char* sql) -> Result<Done> {
    auto prepared = database_.prepare(sql);
    if (!prepared) return prepared.errors();
    statement = std::move(*prepared);
    return Done{};
  };
  if (auto r = one(part_, "SELECT size, checksum, data FROM part WHERE name = ?1"); !r) return r;
  if (auto r = one(chunk_,
                   "SELECT first, count, size, checksum, data FROM chunk WHERE first <= ?1 ORDER BY first "
                   "DESC LIMIT 1");
      !r)
    return r;
  if (auto r =
          one(keyframe_, "SELECT tick, size, checksum, data FROM keyframe WHERE tick <= ?1 ORDER BY tick DESC LIMIT 1");
      !r)
    return r;
  return one(event_,
             "SELECT first, count, size, checksum, data FROM event WHERE first <= ?1 ORDER BY first DESC LIMIT 1");
}

Result<std::optional<Bytes>> SessionStore::part_if_there(const std::string& name) {
  part_.reset();
  part_.bind(1, name);
  const Statement::Outcome outcome = part_.step();
  if (outcome == Statement::Outcome::failed) return database_error(part_name(name) + " cannot be read");
  if (outcome == Statement::Outcome::done) return std::optional<Bytes>{};
  if (!part_.is_integer(0) || !part_.is_integer(1) || !part_.is_blob(2)) return error(part_name(name) + ": is damaged");
  const std::uint64_t seed = name == "session" ? 0 : identity_.seed;
  auto content = unpack(part_name(name), part_.integer(0), part_.integer(1), part_.blob(2), seed, memory_limit_);
  if (!content) return error(content.errors().front().message);
  return std::optional<Bytes>(std::move(*content));
}

Result<Bytes> SessionStore::part(const std::string& name) {
  auto content = part_if_there(name);
  if (!content) return content.errors();
  if (!*content) return error(part_name(name) + ": is missing");
  return std::move(**content);
}

Result<std::vector<std::string>> SessionStore::part_names() {
  auto statement = database_.prepare("SELECT name FROM part ORDER BY 1");
  if (!statement) return statement.errors();
  std::vector<std::string> names;
  Statement::Outcome outcome;
  while ((outcome = statement->step()) == Statement::Outcome::row) names.push_back(statement->text(0));
  if (outcome == Statement::Outcome::failed) return database_error("the table part cannot be read");
  return names;
}

Result<Done> SessionStore::for_each_row(const std::function<void(const std::string&, std::int64_t, ByteView)>& visit) {
  for (const auto& [table, columns] : {std::pair{"part", "name, ''"},
                                       {"chunk", "first, count"},
                                       {"keyframe", "tick, ''"},
                                       {"event", "first, count"}}) {
    auto statement = database_.prepare(std::string("SELECT ") + columns + ", size, data FROM " + table + " ORDER BY 1");
    if (!statement) return statement.errors();
    Statement::Outcome outcome;
    while ((outcome = statement->step()) == Statement::Outcome::row) {
      std::string label = std::string(table) + " " + statement->text(0);
      if (!statement->text(1).empty()) label += " " + statement->text(1);
      visit(label, statement->integer(2), statement->blob(3));
    }
    if (outcome == Statement::Outcome::failed)
      return database_error(std::string("the table ") + table + " cannot be read");
  }
  return Done{};
}

Result<Done> SessionStore::check_container() {
  auto statement = database_.prepare("PRAGMA integrity_check(1)");
  if (!statement || statement->step() != Statement::Outcome::row) return database_error("its pages cannot be checked");
  const std::string found = statement->text(0);  // a line of its own names the database
  if (found == "ok") return Done{};
  return Error{database_.path(), "is damaged: " + found.substr(found.rfind('\n') + 1), "try to recover it"};
}

/// Runs `fill(reader, problem)` over a field set.
template <class Fill>
Result<Done> SessionStore::decode_fields(const std::string& name, const Bytes& content, Fill&& fill) const {
  std::string problem;
  ByteReader in(content, memory_limit_);
  fill(in, problem);
  if (!problem.empty()) return error(name + ": " + problem);
  return Done{};
}

Result<Done> SessionStore::read_identity() {
  const auto content = part("session");
  if (!content) return content.errors();
  return decode_fields("part session", *content, [&](ByteReader& in, std::string& problem) {
    get_fields(in, identity_, problem);
    if (problem.empty() && identity_.physics_revision < 0) problem = "physics_revision must not be below 0";
    if (problem.empty() && !is_id(identity_.id)) problem = "id must be 32 hexadecimal digits";
    if (problem.empty() && !(identity_.created_unix_s >= 0 && identity_.created_unix_s <= latest_unix_s))
      problem = "created_unix_s must be in [0, 1e11]";
  });
}

Result<std::string> SessionStore::scene() {
  const auto content = part("scene");
  if (!content) return content.errors();
  return text_of(*content);
}

Result<std::string> SessionStore::look() {
  const auto content = part("look");
  if (!content) return content.errors();
  return text_of(*content);
}

Result<Model> SessionStore::model() {
  const auto content = part("model");
  if (!content) return content.errors();
  Model model;
  if (auto r = decode_fields("part model", *content,
                             [&](ByteReader& in, std::string& problem) { get_model(in, model, problem); });
      !r)
    return r.errors();
  remarks_.clear();
  if (const auto updated = update_integrator(model, identity_.physics_revision, remarks_); !updated)
    return Error{database_.path(), updated.errors().front().message, updated.errors().front().hint};
  if (const Errors errors = check_model(model); !errors.empty()) return at_file(database_.path(), errors);
  if (identity_.physics_revision < 3) give_modulus(model);
  return model;
}

Result<std::vector<Surface>> SessionStore::surfaces(const Model& model) {
  const auto content = part("surfaces");
  if (!content) return content.errors();
  std::vector<Surface> surfaces;
  const auto decoded = decode_fields("part surfaces", *content, [&](ByteReader& in, std::string& problem) {
    FieldSet set(in, problem);
    FieldReader reader(set, in.budget(), problem);
    reader("surfaces", surfaces);
  });
  if (!decoded) return decoded.errors();
  if (const Errors errors = check_surfaces(model, surfaces); !errors.empty()) return at_file(database_.path(), errors);
  return surfaces;
}

Result<std::map<std::string, std::string>> SessionStore::metadata() {
  const auto content = part("metadata");
  if (!content) return content.errors();
  std::map<std::string, std::string> metadata;
  const auto decoded = decode_fields("part metadata", *content, [&](ByteReader& in, std::string& problem) {
    const FieldSet set(in, problem);
    for (const FieldView& field : set.fields()) metadata[field.name] = text_of(field.body);
  });
  if (!decoded) return decoded.errors();
  return metadata;
}

Result<std::optional<SessionStatistics>> SessionStore::finish() {
  const auto content = part_if_there("finish");
  if (!content) return content.errors();
  if (!*content) return std::optional<SessionStatistics>{};
  SessionStatistics statistics;
  const auto decoded = decode_fields("part finish", **content, [&](ByteReader& in, std::string& problem) {
    FieldSet set(in, problem);
    FieldReader reader(set, in.budget(), problem);
    std::string names;
    std::vector<double> numbers;
    for_each_field(statistics, reader);
    reader("value_names", names);
    reader("values", numbers);
    std::istringstream lines(names);
    std::string name;
    for (std::size_t i = 0; i < numbers.size() && std::getline(lines, name); ++i)
      statistics.values.emplace_back(name, numbers[i]);
    if (problem.empty() && statistics.values.size() != numbers.size()) problem = "values without names";
  });
  if (!decoded) return decoded.errors();
  return std::optional<SessionStatistics>(std::move(statistics));
}

Result<Done> SessionStore::read_columns() {
  const auto content = part("columns");
  if (!content) return content.errors();
  auto decoder = RecordDecoder::create(text_of(*content));
  if (!decoder) return error(decoder.errors().front().message);
  decoder_ = std::move(*decoder);
  return Done{};
}

/// Steps a bound statement once and verifies the block of its row; none if there is no row.
Result<std::optional<Bytes>> SessionStore::block_of(Statement& statement, const std::string& what, bool has_count,
                                                    std::uint64_t max_size, std::int64_t& first, std::int64_t& count) {
  const Statement::Outcome outcome = statement.step();
  if (outcome == Statement::Outcome::failed) return database_error(what + " cannot be read");
  if (outcome == Statement::Outcome::done) return std::optional<Bytes>{};
  const int shift = has_count ? 1 : 0;
  for (int column = 0; column < 3 + shift; ++column)
    if (!statement.is_integer(column)) return error(what + ": is damaged");
  if (!statement.is_blob(3 + shift)) return error(what + ": is damaged");
  first = statement.integer(0);
  count = has_count ? statement.integer(1) : 1;
  const std::string name =
      has_count ? what + " " + std::to_string(first) + " " + std::to_string(count) : what + " " + std::to_string(first);
  auto content = unpack(name, statement.integer(1 + shift), statement.integer(2 + shift), statement.blob(3 + shift),
                        identity_.seed, max_size);
  if (!content) return error(content.errors().front().message);
  return std::optional<Bytes>(std::move(*content));
}

Result<std::optional<Run<TickRecord>>> SessionStore::chunk_at(std::int64_t at) {
  chunk_.reset();
  chunk_.bind(1, at);
  std::int64_t first = 0, count = 0;
  const auto content = block_of(chunk_, "chunk", true, std::min(max_chunk_size, memory_limit_), first, count);
  if (!content) return content.errors();
  if (!*content) return std::optional<Run<TickRecord>>{};
  if (first < 0 || first > last_place || count < 1 || count > chunk_ticks)
    return error(chunk_name(first, count) + ": has an impossible place");
  auto records = decoder_.decode(**content, count);
  if (!records) return error(chunk_name(first, count) + ": " + records.errors().front().message);
  return std::optional(Run<TickRecord>{first, std::move(*records)});
}

Result<std::optional<Run<Event>>> SessionStore::events_at(std::int64_t at) {
  event_.reset();
  event_.bind(1, at);
  std::int64_t first = 0, count = 0;
  const auto content = block_of(event_, "event", true, std::min(max_chunk_size, memory_limit_), first, count);
  if (!content) return content.errors();
  if (!*content) return std::optional<Run<Event>>{};
  Run<Event> run{first, {}};
  const auto decoded = decode_fields(event_name(first, count), **content, [&](ByteReader& in, std::string& problem) {
    FieldSet set(in, problem);
    FieldReader reader(set, in.budget(), problem);
    reader("events", run.items);
    for (Event& event : run.items) update_event(event);
    if (problem.empty() && static_cast<std::int64_t>(run.items.size()) != count)
      problem = "holds another number of events";
  });
  if (!decoded) return decoded.errors();
  if (first < 0 || first > last_place || count < 1)
    return error(event_name(first, count) + ": has an impossible place");
  return std::optional(std::move(run));
}

Result<std::optional<Keyframe>> SessionStore::keyframe_at(std::int64_t at, const Model& model) {
  keyframe_.reset();
  keyframe_.bind(1, at);
  std::int64_t tick = 0, one = 0;
  const auto content = block_of(keyframe_, "keyframe", false, memory_limit_, tick, one);
  if (!content) return content.errors();
  if (!*content) return std::optional<Keyframe>{};
  if (tick < 0) return error(keyframe_name(tick) + ": has an impossible place");
  auto state = state_of(keyframe_name(tick), **content, model);
  if (!state) return state.errors();
  return std::optional(Keyframe{tick, std::move(*state)});
}

Result<std::optional<State>> SessionStore::initial_state(const Model& model) {
  const auto content = part_if_there("initial");
  if (!content) return content.errors();
  if (!*content) return std::optional<State>{};
  auto state = state_of(part_name("initial"), **content, model);
  if (!state) return state.errors();
  return std::optional(std::move(*state));
}

/// Decodes a State and checks it against the Model.
Result<State> SessionStore::state_of(const std::string& name, const Bytes& content, const Model& model) const {
  State state;
  const auto decoded =
      decode_fields(name, content, [&](ByteReader& in, std::string& problem) { get_state(in, state, problem); });
  if (!decoded) return decoded.errors();
  if (const Errors errors = check_state(model, state); !errors.empty()) {
    Errors placed = at_file(database_.path(), errors);
    for (Error& e : placed) e.message = name + ": " + e.message;
    return placed;
  }
  return state;
}

Result<std::vector<std::int64_t>> SessionStore::keys(const std::string& table) {
  auto statement = database_.prepare("SELECT " + std::string(table == "keyframe" ? "tick" : "first") + " FROM " +
                                     table + " ORDER BY 1");
  if (!statement) return statement.errors();
  std::vector<std::int64_t> keys;
  Statement::Outcome outcome;
  while ((outcome = statement->step()) == Statement::Outcome::row) keys.push_back(statement->integer(0));
  if (outcome == Statement::Outcome::failed) return database_error("the table " + table + " cannot be read");
  return keys;
}

}  // namespace ctpm::recordings::session_file
