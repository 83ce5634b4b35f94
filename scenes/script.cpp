#include "scenes/script.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "core/stepping/step.h"
#include "scenes/field_reader.h"
#include "scenes/field_writer.h"
#include "scenes/place_texts.h"
#include "scenes/scene_file.h"
#include "scenes/script_keys.h"

namespace ctpm::scenes {
namespace {

/// What a script can use of a scene.
struct Equipment {
  std::vector<std::string> tools;
  std::int32_t hands;
  const Model* model = nullptr;   ///< null: not known
  bool knows_tools = true;        ///< otherwise any tool is right
  PlaceFinder* finder = nullptr;  ///< null: places by meaning are checked as texts alone
};

/// What a hand holds while steps are checked.
struct Holding {
  bool has_tool = false;
  std::int32_t tool = -1;  ///< in Equipment::tools; -1: none, or none that is known
};
using Holdings = std::array<Holding, kMostHands>;

void check_take(Problems& problems, const std::string& at, const ScriptStep& step, const Equipment& equipment,
                Holdings& holdings) {
  const ScriptStep::Take& take = *step.take;
  const std::vector<std::string>& names = equipment.tools;
  const auto found = std::find(names.begin(), names.end(), take.tool);
  Holding &holding = holdings[step.hand_number()], &other = holdings[1 - step.hand_number()];
  holding = {true, found == names.end() ? -1 : std::int32_t(found - names.begin())};
  if (found == names.end() && equipment.knows_tools) {
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
    problems.add_rule(at + "/take/tool", "the scene has no tool " + in_quotes(take.tool),
                      known.empty() ? "the scene has no tools" : "its tools: " + known);
  }
  std::string conflict;
  if (equipment.model != nullptr)
    conflict = stepping::hands_conflict(*equipment.model, holding.tool, other.tool);
  else if (holding.tool >= 0 && holding.tool == other.tool)
    conflict = "both hands hold the same tool";
  if (!conflict.empty())
    problems.add_rule(at + "/take/tool", conflict, "put " + in_quotes(names[std::size_t(other.tool)]) + " away first");
  check_direction(problems, at + "/take/pointing", take.pointing);
  if (take.facing && problems.is_good(at + "/take/pointing") &&
      norm(cross(*take.facing, take.pointing)) <= 1e-6 * norm(*take.facing) * norm(take.pointing))
    problems.add_rule(at + "/take/facing", "must not be zero or along pointing");
}

void check_hand(Problems& problems, const std::string& at, const ScriptStep& step, std::int32_t hands) {
  if (!step.hand) return;
  if (step.wait) problems.add_rule(at + "/hand", "both hands hold still", "leave it out");
  if (*step.hand > hands) problems.add_rule(at + "/hand", "the scene has one hand", "write \"hands\": 2 in the scene");
}

void check_steps(Problems& problems, const Script& script, const Equipment& equipment) {
  Holdings holdings;
  for (std::size_t i = 0; i < script.steps.size(); ++i) {
    const ScriptStep& step = script.steps[i];
    const std::string at = "/steps/" + std::to_string(i);
    Holding& holding = holdings[step.hand_number()];
    check_hand(problems, at, step, equipment.hands);
    if (step.take) check_take(problems, at, step, equipment, holdings);
    if (step.put_away) holding = {};
    // A step without a known key may be a misspelt take, so what follows it is not judged.
    if (!(step.take || step.move || step.press || step.release || step.cut || step.wait || step.put_away))
      holdings = {Holding{true, -1}, Holding{true, -1}};
    if (step.put_away == false) problems.add_rule(at + "/put_away", "must be true");
    if (step.press) check_direction(problems, at + "/press/direction", step.press->direction);
    if (step.release) check_direction(problems, at + "/release/direction", step.release->direction);
    if (step.cut && step.cut->turns.value_or(false) && !step.cut->smooth.value_or(false))
      problems.add_rule(at + "/cut/turns", "a blade turns along a smooth cut only", "write \"smooth\": true beside it");
    if ((step.move || step.press || step.release || step.cut) && !holding.has_tool)
      problems.add(at, "there is no tool in the hand here", "take one first", at);
  }
}

/// The rotation that turns -z onto `pointing` the shortest way.
Quat orientation_of(Vec3 pointing) {
  const Vec3 to = pointing / norm(pointing);
  // w = 1 + cos(angle) = 1 - z; near straight up, where that cancels, from x and y.
  const double across = to.x * to.x + to.y * to.y;
  const double w = to.z > 0 ? across / (1 + to.z) : 1 - to.z;
  if (across < 1e-200 && to.z > 0) return {0, 1, 0, 0};  // straight up: half a turn about x
  const double length = std::sqrt(w * w + across);
  return {w / length, to.y / length, -to.x / length, 0};
}

/// `orientation` with a turn about the tool's own axis before it.
Quat turned(Quat orientation, ToolTurn turn) {
  const double w = std::sqrt((1 + turn.cosine) / 2), z = (turn.sine < 0 ? -1 : 1) * std::sqrt((1 - turn.cosine) / 2);
  const Quat q = orientation;
  return {q.w * w - q.z * z, q.x * w + q.y * z, q.y * w - q.x * z, q.z * w + q.w * z};
}

/// From a tool's +x to what lies in a direction, seen along its axis; none along the axis itself.
std::optional<ToolTurn> turn_towards(Quat orientation, Vec3 direction) {
  const Vec3 local = rotate({orientation.w, -orientation.x, -orientation.y, -orientation.z}, direction);
  const double length = std::sqrt(local.x * local.x + local.y * local.y);
  if (!(length > 1e-6 * std::abs(local.z))) return std::nullopt;
  return ToolTurn{local.x / length, local.y / length};
}

/// `orientation` turned about the tool's own axis, so that its +x looks to `facing` as well as it can.
Quat facing(Quat orientation, Vec3 facing) {
  const std::optional<ToolTurn> turn = turn_towards(orientation, facing);
  return turn ? turned(orientation, *turn) : orientation;
}

/// Between two turns that are less than half a turn apart.
ToolTurn between(ToolTurn from, ToolTurn to, double part) {
  const double cosine = from.cosine + part * (to.cosine - from.cosine), sine = from.sine + part * (to.sine - from.sine);
  const double length = std::sqrt(cosine * cosine + sine * sine);
  return length > 0 ? ToolTurn{cosine / length, sine / length} : to;
}

/// How much a way has turned at each of its points since the first one, seen along the axis of a tool. Pieces along the
/// axis go on as what is before them.
std::vector<ToolTurn> turns_along(const std::vector<Vec3>& way, Quat orientation) {
  std::vector<std::optional<ToolTurn>> pieces;
  for (std::size_t i = 1; i < way.size(); ++i) pieces.push_back(turn_towards(orientation, way[i] - way[i - 1]));
  const auto known = std::find_if(pieces.begin(), pieces.end(), [](const auto& piece) { return piece.has_value(); });
  if (known == pieces.end()) return {};
  const ToolTurn first = **known;
  ToolTurn before = first;
  std::vector<ToolTurn> turns;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const ToolTurn after = i < pieces.size() ? pieces[i].value_or(before) : before;
    const ToolTurn here = between(before, after, 0.5);
    turns.push_back(
        {here.cosine * first.cosine + here.sine * first.sine, here.sine * first.cosine - here.cosine * first.sine});
    before = after;
  }
  return turns;
}

/// Share of the way after share `t` of the time: speed rises along a cubic in the first fifth and falls in
/// the last.
double eased(double t) {
  constexpr double kRamp = 0.2;
  const auto risen = [](double u) { return u * u * u * (1 - 0.5 * u); };  // integral of 3 u^2 - 2 u^3, 1/2 at u = 1
  const double whole = 1 - kRamp;
  if (t < kRamp) return kRamp * risen(t / kRamp) / whole;
  if (t > 1 - kRamp) return 1 - kRamp * risen((1 - t) / kRamp) / whole;
  return (0.5 * kRamp + (t - kRamp)) / whole;
}

/// Length of the way up to each of its points.
std::vector<double> lengths_along(const std::vector<Vec3>& points) {
  std::vector<double> lengths{0};
  for (std::size_t i = 1; i < points.size(); ++i) lengths.push_back(lengths.back() + norm(points[i] - points[i - 1]));
  return lengths;
}

/// A curve through the points, as a way of short straight pieces: the centripetal Catmull-Rom spline, which has neither
/// loops nor swings where points lie close together. Yuksel, Schaefer & Keyser, "Parameterization and applications of
/// Catmull-Rom curves" (2011).
std::vector<Vec3> curve_through(std::vector<Vec3> points) {
  const auto coincide = [](Vec3 a, Vec3 b) { return !(norm(a - b) > 0); };
  points.erase(std::unique(points.begin(), points.end(), coincide), points.end());
  if (points.size() < 3) return points;
  const Vec3 before = 2.0 * points[0] - points[1], after = 2.0 * points.back() - points[points.size() - 2];
  points.insert(points.begin(), before);
  points.push_back(after);
  std::vector<Vec3> way{points[1]};
  for (std::size_t i = 1; i + 2 < points.size(); ++i) {
    double knot[4] = {0};
    for (std::size_t k = 1; k < 4; ++k) knot[k] = knot[k - 1] + std::sqrt(norm(points[i - 1 + k] - points[i - 2 + k]));
    const auto between = [&](Vec3 p, Vec3 q, std::size_t from, std::size_t to, double t) {
      return ((knot[to] - t) * p + (t - knot[from]) * q) / (knot[to] - knot[from]);
    };
    constexpr int kPieces = 32;
    for (int piece = 1; piece <= kPieces; ++piece) {
      const double t = knot[1] + double(piece) / kPieces * (knot[2] - knot[1]);
      const Vec3 a1 = between(points[i - 1], points[i], 0, 1, t), a2 = between(points[i], points[i + 1], 1, 2, t),
                 a3 = between(points[i + 1], points[i + 2], 2, 3, t);
      const Vec3 b1 = between(a1, a2, 0, 2, t), b2 = between(a2, a3, 1, 3, t);
      way.push_back(piece == kPieces ? points[i + 1] : between(b1, b2, 1, 2, t));
    }
  }
  return way;
}

/// Time for a way at a speed, with the slower start and end.
double duration_of(const std::vector<Vec3>& way, double speed) { return lengths_along(way).back() / speed / 0.8; }

/// From where a press or a release begins to where it ends [m].
template <class Stroke>
Vec3 way_of(const Stroke& stroke) {
  return stroke.distance / norm(stroke.direction) * stroke.direction;
}

Result<Script> read_with(std::string_view text, const std::string& file_name, const Equipment& equipment) {
  Result<JsonNode> parsed = parse_json(text, file_name);
  if (!parsed) return parsed.errors();
  const auto root = std::make_shared<JsonNode>(*std::move(parsed));
  Script script;
  Problems problems(TextPlaces(root, file_name));
  find_places(*root, true, equipment.finder, problems);
  FieldReader::read_record(*root, "", problems, script);
  check_steps(problems, script, equipment);
  if (!problems.is_empty()) return problems.errors();
  return script;
}

}  // namespace

