#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "core/model/result.h"
#include "scenes/script.h"
#include "studio/loading/loaded_scene.h"
#include "studio/session/record_session.h"
#include "studio/session/tick_times.h"

namespace ctpm::session {

/// What the ticks of a session cost on this machine, and what its script did.
struct SessionCost {
  RecordOutcome outcome;
  TimesOfDeeds times;
  int threads = 1;
  double processor_share = 1;  ///< processor time of all threads over time
  double lost_share = 0;       ///< of the ticks' time: in which their first thread had no processor

  DeedTimes of(Deed deed) const { return times[std::size_t(deed)]; }
  /// The greatest p99 of a tick in contact or in a cut, less what the machine took; without either, of all ticks [s].
  double dearest() const;
  /// Whether dearest() is the session's own time, whatever else ran. Where threads share a tick, the others must have
  /// had a processor, too; else it is too high.
  bool is_own() const;
};

/// The script of a scene, whose places may depend on its filling.
using ScriptOf = std::function<Result<scenes::Script>(const loading::LoadedScene& scene)>;

/// Records a session as `record --fast` does, into a file that goes, and measures its ticks. Errors: those of `script`;
/// no file can be written; `running.should_stop` ended it. `like`: another one of the same script; the session
/// ends once its ticks are sure to be too long, see TooLong.
Result<SessionCost> measure_session(const loading::LoadedScene& scene, const ScriptOf& script, RunOptions running,
                                    const SessionCost* like = nullptr);

/// A filling whose ticks hold the scene's rate.
struct FittingRadius {
  double factor = 1;  ///< of every sphere radius of a mesh
  std::size_t spheres = 0;
  SessionCost cost;
};

/// The smallest radii, from some that are measured, with which SessionCost::dearest() is at most a tick. `cost`: of
/// the scene as it is, too high. None if none of those that were measured holds it; if no organ has a mesh. Errors:
/// those of measure_session() but for what a filling refuses.
Result<std::optional<FittingRadius>> find_fitting_radius(const loading::LoadedScene& scene,
                                                         const scenes::LoadOptions& load, const ScriptOf& script,
                                                         const SessionCost& cost, const RunOptions& running);

}  // namespace ctpm::session
