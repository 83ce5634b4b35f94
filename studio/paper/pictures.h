#pragma once

#include <cmath>

#include "core/model/organ.h"
#include "core/model/state.h"
#include "studio/loading/loaded_scene.h"
#include "studio/render/camera.h"
#include "studio/reports/report.h"

namespace ctpm::paper {

/// A closed box around a block of spheres as its surface, bound to them, so that a block can be drawn as
/// tissue. `steps` squares along each spacing.
void add_box_surface(FilledOrgan& block, int steps);

/// What is drawn of a state.
struct PaperShot {
  State state = {};
  std::string caption = {};
  bool is_inside = false;  ///< the spheres instead of the surface
  bool show_tool = false;
  double exaggeration = 1;    ///< displacements from rest are drawn so many times as large
  double from_y = -INFINITY;  ///< spheres that rest before this y are left out [m]; for the inside only
};

/// Pictures of several states of one Model, all through one camera. Errors: those of the renderer.
Result<std::vector<reports::Picture>> draw_shots(const scenes::SceneSpec& scene, const std::vector<FilledOrgan>& organs,
                                                 const Model& model, const render::Camera& camera,
                                                 const std::vector<PaperShot>& shots);

}  // namespace ctpm::paper
