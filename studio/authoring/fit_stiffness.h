#pragma once

#include <span>
#include <vector>

#include "core/model/organ.h"
#include "core/model/result.h"
#include "scenes/scene_spec.h"

namespace ctpm {

/// One depth of the paper's Table 1.
struct FitRow {
  double depth = 0;        ///< of the pressed sphere below its rest [m]
  double force = 0;        ///< of the organ on the ball [N]
  double closed_form = 0;  ///< CTPM force of Table 1 [N]

  double error() const { return force / closed_form - 1; }  ///< [share]
};

/// What a fit came to.
struct StiffnessFit {
  double factor = 1;         ///< by which every stiffness scale of the organ must be multiplied
  double scale = 1;          ///< the organ's own stiffness scale after that
  FittedForSpec fitted_for;  ///< where and with what it was fitted; stored in the scene
  std::vector<FitRow> rows;  ///< at 2, 4, ... 12 mm, with the scale applied
};

/// Fits the stiffness scale of `organ`: the ball of its calibration presses an outermost sphere near the
/// organ's top that lies among neighbours, along the line through its centre, so slowly that only the forces
/// at rest count (no gravity, no viscosity), until the sphere is 12 mm deep. There the force must be the CTPM
/// force of the paper's Table 1. Force is proportional to the scale, so one run gives it and a second one
/// checks it; the other depths show the error of the shape. Errors: nothing at the top can move; the ball
/// slips off every sphere that was tried; a run that diverged.
Result<StiffnessFit> fit_stiffness(const SceneSpec& scene, std::size_t organ, const FilledOrgan& filled);

/// Stores a fit in the scene: the scale, and what it was fitted for.
void apply_fit(OrganSpec& organ, const StiffnessFit& fit);

}  // namespace ctpm
