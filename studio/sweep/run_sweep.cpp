#include "studio/sweep/run_sweep.h"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <map>
#include <new>
#include <optional>
#include <vector>

#include "studio/sweep/each.h"
#include "studio/sweep/run_task.h"
#include "studio/sweep/task_folder.h"

namespace ctpm::sweep {
namespace {

constexpr int kMostProcesses = 256;

/// What the processes share.
struct Shared {
  std::atomic<std::int64_t> next{0};  ///< of the waiting tasks
  std::atomic<std::int64_t> recorded{0}, failed{0}, passed{0};
  std::atomic<std::int64_t> task_ns{0};               ///< processor time
  std::atomic<std::int64_t> working[kMostProcesses];  ///< on which of the waiting tasks; -1: none
  std::atomic<bool> stop{false};
  char problem[2000] = "";  ///< of the first process that could not go on
  std::atomic<bool> has_problem{false};
};

double seconds(const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); }

/// Processor time of this process and of all that ended below it [s].
double processor_time() {
  double sum = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    struct rusage used {};
    getrusage(who, &used);
    sum += seconds(used.ru_utime) + seconds(used.ru_stime);
  }
  return sum;
}

/// Wakes when a process ends, or after a while. Until it is destroyed, the signal of ended processes waits for it.
class ChildWatch {
 public:
  ChildWatch() {
    sigemptyset(&ended_), sigaddset(&ended_, SIGCHLD);
    sigprocmask(SIG_BLOCK, &ended_, &before_);
  }
  ~ChildWatch() { restore(); }
  ChildWatch(const ChildWatch&) = delete;
  ChildWatch& operator=(const ChildWatch&) = delete;

  void wait() const {
    constexpr timespec kLongest{0, 100'000'000};
    sigtimedwait(&ended_, nullptr, &kLongest);
  }
  /// In a process that does not watch.
  void restore() const { sigprocmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t ended_, before_;
};

/// Records one run's tasks with processes of its own.
class Workers {
 public:
  Workers(const RunRequest& request, Sweep* sweep, const Plan& plan, std::vector<std::size_t> waiting, Shared& shared)
      : request_(request), sweep_(sweep), plan_(plan), waiting_(std::move(waiting)), shared_(shared) {}

  /// Starts the processes, and again where they die, until all has ended.
  Result<Done> run();
  std::int64_t deaths() const { return deaths_; }

 private:
  Result<Done> start(int slot, std::optional<std::int64_t> first);
  void work(int slot, std::optional<std::int64_t> first);
  bool work_on(std::int64_t index);
  Result<Done> bury(int slot, int status);
  void give_up(const Error& error);

