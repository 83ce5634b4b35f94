#pragma once

#include <functional>
#include <string>

#include "core/model/result.h"
#include "studio/authoring/fit_stiffness.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm::authoring {

/// The fit of one organ of a scene, as its author reads and keeps it.
struct SceneFit {
  std::string organ;  ///< its name
  StiffnessFit fit;
  bool is_of_table = false;  ///< the closed form is the paper's Table 1; otherwise the paper has no such material
  std::string text;          ///< of the scene with that fit; its comments and layout stay
};

/// Fits the stiffness of the organ of that name; of the first one if it is empty. Errors: the scene has no such organ;
/// those of fit_stiffness().
Result<SceneFit> fit_scene(const loading::LoadedScene& scene, const std::string& organ,
                           const std::function<bool()>& should_stop = {}, const FitProgress& progress = {});

}  // namespace ctpm::authoring
