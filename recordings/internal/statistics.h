#pragma once

#include <cstdint>
#include <vector>

#include "recordings/internal/bytes.h"
#include "recordings/session.h"

namespace ctpm::recordings::session_file {

/// Accumulates statistics tick by tick. Stores four bytes per tick and measured quantity, so that percentiles cover
/// every tick, in single precision.
class StatisticsCounter {
 public:
  void add(const TickRecord& record);
  void add(const Event& event);
  void add_keyframe() { ++sum_.keyframes; }
  SessionStatistics result() const;

 private:
  SessionStatistics sum_;
  std::vector<float> tick_times_, input_ages_;  ///< [s], values above 0
};

/// The part `finish`: fields of a SessionStatistics, with the units in their names.
template <class S, class Visit>
requires std::is_same_v<std::remove_const_t<S>, SessionStatistics>
void for_each_field(S& s, Visit&& visit) {
  visit("ticks", s.ticks);
  visit("keyframes", s.keyframes);
  visit("events", s.events);
  visit("late_ticks", s.late_ticks);
  visit("severed", s.severed);
  visit("tick_time_p50_s", s.tick_time_p50);
  visit("tick_time_p99_s", s.tick_time_p99);
  visit("tick_time_p999_s", s.tick_time_p999);
  visit("tick_time_max_s", s.tick_time_max);
  visit("input_age_p50_s", s.input_age_p50);
  visit("input_age_p99_s", s.input_age_p99);
  visit("input_age_max_s", s.input_age_max);
  visit("slip_s", s.slip);
  visit("slip_max_s", s.slip_max);
  visit("max_force_n", s.max_force);
  visit("max_depth_m", s.max_depth);
}

/// Writes the content of the part `finish`.
void put_finish(Bytes& out, const SessionStatistics& statistics);

}  // namespace ctpm::recordings::session_file
