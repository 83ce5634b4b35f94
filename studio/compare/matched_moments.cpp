#include "studio/compare/matched_moments.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "studio/output/number_text.h"
#include "studio/output/option_name.h"

namespace ctpm::compare {
namespace {

constexpr std::size_t kAlignedPoints = 4000;  // largest number per path; time grows with the product of both
constexpr double kAlignedRate = 50;           // points per second [Hz], fewer above kAlignedPoints
constexpr double kLeastApart = 1;             // of moments of a path [s]: what differs within is left to be seen

Result<std::optional<double>> first_event(recordings::SessionReader& session, recordings::EventKind kind) {
  const Result<std::vector<recordings::Event>> events = session.events();
  if (!events) return events.errors();
  for (const recordings::Event& event : *events)
    if (event.kind == kind) return std::optional(double(event.tick) * session.start().model.tick);
  return std::optional<double>();
}

Result<MatchedMoments> at_event(recordings::SessionReader& a, recordings::SessionReader& b, recordings::EventKind kind,
                                const char* name) {
  MatchedMoments moments(1);
  Errors errors;
  for (std::size_t i = 0; i < 2; ++i) {
    recordings::SessionReader& session = i == 0 ? a : b;
    const Result<std::optional<double>> first = first_event(session, kind);
    if (!first) return first.errors();
    if (*first)
      moments[0][i] = **first;
    else
      errors.push_back(
          {session.path(), std::string("has no ") + name, "give " + output::option_name("export.align") + " clock"});
  }
  if (!errors.empty()) return errors;
  return moments;
}

/// In step, the second session's clock `ahead_s` ahead of the first's, for as long as both last. Error: they are never
/// seen together.
Result<MatchedMoments> shifted(const recordings::SessionReader& a, const recordings::SessionReader& b, double ahead_s) {
  const auto length = [](const recordings::SessionReader& session) {
    return double(session.tick_count()) * session.start().model.tick;
  };
  const double from = std::max(0.0, -ahead_s), to = std::min(length(a), length(b) - ahead_s);
  if (!(from < to))
    return Error{output::option_name("export.align"),
                 "got " + output::fixed(ahead_s, 3) + " s, and the sessions have no moment in common",
                 "give more than " + output::fixed(-length(a), 3) + " and less than " + output::fixed(length(b), 3)};
  return MatchedMoments{{from, from + ahead_s}, {to, to + ahead_s}};
}

/// The number that a text is. None: it is not one.
std::optional<double> number_in(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != 0 || !std::isfinite(number)) return std::nullopt;
  return number;
}

Result<MatchedMoments> on_the_way(recordings::SessionReader& a, recordings::SessionReader& b) {
  if (const Result<Done> same = check_same_scene(a, b); !same) return same.errors();
  TimedPath paths[2];
  for (std::size_t i = 0; i < 2; ++i) {
    recordings::SessionReader& session = i == 0 ? a : b;
    const Result<SessionTrack> track = read_recorded(session);
    if (!track) return track.errors();
    if (track->strokes.empty()) return Error{session.path(), "no tool is ever in the hand", ""};
    paths[i] = tool_path(*track);
  }
  return along_path(align_paths(paths[0].place, paths[1].place), paths[0].time, paths[1].time, kLeastApart);
}

/// The moments nearest to these between whose neighbours no session goes slower than least_pace() of the other; the
/// first and the last are kept where that allows them. In how far both have come (a + b), by how much one is ahead (a -
/// b) may change only so fast: the middle between the lowest and the highest such way through the moments is one.
MatchedMoments keeping_pace(const MatchedMoments& moments) {
  const std::array<double, 2> whole{moments.back()[0] - moments[0][0], moments.back()[1] - moments[0][1]};
  const double least = least_pace(whole[0], whole[1]), steepest = (1 - least) / (1 + least);
  const auto come = [&](std::size_t i) { return moments[i][0] + moments[i][1]; };
  const auto ahead = [&](std::size_t i) { return moments[i][0] - moments[i][1]; };
  MatchedMoments kept = moments;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    double lowest = INFINITY, highest = -INFINITY;
    const auto reach = [&](std::size_t j) { return steepest * std::abs(come(i) - come(j)); };
    for (std::size_t j = 0; j < moments.size(); ++j) {
      lowest = std::min(lowest, ahead(j) + reach(j));
      highest = std::max(highest, ahead(j) - reach(j));
    }
    double lead = 0.5 * (lowest + highest);
    for (const std::size_t end : {moments.size() - 1, std::size_t{0}})
      lead = std::max(std::min(lead, ahead(end) + reach(end)), ahead(end) - reach(end));
    kept[i] = {0.5 * (come(i) + lead), 0.5 * (come(i) - lead)};
  }
  return kept;
}

}  // namespace

