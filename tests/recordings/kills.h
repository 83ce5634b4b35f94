#pragma once

namespace ctpm::testing {

/// Repeats `count` times: starts a process that records at 1 kHz, kills it at a random moment (also during creation and
/// end of the file), and checks the file. It must open, verify, and miss nothing older than 200 ms.
void kill_recorders(int count);

}  // namespace ctpm::testing
