#include "studio/session/urgency.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>
#include <ctime>
#include <fstream>
#include <utility>

namespace ctpm::session {
namespace {

/// struct sched_attr of the kernel, which not every C library declares.
struct SchedulingAttributes {
  std::uint32_t size, policy;
  std::uint64_t flags;
  std::int32_t nice;
  std::uint32_t priority;
  std::uint64_t runtime, deadline, period;
};

/// Asks for short slices, with which the kernel lets the thread interrupt others when it wakes. Without them a tick
/// waits for some milliseconds until the browser's slice ends. Linux 6.12 and later grant them to everybody.
void ask_for_short_slices() {
  constexpr std::uint64_t kShortest = 100'000;  // [ns]
  SchedulingAttributes attributes{};
  if (syscall(SYS_sched_getattr, 0, &attributes, sizeof attributes, 0) != 0) return;
  attributes.runtime = kShortest;
  syscall(SYS_sched_setattr, 0, &attributes, 0);
}

bool schedule(int policy) {
  sched_param parameters{};
  parameters.sched_priority = sched_get_priority_min(policy);
  return sched_setscheduler(0, policy, &parameters) == 0;
}

}  // namespace

double thread_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

double thread_wait() {
  std::ifstream file("/proc/thread-self/schedstat");  // nanoseconds on a processor, and waiting for one
  double ran = 0, waited = 0;
  return file >> ran >> waited ? 1e-9 * waited : 0.0;
}

void become(Urgency urgency) {
  setpriority(PRIO_PROCESS, id_t(gettid()), int(urgency));
  if (urgency != Urgency::tick) return;
  prctl(PR_SET_TIMERSLACK, 1UL);  // [ns]: a tick begins when it is due
  ask_for_short_slices();
}

void Precedence::go_on() {
  constexpr int kTimes = 100;                // that are judged together
  constexpr double kFew = 0.6, kMost = 0.8;  // of the processor's time
  if (count_ == 0) judged_at_ = thread_time();
  if (++count_ <= kTimes) return;
  // Not by the clock: whoever is interrupted needs precedence, and takes long because there is none.
  const double share = (thread_time() - judged_at_) / (kTimes * interval_);
  count_ = 0;
  if (!is_first_ && share < kFew)
    is_first_ = schedule(SCHED_FIFO);
  else if (share > kMost)
    give_up();
}

void Precedence::give_up() {
  count_ = 0;
  if (!is_first_ || !schedule(SCHED_OTHER)) return;
  is_first_ = false;
  become(Urgency::tick);
}

AwakeProcessors::AwakeProcessors() : file_(open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC)) {
  constexpr std::int32_t kNone = 0;  // longest latency of waking up [us], until the file is closed
  if (file_ >= 0 && write(file_, &kNone, sizeof kNone) != sizeof kNone) close(std::exchange(file_, -1));
}

AwakeProcessors::~AwakeProcessors() {
  if (file_ >= 0) close(file_);
}

TickUrgency::TickUrgency(double tick) : nice_before_(getpriority(PRIO_PROCESS, id_t(gettid()))), precedence_(tick) {
  become(Urgency::tick);
}

TickUrgency::~TickUrgency() {
  precedence_.give_up();
  prctl(PR_SET_TIMERSLACK, 0UL);  // as for other threads
  setpriority(PRIO_PROCESS, id_t(gettid()), nice_before_);
}

}  // namespace ctpm::session
