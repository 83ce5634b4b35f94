#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "core/model/model.h"

namespace ctpm::recordings {

/// What happened. Session files store the numbers: one is never given another meaning.
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
};

/// Something worth finding again. Only the fields of its kind are set and stored: for_each_value().
struct Event {
  std::int64_t tick = 0;
  EventKind kind = EventKind::note;
  std::int32_t tool = -1;            ///< that touches or cuts: index into Model::tools
  std::int32_t severed = 0;          ///< elements severed in the tick in which the cut begins
  std::int32_t organ = -1;           ///< whose damage depth was passed: index into Model::organs
  double depth = 0;                  ///< largest displacement of a touched sphere [m]; 0: the depth is not the reason
  double depth_limit = 0;            ///< damage depth of the organ [m]
  double force = 0;                  ///< on the tool [N]; 0: the force is not the reason
  double force_limit = 0;            ///< damage force of the scene [N]
  double late = 0;                   ///< by which the tick passed its deadline [s]
  std::string reason = {};           ///< why the device was not believed
  double held = 0;                   ///< for which the last good pose was held [s]
  std::int64_t refused_samples = 0;  ///< of the device while the pose was held
  std::int32_t pieces = 0;           ///< more than before the tick
  std::int32_t status = 0;           ///< StepStatus of a step that was refused
  std::int32_t sphere = -1;          ///< StepReport::worst_sphere of that step
  std::string text = {};             ///< of a note; of an event from before events had fields, its sentence
  std::vector<double> values = {};   ///< of an event from before events had fields: its numbers, which `text` explains

  friend bool operator==(const Event&, const Event&) = default;
};

/// The one table of what each kind of event holds: `visit(name, member)` is called for each field of the event's kind,
/// with the unit in the name. All fields are visited if this program does not know the kind.
template <class Event_, class Visit>
requires std::is_same_v<std::remove_const_t<Event_>, Event>
void for_each_value(Event_& e, Visit&& visit) {
  const EventKind kind = e.kind;
  const bool is_unknown = kind < EventKind::contact_begins || kind > EventKind::step_refused;
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
  if (give(EventKind::late_tick)) visit("late_s", e.late);
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
}

/// Name of a kind in tables and JSON.
const char* name_of(EventKind kind);

/// One sentence for people, made from the event's fields; the stored sentence of a note or of an event without fields.
std::string describe(const Event& event, const Model& model);

/// Pieces of tissue that came loose in the ticks before `end`.
std::int64_t pieces_came_loose(const std::vector<Event>& events, std::int64_t end);

}  // namespace ctpm::recordings
