#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/fields.h"
#include "core/step.h"
#include "recordings/replay.h"
#include "recordings/state_hash.h"

namespace ctpm {
namespace {

constexpr std::int64_t progress_interval = 500;  // ticks

/// A number that was recorded and the same one simulated again.
struct Pair {
  std::string name;
  double recorded, replayed;
  bool same() const {
    return std::bit_cast<std::uint64_t>(recorded) == std::bit_cast<std::uint64_t>(replayed);
  }
  double difference() const {
    if (same()) return 0;
    const double d = std::abs(replayed - recorded);
    return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
  }
};

/// Everything that a tick reports, next to what the record says.
std::vector<Pair> outcomes(const TickRecord& record, const StepReport& report) {
  return {{"tool_force.x", record.tool_force.x, report.tool_force.x},
          {"tool_force.y", record.tool_force.y, report.tool_force.y},
          {"tool_force.z", record.tool_force.z, report.tool_force.z},
          {"depth", record.depth, report.depth},
          {"status", double(record.status), double(report.status)},
          {"contacts", double(record.contacts), double(report.contacts)},
          {"severed", double(record.severed), double(report.severed)},
          {"iterations", double(record.iterations), double(report.iterations)}};
}

/// A State laid out as numbers, field by field.
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

/// "position" for "position.x": fields that are told apart by their largest difference.
std::string group_of(const std::string& name) { return name.substr(0, name.find('.')); }

/// Names the largest difference within the first group of fields that differs.
bool locate(const State& recorded, const State& replayed, Verdict& verdict) {
  std::vector<FlatField> before, now;
  for_each_field(recorded, Flatten{before});
  for_each_field(replayed, Flatten{now});
  std::string group;
  for (std::size_t f = 0; f < before.size(); ++f) {
    if (!group.empty() && group_of(before[f].name) != group) break;
    const std::size_t count = std::min(before[f].values.size(), now[f].values.size());
    for (std::size_t i = 0; i < count; ++i) {
      const Pair pair{before[f].name, before[f].values[i], now[f].values[i]};
      if (pair.same() || (!group.empty() && pair.difference() <= verdict.difference)) continue;
      group = group_of(pair.name);
      verdict.quantity = pair.name;
      verdict.index = before[f].is_array ? static_cast<std::int32_t>(i) : -1;
      verdict.recorded = pair.recorded, verdict.replayed = pair.replayed,
      verdict.difference = pair.difference();
    }
  }
  return !group.empty();
}

/// Keeps the first difference; the numbers of its tick stand until a keyframe says more.
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
  verdict.recorded = number->recorded, verdict.replayed = number->replayed,
  verdict.difference = number->difference();
}

/// Compares at a keyframe: it must be the state that its tick's hash proves, and after a difference it says
/// where that lies.
Result<Done> compare_keyframe(SessionReader& reader, const ReplayCursor& cursor, Verdict& verdict) {
  const auto keyframe = reader.keyframe_at_or_before(cursor.tick());
  if (!keyframe) return keyframe.errors();
  if (keyframe->tick != cursor.tick()) return Done{};
  if (state_hash(keyframe->state) != cursor.record().state_hash)
    return Error{
        reader.path(),
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

}  // namespace

Result<Verdict> verify_session(SessionReader& reader, const VerifyOptions& options) {
  const std::int64_t to = options.to < 0 ? reader.tick_count() : options.to;
  if (options.from < 0 || to > reader.tick_count() || options.from > to)
    return Error{reader.path(),
                 "has no ticks " + std::to_string(options.from) + " to " + std::to_string(to) + ", it has " +
                     std::to_string(reader.tick_count()),
                 ""};
  const auto keyframe_ticks = reader.keyframe_ticks();
  if (!keyframe_ticks) return keyframe_ticks.errors();
  auto next_keyframe = std::upper_bound(keyframe_ticks->begin(), keyframe_ticks->end(), options.from);

  auto cursor = ReplayCursor::create(reader);
  if (!cursor) return cursor.errors();
  if (auto r = cursor->seek(options.from); !r) return r.errors();
  Verdict verdict;
  while (cursor->tick() < to) {
    const std::int64_t tick = cursor->tick();
    const auto stepped = cursor->step();
    if (!stepped) return stepped.errors();
    const bool same_hash = state_hash(cursor->state()) == cursor->record().state_hash;
    const std::vector<Pair> pairs = outcomes(cursor->record(), cursor->report());
    const bool same =
        same_hash && std::all_of(pairs.begin(), pairs.end(), [](const Pair& p) { return p.same(); });
    if (!same) note_difference(tick, same_hash, pairs, verdict);
    ++verdict.ticks_compared;
    if (next_keyframe != keyframe_ticks->end() && *next_keyframe == cursor->tick()) {
      ++next_keyframe;
      if (auto r = compare_keyframe(reader, *cursor, verdict); !r) return r.errors();
    }
    if (options.progress && (cursor->tick() % progress_interval == 0 || cursor->tick() == to))
      options.progress(cursor->tick() - options.from, to - options.from);
  }
  return verdict;
}

std::string to_string(const Verdict& verdict) {
  std::ostringstream text;
  text.precision(17);
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
    text << " was " << verdict.recorded << ", is " << verdict.replayed << ", difference "
         << verdict.difference;
  }
  return text.str();
}

}  // namespace ctpm
