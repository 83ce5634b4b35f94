#include "studio/compare/session_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "core/cutting/cutting.h"
#include "core/model/fields.h"
#include "recordings/byte_hash.h"
#include "recordings/replay.h"
#include "recordings/state_hash.h"
#include "scenes/scene_file.h"
#include "studio/session/anonymise.h"
#include "studio/session/cut_at_end.h"
#include "studio/session/probes.h"

namespace ctpm::compare {
namespace {

constexpr std::int64_t kReadTicks = 10000;  // held in memory at a time
constexpr std::int32_t kFirstSwept = 4;     // physics revision
constexpr double kCutSpacings = 3;          // a tip that moves farther without severing begins another cut

/// The severed flags of a State in the order of ElementPlaces.
std::vector<std::uint8_t> severed_flags(const State& state) {
  std::vector<std::uint8_t> flags;
  for (const auto* kind : {&state.axial_severed, &state.constraint_severed, &state.angle_severed})
    flags.insert(flags.end(), kind->begin(), kind->end());
  return flags;
}

std::vector<Spell> cuts_of(const SessionTrack& track, const Model& model);
double work_of(Vec3 force, Vec3 by);

bool holds_tool(const Model& model, std::int32_t tool) { return tool >= 0 && std::size_t(tool) < model.tools.size(); }

/// The organ of which a hand's tool touches the most points; -1: none. Of a cut's own points the organ is not known.
std::int32_t organ_touched(const Model& model, const State& state, std::size_t hand, bool is_blade) {
  std::vector<std::int32_t> points(model.organs.size(), 0);
  if (is_blade)
    for (const std::int32_t organ : state.edge_organ)
      if (organ >= 0) ++points[std::size_t(organ)];
  const auto all = std::int32_t(model.touchable_count()), from = std::int32_t(hand) * all;
  for (auto at = std::ranges::lower_bound(state.touched, from);
       !is_blade && at != state.touched.end() && *at < from + all; ++at) {
    std::int32_t point = *at - from;
    std::size_t organ = 0;
    while (organ < model.surfaces.size() && point >= std::int32_t(model.surfaces[organ].vertex.size()))
      point -= std::int32_t(model.surfaces[organ++].vertex.size());
    if (organ < model.surfaces.size())
      ++points[organ];
    else
      for (std::size_t o = 0; o < model.organs.size(); ++o)
        points[o] += point >= model.organs[o].first && point < model.organs[o].first + model.organs[o].count;
  }
  const auto most = std::ranges::max_element(points);
  return most == points.end() || *most == 0 ? -1 : std::int32_t(most - points.begin());
}

/// Whether a script or a file moved the tool, whose times do not depend on the clock.
bool is_scripted(const recordings::SessionStart& start) {
  const auto source = start.metadata.find("source");
  return source != start.metadata.end() && (source->second == "script" || source->second == "motion");
}

/// How deep a held blade is in the tissue, as often as hands are measured.
class BladeDepth {
 public:
  BladeDepth(const Model& model, SessionTrack& track)
      : model_(model),
        track_(track),
        measures_(model),
        every_(std::max(1ll, std::llround(1 / (kDepthRate * track.tick)))) {}

  void look(std::size_t tick, const State& state) {
    if (!model_.is_scalpel(track_.tool[tick])) return;
    if (track_.blade_depth.empty()) track_.blade_depth.assign(track_.tick_count(), 0.0);
    if (tick % std::size_t(every_) == 0) last_ = measures_.edge_depth(state);
    track_.blade_depth[tick] = last_;
  }

  /// Stores the size of all cuts of the last State of a replay.
  void finish(const State& state) { measures_.measure(state), track_.cut = measures_.size(); }

