#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/state.h"
#include "recordings/session_writer.h"
#include "recordings/tick_parts.h"
#include "studio/session/late_ticks.h"
#include "studio/sources/input_source.h"

namespace ctpm::session {

/// The result of a run.
struct RunOutcome {
  std::int64_t ticks = 0;
  std::int64_t late_ticks = 0;                             ///< ticks that ended after their deadline, in real time only
  LateTicks late_by;                                       ///< the same by what made them late
  std::int64_t fallbacks = 0;                              ///< ticks in which backward Euler took a step for sdirk2
  stepping::StepStatus status = stepping::StepStatus::ok;  ///< of the last tick; a diverged tick ends the run
  std::int32_t worst_sphere = -1;
  double lost = 0;    ///< time that the machine took of the last step [s]; see PartClock
  double slip = 0;    ///< real time less session time at the start of the last tick [s]; 0 if not in real time
  double waited = 0;  ///< how long the thread waited for a processor between the first tick and the last [s]
  std::string fault;  ///< why the source ended the session early; empty if it did not
};

struct RunOptions {
  bool in_real_time = true;     ///< true: ticks start at absolute wall-clock deadlines; false: without pauses
  double damage_force = 0;      ///< force on the tool above which a damage event is recorded [N]; 0: no limit
  std::int64_t most_ticks = 0;  ///< the session ends after this many ticks; 0: when the source ends
  int threads = 1;              ///< threads of a tick, >= 1; the result does not depend on it
  std::function<void(std::int64_t done, std::int64_t total)> progress;
  /// Called in the tick in which recording begins to fail, with the reason; must not wait.
  std::function<void(const std::string& problem)> tell;
  /// Called in the tick of a note of the source, with its text; must not wait.
  std::function<void(const std::string& text)> note;
  std::function<bool()> should_stop;  ///< called every tick, for Ctrl-C
  /// Called after each tick, with its State; must not wait.
  std::function<void(const State& state, const recordings::TickRecord& record, const RunOutcome& so_far)> watch;
};

/// Number of threads that pays off for a model on this machine: 2 with several cores and at least 3000 spheres, else 1.
int threads_for(const Model& model);

/// Runs one session from `state`: source -> step -> writer, tick by tick. Ticks after a late one follow without pause
/// until they have caught up; of a delay beyond 0.1 s the rest is lost to the session and stays in TickRecord::slip.
RunOutcome run_session(const Model& model, State& state, sources::InputSource& source,
                       recordings::SessionWriter& writer, const RunOptions& options);

}  // namespace ctpm::session
