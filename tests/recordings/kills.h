#pragma once

namespace ctpm::testing {

/// Starts a process that records at 1 kHz, kills it at a random moment (also while it creates the file and
/// while it ends the session), and checks what is left: it opens, it verifies, and nothing older than 200 ms
/// is missing. `count` times.
void kill_recorders(int count);

}  // namespace ctpm::testing
