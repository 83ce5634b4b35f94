#pragma once

#include <cmath>

#include "core/model/organ.h"
#include "core/model/state.h"
#include "studio/loading/loaded_scene.h"
#include "studio/render/camera.h"
#include "studio/reports/report.h"

namespace ctpm::paper {

/// Gives a block of spheres a closed box as its surface, bound to them, so that it can be drawn as tissue. `steps`:
/// squares along each spacing.
void add_box_surface(FilledOrgan& block, int steps);

/// A State and how to draw it.
struct PaperShot {
  State state = {};
  std::string caption = {};
  bool is_inside = false;  ///< draws the spheres instead of the surface
  bool show_tool = false;
  double exaggeration = 1;    ///< factor on displacements from rest
  double from_y = -INFINITY;  ///< spheres with a smaller rest y are left out [m]; for `is_inside` only
};

/// Draws several States of one Model with one camera. Errors: those of the renderer.
Result<std::vector<reports::Picture>> draw_shots(const scenes::SceneSpec& scene, const std::vector<FilledOrgan>& organs,
                                                 const Model& model, const render::Camera& camera,
                                                 const std::vector<PaperShot>& shots);

}  // namespace ctpm::paper