Result<Script> read_script(std::string_view text, const std::string& file_name,
                           const std::vector<std::string>& tool_names, std::int32_t hands, PlaceFinder* finder) {
  return read_with(text, file_name, {.tools = tool_names, .hands = hands, .finder = finder});
}

Result<Script> read_script_for(std::string_view text, const std::string& file_name, const Model& model,
                               PlaceFinder* finder) {
  std::vector<std::string> names;
  for (const Tool& tool : model.tools) names.push_back(tool.name);
  return read_with(text, file_name,
                   {.tools = std::move(names), .hands = model.hands, .model = &model, .finder = finder});
}

Errors check_script(std::string_view text, const std::string& file_name, const SceneDraft& scene) {
  const SceneSpec& spec = scene.scene.spec;
  PlaceFinder names = names_in(spec);
  const bool knows_places = scene.problems.is_good("/organs") && scene.problems.is_good("/probes");
  Equipment equipment{.tools = {},
                      .hands = scene.problems.is_good("/hands") ? spec.hands.value_or(1) : std::int32_t(kMostHands),
                      .knows_tools = scene.problems.is_good("/tools"),
                      .finder = knows_places ? &names : nullptr};
  for (const ToolSpec& tool : spec.tools) equipment.tools.push_back(tool.name);
  const Result<Script> script = read_with(text, file_name, equipment);
  return script ? Errors{} : script.errors();
}

