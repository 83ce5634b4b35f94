#pragma once

#include <array>

namespace ctpm::recordings {

/// What the time of a tick in real time went to, from its due start, or the end of a tick before that was late, to its
/// end [s]. All 0: not measured.
struct TickParts {
  double solver = 0;    ///< forces, contacts and motion
  double cut = 0;       ///< a blade's sweep and what it severs; surfaces of cuts that are made or waited for
  double input = 0;     ///< the source of the inputs
  double recorder = 0;  ///< hash, session file, events, and those who watch the session
  double machine = 0;   ///< in which the tick had no processor: it was woken late, or other programs had it

  double sum() const { return solver + cut + input + recorder + machine; }
  friend bool operator==(const TickParts&, const TickParts&) = default;
};

/// What made a tick late.
enum class LateCause { unknown, solver, cut, input, recorder, machine };
inline constexpr std::array kLateCauses{LateCause::unknown, LateCause::solver,   LateCause::cut,
                                        LateCause::input,   LateCause::recorder, LateCause::machine};

/// `cut`: "cut", and so on.
const char* name_of(LateCause cause);

/// Takes the parts away one after another, what is not the simulation's first: machine, recorder, input, cut. The cause
/// is the one with which the rest fits into `tick` [s]; if none does, the solver. Unknown if nothing was measured.
LateCause late_cause(const TickParts& parts, double tick);

}  // namespace ctpm::recordings
