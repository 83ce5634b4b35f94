#include "studio/session/late_ticks.h"

#include <algorithm>
#include <numeric>

namespace ctpm::session {

std::int64_t LateTicks::total() const { return std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0}); }

std::string LateTicks::text() const {
  std::array causes = recordings::kLateCauses;
  std::stable_sort(causes.begin(), causes.end(),
                   [&](recordings::LateCause a, recordings::LateCause b) { return of(a) > of(b); });
  std::string text;
  for (const recordings::LateCause cause : causes)
    if (of(cause) > 0)
      text += (text.empty() ? "" : ", ") + std::string(recordings::name_of(cause)) + " " + std::to_string(of(cause));
  return text;
}

LateTicks late_ticks_of(const std::vector<recordings::Event>& events, double tick) {
  LateTicks late;
  for (const recordings::Event& event : events)
    if (event.kind == recordings::EventKind::late_tick) late.add(recordings::late_cause(event.parts, tick));
  return late;
}

}  // namespace ctpm::session