std::string write_script(const Script& script) {
  Script copy = script;
  return FieldWriter::record_text(copy, 0) + "\n";
}

ScriptPlayer::ScriptPlayer(const Script& script, std::span<const Tool> tools, double tick)
    : script_(script), tools_(tools.begin(), tools.end()), tick_(tick) {
  plan(0, {});
}

/// Lays out the steps from `first_step` on, from what the hands do then.
void ScriptPlayer::plan(std::size_t first_step, Inputs hands) {
  for (std::size_t i = first_step; i < script_.steps.size(); ++i) {
    const ScriptStep& step = script_.steps[i];
    Hand& hand = hands.hand(step.hand_number());
    const auto follow = [&](std::vector<Vec3> way, double speed) -> Stretch& {
      hand.position = way.back();
      const double duration = duration_of(way, speed);
      return add_stretch(i, hands, std::move(way), duration);
    };
    if (step.take) {
      const auto it =
          std::find_if(tools_.begin(), tools_.end(), [&](const Tool& t) { return t.name == step.take->tool; });
      CTPM_CHECK(it != tools_.end(), "the script was read with the scene's tools");
      hand.tool = std::int32_t(it - tools_.begin());
      hand.world_from_tool = orientation_of(step.take->pointing);
      if (step.take->facing) hand.world_from_tool = facing(hand.world_from_tool, *step.take->facing);
      hand.position = step.take->at;
      add_stretch(i, hands, {hand.position}, tick_);
    }
    const Vec3 from = hand.position;
    if (step.move) follow({from, step.move->to}, step.move->speed);
    if (step.press)
      follow({from, from + way_of(*step.press)}, step.press->speed).until_force = step.press->until_force.value_or(0);
    if (step.release) follow({from, from + way_of(*step.release)}, step.release->speed);
    if (step.cut && step.cut->smooth.value_or(false)) {
      std::vector<Vec3> points{from};
      points.insert(points.end(), step.cut->path.begin(), step.cut->path.end());
      Stretch& stretch = follow(curve_through(points), step.cut->speed);
      if (step.cut->turns.value_or(false)) stretch.turns = turns_along(stretch.points, hand.world_from_tool);
      if (!stretch.turns.empty()) hand.world_from_tool = turned(hand.world_from_tool, stretch.turns.back());
    } else if (step.cut) {
      for (const Vec3& point : step.cut->path) follow({hand.position, point}, step.cut->speed);
    }
    if (step.wait) add_stretch(i, hands, {hand.position}, *step.wait);
    if (step.put_away) {
      hand.tool = -1;
      add_stretch(i, hands, {hand.position}, tick_);  // the hand stays where it is
    }
  }
}

