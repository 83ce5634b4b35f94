#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <sstream>
#include <thread>

#include "core/model/fields.h"
#include "core/stepping/step.h"
#include "recordings/replay.h"
#include "recordings/signature.h"
#include "recordings/state_hash.h"

namespace ctpm::recordings {
namespace {

constexpr std::int64_t progress_interval = 500;  // ticks

/// A recorded number and its simulated counterpart.
struct Pair {
  std::string name;
  double recorded, replayed;
  bool same() const { return std::bit_cast<std::uint64_t>(recorded) == std::bit_cast<std::uint64_t>(replayed); }
  double difference() const {
    if (same()) return 0;
    const double d = std::abs(replayed - recorded);
    return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
  }
};

/// Every reported number of a tick, recorded and simulated.
std::vector<Pair> outcomes(const TickRecord& record, const stepping::StepReport& report) {
  return {{"tool_force.x", record.tool_force.x, report.tool_force.x},
          {"tool_force.y", record.tool_force.y, report.tool_force.y},
          {"tool_force.z", record.tool_force.z, report.tool_force.z},
          {"depth", record.depth, report.depth},
          {"status", double(record.status), double(report.status)},
          {"contacts", double(record.contacts), double(report.contacts)},
          {"severed", double(record.severed), double(report.severed)},
          {"iterations", double(record.iterations), double(report.iterations)},
          {"second.tool_force.x", record.second.tool_force.x, report.second.tool_force.x},
          {"second.tool_force.y", record.second.tool_force.y, report.second.tool_force.y},
          {"second.tool_force.z", record.second.tool_force.z, report.second.tool_force.z},
          {"second.depth", record.second.depth, report.second.depth},
          {"second.contacts", double(record.second.contacts), double(report.second.contacts)}};
}

/// Flattens a State to numbers, field by field.
struct FlatField {
  std::string name;
  bool is_array;
  std::vector<double> values;
};

struct Flatten {
  std::vector<FlatField>& fields;

  template <class T>
  void operator()(std::string_view name, const T& value) {
    if constexpr (std::is_same_v<T, Vec3>)
      fields.push_back({std::string(name), false, {value.x, value.y, value.z}});
    else if constexpr (std::is_same_v<T, Quat>)
      fields.push_back({std::string(name), false, {value.w, value.x, value.y, value.z}});
    else
      fields.push_back({std::string(name), false, {static_cast<double>(value)}});
  }
  template <class T>
  void operator()(std::string_view name, const std::vector<T>& values) {
    fields.push_back({std::string(name), true, std::vector<double>(values.begin(), values.end())});
  }
};

/// "position" for "position.x". Within a group, the field with the largest difference is named.
std::string group_of(const std::string& name) { return name.substr(0, name.find('.')); }

/// Finds the largest difference within the first group of fields that differs.
bool locate(const State& recorded, const State& replayed, Verdict& verdict) {
  std::vector<FlatField> before, now;
  for_each_field(recorded, Flatten{before});
  for_each_field(replayed, Flatten{now});
  std::string group;
  // The last fields are only in a State whose second hand did something, and in one with open cuts.
  for (std::size_t f = 0; f < std::min(before.size(), now.size()); ++f) {
    if (!group.empty() && group_of(before[f].name) != group) break;
    const std::size_t count = std::min(before[f].values.size(), now[f].values.size());
    for (std::size_t i = 0; i < count; ++i) {
      const Pair pair{before[f].name, before[f].values[i], now[f].values[i]};
      if (pair.same() || (!group.empty() && pair.difference() <= verdict.difference)) continue;
      group = group_of(pair.name);
      verdict.quantity = pair.name;
      verdict.index = before[f].is_array ? static_cast<std::int32_t>(i) : -1;
      verdict.recorded = pair.recorded, verdict.replayed = pair.replayed, verdict.difference = pair.difference();
    }
  }
  return !group.empty();
}

/// Keeps the first difference. The numbers of its tick stay in the verdict unless a keyframe locates it.
void note_difference(std::int64_t tick, bool same_hash, const std::vector<Pair>& pairs, Verdict& verdict) {
  ++verdict.ticks_different;
  if (!verdict.same) return;
  verdict.same = false;
  verdict.first_tick = tick;
  const auto number = std::find_if_not(pairs.begin(), pairs.end(), [](const Pair& p) { return p.same(); });
  verdict.first_quantity = same_hash ? number->name : "state_hash";
  verdict.quantity = verdict.first_quantity;
  if (number == pairs.end()) return;
  verdict.quantity = number->name;
  verdict.recorded = number->recorded, verdict.replayed = number->replayed, verdict.difference = number->difference();
}

/// Compares at a keyframe. The keyframe must match the hash that its tick recorded. After a difference it locates the
/// field and index.
Result<Done> compare_keyframe(SessionReader& reader, const ReplayCursor& cursor, Verdict& verdict) {
  const auto keyframe = reader.keyframe_at_or_before(cursor.tick());
  if (!keyframe) return keyframe.errors();
  if (keyframe->tick != cursor.tick()) return Done{};
  if (state_hash(keyframe->state) != cursor.record().state_hash)
    return Error{reader.path(),
                 "keyframe " + std::to_string(keyframe->tick) + ": is not the state whose hash its tick recorded", ""};
  if (verdict.same || verdict.located_tick >= 0) return Done{};
  Verdict located = verdict;
  located.difference = 0;
  if (locate(keyframe->state, cursor.state(), located)) {
    located.located_tick = keyframe->tick;
    verdict = located;
  }
  return Done{};
}

/// Ticks [from, to) between two keyframes or the ends of the requested range.
struct Stretch {
  std::int64_t from, to;
};

/// Reports the progress of all threads together.
class Progress {
 public:
  Progress(const VerifyOptions& options, std::int64_t total) : call_(options.progress), total_(total) {}
  void add(std::int64_t ticks) {
    if (!call_) return;
    const std::lock_guard lock(mutex_);
    call_(done_ += ticks, total_);
  }

