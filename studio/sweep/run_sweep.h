#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/model/result.h"
#include "studio/sweep/plan.h"

namespace ctpm::sweep {

struct RunRequest {
  std::string folder;
  int processes = 1;                ///< >= 1; each records one session at a time
  std::size_t from = 0, to = -1ul;  ///< tasks of the plan, [from, to)
  std::function<void(std::int64_t done, std::int64_t total)> progress;
  std::function<bool()> should_stop;
};

/// What a run did.
struct RunSummary {
  std::int64_t recorded = 0, failed = 0;  ///< by this run
  std::int64_t deaths = 0;                ///< processes that died; what they worked on was begun again
  bool was_stopped = false;
  double wall_s = 0;
  double task_processor_s = 0;  ///< processor time of the sessions themselves, from reading to the closed file [s]
  double processor_s = 0;       ///< of everything [s]
};

/// Records what waits, on several processes that live as long as the run: one that dies takes no other with it, and
/// its session is begun again, at most kMostDeaths times, after which it has failed. Sessions that another run works on
/// are left to it. Call it before the program starts threads. Errors: there is no plan; its files have changed; the
/// folder cannot be written.
Result<RunSummary> run_sweep(const RunRequest& request);

inline constexpr int kMostDeaths = 3;

}  // namespace ctpm::sweep
