#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "core/parallel/team.h"
#include "studio/calibrate/fit.h"

// The problem behind a fit: the network against measurements, as a function of four logarithms.
namespace ctpm::calibrate {

constexpr std::size_t kAll = 4;
/// Bounds of the parameters, in the units and the order of Parameters. K' may not be less than P2, whatever is rounded.
constexpr double kLeast[kAll] = {1e-3, 1 + 1e-6, 1e-3, 1e-3}, kMost[kAll] = {1e5, 1e5, 1e3, 1e4};

using Logs = std::array<double, kAll>;
Logs logs_of(const Parameters& parameters);
Parameters parameters_at(const Logs& logs);

double root_mean_square(const std::vector<double>& values);
/// Of what was measured, in its unit.
double scale_of(const Measurement& measurement);
/// Every fifth row is held out.
bool is_held_out(std::size_t row);

/// All measurements against the network, as residuals in shares of each measurement's root mean square. Several threads
/// may ask it at once.
class Data {
 public:
  Data(const loading::LoadedScene& rig, const std::vector<Measurement>& measurements, const FitRequest& request);

  std::size_t count() const;  ///< of the rows that take part
  std::optional<std::vector<double>> run(const Logs& logs, std::size_t measurement);
  /// Residuals of the rows that take part; none if a run is refused or it was stopped.
  std::optional<std::vector<double>> residuals(const Logs& logs);

  std::size_t simulations = 0;

 private:
  const loading::LoadedScene& rig_;
  const std::vector<Measurement>& measurements_;
  const FitRequest& request_;
  std::mutex counting_;
  std::vector<double> scales_;  ///< (measurement_count)
};

struct Solution {
  Logs logs{};
  double cost = 0;         ///< half the sum of the squares of the residuals
  Eigen::MatrixXd slopes;  ///< (residual_count x free_count)
};

/// Bounded least squares from one start for those of the four that are free, until the cost changes by less than a
/// share; none if its runs are refused.
std::optional<Solution> solve(Data& data, const Logs& start, const std::vector<std::size_t>& free, double tolerance,
                              parallel::Team& team);

}  // namespace ctpm::calibrate