  const RunRequest& request_;
  Sweep* sweep_;  ///< null: the plan has a command
  const Plan& plan_;
  const std::vector<std::size_t> waiting_;  ///< tasks of the plan
  Shared& shared_;
  const ChildWatch watch_;
  std::optional<Recorder> recorder_;           ///< of this process
  std::map<pid_t, int> slot_of_;               ///< of each process
  std::map<std::int64_t, int> deaths_during_;  ///< by waiting task
  std::int64_t deaths_ = 0;
};

void Workers::give_up(const Error& error) {
  if (!shared_.has_problem.exchange(true)) {
    // Where, message and hint, each with its end.
    const std::string text = error.where + '\n' + error.message + '\n' + error.hint;
    std::snprintf(shared_.problem, sizeof shared_.problem, "%s", text.c_str());
  }
  shared_.stop = true;
}

/// False if the process cannot go on.
bool Workers::work_on(std::int64_t index) {
  const std::size_t task = waiting_[std::size_t(index)];
  const std::string& id = plan_.tasks[task].id;
  Result<std::optional<Claim>> claim = Claim::take(request_.folder, id);
  if (!claim) return give_up(claim.errors().front()), false;
  if (!*claim) return ++shared_.passed, true;
  Result<std::optional<TaskResult>> result =
      recorder_ ? recorder_->record(task, id, **claim, [&] { return shared_.stop.load(std::memory_order_relaxed); })
                : run_each(plan_, task, **claim);
  if (!result) return give_up(result.errors().front()), false;
  if (!*result) {
    // A command that a signal ended counts as this process would, had it been killed.
    claim->reset();
    if (!recorder_) _exit(1);
    return false;
  }
  if (const Result<Done> finished = (*claim)->finish(**result); !finished)
    return give_up(finished.errors().front()), false;
  shared_.task_ns += std::int64_t(1e9 * (*result)->processor_s);
  ++((*result)->is_good ? shared_.recorded : shared_.failed);
  return true;
}

void Workers::work(int slot, std::optional<std::int64_t> first) {
  if (sweep_ != nullptr) recorder_.emplace(*sweep_);
  while (!shared_.stop) {
    const std::int64_t index = first ? *std::exchange(first, std::nullopt) : shared_.next++;
    if (index >= std::int64_t(waiting_.size())) break;
    shared_.working[slot] = index;
    if (!work_on(index)) break;
    shared_.working[slot] = -1;
  }
}

Result<Done> Workers::start(int slot, std::optional<std::int64_t> first) {
  shared_.working[slot] = -1;
  std::fflush(nullptr);
  const pid_t parent = getpid(), child = fork();
  if (child < 0) return Error{"", std::string("no process can be started: ") + std::strerror(errno), ""};
  if (child > 0) return slot_of_[child] = slot, Done{};
  watch_.restore();
  // Ctrl-C reaches the whole group; the parent alone decides what it means.
  std::signal(SIGINT, SIG_IGN), std::signal(SIGTERM, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() == parent) work(slot, first);
  std::fflush(nullptr);
  _exit(0);
}

/// After a process has ended: nothing if it was done, else another one in its place.
Result<Done> Workers::bury(int slot, int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return Done{};
  ++deaths_;
  const std::int64_t index = shared_.working[slot];
  if (shared_.stop) return Done{};
  if (index < 0) return start(slot, std::nullopt);
  if (++deaths_during_[index] < kMostDeaths) return start(slot, index);
  Result<std::optional<Claim>> claim = Claim::take(request_.folder, plan_.tasks[waiting_[std::size_t(index)]].id);
  if (!claim) return claim.errors();
  if (*claim) {
    TaskResult result;
    result.error = "its process died " + std::to_string(kMostDeaths) + " times, the last time of " +
                   (WIFSIGNALED(status) ? std::string("signal ") + strsignal(WTERMSIG(status))
                                        : "exit code " + std::to_string(WEXITSTATUS(status)));
    if (Result<Done> finished = (*claim)->finish(result); !finished) return finished;
    ++shared_.failed;
  }
  return start(slot, std::nullopt);
}

Result<Done> Workers::run() {
  const int count = std::min<std::int64_t>({request_.processes, kMostProcesses, std::int64_t(waiting_.size())});
  Result<Done> outcome = Done{};
  for (int slot = 0; slot < count && outcome; ++slot) outcome = start(slot, std::nullopt);
  while (!slot_of_.empty()) {
    if (!outcome || (request_.should_stop && request_.should_stop())) shared_.stop = true;
    if (request_.progress)
      request_.progress(shared_.recorded + shared_.failed + shared_.passed, std::int64_t(waiting_.size()));
    int status = 0;
    const pid_t ended = waitpid(-1, &status, WNOHANG);
    if (ended == 0) {
      watch_.wait();
    } else if (ended < 0 && errno != EINTR) {
      break;
    } else if (const auto found = slot_of_.find(ended); found != slot_of_.end()) {
      const int slot = found->second;
      slot_of_.erase(found);
      if (const Result<Done> buried = bury(slot, status); !buried) outcome = buried;
    }
  }
  return outcome;
}

/// The tasks of a request that have no result.
std::vector<std::size_t> waiting_tasks(const RunRequest& request, const Plan& plan) {
  std::vector<std::size_t> waiting;
  for (std::size_t task = request.from; task < std::min(request.to, plan.tasks.size()); ++task)
    if (!is_finished(request.folder, plan.tasks[task].id)) waiting.push_back(task);
  return waiting;
}

Error problem_in(const std::string& text) {
  const std::size_t first = text.find('\n'), second = text.find('\n', first + 1);
  return {text.substr(0, first), text.substr(first + 1, second - first - 1), text.substr(second + 1)};
}

}  // namespace

Result<RunSummary> run_sweep(const RunRequest& request) {
  const double before = processor_time();
  const auto start = std::chrono::steady_clock::now();
  const Result<Plan> plan = read_plan(request.folder);
  if (!plan) return plan.errors();
  std::optional<Sweep> sweep;
  if (!plan->file.empty()) {
    Result<Sweep> loaded = Sweep::load(plan->file);
    if (!loaded) return loaded.errors();
    sweep.emplace(std::move(*loaded));
  }
  if (sweep && sweep->task_count() != plan->tasks.size())
    return Error{plan->file, "has changed since it was planned",
                 "plan it again: what is done and did not change stays"};
  void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return Error{"", std::string("no memory to share: ") + std::strerror(errno), ""};
  Shared* shared = new (memory) Shared;
  Workers workers(request, sweep ? &*sweep : nullptr, *plan, waiting_tasks(request, *plan), *shared);
  const Result<Done> done = workers.run();
  RunSummary summary;
  summary.recorded = shared->recorded, summary.failed = shared->failed, summary.deaths = workers.deaths();
  summary.was_stopped = shared->stop;
  summary.task_processor_s = 1e-9 * double(shared->task_ns.load());
  const Error problem = shared->has_problem ? problem_in(shared->problem) : Error{};
  munmap(memory, sizeof(Shared));
  if (!done) return done.errors();
  if (!problem.message.empty()) return problem;
  summary.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  summary.processor_s = processor_time() - before;
  return summary;
}

}  // namespace ctpm::sweep