ScriptPlayer::Stretch& ScriptPlayer::add_stretch(std::size_t step, const Inputs& hands, std::vector<Vec3> points,
                                                 double duration) {
  Stretch stretch;
  stretch.first = tick_count();
  stretch.count = stretch.planned = std::max<std::int64_t>(1, std::llround(std::ceil(duration / tick_)));
  stretch.hand = script_.steps[step].hand_number(), stretch.held = hands, stretch.step = step;
  stretch.lengths = lengths_along(points);
  stretch.points = std::move(points);
  return stretches_.emplace_back(std::move(stretch));
}

std::int64_t ScriptPlayer::tick_count() const {
  return stretches_.empty() ? 0 : stretches_.back().first + stretches_.back().count;
}

const ScriptPlayer::Stretch& ScriptPlayer::stretch_at(std::int64_t tick) const {
  const auto next = std::upper_bound(stretches_.begin(), stretches_.end(), tick,
                                     [](std::int64_t t, const Stretch& s) { return t < s.first; });
  return next == stretches_.begin() ? *next : *(next - 1);
}

std::size_t ScriptPlayer::hand_at(std::int64_t tick) const { return stretches_.empty() ? 0 : stretch_at(tick).hand; }

Inputs ScriptPlayer::at(std::int64_t tick) const {
  if (stretches_.empty()) return {};
  const Stretch& stretch = stretch_at(tick);
  Inputs inputs = stretch.held;
  Hand& hand = inputs.hand(stretch.hand);
  const std::int64_t done = std::clamp<std::int64_t>(tick - stretch.first + 1, 0, stretch.count);
  const double share = double(done) / double(stretch.planned);
  const auto& [points, lengths, turns] = std::tie(stretch.points, stretch.lengths, stretch.turns);
  const double length = eased(share) * lengths.back();
  const auto next = std::upper_bound(lengths.begin(), lengths.end(), length);
  if (next == lengths.end()) {
    hand.position = points.back();
    if (!turns.empty()) hand.world_from_tool = turned(hand.world_from_tool, turns.back());
    return inputs;
  }
  const std::size_t i = std::size_t(next - lengths.begin());
  const double part = (length - lengths[i - 1]) / (lengths[i] - lengths[i - 1]);
  hand.position = points[i - 1] + part * (points[i] - points[i - 1]);
  if (!turns.empty()) hand.world_from_tool = turned(hand.world_from_tool, between(turns[i - 1], turns[i], part));
  return inputs;
}

PressEnd ScriptPlayer::feel(std::int64_t tick, Vec3 force) {
  if (tick < 0 || tick >= tick_count()) return PressEnd::none;
  const std::size_t index = std::size_t(&stretch_at(tick) - stretches_.data());
  Stretch& stretch = stretches_[index];
  if (stretch.until_force == 0) return PressEnd::none;
  const Vec3 way = stretch.points.back() - stretch.points.front();
  if (dot(force, way) > -stretch.until_force * norm(way))
    return tick == stretch.first + stretch.count - 1 ? PressEnd::at_depth : PressEnd::none;
  const Inputs now = at(tick);
  stretch.count = tick - stretch.first + 1;
  const std::size_t next_step = stretch.step + 1;
  stretches_.resize(index + 1);
  plan(next_step, now);
  return PressEnd::at_force;
}

}  // namespace ctpm::scenes
