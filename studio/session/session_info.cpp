#include "studio/session/session_info.h"

#include <algorithm>
#include <ctime>

#include "studio/output/json_writer.h"
#include "studio/session/anonymise.h"
#include "studio/session/late_ticks.h"

namespace ctpm::session {
namespace {

void write_event(output::JsonWriter& json, const recordings::Event& event, const Model& model) {
  json.begin_object().member("tick", event.tick).member("kind", recordings::name_of(event.kind));
  recordings::for_each_value(event, [&](const char* name, const auto& value) { json.member(name, value); });
  json.member("text", recordings::describe(event, model));
  if (!event.values.empty()) {
    json.key("values").begin_list();
    for (const double value : event.values) json.value(value);
    json.end_list();
  }
  json.end_object();
}

}  // namespace

std::string utc_text(double unix_s) {
  const std::time_t whole = std::time_t(unix_s);
  std::tm parts{};
  gmtime_r(&whole, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

Result<SessionInfo> read_info(recordings::SessionReader& reader) {
  Result<recordings::SessionStatistics> statistics = reader.statistics();
  if (!statistics) return statistics.errors();
  Result<std::vector<recordings::Event>> events = reader.events();
  if (!events) return events.errors();
  // An end is detected, and recorded, only a while later.
  std::ranges::stable_sort(*events, {}, &recordings::Event::tick);
  return SessionInfo{std::move(*statistics), std::move(*events)};
}

std::string info_json(const recordings::SessionReader& reader, const SessionInfo& info) {
  const recordings::SessionStatistics& s = info.statistics;
  const std::vector<recordings::Event>& events = info.events;
  const Model& model = reader.start().model;
  output::JsonWriter json;
  json.begin_object().member("session_id", reader.session_id()).member("format_version", reader.format_version());
  const bool is_elapsed = begins_at_elapsed_time(reader);
  json.member("created_utc", is_elapsed ? std::string() : utc_text(reader.created_unix_s()));
  if (is_elapsed) json.member("created_after_first_s", reader.created_unix_s());
  json.member("ended_cleanly", reader.ended_cleanly());
  const std::int32_t revision = reader.start().physics_revision;
  json.member("build", reader.start().build_fingerprint).member("physics_revision", revision);
  json.member("physics_remark", recordings::physics_remark(revision))
      .member("tick_s", model.tick)
      .member("ticks", reader.tick_count());
  json.member("duration_s", double(reader.tick_count()) * model.tick).member("spheres", model.sphere_count());
  json.member("elements", model.element_count())
      .member("keyframes", s.keyframes)
      .member("severed", s.severed)
      .member("pieces_came_loose", recordings::pieces_came_loose(events, reader.tick_count()))
      .member("tissue_cells", model.tissue_cells.size());
  json.key("ends_inside_out");
  if (model.tissue_cells.size() == 0)
    json.null();  // nobody looked
  else
    json.value(recordings::cells_inside_out(events, reader.tick_count()) > 0);
  json.member("late_ticks", s.late_ticks).key("late_because_of").begin_object();
  const LateTicks late = late_ticks_of(events, model.tick);
  for (const recordings::LateCause cause : recordings::kLateCauses)
    json.member(recordings::name_of(cause), late.of(cause));
  json.end_object().member("tick_time_p50_s", s.tick_time_p50).member("tick_time_p99_s", s.tick_time_p99);
  json.member("tick_time_p999_s", s.tick_time_p999).member("tick_time_max_s", s.tick_time_max);
  json.member("input_age_p50_s", s.input_age_p50)
      .member("input_age_p99_s", s.input_age_p99)
      .member("input_age_max_s", s.input_age_max);
  json.member("slip_s", s.slip).member("slip_max_s", s.slip_max);
  json.member("max_force_n", s.max_force).member("max_depth_m", s.max_depth);
  json.key("values").begin_object();
  for (const auto& [name, value] : s.values) json.member(name, value);
  json.end_object().key("remarks").begin_list();
  for (const std::string& remark : reader.remarks()) json.value(remark);
  json.end_list().key("metadata").begin_object();
  for (const auto& [key, value] : reader.start().metadata) json.member(key, value);
  json.end_object().key("events").begin_list();
  for (const recordings::Event& event : events) write_event(json, event, model);
  return json.end_list().end_object().text();
}

}  // namespace ctpm::session
