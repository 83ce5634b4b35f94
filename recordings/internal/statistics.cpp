#include "recordings/internal/statistics.h"

#include <algorithm>
#include <cmath>

#include "core/model/nearest_rank.h"
#include "recordings/internal/field_codec.h"

namespace ctpm::recordings::session_file {
void StatisticsCounter::add(const TickRecord& record) {
  ++sum_.ticks;
  sum_.severed += record.severed;
  sum_.max_force = std::max({sum_.max_force, norm(record.tool_force), norm(record.second.tool_force)});
  sum_.max_depth = std::max({sum_.max_depth, record.depth, record.second.depth});
  sum_.tick_time_max = std::max(sum_.tick_time_max, record.tick_time);
  sum_.input_age_max = std::max(sum_.input_age_max, record.input_age);
  sum_.slip = std::floor(record.slip * 1e3 + 1e-6) / 1e3;  // as it is stored
  sum_.slip_max = std::max(sum_.slip_max, sum_.slip);
  if (record.input_age > 0) input_ages_.push_back(static_cast<float>(record.input_age));
  if (record.tick_time > 0) tick_times_.push_back(static_cast<float>(record.tick_time));
}

void StatisticsCounter::add(const Event& event) {
  ++sum_.events;
  if (event.kind == EventKind::late_tick) ++sum_.late_ticks;
}

SessionStatistics StatisticsCounter::result() const {
  SessionStatistics result = sum_;
  result.tick_time_p50 = percentile(tick_times_, 0.5);
  result.tick_time_p99 = percentile(tick_times_, 0.99);
  result.tick_time_p999 = percentile(tick_times_, 0.999);
  result.input_age_p50 = percentile(input_ages_, 0.5);
  result.input_age_p99 = percentile(input_ages_, 0.99);
  return result;
}

void put_finish(Bytes& out, const SessionStatistics& statistics) {
  put_field_set(out, [&](FieldWriter& writer) {
    for_each_field(statistics, writer);
    std::string names;
    std::vector<double> numbers;
    for (const auto& [name, value] : statistics.values) names += name + "\n", numbers.push_back(value);
    writer("value_names", names);
    writer("values", numbers);
  });
}

}  // namespace ctpm::recordings::session_file
