#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "core/model/model.h"
#include "recordings/tick_parts.h"

namespace ctpm::recordings {

/// Kind of an event. Session files store the numbers, so a number never gets another meaning.
enum class EventKind : std::int32_t {
  contact_begins = 1,
  contact_ends = 2,
  cut = 3,
  damage = 4,
  late_tick = 5,
  device_lost = 6,
  device_back = 7,
  note = 8,
  piece_came_loose = 9,
  press_reached_force = 10,
  press_gave_up = 11,
  step_refused = 12,
  turned_inside_out = 13,
  came_back = 14,
};

/// One event of a session. Only the fields of its kind are set and stored; for_each_value() lists them.
struct Event {
  std::int64_t tick = 0;
  EventKind kind = EventKind::note;
  std::int32_t hand = 0;     ///< whose device, or whose press: 0 the first, 1 the second
  std::int32_t tool = -1;    ///< tool that touches or cuts: index into Model::tools
  std::int32_t severed = 0;  ///< elements severed in the tick in which the cut begins
  std::int32_t organ = -1;   ///< organ whose damage depth was exceeded: index into Model::organs
  double depth = 0;          ///< largest displacement of a touched sphere [m]; 0: the depth is not the reason
  double depth_limit = 0;    ///< damage depth of the organ [m]
  double force = 0;          ///< on the tool [N]; 0: the force is not the reason
  double force_limit = 0;    ///< damage force of the scene [N]
  double late = 0;           ///< time from the tick's deadline to its end [s]
  TickParts parts = {};      ///< what the time of a late tick went to; all 0 in sessions that did not measure it
  std::string reason = {};   ///< why the device counts as lost
  double held = 0;           ///< how long the last valid pose was held [s]
  std::int64_t refused_samples = 0;  ///< device samples refused while the pose was held
  std::int32_t pieces = 0;           ///< increase in the number of loose pieces over the tick
  std::int32_t status = 0;           ///< StepStatus of a step that was refused
  std::int32_t sphere = -1;          ///< StepReport::worst_sphere of that step
  std::int32_t cells = 0;            ///< tissue cells inside out: in the first tick, or the most in one tick
  std::string text = {};             ///< text of a note; for an old event without fields, its sentence
  std::vector<double> values = {};   ///< numbers of an old event without fields; `text` explains them

  friend bool operator==(const Event&, const Event&) = default;
};

/// The only table of the fields of each event kind. Calls `visit(name, member)` for each field of the event's kind;
/// names contain the unit. Visits all fields if this program does not know the kind.
template <class Event_, class Visit>
requires std::is_same_v<std::remove_const_t<Event_>, Event>
void for_each_value(Event_& e, Visit&& visit) {
  const EventKind kind = e.kind;
  const bool is_unknown = kind < EventKind::contact_begins || kind > EventKind::came_back;
  const auto give = [&](auto... kinds) { return is_unknown || ((kind == kinds) || ...); };
  if (give(EventKind::contact_begins, EventKind::contact_ends, EventKind::cut)) visit("tool", e.tool);
  if (give(EventKind::cut)) visit("severed", e.severed);
  if (give(EventKind::damage)) {
    visit("organ", e.organ);
    visit("depth_m", e.depth);
    visit("depth_limit_m", e.depth_limit);
  }
  if (give(EventKind::damage, EventKind::press_reached_force, EventKind::press_gave_up)) visit("force_n", e.force);
  if (give(EventKind::damage)) visit("force_limit_n", e.force_limit);
  if (give(EventKind::late_tick)) {
    visit("late_s", e.late);
    visit("solver_s", e.parts.solver);
    visit("cut_s", e.parts.cut);
    visit("input_s", e.parts.input);
    visit("recorder_s", e.parts.recorder);
    visit("machine_s", e.parts.machine);
  }
  if (give(EventKind::device_lost)) visit("reason", e.reason);
  if (give(EventKind::device_back)) {
    visit("held_s", e.held);
    visit("refused_samples", e.refused_samples);
  }
  if (give(EventKind::piece_came_loose)) visit("pieces", e.pieces);
  if (give(EventKind::step_refused)) {
    visit("status", e.status);
    visit("sphere", e.sphere);
  }
  if (give(EventKind::turned_inside_out, EventKind::came_back)) visit("cells", e.cells);
  // Written only of the second hand, and read from every file.
  if (give(EventKind::device_lost, EventKind::device_back, EventKind::press_reached_force, EventKind::press_gave_up) &&
      (!std::is_const_v<Event_> || e.hand != 0))
    visit("hand", e.hand);
}

/// Name of a kind in tables and JSON.
const char* name_of(EventKind kind);

/// One readable sentence, made from the event's fields. A note or an old event without fields returns its stored text.
std::string describe(const Event& event, const Model& model);

/// Number of tissue cells inside out when tissue turned inside out for the last time before `end`; 0 if it has come
/// back since then, or never turned.
std::int32_t cells_inside_out(const std::vector<Event>& events, std::int64_t end);

/// Number of tissue pieces that came loose in ticks before `end`.
std::int64_t pieces_came_loose(const std::vector<Event>& events, std::int64_t end);

}  // namespace ctpm::recordings
