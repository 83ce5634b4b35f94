#pragma once

#include <span>
#include <vector>

#include "core/model/organ.h"
#include "core/model/result.h"
#include "scenes/scene_spec.h"

namespace ctpm::authoring {

/// One depth of the paper's Table 1.
struct FitRow {
  double depth = 0;        ///< of the pressed sphere below its rest position [m]
  double force = 0;        ///< of the organ on the ball [N]
  double closed_form = 0;  ///< CTPM force of Table 1 [N]

  double error() const { return force / closed_form - 1; }  ///< [share]
};

/// The result of a fit.
struct StiffnessFit {
  double factor = 1;                 ///< to multiply every stiffness scale of the organ with [1], > 0
  double scale = 1;                  ///< stiffness scale of the organ's own material, factor included [1]
  scenes::FittedForSpec fitted_for;  ///< where and with what it was fitted; stored in the scene
  std::vector<FitRow> rows;          ///< at 2, 4, ... 12 mm, with the scale applied
};

/// Fits the stiffness scale of `organ` so that the force at 12 mm equals the CTPM force of the paper's Table 1 to 0.2
/// %. The ball of the calibration presses an outermost sphere near the top, without gravity and viscosity, and so
/// slowly that inertia is negligible. Force is nearly proportional to the scale: one run gives the scale, and up to
/// four more check and correct it. The other depths show the error of the curve's shape. Errors: those of
/// build_model(); no outermost sphere can move; none of the eight spheres tried can be pressed to 12 mm, because the
/// ball slips off or a run fails.
Result<StiffnessFit> fit_stiffness(const scenes::SceneSpec& scene, std::size_t organ, const FilledOrgan& filled);

/// Stores a fit in a scene's organ: its scale, and the contact point and ball for which it holds.
void apply_fit(scenes::OrganSpec& organ, const StiffnessFit& fit);

}  // namespace ctpm::authoring
