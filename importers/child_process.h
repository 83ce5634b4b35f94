#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace ctpm::importers {

struct ChildLimits {
  double time_s = 120;             ///< wall and processor time [s]
  std::int64_t memory_mib = 4096;  ///< in addition to the program's memory when the child starts [MiB]
  std::int64_t output_mib = 4096;  ///< most that the child may send [MiB]
};

struct ChildResult {
  bool is_whole = false;  ///< the child sent everything and exited normally
  std::string trouble;    ///< otherwise: what happened, as the end of a sentence ("took longer than 5 s")
  std::string output;     ///< bytes received from the child
};

/// Sends bytes to the parent. Returns false if the parent is gone.
using Send = std::function<bool(const void* bytes, std::size_t count)>;

/// Runs `work` in a forked child with limits and collects its output. The child has no terminal, no open files of the
/// parent, default signals and no core dump; it can only compute, read files and send. A child that hangs (even on a
/// lock that a thread of the parent held at the fork) is killed at the time limit.
ChildResult run_in_child(const ChildLimits& limits, const std::function<void(const Send&)>& work);

}  // namespace ctpm::importers
