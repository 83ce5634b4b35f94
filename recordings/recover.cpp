#include "recordings/recover.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "core/stepping/step.h"
#include "recordings/internal/rescue.h"
#include "recordings/internal/schema.h"
#include "recordings/internal/session_store.h"
#include "recordings/internal/whole_writer.h"
#include "recordings/state_hash.h"

namespace ctpm::recordings {

using namespace session_file;

namespace {

constexpr std::int64_t last_key = std::numeric_limits<std::int64_t>::max();

/// The readable content of the damaged session. Ticks and keyframes are read again during writing, because an hour of
/// them is too large for memory.
struct Salvage {
  SessionStart start;
  std::int64_t parts = 0;                    ///< undamaged parts beside those that a replay needs
  std::vector<std::int64_t> keyframe_ticks;  ///< ticks of the undamaged keyframes
  std::vector<Event> events;
  std::optional<SessionStatistics> finish;
};

void note(RecoverReport& report, const Errors& errors) {
  for (const Error& error : errors) report.losses.push_back(error.message);
}

/// The State before tick 0. If both copies of it are damaged, uses the rest state, provided that the first tick
/// simulated from it matches its recorded hash. Scenes without gravity start at rest.
Result<State> initial_state(SessionStore& store, const Model& model, RecoverReport& report) {
  auto first = store.keyframe_at(0, model);
  if (first && *first) return std::move((*first)->state);
  auto copy = store.initial_state(model);
  if (copy && *copy) {
    report.repairs.push_back("keyframe 0 was lost; the copy in the part initial is as good");
    return std::move(**copy);
  }
  const Errors lost = first ? Errors{{"", "keyframe 0: is missing", ""}} : first.errors();
  const auto chunk = store.chunk_at(0);
  if (!chunk || !*chunk || (*chunk)->first != 0 || (*chunk)->items.empty()) return lost;
  const TickRecord& record = (*chunk)->items.front();
  State state = rest_state(model);
  stepping::Stepper(model).step(state, record.inputs);
  if (state_hash(state) != record.state_hash) return lost;
  report.repairs.push_back(
      "the initial state was damaged; the first tick proves that the session began at rest, so it is written "
      "anew");
  return rest_state(model);
}

/// Reads the start. Replay is impossible without Model or initial State.
Result<Done> salvage_start(SessionStore& store, Salvage& salvage, RecoverReport& report) {
  auto model = store.model();
  if (!model) return model.errors();
  salvage.start.model = std::move(*model);
  if (auto r = store.read_columns(); !r) return r.errors();
  auto surfaces = store.surfaces(salvage.start.model);
  if (!surfaces) return surfaces.errors();  // tools touch them
  salvage.start.model.surfaces = std::move(*surfaces);
  auto initial = initial_state(store, salvage.start.model, report);
  if (!initial) return initial.errors();
  salvage.start.initial_state = std::move(*initial);

  const auto take = [&](auto result, auto& place) {
    if (result)
      place = std::move(*result), ++salvage.parts;
    else
      note(report, result.errors());
  };
  take(store.scene(), salvage.start.scene_text);
  take(store.look(), salvage.start.look);
  take(store.metadata(), salvage.start.metadata);
  take(store.finish(), salvage.finish);
  salvage.start.build_fingerprint = store.identity().build;
  salvage.start.physics_revision = store.identity().physics_revision;
  return Done{};
}

/// Reads all chunks up to the first gap, and only counts the readable ticks beyond it.
void salvage_ticks(SessionStore& store, Salvage& salvage, RecoverReport& report) {
  std::int64_t next = 0;
  while (true) {
    auto chunk = store.chunk_at(next);
    if (!chunk) {
      note(report, chunk.errors());
      break;
    }
    if (!*chunk || (*chunk)->first != next) break;
    next = (*chunk)->end();
  }
  report.ticks_saved = next;

  // Search backwards from the end: the last readable chunk gives the length of the session.
  for (std::int64_t at = last_key; at >= next;) {
    const auto later = store.chunk_at(at);
    if (!later) {
      note(report, later.errors());
      break;
    }
    if (!*later || (*later)->first < next) break;
    if (report.ticks_dropped == 0 && (*later)->first > next)
      report.losses.push_back("ticks from " + std::to_string(next) +
                              " on cannot be replayed: a chunk before them is lost");
    report.ticks_dropped += static_cast<std::int64_t>((*later)->items.size());
    at = (*later)->first - 1;
  }
  if (salvage.finish && salvage.finish->ticks != next)
    report.losses.push_back("ticks " + std::to_string(next) + " to " + std::to_string(salvage.finish->ticks - 1) +
                            " of " + std::to_string(salvage.finish->ticks));
}

void salvage_keyframes(SessionStore& store, Salvage& salvage, RecoverReport& report) {
  const auto keys = store.keys("keyframe");
  if (!keys) return note(report, keys.errors());
  for (const std::int64_t key : *keys) {
    if (key <= 0 || key > report.ticks_saved) continue;
    auto keyframe = store.keyframe_at(key, salvage.start.model);
    if (!keyframe)
      note(report, keyframe.errors());
    else if (*keyframe && (*keyframe)->tick == key)
      salvage.keyframe_ticks.push_back(key);
  }
  report.keyframes_saved = static_cast<std::int64_t>(salvage.keyframe_ticks.size());
  if (salvage.finish && report.ticks_saved == salvage.finish->ticks &&
      report.keyframes_saved != salvage.finish->keyframes)
    report.losses.push_back("keyframes: " + std::to_string(report.keyframes_saved) + " of " +
                            std::to_string(salvage.finish->keyframes) + " are left");
}

void salvage_events(SessionStore& store, Salvage& salvage, RecoverReport& report) {
  const auto keys = store.keys("event");
  if (!keys) return note(report, keys.errors());
  std::int64_t read = 0;
  for (const std::int64_t key : *keys) {
    auto run = store.events_at(key);
    if (!run) {
      note(report, run.errors());
      continue;
    }
    if (!*run || (*run)->first != key) continue;
    read += static_cast<std::int64_t>((*run)->items.size());
    for (Event& event : (*run)->items)
      if (event.tick <= report.ticks_saved) salvage.events.push_back(std::move(event));
  }
  report.events_saved = static_cast<std::int64_t>(salvage.events.size());
  if (salvage.finish && read != salvage.finish->events)
    report.losses.push_back("events: " + std::to_string(read) + " of " + std::to_string(salvage.finish->events) +
                            " are left");
}

/// Writes the salvage as a new session with a new identity. Its metadata name the old session.
Result<Done> write_salvage(const std::string& out, Salvage& salvage, SessionStore& from, const RecoverReport& report) {
  SessionIdentity identity = new_identity(salvage.start);
  identity.created_unix_s = from.identity().created_unix_s;
  salvage.start.metadata["recovered_from"] = from.identity().id;
  auto writer = WholeWriter::create(out, salvage.start, identity);
  if (!writer) return writer.errors();
  for (std::int64_t next = 0; next < report.ticks_saved;) {
    const auto chunk = from.chunk_at(next);
    if (!chunk) return chunk.errors();
    if (auto r = writer->add_ticks((*chunk)->items); !r) return r;
    next = (*chunk)->end();
  }
  for (const std::int64_t tick : salvage.keyframe_ticks) {
    const auto keyframe = from.keyframe_at(tick, salvage.start.model);
    if (!keyframe) return keyframe.errors();
    if (auto r = writer->add_keyframe(**keyframe); !r) return r;
  }
  if (auto r = writer->add_events(salvage.events); !r) return r;
  // Only a complete session gets its end.
  if (salvage.finish && report.losses.empty())
    if (auto r = writer->add_end(salvage.finish->values); !r) return r;
  return writer->close();
}

/// What one way of reading the damaged session saves.
struct Attempt {
  SessionStore store;
  Salvage salvage;
  RecoverReport report;

