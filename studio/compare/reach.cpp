#include "studio/compare/reach.h"

#include "studio/compare/measure_table.h"
#include "studio/output/number_text.h"

namespace ctpm::compare {

std::vector<Shortfall> shortfalls_of(std::span<const MeasuredValue> values, double damage_depth) {
  std::vector<Shortfall> shortfalls;
  for (const MeasuredValue& value : values) {
    if (value.measure != &kDepth && value.measure != &kCutAlongBlade && value.measure != &kCutArea) continue;
    const double expert = value.expert.value_or(0), trainee = value.trainee.value_or(0);
    if (value.measure == &kDepth && damage_depth > 0 && expert > 1e3 * damage_depth) continue;
    if (trainee < (1 - kNotableShare) * expert) shortfalls.push_back({value.measure, expert, trainee});
  }
  return shortfalls;
}

std::string to_words(const std::vector<Shortfall>& shortfalls) {
  std::string words;
  for (const auto& [measure, expert, trainee] : shortfalls)
    words += (words.empty() ? "" : ", ") + std::string(measure->title) + " " + output::short_number(trainee, 3) +
             " of the expert's " + output::short_number(expert, 3) + " " + measure->unit;
  return words;
}

}  // namespace ctpm::compare
