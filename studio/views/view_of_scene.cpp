#include "studio/views/view_of_scene.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "scenes/presets.h"
#include "studio/output/number_text.h"

namespace ctpm::views {
namespace {

struct NamedColour {
  const char* name;
  render::Colour colour;
};
/// Far from each other, also for the colour-blind (Wong, "Points of view: Color blindness", Nat. Methods 8, 2011).
constexpr NamedColour kMaterials[] = {{"orange", {0.90, 0.62, 0.00}},    {"blue", {0.00, 0.45, 0.70}},
                                      {"green", {0.00, 0.62, 0.45}},     {"yellow", {0.94, 0.89, 0.26}},
                                      {"purple", {0.80, 0.47, 0.65}},    {"light blue", {0.34, 0.71, 0.91}},
                                      {"vermilion", {0.84, 0.37, 0.00}}, {"grey", {0.60, 0.60, 0.60}}};

/// Tissues where they are cut, by the organ of their preset.
constexpr NamedColour kTissues[] = {{"liver", {0.43, 0.07, 0.06}},  {"kidney", {0.56, 0.12, 0.11}},
                                    {"skin", {0.90, 0.66, 0.58}},   {"fat", {0.93, 0.76, 0.36}},
                                    {"muscle", {0.52, 0.13, 0.13}}, {"spleen", {0.40, 0.08, 0.14}}};

std::string_view organ_of(const scenes::MaterialSpec& material) {
  const scenes::MaterialPreset* preset = scenes::find_preset(material.preset);
  return preset ? preset->organ : std::string_view();
}

/// Whether tissues differ in more than the tension that they are under, which nobody sees.
bool looks_alike(scenes::MaterialSpec a, scenes::MaterialSpec b) {
  for (scenes::MaterialSpec* material : {&a, &b}) material->prestrain.reset(), material->fitted_for.reset();
  return a == b;
}

/// The material below a layer.
const scenes::MaterialSpec& material_below(const scenes::OrganSpec& organ, std::size_t layer) {
  return layer + 1 < organ.layers.size() ? organ.layers[layer + 1].material : organ.material;
}

/// A layer of the tissue below it, or of none that has a colour, is pale as a capsule is.
render::Colour colour_of_layer(const scenes::OrganSpec& organ, std::size_t layer) {
  const std::string_view tissue = organ_of(organ.layers[layer].material);
  if (tissue != organ_of(material_below(organ, layer)))
    for (const auto& [name, colour] : kTissues)
      if (tissue == name) return colour;
  constexpr double kPale = 0.25;
  const auto paler = [](double inner) { return inner + kPale * (0.95 - inner); };
  return {paler(organ.inner_color.x), paler(organ.inner_color.y), paler(organ.inner_color.z)};
}

/// What an organ of one tissue shows where it is cut, as it does in a body: for pictures alone. The inside is the
/// scene's.
std::vector<render::LayerLook> anatomy_of(const std::string& organ) {
  const auto is = [&](std::string_view word) { return organ.find(word) != std::string::npos; };
  if (is("kidney")) return {{0.0006, {0.82, 0.58, 0.50}}, {0.0075, {0.74, 0.42, 0.36}}};  // capsule, cortex; medulla
  if (is("liver")) return {{0.0006, {0.70, 0.46, 0.40}}};                                 // capsule; parenchyma
  if (is("skin")) return {{0.0009, {0.72, 0.48, 0.38}}, {0.004, {0.90, 0.64, 0.58}}};     // epidermis, dermis; fat
  return {};
}

std::string name_of(const scenes::MaterialSpec& material) {
  return material.preset.empty() ? "a material of its own" : material.preset;
}

}  // namespace

render::SceneView view_of(const scenes::SceneSpec& scene, const Model& model) {
  render::SceneView view;
  view.model = &model;
  for (const scenes::OrganSpec& organ : scene.organs) {
    render::OrganLook look = render::look_of(organ.name);
    look.name = organ.name;
    look.outer = {organ.surface_color.x, organ.surface_color.y, organ.surface_color.z};
    look.inner = {organ.inner_color.x, organ.inner_color.y, organ.inner_color.z};
    for (std::size_t layer = 0; layer < organ.layers.size(); ++layer)
      if (!looks_alike(organ.layers[layer].material, material_below(organ, layer)))
        look.layers.push_back({organ.layers[layer].to_depth, colour_of_layer(organ, layer)});
    if (look.layers.empty()) look.layers = anatomy_of(organ.name);
    view.looks.push_back(look);
  }
  return view;
}

std::vector<OrganTissues> tissues_of(const scenes::SceneSpec& scene, std::span<const FilledOrgan> organs) {
  std::vector<OrganTissues> all;
  std::size_t colours = 0;
  for (std::size_t o = 0; o < organs.size(); ++o) {
    const scenes::OrganSpec& organ = scene.organs[o];
    OrganTissues tissues;
    const auto add = [&](const scenes::MaterialSpec& material, const std::string& where) {
      const NamedColour& own = kMaterials[colours++ % std::size(kMaterials)];
      tissues.tissue.push_back({name_of(material) + where, std::string(own.name), own.colour});
    };
    for (const scenes::LayerSpec& layer : organ.layers)
      add(layer.material, " down to " + output::short_number(1e3 * layer.to_depth) + " mm");
    add(organ.material, organ.layers.empty() ? "" : " below");
    for (const double depth : organs[o].depth) {
      const auto layer = std::find_if(organ.layers.begin(), organ.layers.end(),
                                      [&](const scenes::LayerSpec& l) { return l.to_depth > depth; });
      tissues.of_sphere.push_back(std::int32_t(layer - organ.layers.begin()));
      ++tissues.tissue[std::size_t(tissues.of_sphere.back())].spheres;
    }
    all.push_back(std::move(tissues));
  }
  return all;
}

std::vector<std::string> colour_by_material(const scenes::SceneSpec& scene, std::span<const FilledOrgan> organs,
                                            render::SceneView& view) {
  std::vector<std::string> legend;
  view.sphere_colours.clear();
  const std::vector<OrganTissues> tissues = tissues_of(scene, organs);
  for (std::size_t o = 0; o < tissues.size(); ++o) {
    for (const TissueOfOrgan& tissue : tissues[o].tissue)
      legend.push_back(tissue.colour_name + ": " + scene.organs[o].name + ", " + tissue.text);
    for (const std::int32_t tissue : tissues[o].of_sphere)
      view.sphere_colours.push_back(tissues[o].tissue[std::size_t(tissue)].colour);
  }
  return legend;
}

}  // namespace ctpm::views
