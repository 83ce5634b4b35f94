#include "studio/authoring/fit_scene.h"

#include "scenes/presets.h"
#include "scenes/scene_file.h"
#include "studio/output/option_name.h"

namespace ctpm::authoring {
namespace {

/// Index of the organ of that name; of the first if the name is empty.
Result<std::size_t> find_organ(const loading::LoadedScene& scene, const std::string& name) {
  std::string known;
  for (std::size_t i = 0; i < scene.scene.spec.organs.size(); ++i) {
    const std::string& own = scene.scene.spec.organs[i].name;
    if (name.empty() || own == name) return i;
    known += (known.empty() ? "" : ", ") + own;
  }
  return Error{output::option_name("fit.organ"), "the scene has no organ '" + name + "'", "it has: " + known};
}

/// Whether the paper's Table 1 has the forces of a material.
bool is_of_table(const scenes::MaterialSpec& material) {
  const scenes::MaterialPreset* preset = scenes::find_preset(material.preset);
  return preset && preset->is_of_paper && !material.spring && !material.kelvin && !material.constraint;
}

}  // namespace

Result<SceneFit> fit_scene(const loading::LoadedScene& scene, const std::string& organ,
                           const std::function<bool()>& should_stop, const FitProgress& progress) {
  const Result<std::size_t> index = find_organ(scene, organ);
  if (!index) return index.errors();
  scenes::SceneSpec spec = scene.scene.spec;
  const Result<StiffnessFit> fit = fit_stiffness(spec, *index, scene.organs[*index], should_stop, progress);
  if (!fit) {
    Errors errors = fit.errors();
    for (Error& error : errors) error.where = scene.path + ": " + error.where;
    return errors;
  }
  scenes::OrganSpec& fitted = spec.organs[*index];
  apply_fit(fitted, *fit);
  return SceneFit{fitted.name, *fit, is_of_table(fitted.material),
                  scenes::rewrite_scene(scene.scene.text, scene.scene.spec, spec)};
}

}  // namespace ctpm::authoring
