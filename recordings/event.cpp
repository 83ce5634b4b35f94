#include "recordings/event.h"

#include <cstdio>
#include <utility>

namespace ctpm::recordings {
namespace {

constexpr double kLeastTold = 1e-6;  ///< of the parts of a tick [s]

/// Formats `number`; the format takes one double.
std::string with_number(const char* format, double number) {
  char text[160];
  std::snprintf(text, sizeof text, format, number);
  return text;
}

/// Name of a tool or an organ; `what` and the index if the Model has none at the index.
template <class Named>
std::string name_in(const std::vector<Named>& all, std::int32_t index, const char* what) {
  if (index >= 0 && index < static_cast<std::int32_t>(all.size())) return all[static_cast<std::size_t>(index)].name;
  return std::string(what) + " " + std::to_string(index);
}

std::string describe_damage(const Event& event, const Model& model) {
  if (event.force > 0)
    return with_number("force of %.3g N", event.force) +
           with_number(" passes the damage limit of %.3g N", event.force_limit);
  return with_number("depth of %.3g mm", 1e3 * event.depth) +
         with_number(" passes the damage limit of %.3g mm", 1e3 * event.depth_limit) + " of " +
         name_in(model.organs, event.organ, "organ");
}

std::string describe_late(const Event& event, const Model& model) {
  const std::string late = with_number("tick ended %.3g ms late", 1e3 * event.late);
  const LateCause cause = late_cause(event.parts, model.tick);
  if (cause == LateCause::unknown) return late;
  std::string parts;
  for (const auto& [part, seconds] : {std::pair{LateCause::solver, event.parts.solver},
                                      {LateCause::cut, event.parts.cut},
                                      {LateCause::input, event.parts.input},
                                      {LateCause::recorder, event.parts.recorder},
                                      {LateCause::machine, event.parts.machine}})
    if (seconds >= kLeastTold)
      parts += (parts.empty() ? ": " : ", ") + std::string(name_of(part)) + with_number(" %.3g ms", 1e3 * seconds);
  return late + ", because of the " + name_of(cause) + parts;
}

std::string of_second_hand(const Event& event) { return event.hand == 0 ? "" : "second hand: "; }

}  // namespace

const char* name_of(EventKind kind) {
  switch (kind) {
    case EventKind::contact_begins:
      return "contact begins";
    case EventKind::contact_ends:
      return "contact ends";
    case EventKind::cut:
      return "cut";
    case EventKind::damage:
      return "damage";
    case EventKind::late_tick:
      return "late tick";
    case EventKind::device_lost:
      return "device lost";
    case EventKind::device_back:
      return "device back";
    case EventKind::note:
      return "note";
    case EventKind::piece_came_loose:
      return "piece came loose";
    case EventKind::press_reached_force:
      return "press reached its force";
    case EventKind::press_gave_up:
      return "press gave up";
    case EventKind::step_refused:
      return "step refused";
    case EventKind::turned_inside_out:
      return "turned inside out";
    case EventKind::came_back:
      return "came back";
  }
  return "unknown";
}

std::string describe(const Event& event, const Model& model) {
  if (!event.text.empty()) return event.text;
  switch (event.kind) {
    case EventKind::contact_begins:
      return name_in(model.tools, event.tool, "tool") + " touches the tissue";
    case EventKind::contact_ends:
      return name_in(model.tools, event.tool, "tool") + " leaves the tissue";
    case EventKind::cut:
      return name_in(model.tools, event.tool, "tool") +
             " begins to sever; elements in the first tick: " + std::to_string(event.severed);
    case EventKind::damage:
      return describe_damage(event, model);
    case EventKind::late_tick:
      return describe_late(event, model);
    case EventKind::device_lost:
      return of_second_hand(event) + event.reason + "; the pose is held";
    case EventKind::device_back:
      return of_second_hand(event) +
             with_number("good poses come again; the pose was held for %.3g s in all", event.held) +
             ", samples refused: " + std::to_string(event.refused_samples);
    case EventKind::note:
      break;
    case EventKind::piece_came_loose:
      return "pieces that came loose: " + std::to_string(event.pieces);
    case EventKind::press_reached_force:
      return of_second_hand(event) + with_number("press reached its force at %.3g N", event.force);
    case EventKind::press_gave_up:
      return of_second_hand(event) +
             with_number("press gave up at its depth with %.3g N, short of its force", event.force);
    case EventKind::step_refused:
      return "the step was refused, status " + std::to_string(event.status) + ", worst sphere " +
             std::to_string(event.sphere);
    case EventKind::turned_inside_out:
      return "tissue turned inside out; cells in the first tick: " + std::to_string(event.cells);
    case EventKind::came_back:
      return "no tissue is inside out any more; cells at most: " + std::to_string(event.cells);
  }
  return "";
}

std::int32_t cells_inside_out(const std::vector<Event>& events, std::int64_t end) {
  std::int32_t cells = 0;
  for (const Event& event : events) {
    if (event.tick >= end) continue;
    if (event.kind == EventKind::turned_inside_out) cells = event.cells;
    if (event.kind == EventKind::came_back) cells = 0;
  }
  return cells;
}

std::int64_t pieces_came_loose(const std::vector<Event>& events, std::int64_t end) {
  std::int64_t pieces = 0;
  for (const Event& event : events)
    if (event.tick < end && event.kind == EventKind::piece_came_loose) pieces += event.pieces;
  return pieces;
}

}  // namespace ctpm::recordings
