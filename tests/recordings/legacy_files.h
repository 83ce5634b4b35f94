#pragma once

#include "recordings/internal/field_codec.h"
#include "recordings/internal/session_database.h"
#include "tests/recordings/sessions.h"

namespace ctpm::recordings::session_file {

/// An event in the format from before events had fields.
struct SentenceEvent {
  std::int64_t tick = 0;
  std::int32_t kind = 0;
  std::string text;
  std::vector<double> values;
};

template <class E, class Visit>
requires std::is_same_v<std::remove_const_t<E>, SentenceEvent>
void for_each_field(E& e, Visit&& visit) {
  visit("tick", e.tick), visit("kind", e.kind), visit("text", e.text), visit("values", e.values);
}

}  // namespace ctpm::recordings::session_file

namespace ctpm::testing {

/// Writes a session without ticks whose Model stores `integrator`, bypassing the writer's checks.
inline void write_with_integrator(const std::string& path, std::int32_t integrator, std::int32_t physics_revision,
                                  const std::vector<recordings::session_file::SentenceEvent>& events = {}) {
  namespace file = recordings::session_file;
  recordings::SessionStart start = small_start();
  start.model.solver.integrator = static_cast<Integrator>(integrator);
  start.physics_revision = physics_revision;
  const file::SessionIdentity identity = file::new_identity(start);
  CTPM_CHECK(bool(file::create_session_file(path, start, identity, false, 3)), "a test's session can be created");
  if (events.empty()) return;
  file::Bytes content;
  file::put_field_set(content, [&](file::FieldWriter& writer) { writer("events", events); });
  const auto count = static_cast<std::int64_t>(events.size());
  auto tables = file::SessionTables::open_for_writing(path);
  const file::Block block = file::pack(file::event_name(0, count), content, identity.seed, 3);
  CTPM_CHECK(tables && tables->begin() && tables->insert_events(0, count, block) && tables->commit() && tables->close(),
             "a test's events can be written");
}

}  // namespace ctpm::testing
