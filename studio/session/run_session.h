#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/state.h"
#include "recordings/session_writer.h"
#include "studio/sources/input_source.h"

namespace ctpm::session {

struct RunOptions {
  bool in_real_time = true;     ///< ticks start on absolute deadlines of the wall clock; else one after the other
  double damage_force = 0;      ///< force on the tool beyond which a damage event is noted [N]; 0: no limit
  std::int64_t most_ticks = 0;  ///< the session ends after so many; 0: when the source ends
  int threads = 1;              ///< that share a tick, >= 1; they change no bit of it
  std::function<void(std::int64_t done, std::int64_t total)> progress;
  std::function<bool()> should_stop;  ///< asked every tick: Ctrl-C
};

/// Threads that pay for a scene on this machine: two where there are so many cores and a tick has enough to share.
int threads_for(const Model& model);

/// What a run came to.
struct RunOutcome {
  std::int64_t ticks = 0;
  std::int64_t late_ticks = 0;                             ///< ticks that ended after their deadline, in real time only
  stepping::StepStatus status = stepping::StepStatus::ok;  ///< of the last tick; a diverged tick ends the run
  std::int32_t worst_sphere = -1;
  std::string fault;  ///< why the source ended the session before its time; empty if it did not
};

/// Runs one session: source -> step -> writer, tick by tick. `state` goes on from where it is.
RunOutcome run_session(const Model& model, State& state, sources::InputSource& source,
                       recordings::SessionWriter& writer, const RunOptions& options);

}  // namespace ctpm::session
