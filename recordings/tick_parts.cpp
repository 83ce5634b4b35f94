#include "recordings/tick_parts.h"

#include <utility>

namespace ctpm::recordings {

const char* name_of(LateCause cause) {
  switch (cause) {
    case LateCause::unknown:
      return "unknown";
    case LateCause::solver:
      return "solver";
    case LateCause::cut:
      return "cut";
    case LateCause::input:
      return "input";
    case LateCause::recorder:
      return "recorder";
    case LateCause::machine:
      return "machine";
  }
  return "";
}

LateCause late_cause(const TickParts& parts, double tick) {
  double rest = parts.sum();
  if (!(rest > 0)) return LateCause::unknown;
  for (const auto& [cause, part] : {std::pair{LateCause::machine, parts.machine},
                                    {LateCause::recorder, parts.recorder},
                                    {LateCause::input, parts.input},
                                    {LateCause::cut, parts.cut}}) {
    rest -= part;
    if (rest <= tick) return cause;
  }
  return LateCause::solver;
}

}  // namespace ctpm::recordings
