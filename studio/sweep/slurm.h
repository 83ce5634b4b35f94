#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/result.h"

namespace ctpm::sweep {

/// What Slurm is asked for; empty: its own defaults hold. Its words are its own (man sbatch).
struct SlurmRequest {
  std::string folder;                   ///< of the sweep; all nodes must see it under its path
  std::string partition, time, memory;  ///< passed through
  std::vector<std::string> options;     ///< further options of sbatch, passed through
  int tasks_per_element = 0;  ///< sessions of one array element; 0: as few as let the array be as Slurm allows
};

/// What was submitted.
struct Submission {
  std::string job;  ///< Slurm's number; empty: nothing waited
  std::size_t elements = 0, tasks_per_element = 0;
  std::size_t waiting = 0;  ///< sessions without a result
};

/// Submits what waits as one job array: each element records a slice of the plan. Slurm places, queues and accounts; an
/// element whose node dies is put into the queue again. Errors: there is no plan; Slurm is not there or refuses;
/// more elements than its MaxArraySize.
Result<Submission> submit_to_slurm(const SlurmRequest& request);

/// Indices as sbatch takes them: {0, 1, 2, 7} as "0-2,7".
std::string array_text(const std::vector<std::size_t>& indices);

}  // namespace ctpm::sweep
