#pragma once

#include "scenes/key_types.h"
#include "scenes/sweep.h"

// Every key of a sweep with its type, range and sentence, as scene_keys.h for scenes. Internal to scenes.
namespace ctpm::scenes {

inline constexpr const char* sweep_format_name = "ctpm-sweep";
inline constexpr int sweep_format_version = 1;
inline constexpr double kMostTasks = 1e6;

template <>
inline std::span<const Choice<SweepMethod>> choices_of<SweepMethod>() {
  static constexpr Choice<SweepMethod> choices[] = {
      {"grid", SweepMethod::grid}, {"list", SweepMethod::list}, {"latin-hypercube", SweepMethod::latin_hypercube}};
  return choices;
}
template <>
inline std::span<const Choice<SweepTarget>> choices_of<SweepTarget>() {
  static constexpr Choice<SweepTarget> choices[] = {{"scene", SweepTarget::scene}, {"script", SweepTarget::script}};
  return choices;
}
template <>
inline std::span<const Choice<SweepScale>> choices_of<SweepScale>() {
  static constexpr Choice<SweepScale> choices[] = {{"linear", SweepScale::linear},
                                                   {"logarithmic", SweepScale::logarithmic}};
  return choices;
}

inline RecordInfo info_of(const SweepAxis&) {
  return {"axis", "One thing that varies. It has `values`, or a range between `from` and `to`."};
}
template <class V>
void describe_fields(V& v, SweepAxis& axis) {
  v.text(Key{"name", "Name of its column in tables, unique in the sweep.", false, "the last part of the key, or `of`"},
         axis.name);
  v.choice(Key{"of", "Whether the scene varies or the script."}, axis.of);
  v.text(Key{"key", "JSON pointer of a key in that file, as `/organs/0/material/stiffness_scale`.", false,
             "the whole file: its paths are the values"},
         axis.key);
  v.values(Key{"values", "The values: numbers, texts, flags or points, as the key takes them."}, axis.values, 1);
  v.number(Key{"from", "Where the range begins."}, axis.from, units::none, within(-1e15, 1e15));
  v.number(Key{"to", "Where it ends."}, axis.to, units::none, within(-1e15, 1e15));
  v.integer(Key{"steps", "Values of a range in a grid, both ends included."}, axis.steps, within(2, kMostTasks));
  v.choice(Key{"scale", "How values lie in the range."}, axis.scale);
}

inline RecordInfo info_of(const SweepSpec&) { return {"sweep", "The whole file."}; }
template <class V>
void describe_fields(V& v, SweepSpec& sweep) {
  v.constant(required("format", "Says that this is a sweep."), sweep_format_name);
  v.constant(required("version", "Version of the format."), sweep_format_version);
  v.text(required("name", "Name of the sweep."), sweep.name);
  v.text(required("scene", "Path of the scene, from this file's folder."), sweep.scene);
  v.text(Key{"script", "Path of a script (.json) or a motion (.csv), from this file's folder.", false,
             "a press and a cut at the organs' tops"},
         sweep.script);
  v.number(Key{"duration_s", "Ends each session after so many seconds.", false, "the script's end"}, sweep.duration,
           units::second, above(0, 1e6));
  v.choice(Key{"method",
               "`grid`: every value with every other; `list`: the first values together, then the second ones, and so "
               "on; `latin-hypercube`: each range is divided into as many parts as there are samples, and each part "
               "is taken once."},
           sweep.method);
  v.integer(Key{"samples", "Of a Latin hypercube."}, sweep.samples, within(1, kMostTasks));
  v.values(Key{"seeds", "Whole numbers; each gives a Latin hypercube of its own.", false, "`[1]`"}, sweep.seeds, 1);
  v.list(required("vary", "What varies."), sweep.vary, 1);
}

}  // namespace ctpm::scenes