  /// Rows of the database: what a way of reading is judged by.
  std::int64_t rows() const {
    return salvage.parts + report.ticks_saved + report.keyframes_saved + report.events_saved;
  }
};

Result<Attempt> salvage_all(const std::string& path) {
  auto store = SessionStore::open(path, true);
  if (!store) return store.errors();
  Attempt attempt;
  attempt.store = std::move(*store);
  if (const int version = attempt.store.version(); version < 1 || version > format_version)
    attempt.report.repairs.push_back("its header says that it is of format version " + std::to_string(version) +
                                     ", which this program does not know; it is read as of version " +
                                     std::to_string(format_version));
  if (auto r = salvage_start(attempt.store, attempt.salvage, attempt.report); !r) {
    Errors errors = r.errors();
    for (Error& error : errors) error.where = path;
    errors.push_back(
        {path, "cannot be recovered: without the model and the initial state there is nothing to replay", ""});
    return errors;
  }
  salvage_ticks(attempt.store, attempt.salvage, attempt.report);
  salvage_keyframes(attempt.store, attempt.salvage, attempt.report);
  salvage_events(attempt.store, attempt.salvage, attempt.report);
  return attempt;
}

/// Reads the damaged session as the database that it is and, where something is lost, the blocks on its pages one by
/// one, in a file `copy`: a lost inner page then loses nothing but itself. Keeps what saves more.
Result<Attempt> salvage_either_way(const std::string& in, const std::string& copy) {
  auto plain = salvage_all(in);
  if (plain && plain->report.losses.empty()) return plain;
  if (const auto rows = rescue_rows(in, copy); !rows) {
    // A full disk tells nothing about the session: what it would have saved must not be called lost.
    if (rows.errors().front().where != in) return rows.errors();
    return plain;
  }
  auto rescued = salvage_all(copy);
  if (!rescued || (plain && rescued->rows() <= plain->rows())) return plain;
  rescued->report.repairs.push_back(
      "pages that hold the database together were lost or damaged; what lies on the others is put together anew");
  return rescued;
}

}  // namespace

Result<RecoverReport> recover_session(const std::string& in, const std::string& out) {
  std::error_code ignored;
  if (std::filesystem::exists(out, ignored)) return Error{out, "exists already", "choose another name"};
  std::string copy = out + ".salvage";
  while (std::filesystem::exists(copy, ignored)) copy += "-";
  struct Remover {
    const std::string& path;
    ~Remover() { remove_with_companions(path); }
  } const remover{copy};
  auto attempt = salvage_either_way(in, copy);
  if (!attempt) {
    Errors errors = attempt.errors();
    for (Error& error : errors)
      if (error.where == copy) error.where = out;
    return errors;
  }
  auto& [store, salvage, report] = *attempt;
  report.complete = report.losses.empty() && salvage.finish.has_value();
  if (!salvage.finish) report.losses.push_back("the session was cut off: it has no end");
  if (auto r = write_salvage(out, salvage, store, report); !r) {
    remove_with_companions(out);
    return r.errors();
  }

  // Read the new file back and verify it.
  auto reader = SessionReader::open(out);
  if (!reader) return reader.errors();
  auto verdict = verify_session(*reader);
  if (!verdict) return verdict.errors();
  report.verdict = *verdict;
  return report;
}

}  // namespace ctpm::recordings
