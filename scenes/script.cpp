#include "scenes/script.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "scenes/field_reader.h"
#include "scenes/field_writer.h"
#include "scenes/script_fields.h"

namespace ctpm {
namespace {

void check_tool(Problems& problems, const std::string& at, const ScriptStep::Take& take,
                const std::vector<std::string>& tool_names) {
  if (std::find(tool_names.begin(), tool_names.end(), take.tool) == tool_names.end()) {
    std::string known;
    for (const std::string& name : tool_names) known += (known.empty() ? "" : ", ") + name;
    problems.add_rule(at + "/take/tool", "the scene has no tool " + in_quotes(take.tool),
                      known.empty() ? "the scene has no tools" : "its tools: " + known);
  }
  check_direction(problems, at + "/take/pointing", take.pointing);
  if (take.facing && norm(cross(*take.facing, take.pointing)) <= 1e-6 * norm(*take.facing) * norm(take.pointing))
    problems.add_rule(at + "/take/facing", "must not be zero or along pointing");
}

void check_steps(Problems& problems, const Script& script, const std::vector<std::string>& tool_names) {
  bool has_tool = false;
  for (std::size_t i = 0; i < script.steps.size(); ++i) {
    const ScriptStep& step = script.steps[i];
    const std::string at = "/steps/" + std::to_string(i);
    if (step.take) {
      has_tool = true;
      check_tool(problems, at, *step.take, tool_names);
    }
    if (step.put_away) has_tool = false;
    if (step.put_away == false) problems.add_rule(at + "/put_away", "must be true");
    if (step.press) check_direction(problems, at + "/press/direction", step.press->direction);
    if (step.release) check_direction(problems, at + "/release/direction", step.release->direction);
    if ((step.move || step.press || step.release || step.cut) && !has_tool)
      problems.add_rule(at, "there is no tool in the hand here", "take one first");
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

/// `orientation` with a turn about the tool's own axis before it, so that the tool's +x looks to `facing` as well as it can.
Quat facing(Quat orientation, Vec3 facing) {
  const Vec3 local = rotate({orientation.w, -orientation.x, -orientation.y, -orientation.z}, facing);
  const double length = std::sqrt(local.x * local.x + local.y * local.y);
  if (length == 0) return orientation;
  // Half of the angle whose cosine is x / length.
  const double cosine = local.x / length;
  const double w = std::sqrt((1 + cosine) / 2), z = (local.y < 0 ? -1 : 1) * std::sqrt((1 - cosine) / 2);
  const Quat q = orientation;
  return {q.w * w - q.z * z, q.x * w + q.y * z, q.y * w - q.x * z, q.z * w + q.w * z};
}

/// Share of the way after share `t` of the time: speed rises along a cubic in the first fifth and falls in
/// the last.
double eased(double t) {
  constexpr double kRamp = 0.2;
  const auto risen = [](double u) {
    return u * u * u * (1 - 0.5 * u);
  };  // integral of 3 u^2 - 2 u^3, 1/2 at u = 1
  const double whole = 1 - kRamp;
  if (t < kRamp) return kRamp * risen(t / kRamp) / whole;
  if (t > 1 - kRamp) return 1 - kRamp * risen((1 - t) / kRamp) / whole;
  return (0.5 * kRamp + (t - kRamp)) / whole;
}

/// Time for a way at a speed, with the slower start and end.
double duration_of(Vec3 from, Vec3 to, double speed) { return norm(to - from) / speed / 0.8; }

/// From where a press or a release begins to where it ends [m].
template <class Stroke>
Vec3 way_of(const Stroke& stroke) {
  return stroke.distance / norm(stroke.direction) * stroke.direction;
}

}  // namespace

Result<Script> read_script(std::string_view text, const std::string& file_name,
                           const std::vector<std::string>& tool_names) {
  const Result<JsonNode> root = parse_json(text, file_name);
  if (!root) return root.errors();
  Script script;
  Problems problems(*root, file_name);
  FieldReader::read_record(*root, "", problems, script);
  check_steps(problems, script, tool_names);
  if (Errors errors = problems.errors(); !errors.empty()) return errors;
  return script;
}

std::string write_script(const Script& script) {
  Script copy = script;
  return FieldWriter::record_text(copy, 0) + "\n";
}

ScriptPlayer::ScriptPlayer(const Script& script, std::span<const Tool> tools, double tick) : tick_(tick) {
  std::int32_t tool = -1;
  Quat orientation;
  Vec3 hand;
  const auto go = [&](Vec3 to, double speed) {
    add_stretch(tool, orientation, hand, to, duration_of(hand, to, speed));
    hand = to;
  };
  for (const ScriptStep& step : script.steps) {
    if (step.take) {
      const auto it =
          std::find_if(tools.begin(), tools.end(), [&](const Tool& t) { return t.name == step.take->tool; });
      CTPM_CHECK(it != tools.end(), "the script was read with the scene's tools");
      tool = std::int32_t(it - tools.begin());
      orientation = orientation_of(step.take->pointing);
      if (step.take->facing) orientation = facing(orientation, *step.take->facing);
      hand = step.take->at;
      add_stretch(tool, orientation, hand, hand, tick_);
    }
    if (step.move) go(step.move->to, step.move->speed);
    if (step.press) go(hand + way_of(*step.press), step.press->speed);
    if (step.release) go(hand + way_of(*step.release), step.release->speed);
    if (step.cut)
      for (const Vec3& point : step.cut->path) go(point, step.cut->speed);
    if (step.wait) add_stretch(tool, orientation, hand, hand, *step.wait);
    if (step.put_away) {
      tool = -1;
      add_stretch(tool, {}, {}, {}, tick_);
    }
  }
}

void ScriptPlayer::add_stretch(std::int32_t tool, Quat orientation, Vec3 from, Vec3 to, double duration) {
  const std::int64_t count = std::max<std::int64_t>(1, std::llround(std::ceil(duration / tick_)));
  stretches_.push_back({tick_count(), count, tool, orientation, from, to});
}

std::int64_t ScriptPlayer::tick_count() const {
  return stretches_.empty() ? 0 : stretches_.back().first + stretches_.back().count;
}

Inputs ScriptPlayer::at(std::int64_t tick) const {
  Inputs inputs;
  if (stretches_.empty()) return inputs;
  const auto next = std::upper_bound(stretches_.begin(), stretches_.end(), tick,
                                     [](std::int64_t t, const Stretch& s) { return t < s.first; });
  const Stretch& stretch = next == stretches_.begin() ? *next : *(next - 1);
  const double share = std::clamp(double(tick - stretch.first + 1) / double(stretch.count), 0.0, 1.0);
  inputs.tool = stretch.tool;
  inputs.world_from_tool = stretch.world_from_tool;
  inputs.position = stretch.from + eased(share) * (stretch.to - stretch.from);
  return inputs;
}

}  // namespace ctpm
