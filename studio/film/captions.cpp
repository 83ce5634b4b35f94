#include "studio/film/captions.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "studio/output/number_text.h"
#include "studio/output/option_name.h"
#include "studio/session/anonymise.h"

namespace ctpm::film {
namespace {

using Kind = Moment::Kind;

std::optional<Moment> moment_of(const recordings::Event& event, const Model& model) {
  using recordings::EventKind;
  const std::string text = recordings::describe(event, model);
  const std::string tool = event.tool >= 0 && std::size_t(event.tool) < model.tools.size()
                               ? model.tools[std::size_t(event.tool)].name
                               : std::string("tool");
  switch (event.kind) {
    case EventKind::contact_begins:
      return Moment{event.tick, tool + " touches the tissue", Kind::contact};
    case EventKind::cut:
      return Moment{event.tick, tool + " cuts", Kind::cut};
    case EventKind::damage: {
      std::string limits;
      if (event.depth > 0) limits = "deeper than " + output::short_number(1000 * event.depth_limit) + " mm";
      if (event.force > 0)
        limits +=
            (limits.empty() ? "" : ", ") + std::string("more than ") + output::short_number(event.force_limit) + " N";
      return Moment{event.tick, "tissue damage: " + (limits.empty() ? text : limits), Kind::damage};
    }
    case EventKind::piece_came_loose:
      return Moment{event.tick, text, Kind::loose};
    case EventKind::turned_inside_out:
      return Moment{event.tick, text, Kind::inside_out};
    default:
      return std::nullopt;
  }
}

/// The ticks of a part with the largest force, and with the largest depth of a tool that is no blade.
Result<Done> add_largest(recordings::SessionReader& session, const session::TickRange& part,
                         std::vector<Moment>& moments) {
  constexpr std::int64_t kReadTicks = 10000;  // held in memory at a time
  const Model& model = session.start().model;
  double force = 0, depth = 0;
  std::int64_t force_tick = -1, depth_tick = -1;
  for (std::int64_t from = part.from; from < part.to; from += kReadTicks) {
    const auto records = session.ticks(from, std::min(from + kReadTicks, part.to));
    if (!records) return records.errors();
    for (std::size_t i = 0; i < records->size(); ++i)
      for (std::size_t hand = 0; hand < std::size_t(model.hands); ++hand) {
        const stepping::HandReport report = (*records)[i].of_hand(hand);
        const bool is_blade = model.is_scalpel((*records)[i].inputs.hand(hand).tool);
        if (norm(report.tool_force) > force) force = norm(report.tool_force), force_tick = from + std::int64_t(i);
        if (!is_blade && report.depth > depth) depth = report.depth, depth_tick = from + std::int64_t(i);
      }
  }
  const std::string newtons = output::fixed(force, 2) + " N", millimetres = output::fixed(1000 * depth, 1) + " mm";
  if (force_tick >= 0) moments.push_back({force_tick, "largest force: " + newtons, Kind::force, newtons});
  if (depth_tick >= 0)
    moments.push_back({depth_tick, "deepest press: " + millimetres, Kind::deepest, millimetres + " deep"});
  return Done{};
}

/// The last tick at which a moment's words are shown.
std::int64_t end_of_words(const Moment& moment, std::int64_t shown) {
  const auto ticks_of = [&](double seconds) {
    return std::int64_t(std::llround(double(shown) * seconds / kCaptionSeconds));
  };
  if (moment.left == Moment::kNever) return moment.tick + shown;
  const std::int64_t least = moment.tick + ticks_of(kShortestCaption);
  return std::min(moment.tick + shown, std::max(moment.left + ticks_of(kCaptionAfterContact), least));
}

/// The last moment before a tick, whose State is shown; null: there is none.
const Moment* last_before(const std::vector<Moment>& moments, std::int64_t tick) {
  const auto next = std::upper_bound(moments.begin(), moments.end(), tick,
                                     [](std::int64_t now, const Moment& moment) { return now <= moment.tick; });
  return next == moments.begin() ? nullptr : &*(next - 1);
}

}  // namespace

Result<std::vector<Moment>> all_moments(recordings::SessionReader& session, const session::TickRange& part) {
  const Result<std::vector<recordings::Event>> events = session.events();
  if (!events) return events.errors();
  std::vector<Moment> all;
  std::map<std::int32_t, std::vector<std::size_t>> touching;  // moments of each tool until it leaves
  for (const recordings::Event& event : *events) {
    if (event.kind == recordings::EventKind::contact_ends)
      for (const std::size_t i : std::exchange(touching[event.tool], {})) all[i].left = event.tick;
    const std::optional<Moment> moment = moment_of(event, session.start().model);
    if (!moment) continue;
    if (moment->kind == Kind::contact || moment->kind == Kind::cut) touching[event.tool].push_back(all.size());
    all.push_back(*moment);
  }
  if (!add_largest(session, {0, session.tick_count()}, all))
    if (const Result<Done> added = add_largest(session, part, all); !added) return added.errors();
  std::stable_sort(all.begin(), all.end(), [](const Moment& a, const Moment& b) { return a.tick < b.tick; });
  return all;
}

std::vector<Moment> told_moments(const std::vector<Moment>& all, const std::string& title, double tick,
                                 std::int64_t from) {
  constexpr double kApart = 0.7;  // [s]: of two that are nearer, the later in Kind is told
  const auto apart = std::int64_t(kApart / tick);
  std::vector<Moment> told{{from, title, Kind::title}};
  for (const Moment& moment : all) {
    if (moment.tick < from) continue;
    const bool is_near = told.size() > 1 && moment.tick - told.back().tick < apart;
    if (!is_near)
      told.push_back(moment);
    else if (!moment.largest.empty() && !told.back().largest.empty())  // a press is often deepest where it is strongest
      told.back().text = "largest: " + told.back().largest + ", " + moment.largest;
    else if (moment.kind > told.back().kind)
      told.back() = moment;
  }
  return told;
}

Result<std::vector<std::array<double, 2>>> slow_parts(const std::vector<Moment>& all, const std::string& words,
                                                      double tick) {
  constexpr double kBefore = 0.25, kAfter = 0.5;  // [s]
  std::vector<Kind> kinds;
  Errors errors;
  std::istringstream list(words);
  for (std::string word; std::getline(list, word, ',');) {
    if (word == "cut")
      kinds.push_back(Kind::cut);
    else if (word == "damage")
      kinds.push_back(Kind::damage);
    else if (word == "worst")
      kinds.insert(kinds.end(), {Kind::force, Kind::deepest});
    else
      errors.push_back({output::option_name("export.slow_at"),
                        "got '" + word + "', must be cut, damage or worst, or some of them with commas between", ""});
  }
  if (!errors.empty()) return errors;
  std::vector<std::array<double, 2>> parts;
  for (const Moment& moment : all) {
    if (std::find(kinds.begin(), kinds.end(), moment.kind) == kinds.end()) continue;
    const double at = double(moment.tick) * tick;
    if (!parts.empty() && at - kBefore <= parts.back()[1])
      parts.back()[1] = at + kAfter;
    else
      parts.push_back({std::max(0.0, at - kBefore), at + kAfter});
  }
  return parts;
}

std::string words_at(const std::vector<Moment>& moments, std::int64_t tick, std::int64_t shown) {
  const Moment* last = last_before(moments, tick);
  return last && tick <= end_of_words(*last, shown) ? last->text : "";
}

std::string words_between(const std::vector<Moment>& moments, std::int64_t from, std::int64_t tick) {
  const Moment* last = last_before(moments, tick);
  return last && last->tick > from ? last->text : "";
}

std::vector<video::Caption> captions_of(const std::vector<Moment>& moments, const FrameTicks& ticks, std::int64_t shown,
                                        double fps) {
  // The first frame after a tick; frames never go back.
  const auto frame_after = [&](std::int64_t tick) {
    std::int64_t low = 0, high = ticks.frame_count;
    while (low < high) {
      const std::int64_t middle = (low + high) / 2;
      ticks.tick(middle) > tick ? high = middle : low = middle + 1;
    }
    return low;
  };
  std::vector<video::Caption> captions;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    std::int64_t end = end_of_words(moments[i], shown);
    if (i + 1 < moments.size()) end = std::min(end, moments[i + 1].tick);
    const std::int64_t from = frame_after(moments[i].tick), to = frame_after(end);
    if (from < to) captions.push_back({double(from) / fps, double(to) / fps, moments[i].text});
  }
  return captions;
}