 private:
  static constexpr double kDepthRate = 100;  // [Hz]
  const Model& model_;
  SessionTrack& track_;
  session::CutMeasures measures_;
  long long every_;
  double last_ = 0;
};

/// Replays ticks [from, to) and stores the tick in which each element was severed. `look(tick, report)` sees each tick.
template <class Look>
Result<Done> replay_ticks(recordings::ReplayCursor& cursor, std::int64_t from, std::int64_t to, SessionTrack& track,
                          const ReplayWatch& watch, Look&& look) {
  if (const Result<Done> found = cursor.seek(from); !found) return found.errors();
  std::vector<std::uint8_t> before = severed_flags(cursor.state());
  while (cursor.tick() < to) {
    const std::int64_t tick = cursor.tick();
    if (watch && !watch(tick)) return Error{track.path, "stopped", ""};
    if (const Result<bool> stepped = cursor.step(); !stepped) return stepped.errors();
    look(std::size_t(tick), cursor.report());
    if (cursor.report().severed == 0) continue;
    const std::vector<std::uint8_t> now = severed_flags(cursor.state());
    for (std::size_t i = 0; i < now.size(); ++i)
      if (now[i] && !before[i]) track.severed_at[i] = tick;
    before = now;
  }
  track.replays = track.replays && cursor.same_so_far();
  return Done{};
}

/// Replays every tick. If all are as recorded, takes what the tool did to the tissue from the replay: the recorded
/// numbers have no hash of their own.
Result<Done> replay_all(recordings::SessionReader& session, SessionTrack& track, const ReplayWatch& watch) {
  track.severed_at.assign(ElementPlaces(session.start().model).count, -1);
  Result<recordings::ReplayCursor> cursor = recordings::ReplayCursor::create(session);
  if (!cursor) return cursor.errors();
  std::vector<double> force = track.force, depth = track.depth, other_force = track.other_force, work = track.work;
  std::vector<std::int32_t> organ(track.tick_count(), -1);
  std::vector<std::int32_t> severed = track.severed;
  const std::vector<session::Probe> probes = session::probes_of(session);
  for (const session::Probe& probe : probes) track.probes.push_back({probe.name, {}});
  const Vec3Array before = session.start().initial_state.position;
  BladeDepth blade(session.start().model, track);
  const Result<Done> replayed = replay_ticks(
      *cursor, 0, session.tick_count(), track, watch, [&](std::size_t tick, const stepping::StepReport& report) {
        for (std::size_t i = 0; i < probes.size(); ++i)
          track.probes[i].way.push_back(norm(cursor->state().position[probes[i].sphere] - before[probes[i].sphere]));
        force[tick] = norm(report.of_hand(track.hand).tool_force), depth[tick] = report.of_hand(track.hand).depth;
        if (!other_force.empty()) other_force[tick] = norm(report.of_hand(1 - track.hand).tool_force);
        severed[tick] = report.severed;
        if (tick > 0 && track.tool[tick] == track.tool[tick - 1])
          work[tick] = work_of(report.of_hand(track.hand).tool_force, track.tip[tick] - track.tip[tick - 1]);
        if (const Model& model = session.start().model;
            model.organs.size() > 1 && holds_tool(model, track.tool[tick])) {
          const bool is_blade = model.is_scalpel(track.tool[tick]);
          if (force[tick] > 0) organ[tick] = organ_touched(model, cursor->state(), track.hand, is_blade);
          if (force[tick] > 0 && organ[tick] < 0 && tick > 0) organ[tick] = organ[tick - 1];  // within a cut
        }
        blade.look(tick, cursor->state());
      });
  if (!replayed) return replayed.errors();
  blade.finish(cursor->state());
  track.is_verified = track.replays;
  if (track.is_verified)
    track.force = force, track.depth = depth, track.other_force = other_force, track.severed = severed,
    track.work = work;
  if (track.is_verified && session.start().model.organs.size() > 1) track.organ = organ;
  track.cuts = cuts_of(track, session.start().model);
  return Done{};
}

/// Replays the cuts alone.
Result<Done> replay_cuts(recordings::SessionReader& session, SessionTrack& track, const ReplayWatch& watch) {
  track.severed_at.assign(ElementPlaces(session.start().model).count, -1);
  if (track.cuts.empty()) return Done{};
  Result<recordings::ReplayCursor> cursor = recordings::ReplayCursor::create(session);
  if (!cursor) return cursor.errors();
  BladeDepth blade(session.start().model, track);
  for (const Spell& cut : track.cuts)
    if (const Result<Done> replayed =
            replay_ticks(*cursor, std::int64_t(cut.first), std::int64_t(cut.last), track, watch,
                         [&](std::size_t tick, const stepping::StepReport&) { blade.look(tick, cursor->state()); });
        !replayed)
      return replayed.errors();
  // A blade goes on where nothing is left to sever. Keyframes of earlier revisions do not hold what it swept.
  if (session.start().physics_revision >= kFirstSwept)
    if (const Result<Done> ended = cursor->seek(session.tick_count()); !ended) return ended.errors();
  track.replays = track.replays && cursor->same_so_far();
  blade.finish(cursor->state());
  return Done{};
}

/// What is severed in the end, and the size of the cuts. In which tick something was severed is not known.
Result<Done> replay_end(recordings::SessionReader& session, SessionTrack& track) {
  track.severed_at.assign(ElementPlaces(session.start().model).count, -1);
  if (track.cuts.empty()) return Done{};
  const Result<session::CutAtEnd> end = session::cut_at_end(session);
  if (!end) return end.errors();
  track.replays = end->is_same;
  const std::vector<std::uint8_t> severed = severed_flags(end->state);
  for (std::size_t i = 0; i < severed.size(); ++i)
    if (severed[i]) track.severed_at[i] = std::int64_t(track.cuts.back().last) - 1;
  session::CutMeasures measures(session.start().model);
  measures.measure(end->state), track.cut = measures.size();
  return Done{};
}

std::vector<Spell> strokes_of(const std::vector<std::int32_t>& tool) {
  std::vector<Spell> strokes;
  for (std::size_t i = 0; i < tool.size(); ++i) {
    if (tool[i] < 0) continue;
    if (i > 0 && tool[i] == tool[i - 1])
      strokes.back().last = i + 1;
    else
      strokes.push_back({i, i + 1});
  }
  return strokes;
}

/// Runs of severing ticks, separated by the path of the tip instead of time: elements lie a spacing apart, so a blade
/// that continues soon meets the next one at any speed.
std::vector<Spell> cuts_of(const SessionTrack& track, const Model& model) {
  double most = 0, gone = 0;
  for (const OrganRange& organ : model.organs) most = std::max(most, kCutSpacings * organ.spacing);
  std::vector<Spell> cuts;
  for (std::size_t i = 0; i < track.tick_count(); ++i) {
    const bool same_tool = i > 0 && track.tool[i] == track.tool[i - 1];
    gone = same_tool ? gone + norm(track.tip[i] - track.tip[i - 1]) : INFINITY;
    if (track.severed[i] == 0) continue;
    if (!cuts.empty() && gone <= most)
      cuts.back().last = i + 1;
    else
      cuts.push_back({i, i + 1});
    gone = 0;
  }
  return cuts;
}

/// How well a tick is solved after its first iteration is no matter of the scene: sessions recorded before scenes had a
/// say in that are compared with later ones.
constexpr std::string_view kNoMatter = "solver.velocity_enough";

/// The fields of a Model as bytes, by name.
struct FieldBytes {
  std::vector<std::pair<std::string, std::string>>& fields;
  Names names = Names::count;
  std::string prefix = {};

