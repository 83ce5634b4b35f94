#include "studio/calibrate/block.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "scenes/presets.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"

namespace ctpm::calibrate {
namespace {

constexpr std::size_t kMostSpheres = 3000;  ///< of a block; more take minutes

std::string count_text(Vec3 count) {
  return std::to_string(int(count.x)) + " x " + std::to_string(int(count.y)) + " x " + std::to_string(int(count.z));
}

}  // namespace

Result<loading::LoadedScene> make_block(const std::string& scenes, const scenes::MaterialSpec& material, Vec3 size,
                                        std::optional<double> sphere_radius) {
  const scenes::MaterialPreset* preset = scenes::find_preset(material.preset);
  CTPM_CHECK(preset != nullptr, "the preset is known");
  scenes::FillSpec fill;
  fill.radius = fill.gap = sphere_radius ? 1e-3 * *sphere_radius : preset->sphere_radius;
  const double spacing = 1e3 * fill.spacing();
  const auto odd = [&](double side) { return 2 * std::round((side / spacing - 1) / 2) + 1; };
  const Vec3 count{odd(size.x), odd(size.y), std::round(size.z / spacing) + 1};
  const auto refused = [&](const std::string& why, const std::string& hint) {
    return Error{output::option_name("calibrate.specimen_mm"),
                 "spheres of " + output::short_number(1e3 * fill.radius) + " mm make a block of " + count_text(count) +
                     ": " + why,
                 hint};
  };
  // The constraint acts on five spheres in a line.
  if (std::min(count.x, count.y) < 5 || count.z < 3)
    return refused("at least 5 x 5 x 3 are needed",
                   output::option_name("calibrate.sphere_radius_mm") + " makes them smaller");
  if (count.x * count.y * count.z > double(kMostSpheres))
    return refused("at most " + std::to_string(kMostSpheres) + " spheres are fitted",
                   output::option_name("calibrate.sphere_radius_mm") + " makes them larger");
  return loading::load_whole_scene(scenes + "/paper/block-liver.json", {}, [&](scenes::SceneSpec& scene) {
    const Vec3 top{0, 0, (count.z - 1) * fill.spacing()};
    scene.organs[0].rig->block = count, scene.organs[0].fill = fill, scene.organs[0].material = material;
    scenes::ToolSpec pin;
    pin.name = "pin", pin.kind = ToolKind::pin, pin.holds = top;
    scene.tools = {pin}, scene.loads.clear(), scene.probes[0].at = top;
    scene.solver.substeps.reset(), scene.solver.max_iterations = 2000;
  });
}

}  // namespace ctpm::calibrate
