#include "recordings/internal/session_check.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/model/errors.h"
#include "recordings/internal/event_check.h"
#include "recordings/internal/statistics.h"
#include "recordings/state_hash.h"

namespace ctpm::recordings::session_file {
namespace {

/// A writer counts times before they are rounded to 1 ns, and percentiles are single precision.
constexpr double time_error = 1e-9, relative_time_error = 1e-6;  // [s], [1]

bool is_same(std::string_view name, double stored, double counted) {
  const bool is_time = name.starts_with("tick_time") || name.starts_with("input_age") || name.starts_with("slip");
  return stored == counted ||
         (is_time && std::abs(stored - counted) <= time_error + relative_time_error * std::abs(counted));
}

class SessionCheck {
 public:
  SessionCheck(SessionStore& store, const OpenedSession& session) : store_(store), session_(session) {}

  Result<Done> run() {
    take(store_.check_container());
    parts();
    chunks();
    keyframes();
    events();
    // Statistics of what is missing would differ for that reason alone.
    if (errors_.empty()) statistics();
    if (!errors_.empty()) return errors_;
    return Done{};
  }

 private:
  void complain(const std::string& message) { errors_.push_back({session_.path, message, ""}); }

  /// True if good.
  template <class T>
  bool take(const Result<T>& result) {
    append(errors_, result);
    return bool(result);
  }

  /// The known parts are read by open(). Others belong to newer programs, but have a checksum as well.
  void parts() {
    const auto names = store_.part_names();
    if (!take(names)) return;
    for (const std::string& name : *names) take(store_.part(name));
    const auto initial = store_.initial_state(session_.model);
    if (take(initial) && *initial) initial_hash_ = state_hash(**initial);
  }

  /// A damaged chunk is skipped by its key.
  void chunks() {
    const auto keys = store_.keys("chunk");
    if (!take(keys)) return;
    std::int64_t next = 0;
    for (const std::int64_t key : *keys) {
      if (key > next) complain("ticks " + std::to_string(next) + " to " + std::to_string(key - 1) + " are missing");
      const auto chunk = store_.chunk_at(key);
      if (!take(chunk)) continue;
      if (!*chunk || (*chunk)->first != key || key < next) {
        complain("the chunk of tick " + std::to_string(key) + " is out of place");
        continue;
      }
      next = (*chunk)->end();
      for (const TickRecord& record : (*chunk)->items) counter_.add(record);
    }
    if (next != session_.tick_count) complain("its chunks end at tick " + std::to_string(next));
  }

  void keyframes() {
    const auto keys = store_.keys("keyframe");
    if (!take(keys)) return;
    for (const std::int64_t key : *keys) {
      const auto keyframe = store_.keyframe_at(key, session_.model);
      if (!take(keyframe)) continue;
      if (!*keyframe || (*keyframe)->tick != key || key > session_.tick_count)
        complain("the keyframe of tick " + std::to_string(key) + " is out of place");
      else if (key > 0)
        counter_.add_keyframe();
      else if (initial_hash_ && *initial_hash_ != state_hash((*keyframe)->state))
        complain("part initial: is another state than keyframe 0");
    }
    const auto left = static_cast<std::int64_t>(keys->size()) - 1;
    if (session_.finish && session_.finish->keyframes != left)
      complain(std::to_string(left) + " of " + std::to_string(session_.finish->keyframes) + " keyframes are left");
  }

  void events() {
    const auto keys = store_.keys("event");
    if (!take(keys)) return;
    // Events are written without waiting for the chunk of their tick, so a session that was cut off may lack it.
    const std::int64_t last = session_.finish ? session_.tick_count : std::numeric_limits<std::int64_t>::max();
    std::int64_t next = 0;
    for (const std::int64_t key : *keys) {
      if (key > next) complain("events " + std::to_string(next) + " to " + std::to_string(key - 1) + " are missing");
      const auto run = store_.events_at(key);
      if (!take(run)) continue;
      if (!*run || (*run)->first != key || key < next) {
        complain("the run of event " + std::to_string(key) + " is out of place");
        continue;
      }
      next = key;
      for (const Event& event : (*run)->items) {
        const std::string problem = problem_of(event, session_.model, last);
        if (!problem.empty()) complain("event " + std::to_string(next) + ": " + problem);
        counter_.add(event);
        ++next;
      }
    }
  }

  void statistics() {
    if (!session_.finish) return;
    const SessionStatistics anew = counter_.result();
    std::vector<std::pair<std::string, double>> counted;
    for_each_field(anew, [&](std::string_view name, const auto& value) { counted.emplace_back(name, double(value)); });
    std::size_t i = 0;
    for_each_field(*session_.finish, [&](std::string_view name, const auto& value) {
      const double stored = double(value), now = counted[i++].second;
      if (is_same(name, stored, now)) return;
      complain("part finish: " + std::string(name) + " is " + shown(stored) + ", counted anew it is " + shown(now));
    });
  }

  static std::string shown(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", number);
    return text;
  }

  SessionStore& store_;
  const OpenedSession& session_;
  std::optional<std::uint64_t> initial_hash_;  ///< of the part `initial`
  StatisticsCounter counter_;
  Errors errors_;
};

}  // namespace

Result<Done> check_session(SessionStore& store, const OpenedSession& session) {
  return SessionCheck(store, session).run();
}

}  // namespace ctpm::recordings::session_file