  template <class T>
  void operator()(std::string_view name, const T& value) {
    if (name == kNoMatter) return;
    if constexpr (std::is_same_v<T, std::string>) {
      if (names == Names::count) fields.emplace_back(prefix + std::string(name), value);
    } else {
      static_assert(std::is_trivially_copyable_v<T>);
      fields.emplace_back(prefix + std::string(name), std::string(reinterpret_cast<const char*>(&value), sizeof value));
    }
  }
  template <class T>
  void operator()(std::string_view name, const std::vector<T>& values) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      fields.emplace_back(prefix + std::string(name),
                          std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)));
    } else {
      for (std::size_t i = 0; i < values.size(); ++i)
        for_each_field(values[i],
                       FieldBytes{fields, names, prefix + std::string(name) + "[" + std::to_string(i) + "]."});
    }
  }
};

/// The difference of two networks in words; empty if only numbers differ.
std::string difference_in_words(const Model& a, const Model& b, Names count_names) {
  const auto list = [&](const auto& things) {
    if (count_names == Names::do_not_count) return std::to_string(things.size());
    std::string names;
    for (const auto& thing : things) names += (names.empty() ? "" : ", ") + thing.name;
    return names.empty() ? std::string("none") : names;
  };
  if (list(a.organs) != list(b.organs)) return "its organs are " + list(b.organs) + " instead of " + list(a.organs);
  if (a.sphere_count() != b.sphere_count())
    return "it has " + std::to_string(b.sphere_count()) + " spheres instead of " + std::to_string(a.sphere_count());
  if (a.hands != b.hands) return "it has " + std::to_string(b.hands) + " hands instead of " + std::to_string(a.hands);
  if (list(a.tools) != list(b.tools)) return "its tools are " + list(b.tools) + " instead of " + list(a.tools);
  return "";
}

