#include "studio/authoring/scene_parts.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "scenes/presets.h"
#include "studio/output/printable.h"
#include "studio/render/scene_view.h"

namespace ctpm::authoring {
namespace {

struct Box {
  Vec3 least{INFINITY, INFINITY, INFINITY}, most{-INFINITY, -INFINITY, -INFINITY};
};

Box box_of(std::span<const FilledOrgan> organs) {
  Box box;
  for (const FilledOrgan& organ : organs)
    for (const Vec3& p : organ.surface.vertex) {
      box.least = {std::min(box.least.x, p.x), std::min(box.least.y, p.y), std::min(box.least.z, p.z)};
      box.most = {std::max(box.most.x, p.x), std::max(box.most.y, p.y), std::max(box.most.z, p.z)};
    }
  return box;
}

/// Up to the next of 1, 1.5, 2, 2.5 ... in the place of the second digit.
double rounded_up(double length) {
  const double step = 0.5 * std::pow(10.0, std::floor(std::log10(length)));
  return whole_nanometres(std::ceil(length / step - 1e-9) * step);
}

/// To a millimetre, or to a tenth of one near something small: the number that an author would write.
Vec3 rounded(Vec3 p, double size) {
  const double steps = size > 0.02 ? 1e3 : 1e4;  // of a metre
  return {std::round(p.x * steps) / steps, std::round(p.y * steps) / steps, std::round(p.z * steps) / steps};
}

}  // namespace

scenes::OrganSpec organ_spec(const std::string& name, const std::string& mesh, const Tissue& tissue,
                             const FilledOrgan& filled, std::optional<Vec3> colour) {
  scenes::OrganSpec spec;
  spec.name = name, spec.mesh = mesh;
  spec.fill.radius = filled.sphere_radius;
  spec.fill.gap = whole_nanometres(filled.spacing - 2 * filled.sphere_radius);
  spec.material = tissue.material;
  spec.damage_depth = tissue.preset->damage_depth;
  const render::OrganLook look = render::look_of(tissue.preset->organ);
  const Vec3 outer = colour.value_or(Vec3{look.outer[0], look.outer[1], look.outer[2]});
  const auto rounded = [](double part) { return std::round(1e3 * part) / 1e3; };
  spec.surface_color = {rounded(outer.x), rounded(outer.y), rounded(outer.z)};
  spec.inner_color = {look.inner[0], look.inner[1], look.inner[2]};
  return spec;
}

std::vector<scenes::ToolSpec> tools_for(std::span<const FilledOrgan> organs) {
  // A ball of 2.5 sphere radii of the coarsest organ; a blade of 0.7 of the tallest organ's height, but that of a
  // scalpel at least, 40 mm, and as long as its key allows at most.
  constexpr double kShortest = 0.04, kLongest = 0.5, kLargestBall = 0.2;
  double radius = 0, height = 0;
  for (const FilledOrgan& organ : organs) {
    const Box box = box_of({&organ, 1});
    radius = std::max(radius, organ.sphere_radius), height = std::max(height, box.most.z - box.least.z);
  }
  scenes::ToolSpec ball, scalpel;
  ball.name = "ball", ball.kind = ToolKind::ball,
  ball.radius = std::min(kLargestBall, std::round(2.5e6 * radius) / 1e6);
  scalpel.name = "scalpel", scalpel.kind = ToolKind::scalpel;
  scalpel.blade_length = std::clamp(rounded_up(0.7 * height), kShortest, kLongest);
  return {ball, scalpel};
}

scenes::CameraSpec front_camera(const std::vector<FilledOrgan>& organs) {
  const Box box = box_of(organs);
  const double size = norm(box.most - box.least);
  scenes::CameraSpec camera;
  camera.name = "front";
  // The organ is right of the centre, clear of the panels on the left.
  camera.target = rounded(0.5 * (box.least + box.most) + size * Vec3{-0.13, 0, 0}, size);
  camera.eye = rounded(camera.target + size * Vec3{0.05, -1.25, 0.95}, size);
  camera.field_of_view = 32;
  return camera;
}

Vec3 place_beside(const std::vector<FilledOrgan>& present, const std::vector<FilledOrgan>& added) {
  constexpr double kGap = 0.1;  // of the size of what is added
  const Box old = box_of(present), own = box_of(added);
  const double size = norm(own.most - own.least), y = 0.5 * (old.least.y + old.most.y - own.least.y - own.most.y);
  const Vec3 place{old.most.x + kGap * size - own.least.x, y, old.least.z - own.least.z};
  return rounded(place, size);
}

double overlap(const FilledOrgan& organ, const FilledOrgan& other) {
  const double reach = 0.5 * other.spacing;
  const Box box = box_of({&other, 1});
  const auto is_in_box = [&](Vec3 p) {
    return p.x > box.least.x && p.y > box.least.y && p.z > box.least.z && p.x < box.most.x && p.y < box.most.y &&
           p.z < box.most.z;
  };
  // Within a lattice cell of its own around a sphere, which is in the tissue.
  const auto is_near = [&](Vec3 p, Vec3 centre) {
    return std::abs(p.x - centre.x) <= reach && std::abs(p.y - centre.y) <= reach && std::abs(p.z - centre.z) <= reach;
  };
  std::size_t within = 0;
  for (const Vec3& p : organ.centre)
    within += is_in_box(p) &&
              std::any_of(other.centre.begin(), other.centre.end(), [&](Vec3 centre) { return is_near(p, centre); });
  return organ.centre.empty() ? 0 : double(within) / double(organ.centre.size());
}

double whole_nanometres(double length) { return std::round(1e9 * length) / 1e9; }

Result<std::string> stem_of_scene(const std::string& path) {
  const std::string stem = std::filesystem::path(path).stem().string();
  if (!path.ends_with(".json")) return Error{path, "a scene's name must end in .json", ""};
  if (output::printable(stem) != stem)
    return Error{path, "a scene's name must be UTF-8, without line breaks and other control characters", ""};
  return stem;
}

std::vector<std::string> files_of_import(const std::string& scene) {
  const auto beside = [&](const char* ending) {
    return std::filesystem::path(scene).replace_extension(ending).string();
  };
  return {beside(".obj"), scene, beside(".script.json")};
}

std::string file_name_of(const std::string& name) {
  std::string safe;
  for (const char c : name) safe += std::isalnum((unsigned char)c) || c == '-' || c == '_' ? c : '-';
  return safe.substr(0, 60);
}

std::string name_alone(const std::string& tissue, const std::string& other) {
  return tissue.empty() || tissue == scenes::kGenericPreset ? other : file_name_of(tissue);
}

std::string free_name(std::string name, const std::vector<std::string>& taken) {
  if (name.empty()) name = "organ";
  const auto is_taken = [&](const std::string& text) {
    return std::find(taken.begin(), taken.end(), text) != taken.end();
  };
  if (!is_taken(name)) return name;
  for (int number = 2;; ++number)
    if (const std::string next = name + "-" + std::to_string(number); !is_taken(next)) return next;
}

namespace {

void rename_tool(scenes::Script& script, const std::string& from, const std::string& to) {
  for (scenes::ScriptStep& step : script.steps)
    if (step.take && step.take->tool == from) step.take->tool = to;
}

}  // namespace

void name_tools(scenes::Script& script, std::vector<scenes::ToolSpec> tools, scenes::SceneSpec& scene) {
  for (scenes::ToolSpec& tool : tools) {
    const auto own = std::find_if(scene.tools.begin(), scene.tools.end(),
                                  [&](const scenes::ToolSpec& t) { return t.kind == tool.kind; });
    if (own == scene.tools.end()) {
      std::vector<std::string> taken;
      for (const scenes::ToolSpec& t : scene.tools) taken.push_back(t.name);
      const std::string old = tool.name;
      tool.name = free_name(tool.name, taken);
      rename_tool(script, old, tool.name);
      scene.tools.push_back(tool);
    } else {
      rename_tool(script, tool.name, own->name);
    }
  }
}

}  // namespace ctpm::authoring
