#pragma once

#include <string>
#include <vector>

#include "studio/calibrate/fit.h"

namespace ctpm::calibrate {

/// One specimen beside the others.
struct SpecimenFit {
  std::string name;
  std::vector<Estimate>
      estimates{};            ///< of its own measurements alone, in the order of Fit::estimates; empty: `problem`
  double error = 0;           ///< of that fit, on its rows [share]
  double left_out_error = 0;  ///< of a fit of all others, on all rows of this one [share]; NaN: `problem`
  std::string problem{};      ///< why there is no such fit
};

/// What the specimens tell of a modulus: those that tell it.
struct SpecimenSpread {
  std::size_t count = 0;
  double mean = 0;       ///< geometric
  double deviation = 0;  ///< standard deviation of the logarithms (count - 1) [share]; 0 of fewer than two
};

/// Names of the specimens, in the order of the measurements.
std::vector<std::string> specimens_of(const std::vector<Measurement>& measurements);

/// Fits each specimen alone, and all others without it, from the material of `whole`, the fit of them all; empty for a
/// single specimen. What a specimen cannot be fitted for is in its `problem`. Error: it was stopped.
Result<std::vector<SpecimenFit>> fit_specimens(const loading::LoadedScene& tissue,
                                               const std::vector<Measurement>& measurements, const Fit& whole,
                                               const FitRequest& request);

/// Of one of Fit::estimates, by its place.
SpecimenSpread spread_of(const std::vector<SpecimenFit>& specimens, std::size_t estimate);

}  // namespace ctpm::calibrate