/// Of a tool that is moved `by` against the force of the tissue on it [J].
double work_of(Vec3 force, Vec3 by) { return -dot(force, by); }

/// The scene's forbidden zones; none of a scene that another version wrote.
std::vector<scenes::ZoneSpec> zones_of(const recordings::SessionStart& start, const std::string& path) {
  const Result<scenes::SceneText> scene = scenes::read_scene(start.scene_text, path);
  return scene ? scene->spec.forbidden : std::vector<scenes::ZoneSpec>();
}

/// In which of some zones a tool is with any part of its ball, or of its blade's edge and point; -1: in none. Of
/// another tool its place counts.
std::int32_t zone_of(const std::vector<scenes::ZoneSpec>& zones, const Model& model, const Hand& hand) {
  if (hand.tool < 0) return -1;
  const Tool& tool = model.tools[std::size_t(hand.tool)];
  const auto in = std::ranges::find_if(zones, [&](const scenes::ZoneSpec& zone) {
    if (tool.kind != ToolKind::scalpel)
      return scenes::is_in(zone, hand.position, tool.kind == ToolKind::ball ? tool.radius : 0);
    const cutting::BladeEdge edge = cutting::blade_edge(tool, hand);
    return scenes::is_in(zone, edge.tip, edge.heel) || scenes::is_in(zone, edge.tip, edge.back);
  });
  return in == zones.end() ? -1 : std::int32_t(in - zones.begin());
}

/// What one hand did.
struct HandTrack {
  std::vector<std::int32_t> tool, zone;
  std::vector<Vec3> tip;
  std::vector<double> force, depth, work;
  std::int64_t cuts = 0, holds = 0;  ///< ticks in which it severs, and in which it holds a tool

  void add(const Model& model, const std::vector<scenes::ZoneSpec>& zones, const recordings::TickRecord& record,
           std::size_t number) {
    const Hand& hand = record.inputs.hand(number);
    const stepping::HandReport report = record.of_hand(number);
    const bool goes_on = !tool.empty() && tool.back() == hand.tool;
    work.push_back(goes_on ? work_of(report.tool_force, hand.position - tip.back()) : 0.0);
    tool.push_back(hand.tool), tip.push_back(hand.position);
    force.push_back(norm(report.tool_force)), depth.push_back(report.depth);
    if (!zones.empty()) zone.push_back(zone_of(zones, model, hand));
    holds += holds_tool(model, hand.tool);
    cuts += record.severed > 0 && model.is_scalpel(hand.tool);
  }
  bool works_more_than(const HandTrack& other) const {
    return cuts != other.cuts ? cuts > other.cuts : holds > other.holds;
  }
};

}  // namespace

ElementPlaces::ElementPlaces(const Model& model)
    : constraints(model.axial.size()),
      angle_springs(constraints + model.constraints.size()),
      count(angle_springs + model.angle_springs.size()) {}

Result<SessionTrack> read_recorded(recordings::SessionReader& session) {
  const recordings::SessionStart& start = session.start();
  SessionTrack track;
  track.path = session.path(), track.session_id = session.session_id(), track.tick = start.model.tick;
  track.has_end = session.ended_cleanly();
  track.initial_state = recordings::state_hash(start.initial_state);
  if (const auto name = start.metadata.find("scene_name"); name != start.metadata.end())
    track.scene_name = name->second;
  std::array<HandTrack, kMostHands> hands;
  const std::vector<scenes::ZoneSpec> zones = zones_of(start, track.path);
  for (const scenes::ZoneSpec& zone : zones) track.zones.push_back(zone.name);
  const std::int64_t count = session.tick_count();
  for (std::int64_t from = 0; from < count; from += kReadTicks) {
    const auto records = session.ticks(from, std::min(from + kReadTicks, count));
    if (!records) return records.errors();
    for (const recordings::TickRecord& record : *records) {
      for (std::size_t i = 0; i < std::size_t(start.model.hands); ++i) hands[i].add(start.model, zones, record, i);
      track.severed.push_back(record.severed);
      track.slip = std::max(track.slip, record.slip);
    }
  }
  track.hand = hands[1].works_more_than(hands[0]) ? 1 : 0;
  HandTrack &works = hands[track.hand], &other = hands[1 - track.hand];
  track.tool = std::move(works.tool), track.tip = std::move(works.tip), track.zone = std::move(works.zone);
  track.force = std::move(works.force), track.depth = std::move(works.depth);
  track.other_force = std::move(other.force), track.work = std::move(works.work);
  // Where there is one organ, it is the one that is touched.
  if (start.model.organs.size() == 1)
    for (const double force : track.force) track.organ.push_back(force > 0 ? 0 : -1);
  constexpr double kSlipShare = 0.01;
  track.is_timed = is_scripted(start) || track.slip <= kSlipShare * track.seconds(track.tick_count());
  track.strokes = strokes_of(track.tool);
  track.cuts = cuts_of(track, start.model);
  return track;
}

