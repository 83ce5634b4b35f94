#pragma once

#include "scenes/key_types.h"
#include "scenes/script.h"

// Every key of a script with its type, unit, range and sentence, as scene_keys.h for scenes. Internal to scenes.
namespace ctpm::scenes {

inline constexpr const char* script_format_name = "ctpm-script";
inline constexpr int script_format_version = 1;

namespace script_ranges {
inline constexpr Range coordinate_mm = within(-100000, 100000);
inline constexpr Range direction = within(-1e6, 1e6);
inline constexpr Range speed_mm_per_s = within(0.001, 10000);
}  // namespace script_ranges

inline RecordInfo info_of(const ScriptStep::Take&) { return {"take", "A tool appears in the hand."}; }
template <class V>
void describe_fields(V& v, ScriptStep::Take& take) {
  v.text(required("tool", "Name of a tool of the scene."), take.tool);
  v.point(required("at_mm", "Where its origin appears: a ball's centre, a blade's tip."), take.at, units::millimetre,
          script_ranges::coordinate_mm);
  v.point(Key{"pointing", "Direction from handle to tip; any length but zero."}, take.pointing, units::none,
          script_ranges::direction);
  v.point(Key{"facing", "Direction of a blade's cutting side; not along pointing.", false, "the shortest turn decides"},
          take.facing, units::none, script_ranges::direction);
}

inline RecordInfo info_of(const ScriptStep::Move&) { return {"move", "The tool moves along a straight line."}; }
template <class V>
void describe_fields(V& v, ScriptStep::Move& move) {
  v.point(required("to_mm", "End of the line."), move.to, units::millimetre, script_ranges::coordinate_mm);
  v.number(required("speed_mm_per_s", "Speed of each straight piece after its start and before its end."), move.speed,
           units::millimetre_per_second, script_ranges::speed_mm_per_s);
}

inline RecordInfo info_of(const ScriptStep::Press&) {
  return {"press", "The tool moves into the tissue, by a distance or up to a force."};
}
template <class V>
void describe_fields(V& v, ScriptStep::Press& press) {
  v.number(required("distance_mm", "Length of the stroke; with until_force_n, its largest length."), press.distance,
           units::millimetre, above(0, 1000));
  v.number(Key{"until_force_n", "Ends when the tissue's reaction against the direction reaches this force.", false,
               "the whole distance"},
           press.until_force, units::newton, above(0, 1000));
  v.point(Key{"direction", "Direction of the stroke; any length but zero."}, press.direction, units::none,
          script_ranges::direction);
  v.number(required("speed_mm_per_s", "Speed of each straight piece after its start and before its end."), press.speed,
           units::millimetre_per_second, script_ranges::speed_mm_per_s);
}

inline RecordInfo info_of(const ScriptStep::Release&) {
  return {"release", "The tool moves by a distance out of the tissue."};
}
template <class V>
void describe_fields(V& v, ScriptStep::Release& release) {
  v.number(required("distance_mm", "Length of the stroke."), release.distance, units::millimetre, above(0, 1000));
  v.point(Key{"direction", "Direction of the stroke; any length but zero."}, release.direction, units::none,
          script_ranges::direction);
  v.number(required("speed_mm_per_s", "Speed of each straight piece after its start and before its end."),
           release.speed, units::millimetre_per_second, script_ranges::speed_mm_per_s);
}

inline RecordInfo info_of(const ScriptStep::Cut&) { return {"cut", "The tip moves along a path of points."}; }
template <class V>
void describe_fields(V& v, ScriptStep::Cut& cut) {
  v.points(required("path_mm", "Points that the tip passes, from where it is."), cut.path, units::millimetre,
           script_ranges::coordinate_mm, 1);
  v.flag(Key{"smooth", "Moves along one smooth curve through the points without stopping.", false,
             "straight from point to point, with a stop at each"},
         cut.smooth);
  v.flag(Key{"turns",
             "With smooth: the tool turns about its own axis as much as the curve does, so that a blade goes on to "
             "look along it.",
             false, "the tool does not turn"},
         cut.turns);
  v.number(required("speed_mm_per_s", "Speed of each straight piece after its start and before its end."), cut.speed,
           units::millimetre_per_second, script_ranges::speed_mm_per_s);
}

inline RecordInfo info_of(const ScriptStep&) { return {"step", "One action of a hand."}; }
template <class V>
void describe_fields(V& v, ScriptStep& step) {
  v.record(Key{"take", "Take a tool."}, step.take);
  v.record(Key{"move", "Move it."}, step.move);
  v.record(Key{"press", "Press into the tissue."}, step.press);
  v.record(Key{"release", "Leave the tissue."}, step.release);
  v.record(Key{"cut", "Cut along a path."}, step.cut);
  v.number(Key{"wait_s", "Hold still."}, step.wait, units::second, within(0, 100000));
  v.flag(Key{"put_away", "Put the tool away; always true."}, step.put_away);
  v.integer(Key{"hand", "Which hand does it, in a scene with two; the other one holds still.", false, "1"}, step.hand,
            within(1, kMostHands));
  v.exactly_one("hand");
}

inline RecordInfo info_of(const Script&) { return {"script", "The whole file."}; }
template <class V>
void describe_fields(V& v, Script& script) {
  v.constant(required("format", "Says that this is a script."), script_format_name);
  v.constant(required("version", "Version of the format."), script_format_version);
  v.list(required("steps", "Steps in the order in which they run."), script.steps, 1);
}

}  // namespace ctpm::scenes
