#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace ctpm::server {

/// Whom a thread goes before, as the kernel's nice values have it. The browser draws on the same processors.
enum class Urgency {
  tick = -15,     ///< a tick, and the input that it takes: the network never computes
  picture = -10,  ///< what somebody waits for
  idle = 15,      ///< what may be of use later
};

/// Gives the calling thread that urgency, and those that it makes. Only a privileged user may go before others; without
/// that a thread stays as it was.
inline void become(Urgency urgency) { setpriority(PRIO_PROCESS, id_t(gettid()), int(urgency)); }

}  // namespace ctpm::server