std::string name_of(const recordings::SessionReader& session) {
  const auto& metadata = session.start().metadata;
  const auto trainee = metadata.find(session::trainee_key);
  return trainee != metadata.end() ? trainee->second : std::filesystem::path(session.path()).stem().string();
}

std::vector<video::Caption> captions_of_pair(const std::vector<video::Caption>& left,
                                             const std::vector<video::Caption>& right,
                                             const std::array<std::string, 2>& names) {
  std::vector<double> ends;
  for (const auto* half : {&left, &right})
    for (const video::Caption& caption : *half) ends.push_back(caption.from_s), ends.push_back(caption.to_s);
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<video::Caption> track;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    video::Caption caption{ends[i], ends[i + 1], "", false};
    const auto add = [&](const std::string& where, const std::vector<video::Caption>& half) {
      for (const video::Caption& own : half)
        if (own.from_s <= caption.from_s && own.to_s >= caption.to_s) {
          caption.text += (caption.text.empty() ? "" : "\n") + where + own.text;
          caption.is_chapter = caption.is_chapter || own.from_s == caption.from_s;
        }
    };
    add("left (" + names[0] + "): ", left), add("right (" + names[1] + "): ", right);
    if (!caption.text.empty()) track.push_back(caption);
  }
  return track;
}

}  // namespace ctpm::film
