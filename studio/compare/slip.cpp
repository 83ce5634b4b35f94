#include "studio/compare/slip.h"

#include <algorithm>
#include <string_view>

#include "studio/output/number_text.h"

namespace ctpm::compare {
bool depends_on_time(std::string_view key) {
  constexpr std::string_view kSmoothness[] = {"spectral_arc_length", "log_dimensionless_jerk"};
  return key.ends_with("_s") || std::ranges::find(kSmoothness, key) != std::end(kSmoothness);
}

void refuse_times(Comparison& comparison, const SessionTrack& expert, const SessionTrack& trainee) {
  std::string note;
  for (const SessionTrack* track : {&expert, &trainee})
    if (!track->is_timed)
      note += std::string(note.empty() ? "" : "; ") + "the " + (track == &expert ? "expert" : "trainee") +
              "'s session lacks " + output::fixed(track->slip, 3) + " s of real time";
  if (note.empty()) return;
  for (MeasuredValue& value : comparison.values)
    if (depends_on_time(value.measure->key)) value.expert.reset(), value.trainee.reset(), value.note = note;
}

}  // namespace ctpm::compare