 private:
  const std::function<void(std::int64_t, std::int64_t)>& call_;
  std::int64_t total_, done_ = 0;
  std::mutex mutex_;
};

Result<Verdict> verify_stretch(SessionReader& reader, ReplayCursor& cursor, const Stretch& stretch,
                               const VerifyOptions& options, Progress& progress) {
  Verdict verdict;
  if (stretch.from == stretch.to) return verdict;
  if (auto r = cursor.seek(stretch.from); !r) return r.errors();
  std::int64_t told = stretch.from;
  while (cursor.tick() < stretch.to) {
    if (options.should_stop && options.should_stop()) return Error{reader.path(), "stopped", ""};
    const std::int64_t tick = cursor.tick();
    const auto stepped = cursor.step();
    if (!stepped) return stepped.errors();
    const bool same_hash = state_hash(cursor.state()) == cursor.record().state_hash;
    if (options.look) options.look(tick, cursor.report());
    const std::vector<Pair> pairs = outcomes(cursor.record(), cursor.report());
    const bool same = same_hash && std::all_of(pairs.begin(), pairs.end(), [](const Pair& p) { return p.same(); });
    if (!same) note_difference(tick, same_hash, pairs, verdict);
    ++verdict.ticks_compared;
    if (cursor.tick() - told < progress_interval && cursor.tick() < stretch.to) continue;
    progress.add(cursor.tick() - told);
    told = cursor.tick();
  }
  if (auto r = compare_keyframe(reader, cursor, verdict); !r) return r.errors();
  return verdict;
}

/// Result of one stretch: a verdict or errors.
struct Outcome {
  Verdict verdict;
  Errors errors;
};

/// Work shared by all threads.
struct Work {
  std::vector<Stretch> stretches;
  std::vector<Outcome> outcomes;  ///< (stretch_count)
  std::atomic<std::size_t> next{0};
};

/// One thread's work: takes the next stretch until none is left.
void verify_next(SessionReader& reader, Work& work, const VerifyOptions& options, Progress& progress) {
  std::optional<ReplayCursor> cursor;
  for (std::size_t i; (i = work.next.fetch_add(1)) < work.stretches.size();) {
    // A diverged cursor cannot return to the recorded State by stepping on.
    if (!cursor || !cursor->same_so_far()) {
      auto fresh = ReplayCursor::create(reader);
      if (fresh)
        cursor.emplace(std::move(*fresh));
      else
        work.outcomes[i].errors = fresh.errors();
    }
    if (!work.outcomes[i].errors.empty()) continue;
    const auto verdict = verify_stretch(reader, *cursor, work.stretches[i], options, progress);
    if (verdict)
      work.outcomes[i].verdict = *verdict;
    else
      work.outcomes[i].errors = verdict.errors();
  }
}

/// The stretches of [from, to), split at the keyframes.
std::vector<Stretch> cut_at(const std::vector<std::int64_t>& keyframes, std::int64_t from, std::int64_t to) {
  std::vector<Stretch> stretches{{from, to}};
  for (const std::int64_t keyframe : keyframes) {
    if (keyframe <= from || keyframe >= to) continue;
    stretches.back().to = keyframe;
    stretches.push_back({keyframe, to});
  }
  return stretches;
}

/// Merges the outcomes: any error wins, then the first difference.
Result<Verdict> merge(const std::vector<Outcome>& outcomes) {
  Verdict whole;
  for (const Outcome& outcome : outcomes) {
    if (!outcome.errors.empty()) return outcome.errors;
    const Verdict& one = outcome.verdict;
    const std::int64_t compared = whole.ticks_compared + one.ticks_compared,
                       different = whole.ticks_different + one.ticks_different;
    if (whole.same && !one.same) whole = one;
    whole.ticks_compared = compared, whole.ticks_different = different;
  }
  return whole;
}

}  // namespace

Result<Verdict> verify_session(SessionReader& reader, const VerifyOptions& options) {
  const std::int64_t to = options.to < 0 ? reader.tick_count() : options.to;
  if (options.from < 0 || to > reader.tick_count() || options.from > to)
    return Error{reader.path(),
                 "has no ticks " + std::to_string(options.from) + " to " + std::to_string(to) + ", it has " +
                     std::to_string(reader.tick_count()),
                 ""};
  // Of a whole session everything is checked, not only what a replay reads.
  const bool is_whole = options.from == 0 && to == reader.tick_count();
  if (is_whole) {
    if (auto r = reader.check_all(); !r) return r.errors();
    if (can_sign())
      if (const auto signature = check_signature(reader.path()); !signature) return signature.errors();
  }
  const auto keyframes = reader.keyframe_ticks();
  if (!keyframes) return keyframes.errors();

  Work work;
  work.stretches = cut_at(*keyframes, options.from, to);
  work.outcomes.resize(work.stretches.size());
  Progress progress(options, to - options.from);

  // Each further thread has its own reader.
  const std::size_t threads = std::min<std::size_t>(std::max(options.threads, 1), work.stretches.size());
  std::vector<SessionReader> readers;
  for (std::size_t i = 1; i < threads; ++i) {
    auto another = SessionReader::open(reader.path());
    if (!another) return another.errors();
    readers.push_back(std::move(*another));
  }
  std::vector<std::thread> running;
  for (SessionReader& another : readers) running.emplace_back([&] { verify_next(another, work, options, progress); });
  verify_next(reader, work, options, progress);
  for (std::thread& thread : running) thread.join();
  Result<Verdict> verdict = merge(work.outcomes);
  if (verdict) {
    verdict->physics_revision = reader.start().physics_revision;
    verdict->same = verdict->same && verdict->ticks_compared > 0;
  }
  return verdict;
}

std::string to_string(const Verdict& verdict) {
  std::ostringstream text;
  text.precision(17);
  if (verdict.ticks_compared == 0) return "no verdict: there is no tick to compare";
  if (verdict.same) {
    text << "same: " << verdict.ticks_compared << " ticks compared, no difference";
    return text.str();
  }
  text << "different: first at tick " << verdict.first_tick << " (" << verdict.first_quantity << "), "
       << verdict.ticks_different << " of " << verdict.ticks_compared << " ticks differ";
  if (verdict.quantity != "state_hash") {
    text << "; " << verdict.quantity;
    if (verdict.index >= 0) text << "[" << verdict.index << "]";
    if (verdict.located_tick >= 0) text << " at keyframe " << verdict.located_tick;
    text << " was " << verdict.recorded << ", is " << verdict.replayed << ", difference " << verdict.difference;
  }
  if (const std::string remark = physics_remark(verdict.physics_revision); !remark.empty()) text << "; " << remark;
  return text.str();
}

}  // namespace ctpm::recordings