Result<SessionTrack> read_track(recordings::SessionReader& session, Replaying replaying, const ReplayWatch& watch) {
  if (const Result<Done> whole = session.check_all(); !whole) return whole.errors();
  Result<SessionTrack> track = read_recorded(session);
  if (!track) return track.errors();
  if (track->strokes.empty()) return Error{session.path(), "no tool is ever in the hand", ""};
  const bool is_short = track->seconds(track->tick_count()) <= kShortSession;
  const bool all = replaying == Replaying::all || (replaying == Replaying::short_ones && is_short);
  const Result<Done> replayed = all                            ? replay_all(session, *track, watch)
                                : replaying == Replaying::ends ? replay_end(session, *track)
                                                               : replay_cuts(session, *track, watch);
  if (!replayed) return replayed.errors();
  if (watch) watch(session.tick_count());
  return track;
}

std::string scene_difference(const Model& expert, const Model& other, Names names) {
  if (std::string words = difference_in_words(expert, other, names); !words.empty()) return words;
  std::vector<std::pair<std::string, std::string>> fields_a, fields_b;
  for_each_field(expert, FieldBytes{fields_a, names});
  for_each_field(other, FieldBytes{fields_b, names});
  const auto [in_a, in_b] = std::mismatch(fields_a.begin(), fields_a.end(), fields_b.begin(), fields_b.end());
  if (in_a == fields_a.end() && in_b == fields_b.end()) return "";
  return "its network differs in " + (in_a != fields_a.end() ? in_a->first : in_b->first);
}

Result<Done> check_same_scene(const recordings::SessionReader& expert, const recordings::SessionReader& trainee) {
  const std::string reason = scene_difference(
      expert.start().model, trainee.start().model,
      session::begins_at_elapsed_time(expert) || session::begins_at_elapsed_time(trainee) ? Names::do_not_count
                                                                                          : Names::count);
  if (reason.empty()) return Done{};
  return Error{trainee.path(), "is of another scene than " + expert.path() + ": " + reason,
               "sessions can be compared if they were recorded in the same scene"};
}

std::uint64_t scene_hash(const Model& model, Names names_count) {
  std::vector<std::pair<std::string, std::string>> fields;
  for_each_field(model, FieldBytes{fields, names_count});
  recordings::ByteHash hash;
  for (const auto& [name, bytes] : fields) {
    const std::string head = name + " " + std::to_string(bytes.size()) + "\n";
    hash.add(head.data(), head.size()), hash.add(bytes.data(), bytes.size());
  }
  return hash.value();
}

std::vector<Path> cut_paths(const SessionTrack& track) {
  std::vector<Path> paths;
  for (const Spell& cut : track.cuts)
    paths.emplace_back(track.tip.begin() + std::ptrdiff_t(cut.first), track.tip.begin() + std::ptrdiff_t(cut.last));
  return paths;
}

Vec3 rest_middle(const Model& model, std::size_t element) {
  const ElementPlaces places(model);
  const Vec3Array& rest = model.rest_position;
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    return 0.5 * (rest[std::size_t(a)] + rest[std::size_t(b)]);
  };
  if (element < places.constraints) return middle(model.axial.a[element], model.axial.b[element]);
  if (element < places.angle_springs) return rest[std::size_t(model.constraints.c[element - places.constraints])];
  return rest[std::size_t(model.angle_springs.b[element - places.angle_springs])];
}

}  // namespace ctpm::compare
