#include "studio/compare/advice.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "studio/compare/measure_table.h"
#include "studio/compare/moments.h"
#include "studio/compare/reach.h"
#include "studio/compare/way.h"
#include "studio/output/number_text.h"

namespace ctpm::compare {
namespace {

constexpr double kUndone = 0.5;  // of what the expert cut
constexpr double kOfAll = 100;   // severity of what is wrong with the whole stroke: more than that of any part of it

struct Sentence {
  Concern concern;
  double severity;
  std::string text;
};

std::string number(double value) { return output::short_number(value, 3); }
std::string at(const Moment& moment) { return " at " + output::fixed(moment.worst_s, 2) + " s"; }

std::string zone_at(const SessionTrack& track, double seconds) {
  const std::int32_t zone = track.zone[std::size_t(std::llround(seconds / track.tick))];
  return track.zones[std::size_t(zone)];
}

/// The worst moment of a kind, in words. `seconds`, `sum` (of values) and `count`: of all moments of
/// the kind.
std::string to_sentence(const Moment& moment, double seconds, double sum, std::size_t count,
                        const SessionTrack& trainee) {
  const std::string value = number(moment.value) + " " + moment.unit, limit = number(moment.limit) + " " + moment.unit;
  const std::string in_all = " for " + number(seconds) + " s in all";
  switch (moment.kind) {
    case MomentKind::zone:
      return "Keep out of forbidden zones: " + value + " in " + zone_at(trainee, moment.worst_s) + at(moment) +
             (count > 1 ? ", and in such zones" + in_all + "." : ".");
    case MomentKind::stray_cut:
      return "Cut only where the expert cut: " + number(sum) + " severed elements are ones that the expert left whole" +
             ", " + (count > 1 ? number(moment.value) : "all") + " of them in the cut that ends" + at(moment) + ".";
    case MomentKind::force:
      return "Press more gently: " + value + at(moment) + ", above the limit of " + limit + in_all + ".";
    case MomentKind::depth:
      return "Push less deep: " + value + at(moment) + ", and" + in_all + " beyond the " + limit +
             " that the tissue bears.";
    case MomentKind::deviation:
      return "Stay on the expert's path: " + value + " away from it" + at(moment) + ", and more than " + limit +
             in_all + ".";
    case MomentKind::pause:
      return "Go on without stopping: " + value + " of standing still" + at(moment) + ", at most " + limit +
             " are usual" + (count > 1 ? "; " + std::to_string(count) + " such pauses." : ".");
  }
  return "";
}

void add_moments(std::vector<Sentence>& sentences, const std::vector<Moment>& moments, const SessionTrack& trainee) {
  using enum MomentKind;
  for (const MomentKind kind : {zone, stray_cut, force, depth, deviation, pause}) {
    const Moment* worst = nullptr;
    double seconds = 0, sum = 0, severities = 0;
    std::size_t count = 0;
    for (const Moment& moment : moments)
      if (moment.kind == kind) {
        if (!worst) worst = &moment;  // they are sorted
        seconds += moment.to_s - moment.from_s, sum += moment.value, severities += moment.severity, ++count;
      }
    if (!worst) continue;
    Moment told = *worst;
    if (kind == stray_cut) told.severity = severities;  // what is cut stays cut, in one stroke or in several
    sentences.push_back({concern_of(told), told.severity, to_sentence(told, seconds, sum, count, trainee)});
  }
}

/// What the trainee's cut lacks beside the expert's.
void add_cut(std::vector<Sentence>& sentences, const SessionTrack& expert, const SessionTrack& trainee) {
  if (expert.cuts.empty()) return;
  double severed = 0, whole = 0;
  for (std::size_t i = 0; i < expert.severed_at.size(); ++i)
    if (expert.severed_at[i] >= 0) ++severed, whole += trainee.severed_at[i] < 0;
  if (trainee.cuts.empty()) {
    sentences.push_back(
        {Concern::undone, kOfAll, "Cut: the expert severed " + number(severed) + " elements, this hand none."});
    return;
  }
  if (severed > 0 && whole > kNotableShare * severed)
    sentences.push_back({whole > kUndone * severed ? Concern::undone : Concern::accuracy, whole / severed,
                         "Complete the cut: " + number(whole) + " of the " + number(severed) +
                             " elements that the expert severed were left whole."});
  if (!expert.cut || !trainee.cut) return;
  // Not from the nearest surface: in a cut through most of an organ that is the far side.
  const double own = trainee.cut->along_blade, wanted = expert.cut->along_blade;
  if (const double more = own - wanted; std::abs(more) > kNotableShare * wanted)
    sentences.push_back({more > 0                 ? Concern::harm
                         : own < kUndone * wanted ? Concern::undone
                                                  : Concern::accuracy,
                         std::abs(more) / wanted,
                         std::string("Cut ") + (more < 0 ? "deeper: " : "less deep: ") + number(1e3 * own) +
                             " mm, the expert " + number(1e3 * wanted) + " mm."});
}

/// How much less deep than the expert a tool without a blade pushes.
void add_push(std::vector<Sentence>& sentences, const Comparison& comparison) {
  for (const auto& [measure, expert, trainee] : shortfalls_of(comparison.values, comparison.damage_depth))
    if (measure == &kDepth)
      sentences.push_back({Concern::accuracy, 1 - trainee / expert,
                           "Push deeper: " + number(trainee) + " mm, the expert " + number(expert) + " mm."});
}

/// The worse measure whose value is farthest from the expert's, as a share.
std::string most_to_gain(const Comparison& comparison) {
  const MeasuredValue* most = nullptr;
  double share = 0;
  for (const MeasuredValue& value : comparison.values) {
    if (standing_of(value) != "worse") continue;
    const double largest = std::max(std::abs(*value.expert), std::abs(*value.trainee));
    const double own = std::abs(*value.trainee - *value.expert) / largest;
    if (own > share) most = &value, share = own;
  }
  if (!most) return "";
  const std::string unit = std::string_view(most->measure->unit) == "1" ? "" : std::string(" ") + most->measure->unit;
  return std::string("Most is to be gained in ") + most->measure->title + ": " + number(*most->trainee) + unit +
         ", the expert " + number(*most->expert) + unit + ".";
}

}  // namespace

std::vector<std::string> advice_of(const ComparedSessions& compared) {
  const Comparison& comparison = compared.comparison;
  std::vector<Sentence> sentences;
  if (comparison.way != Way::same)
    sentences.push_back({Concern::harm, kOfAll, std::string("Turn the stroke: ") + to_word(comparison.way) + "."});
  add_moments(sentences, comparison.moments, compared.trainee);
  add_push(sentences, comparison);
  add_cut(sentences, compared.expert, compared.trainee);
  std::ranges::stable_sort(sentences, std::greater<>(), &Sentence::severity);
  std::ranges::stable_sort(sentences, {}, &Sentence::concern);
  std::vector<std::string> advice;
  for (const Sentence& sentence : sentences) advice.push_back(sentence.text);
  if (!advice.empty()) return advice;
  advice.push_back("Nothing goes beyond a limit.");
  if (const std::string gain = most_to_gain(comparison); !gain.empty()) advice.push_back(gain);
  return advice;
}

}  // namespace ctpm::compare