double least_pace(double a_s, double b_s) {
  const double longer = std::max(a_s, b_s);
  return longer > 0 ? kLeastPace * std::min(a_s, b_s) / longer : 1;
}

TimedPath tool_path(const SessionTrack& track) {
  TimedPath path;
  const std::size_t step = std::max({std::size_t(std::llround(1 / (kAlignedRate * track.tick))),
                                     (track.tick_count() + kAlignedPoints - 1) / kAlignedPoints, std::size_t(1)});
  const auto add = [&](std::size_t i) { path.place.push_back(track.tip[i]), path.time.push_back(track.seconds(i)); };
  for (const Spell& stroke : track.strokes) {
    for (std::size_t i = stroke.first; i + 1 < stroke.last; i += step) add(i);
    add(stroke.last - 1);
  }
  return path;
}

MatchedMoments along_path(const Alignment& alignment, const std::vector<double>& time_a,
                          const std::vector<double>& time_b, double least_s) {
  constexpr int kRounds = 2;
  MatchedMoments moments;
  for (const AlignedPair& pair : alignment.pairs) {
    const std::array<double, 2> now{time_a[pair.a], time_b[pair.b]};
    if (moments.empty() || std::max(now[0] - moments.back()[0], now[1] - moments.back()[1]) >= least_s)
      moments.push_back(now);
  }
  if (alignment.pairs.empty()) return moments;
  const std::array<double, 2> end{time_a[alignment.pairs.back().a], time_b[alignment.pairs.back().b]};
  if (end != moments.back()) moments.push_back(end);
  // Where one tool waits for the other, it is better seen slowing down.
  for (int round = 0; round < kRounds; ++round) {
    const MatchedMoments rough = moments;
    for (std::size_t i = 1; i + 1 < moments.size(); ++i)
      for (std::size_t s = 0; s < 2; ++s)
        moments[i][s] = 0.25 * rough[i - 1][s] + 0.5 * rough[i][s] + 0.25 * rough[i + 1][s];
  }
  return keeping_pace(moments);
}

Result<MatchedMoments> match_sessions(recordings::SessionReader& a, recordings::SessionReader& b,
                                      const std::string& by) {
  using recordings::EventKind;
  if (by == "clock") return MatchedMoments{};
  if (by == "path") return on_the_way(a, b);
  if (by == "contact") return at_event(a, b, EventKind::contact_begins, "contact");
  if (by == "cut") return at_event(a, b, EventKind::cut, "cut");
  if (const std::optional<double> ahead_s = number_in(by)) return shifted(a, b, *ahead_s);
  if (!by.empty())
    return Error{
        output::option_name("export.align"),
        "got '" + by + "', must be path, contact, cut, clock or the seconds that the second one's clock shows more",
        ""};
  if (Result<MatchedMoments> found = on_the_way(a, b)) return found;
  if (Result<MatchedMoments> found = at_event(a, b, EventKind::contact_begins, "contact")) return found;
  return MatchedMoments{};
}

}  // namespace ctpm::compare
