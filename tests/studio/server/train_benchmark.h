#pragma once

#include <string>

namespace ctpm {

/// Presses the organ of a scene by a hand that moves every 8 ms, in `rounds` of runs of so many seconds: without a
/// studio, with the page that leads, and with three further pages that ask it 60 times a second, all of which read, or
/// one of which does not for the first 10 s. Each round runs all of them, in changing order, so that what else the
/// machine does meets each of them alike. Prints the share of late ticks, how long their thread waited for a processor
/// that others had, the ticks' own times and how long poses waited for their tick, and for each the difference to the
/// page that leads alone, its mean and its median, with 95 % intervals; then how many times as many late ticks there
/// are as without a studio. Returns the exit code.
int benchmark_training(const std::string& folder, const std::string& scene, int rounds, double seconds);

}  // namespace ctpm
