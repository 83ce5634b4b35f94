#include "studio/commands/script_checks.h"

#include <algorithm>
#include <vector>

#include "core/model/box.h"
#include "studio/loading/standing.h"
#include "studio/output/files.h"

namespace ctpm::commands {
namespace {

constexpr const char* kRemedy = "its places are those of the scene, in mm";

/// The boxes in which the organs can be, however they sag.
std::vector<Box> boxes_of(const Model& model) {
  std::vector<Box> boxes;
  for (const OrganRange& organ : model.organs) {
    if (organ.count == 0) continue;
    Box box(Vec3(model.rest_position[std::size_t(organ.first)]));
    for (std::int32_t i = organ.first; i < organ.first + organ.count; ++i) box.add(model.rest_position[std::size_t(i)]);
    boxes.push_back(box.grown(organ.spacing + loading::kMostSag * norm(box.high - box.low)));
  }
  return boxes;
}

bool is_near(const Hand& hand, const Model& model, const std::vector<Box>& boxes) {
  if (hand.tool < 0) return false;
  const Tool& tool = model.tools[std::size_t(hand.tool)];
  if (tool.sphere >= 0) return true;  // a pin holds tissue
  const Box around = Box(hand.position).grown(std::max(tool.radius, tool.blade_length));
  return std::ranges::any_of(boxes, [&](const Box& box) { return box.meets(around); });
}

}  // namespace

Result<scenes::Script> read_script(const std::string& file, const loading::LoadedScene& scene) {
  const Result<std::string> text = output::read_text_file(file);
  if (!text) return text.errors();
  scenes::PlaceFinder finder = scenes::finder_of(scene.built.model, scene.scene.spec);
  return scenes::read_script_for(*text, file, scene.built.model, &finder);
}

Errors find_misses(const recordings::SessionStatistics& did, bool took_blade, const std::string& where) {
  if (!(did.max_force > 0)) return {{where, "never touches any tissue", kRemedy}};
  if (took_blade && did.severed == 0) return {{where, "takes up a scalpel but cuts nothing", kRemedy}};
  return {};
}

Errors find_far_script(const scenes::Script& script, const Model& model, const std::string& where) {
  if (std::ranges::none_of(script.steps, [](const scenes::ScriptStep& step) { return step.take.has_value(); }))
    return {};
  const std::vector<Box> boxes = boxes_of(model);
  const scenes::ScriptPlayer player(script, model.tools, model.tick);
  for (std::int64_t tick = 0; tick < player.tick_count(); ++tick) {
    const Inputs inputs = player.at(tick);
    if (is_near(inputs, model, boxes) || is_near(inputs.second, model, boxes)) return {};
  }
  return {{where, "no tool comes near any organ", kRemedy}};
}

}  // namespace ctpm::commands
