#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/model/organ.h"
#include "core/model/result.h"
#include "scenes/scene_spec.h"

namespace ctpm::authoring {

/// One depth of the paper's Table 1.
struct FitRow {
  double depth = 0;        ///< of the ball below first contact [m]
  double force = 0;        ///< of the organ on the ball, mean over the places [N]
  double scatter = 0;      ///< standard deviation over the places, relative to the mean [share]
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

/// Gets the presses that are done, and the most that there may be.
using FitProgress = std::function<void(std::int64_t done, std::int64_t most)>;

/// Fits the stiffness scale of `organ` so that the mean force at 12 mm equals the CTPM force of the paper's Table 1 to
/// 0.2 %. The ball of the calibration presses the top of the surface at nine places over one lattice cell, without
/// gravity and viscosity, and so slowly that inertia is negligible; in a rig, it presses the highest sphere that can
/// move. Force is nearly proportional to the scale: one round gives the scale, and up to four more check and correct
/// it. The other depths show the error of the curve's shape. Errors: those of build_model(); nothing at the top can
/// move; the ball loses the organ before 12 mm; a run fails; `should_stop`, if given, ended it.
Result<StiffnessFit> fit_stiffness(const scenes::SceneSpec& scene, std::size_t organ, const FilledOrgan& filled,
                                   const std::function<bool()>& should_stop = {}, const FitProgress& progress = {});

/// Stores a fit in a scene's organ: its scale, and the contact point and ball for which it holds.
void apply_fit(scenes::OrganSpec& organ, const StiffnessFit& fit);

}  // namespace ctpm::authoring
