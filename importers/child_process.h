#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace ctpm::importers {

struct ChildLimits {
  double time_s = 120;             ///< wall and processor time [s]
  std::int64_t memory_mib = 4096;  ///< beside what the program holds when the child starts [MiB]
  std::int64_t output_mib = 4096;  ///< bytes that the child may send [MiB]
};

struct ChildResult {
  bool is_whole = false;  ///< the child ended by itself after sending everything
  std::string trouble;    ///< otherwise: what happened to it, as a sentence's end ("took longer than 5 s")
  std::string output;     ///< what it sent
};

/// Sends bytes to the parent; false when the parent is gone.
using Send = std::function<bool(const void* bytes, std::size_t count)>;

/// Runs `work` in a forked child with limits and collects what it sends. The child has no terminal, no open
/// files of the parent, default signals and no core dump; it can only compute, read files and send. A child
/// that hangs (even on a lock that some thread of the parent held at the fork) is killed when the time is
/// over.
ChildResult run_in_child(const ChildLimits& limits, const std::function<void(const Send&)>& work);

}  // namespace ctpm::importers
