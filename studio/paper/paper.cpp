#include "studio/paper/paper.h"

#include <algorithm>
#include <iterator>

#include "core/model/errors.h"

namespace ctpm::paper {
namespace {

/// The parts of a scene that an experiment requires.
struct Need {
  const char* name;
  std::size_t cells, loads, probes, tools;
};
constexpr Need kNeeds[] = {{"paper/rig-skin.json", 7, 0, 0, 1},
                           {"paper/rig-kidney.json", 7, 0, 0, 1},
                           {"paper/rig-liver.json", 7, 0, 0, 1},
                           {"paper/creep-liver.json", 7, 1, 1, 0},
                           {"paper/block-liver.json", 0, 1, 1, 1},
                           {"paper/convergence-liver.json", 0, 0, 0, 0},
                           {"liver.json", 0, 0, 0, 1},
                           {"incision.json", 0, 0, 4, 1}};

}  // namespace

Result<loading::LoadedScene> load_experiment(const std::string& scenes, const std::string& name) {
  Result<loading::LoadedScene> scene = loading::load_whole_scene(scenes + "/" + name);
  if (!scene) return scene;
  const auto need = std::find_if(std::begin(kNeeds), std::end(kNeeds), [&](const Need& n) { return n.name == name; });
  CTPM_CHECK(need != std::end(kNeeds), "every experiment says what it needs");
  const scenes::SceneSpec& spec = scene->scene.spec;
  Errors errors;
  const std::size_t cells = spec.organs[0].rig ? spec.organs[0].rig->cells.size() : 0;
  if (cells < need->cells)
    errors.push_back(scene->scene.places.error_at(
        "/organs/0/rig/cells",
        "got " + std::to_string(cells) + " spheres, the rig of Fig. 3 has 7: A to E on a line, and two below C"));
  const auto check = [&](const char* key, std::size_t got, std::size_t wanted) {
    if (got < wanted)
      errors.push_back(scene->scene.places.error_at(std::string("/") + key, "the experiment needs one"));
  };
  check("loads", spec.loads.size(), need->loads), check("probes", spec.probes.size(), need->probes),
      check("tools", spec.tools.size(), need->tools);
  if (!errors.empty()) return errors;
  return scene;
}

Errors check_experiments(const std::string& scenes) {
  Errors errors;
  for (const Need& need : kNeeds) append(errors, load_experiment(scenes, need.name));
  return errors;
}

}  // namespace ctpm::paper
