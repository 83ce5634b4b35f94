#include "studio/commands/comparison_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "studio/compare/advice.h"
#include "studio/output/number_text.h"
#include "studio/output/printable.h"

namespace ctpm::commands {
namespace {

constexpr std::size_t kMomentsOnConsole = 5;

std::string number(std::optional<double> value) { return value ? output::short_number(*value) : "-"; }

std::string describe(const compare::Moment& moment) {
  char text[200];
  const std::string limit = moment.limit > 0 ? ", limit " + output::short_number(moment.limit) : "";
  std::snprintf(text, sizeof text, "%7.2f s  %s: %s %s%s, from %.2f s to %.2f s", moment.worst_s,
                compare::to_word(moment.kind), output::short_number(moment.value).c_str(), moment.unit, limit.c_str(),
                moment.from_s, moment.to_s);
  return text;
}

}  // namespace

std::string comparison_text(const compare::ComparedSessions& compared, const std::string& to_see_worst) {
  const compare::Comparison& comparison = compared.comparison;
  std::string text;
  char line[200];
  std::snprintf(line, sizeof line, "%-38s %10s %10s  %-4s %-13s %s\n", "measure", "expert", "trainee", "unit",
                "better is", "trainee is");
  text += line;
  for (const compare::MeasuredValue& value : comparison.values) {
    const std::string standing = value.note.empty() ? compare::standing_of(value) : "(" + value.note + ")";
    std::snprintf(line, sizeof line, "%-38s %10s %10s  %-4s %-13s %s", value.measure->title,
                  number(value.expert).c_str(), number(value.trainee).c_str(), value.measure->unit,
                  compare::to_word(value.measure->direction), standing.c_str());
    std::string row = line;
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  if (const std::string less = compare::less_done_text(comparison); !less.empty()) text += less + "\n";
  text += "what to do better:\n";
  for (const std::string& sentence : compare::advice_of(compared)) text += "  " + sentence + "\n";
  text += comparison.moments.empty() ? "no moment goes beyond a limit\n" : "worst moments of the trainee's session:\n";
  for (std::size_t i = 0; i < std::min(kMomentsOnConsole, comparison.moments.size()); ++i)
    text += describe(comparison.moments[i]) + "\n";
  if (comparison.moments.size() > kMomentsOnConsole)
    text += "and " + std::to_string(comparison.moments.size() - kMomentsOnConsole) + " more\n";
  if (!comparison.moments.empty()) text += "to see the worst: " + to_see_worst + "\n";
  return text;
}

std::string worst_moment_command(const compare::ComparedSessions& compared) {
  if (compared.comparison.moments.empty()) return "";
  const compare::SessionTrack& trainee = compared.trainee;
  const compare::Moment& moment = compared.comparison.moments.front();
  constexpr double kAround = 1;  // [s]
  char range[80];
  std::snprintf(range, sizeof range, "--from-s %.1f --to-s %.1f", std::max(0.0, moment.from_s - kAround),
                std::min(std::floor(10 * trainee.seconds(trainee.tick_count())) / 10, moment.to_s + kAround));
  return "ctpm export " + output::shell_word(trainee.path) + " -o worst.mp4 " + range;
}

}  // namespace ctpm::commands
