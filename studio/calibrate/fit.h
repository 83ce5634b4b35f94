#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/calibrate/experiment.h"

namespace ctpm::calibrate {

/// A modulus or another number that the data may tell.
struct Estimate {
  std::string key, title, unit;
  double value = 0;
  /// Factor by which the interval reaches from the value, up and down, with 95 % confidence; infinite: the data cannot
  /// tell it.
  double factor = std::numeric_limits<double>::infinity();
  bool is_at_bound = false;

  bool is_told() const { return factor < kMostFactor; }
  double low() const { return value / factor; }
  double high() const { return value * factor; }
  static constexpr double kMostFactor = 10;
};

/// How one measurement is met.
struct Match {
  const Measurement* measurement = nullptr;
  std::vector<double> simulated;  ///< (row_count)
  std::vector<bool> is_held_out;  ///< every fifth row: it judges the fit and takes no part in it (row_count)
};

struct Fit {
  Parameters parameters;
  scenes::MaterialSpec material;         ///< with all moduli; those that the data cannot tell are the start's
  std::vector<Estimate> estimates;       ///< P2, K1, K2, K', v1, P1
  std::vector<std::string> fitted;       ///< names of what was fitted
  std::vector<double> correlation;       ///< of their logarithms (fitted_count x fitted_count)
  std::vector<Match> matches;            ///< (measurement_count)
  double error = 0, held_out_error = 0;  ///< root mean square, of each measurement's own [share]; NaN: of no row
  int starts = 0, same_starts = 0;       ///< and how many of them ended at the same place
  std::size_t simulations = 0;
  std::optional<Vec3> block;  ///< spheres along x, y and z of the specimen that was pressed; none: the rig
};

struct FitRequest {
  scenes::MaterialSpec start;  ///< a preset, with the ball's radius if it is another
  int starts = 5;              ///< >= 1; the first is `start`, scaled to the data
  int threads = 1;             ///< >= 1; results do not depend on it
  std::function<bool()> should_stop;
  std::function<void(std::size_t simulations)> progress;  ///< called by one thread at a time
};

/// Fits the moduli of a material so that the network does what was measured: bounded least squares on their logarithms,
/// from several starts. `tissue`: what is pressed, as simulate() takes it. Slow indentation alone cannot tell K1 from
/// K2 nor any time; those keep the start's values. Intervals are linear in the logarithms, with Student's t.
/// `measurements` must outlive the result. Errors: nothing to fit; no start can be simulated; it was stopped.
Result<Fit> fit_material(const loading::LoadedScene& tissue, const std::vector<Measurement>& measurements,
                         const FitRequest& request);

/// How far the network with a material is from measurements: root mean square of all rows, in shares of each
/// measurement's own. None if a run is refused.
std::optional<double> error_of(const loading::LoadedScene& tissue, const scenes::MaterialSpec& material,
                               const std::vector<Measurement>& measurements);

}  // namespace ctpm::calibrate
