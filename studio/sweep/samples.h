#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/sweep.h"

namespace ctpm::sweep {

/// The values of one session.
struct Sample {
  std::vector<scenes::SweepValue> values;  ///< (axis_count)
  std::vector<int> index;                  ///< in SweepAxis::values; -1: from a range (axis_count)
  std::string seed;                        ///< of its Latin hypercube; empty for other methods
};

/// All samples of a sweep that read_sweep() accepted; in a grid the last axis varies fastest. The same on every
/// machine.
std::vector<Sample> samples_of(const scenes::SweepSpec& sweep);

}  // namespace ctpm::sweep
