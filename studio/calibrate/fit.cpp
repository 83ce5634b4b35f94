#include "studio/calibrate/fit.h"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace ctpm::calibrate {
namespace {

constexpr std::size_t kAll = 4;
constexpr const char* kNames[kAll] = {"P2", "K'/P2", "K1/K2", "P1"};
/// Bounds of the parameters, in the units of Parameters. K' may not be less than P2, whatever is rounded.
constexpr double kLeast[kAll] = {1e-3, 1 + 1e-6, 1e-3, 1e-3}, kMost[kAll] = {1e5, 1e5, 1e3, 1e4};
/// Within which starts lie, as factors of the first one.
constexpr double kStartFactor = 10;
constexpr std::size_t kHeldOut = 5;  ///< every fifth row
constexpr double kStep = 1e-4;       ///< of a logarithm, for differences

using Logs = std::array<double, kAll>;

Logs logs_of(const Parameters& p) {
  return {std::log(p.slow), std::log(p.constraint), std::log(p.ratio), std::log(p.time)};
}
Parameters parameters_at(const Logs& logs) {
  return {std::exp(logs[0]), std::exp(logs[1]), std::exp(logs[2]), std::exp(logs[3])};
}

/// All measurements against the network, as residuals in shares of each measurement's root mean square.
class Data {
 public:
  Data(const loading::LoadedScene& rig, const std::vector<Measurement>& measurements, const FitRequest& request)
      : rig_(rig), measurements_(measurements), request_(request) {
    for (const Measurement& one : measurements) {
      double squares = 0;
      for (const Row& row : one.rows) squares += row.measured * row.measured;
      scales_.push_back(std::sqrt(squares / double(one.rows.size())));
    }
  }

  static bool is_held_out(std::size_t row) { return row % kHeldOut == kHeldOut - 1; }

  std::size_t count(bool held_out) const {
    std::size_t count = 0;
    for (const Measurement& one : measurements_)
      for (std::size_t i = 0; i < one.rows.size(); ++i) count += is_held_out(i) == held_out;
    return count;
  }

  std::optional<std::vector<double>> run(const Logs& logs, std::size_t measurement) {
    ++simulations;
    if (request_.progress) request_.progress(simulations);
    return simulate(rig_, with_moduli(request_.start, parameters_at(logs)), measurements_[measurement]);
  }

  /// Residuals of the rows that take part, or of those that are held out; none if a run is refused.
  std::optional<std::vector<double>> residuals(const Logs& logs, bool held_out = false) {
    std::vector<double> all;
    for (std::size_t m = 0; m < measurements_.size(); ++m) {
      if (request_.should_stop && request_.should_stop()) return std::nullopt;
      const auto simulated = run(logs, m);
      if (!simulated) return std::nullopt;
      for (std::size_t i = 0; i < simulated->size(); ++i)
        if (is_held_out(i) == held_out)
          all.push_back(((*simulated)[i] - measurements_[m].rows[i].measured) / scales_[m]);
    }
    return all;
  }

  std::size_t simulations = 0;

 private:
  const loading::LoadedScene& rig_;
  const std::vector<Measurement>& measurements_;
  const FitRequest& request_;
  std::vector<double> scales_;  ///< (measurement_count)
};

/// The residuals for Ceres, with differences to one side for their slopes.
class Cost : public ceres::CostFunction {
 public:
  Cost(Data& data, const Logs& start, const std::vector<std::size_t>& free) : data_(data), start_(start), free_(free) {
    set_num_residuals(int(data.count(false)));
    mutable_parameter_block_sizes()->push_back(int(free.size()));
  }
  Logs at(const double* values) const {
    Logs logs = start_;
    for (std::size_t i = 0; i < free_.size(); ++i) logs[free_[i]] = values[i];
    return logs;
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Logs logs = at(parameters[0]);
    const auto here = data_.residuals(logs);
    if (!here) return false;
    std::copy(here->begin(), here->end(), residuals);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      Logs beside = logs;
      // Away from the upper bound, where a run may be refused beyond it.
      const double step = beside[free_[k]] + kStep > std::log(kMost[free_[k]]) ? -kStep : kStep;
      beside[free_[k]] += step;
      const auto there = data_.residuals(beside);
      if (!there) return false;
      for (std::size_t i = 0; i < here->size(); ++i)
        jacobians[0][i * free_.size() + k] = ((*there)[i] - (*here)[i]) / step;
    }
    return true;
  }

 private:
  Data& data_;
  const Logs start_;
  const std::vector<std::size_t>& free_;
};

struct Solution {
  Logs logs{};
  double cost = 0;
  Eigen::MatrixXd slopes;  ///< (residual_count x free_count)
};

/// Bounded least squares from one start, until the cost changes by less than a share; none if its runs are refused.
std::optional<Solution> solve(Data& data, const Logs& start, const std::vector<std::size_t>& free, double tolerance) {
  std::vector<double> values;
  for (const std::size_t k : free) values.push_back(std::clamp(start[k], std::log(kLeast[k]), std::log(kMost[k])));
  Logs within = start;
  for (std::size_t i = 0; i < free.size(); ++i) within[free[i]] = values[i];
  if (!data.residuals(within)) return std::nullopt;
  ceres::Problem problem;
  auto* cost = new Cost(data, start, free);
  problem.AddResidualBlock(cost, nullptr, values.data());
  for (std::size_t i = 0; i < free.size(); ++i) {
    problem.SetParameterLowerBound(values.data(), int(i), std::log(kLeast[free[i]]));
    problem.SetParameterUpperBound(values.data(), int(i), std::log(kMost[free[i]]));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 40;
  options.function_tolerance = tolerance, options.parameter_tolerance = 1e-6;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;
  Solution solution;
  solution.logs = cost->at(values.data()), solution.cost = summary.final_cost;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> slopes(cost->num_residuals(),
                                                                                Eigen::Index(free.size()));
  std::vector<double> residuals(std::size_t(cost->num_residuals()));
  const double* blocks[] = {values.data()};
  double* jacobians[] = {slopes.data()};
  if (!cost->Evaluate(blocks, residuals.data(), jacobians)) return std::nullopt;
  solution.slopes = slopes;
  return solution;
}

/// The n-th of the starts: the first is the material's own; the others lie around it, evenly (Halton's sequence). What
/// is not fitted stays.
Logs start_of(const Logs& first, const std::vector<std::size_t>& free, int n) {
  static constexpr int kBases[kAll] = {2, 3, 5, 7};
  Logs logs = first;
  for (const std::size_t k : free) {
    if (n == 0) break;
    double share = 0, part = 1;
    for (int i = n; i > 0; i /= kBases[k]) part /= kBases[k], share += part * (i % kBases[k]);
    logs[k] += (2 * share - 1) * std::log(kStartFactor);
  }
  return logs;
}

/// The start with its stiffness scaled to what was measured: forces are nearly proportional to it, depths of creep to
/// its inverse.
std::optional<Logs> scaled_start(Data& data, const std::vector<Measurement>& measurements, Logs logs) {
  double change = 0;
  for (std::size_t m = 0; m < measurements.size(); ++m) {
    const auto simulated = data.run(logs, m);
    if (!simulated) return std::nullopt;
    double measured = 0, got = 0;
    for (std::size_t i = 0; i < simulated->size(); ++i)
      measured += std::abs(measurements[m].rows[i].measured), got += std::abs((*simulated)[i]);
    if (!(measured > 0 && got > 0)) return std::nullopt;
    change += (measurements[m].kind == Kind::creep ? -1 : 1) * std::log(measured / got) / double(measurements.size());
  }
  logs[0] += change;
  return logs;
}

/// What the slopes say about the free parameters.
struct Certainty {
  Eigen::MatrixXd covariance;  ///< of the logarithms, scaled by the residuals
  Eigen::MatrixXd unknown;     ///< directions that change nothing, one a column
  double student = 0;          ///< t for 95 %
};

Certainty certainty_of(const Solution& solution) {
  const Eigen::Index rows = solution.slopes.rows(), columns = solution.slopes.cols();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(solution.slopes, Eigen::ComputeThinU | Eigen::ComputeThinV);
  constexpr double kNothing = 1e-6;  ///< of the strongest direction: less than what differences can see
  Certainty certainty;
  certainty.covariance = Eigen::MatrixXd::Zero(columns, columns);
  certainty.unknown = Eigen::MatrixXd::Zero(columns, 0);
  const double free_rows = double(std::max<Eigen::Index>(1, rows - columns));
  const double variance = 2 * solution.cost / free_rows;
  for (Eigen::Index i = 0; i < columns; ++i) {
    const double strength = i < svd.singularValues().size() ? svd.singularValues()[i] : 0;
    if (strength > kNothing * svd.singularValues()[0]) {
      certainty.covariance +=
          svd.matrixV().col(i) * svd.matrixV().col(i).transpose() * variance / (strength * strength);
    } else {
      certainty.unknown.conservativeResize(columns, certainty.unknown.cols() + 1);
      certainty.unknown.col(certainty.unknown.cols() - 1) = svd.matrixV().col(i);
    }
  }
  certainty.student = boost::math::quantile(boost::math::students_t(free_rows), 0.975);
  return certainty;
}

/// Derivatives of the logarithm of one number by those of all parameters.
using Gradient = std::array<double, kAll>;

Estimate estimate_of(const char* key, const char* title, const char* unit, double value, const Gradient& gradient,
                     const Certainty& certainty, const std::vector<std::size_t>& free) {
  Estimate estimate{.key = key, .title = title, .unit = unit, .value = value};
  Eigen::VectorXd own = Eigen::VectorXd::Zero(Eigen::Index(free.size()));
  double elsewhere = 0;  // what depends on a parameter that is not fitted cannot be told
  for (std::size_t k = 0; k < kAll; ++k) {
    const auto found = std::find(free.begin(), free.end(), k);
    if (found == free.end())
      elsewhere = std::max(elsewhere, std::abs(gradient[k]));
    else
      own[found - free.begin()] = gradient[k];
  }
  const double into_unknown = certainty.unknown.cols() > 0 ? (certainty.unknown.transpose() * own).norm() : 0;
  if (elsewhere > 0 || into_unknown > 1e-6 * own.norm()) return estimate;
  estimate.factor = std::exp(certainty.student * std::sqrt(own.dot(certainty.covariance * own)));
  return estimate;
}

std::vector<Estimate> estimates_of(const Parameters& p, const Certainty& certainty,
                                   const std::vector<std::size_t>& free) {
  const double r = p.ratio, both = 2 + r + 1 / r;
  const auto one = [&](const char* key, const char* title, const char* unit, double value, const Gradient& gradient) {
    return estimate_of(key, title, unit, value, gradient, certainty, free);
  };
  std::vector<Estimate> all{
      one("slow_kpa_per_mm", "P2 = K1 K2 / (K1 + K2), the stiffness that stays", "kPa/mm", p.slow, {1, 0, 0, 0}),
      one("kelvin_kpa_per_mm", "K1", "kPa/mm", p.kelvin(), {1, 0, r / (1 + r), 0}),
      one("spring_kpa_per_mm", "K2, the stiffness at once", "kPa/mm", p.spring(), {1, 0, -1 / (1 + r), 0}),
      one("constraint_kpa_per_mm", "K'", "kPa/mm", p.prime(), {1, 1, 0, 0}),
      one("viscosity_kpa_s_per_mm", "v1", "kPa s/mm", p.viscosity(), {1, 0, (r - 1 / r) / both, 1}),
      one("time_s", "P1 = v1 / (K1 + K2), the time of relaxation", "s", p.time, {0, 0, 0, 1})};
  const Logs logs = logs_of(p);
  std::vector<bool> at_bound(kAll);
  for (const std::size_t k : free)
    at_bound[k] = logs[k] < std::log(kLeast[k]) + 1e-6 || logs[k] > std::log(kMost[k]) - 1e-6;
  all[0].is_at_bound = at_bound[0], all[1].is_at_bound = all[2].is_at_bound = at_bound[2];
  all[3].is_at_bound = at_bound[1], all[4].is_at_bound = at_bound[2] || at_bound[3], all[5].is_at_bound = at_bound[3];
  return all;
}

double root_mean_square(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return values.empty() ? 0 : std::sqrt(squares / double(values.size()));
}

/// Of the cost. The last one is far below what scatter does: it moves a number by a hundredth of its uncertainty.
constexpr double kEarlyTolerance = 1e-4, kLastTolerance = 1e-6;

/// The best of all starts, followed to its end, and how many came there.
std::optional<Solution> best_of(Data& data, const Logs& first, const std::vector<std::size_t>& free,
                                const FitRequest& request, Fit& fit) {
  std::vector<Solution> found;
  for (int n = 0; n < request.starts; ++n) {
    if (request.should_stop && request.should_stop()) return std::nullopt;
    if (std::optional<Solution> one = solve(data, start_of(first, free, n), free, kEarlyTolerance))
      found.push_back(std::move(*one));
  }
  if (found.empty()) return std::nullopt;
  const auto best = std::min_element(found.begin(), found.end(),
                                     [](const Solution& a, const Solution& b) { return a.cost < b.cost; });
  fit.starts = request.starts;
  for (const Solution& one : found) fit.same_starts += one.cost <= best->cost * 1.01 + 1e-12;
  return solve(data, best->logs, free, kLastTolerance);
}

/// Correlations of the logarithms of the free parameters; 0 where a variance is none.
std::vector<double> correlations_of(const Eigen::MatrixXd& covariance) {
  std::vector<double> correlation;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i)
    for (Eigen::Index j = 0; j < covariance.cols(); ++j) {
      const double scale = std::sqrt(covariance(i, i) * covariance(j, j));
      correlation.push_back(scale > 0 ? covariance(i, j) / scale : 0);
    }
  return correlation;
}

}  // namespace

Result<Fit> fit_material(const loading::LoadedScene& rig, const std::vector<Measurement>& measurements,
                         const FitRequest& request) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // a start that cannot be simulated is not for the terminal
  Data data(rig, measurements, request);
  const bool is_slow = std::all_of(measurements.begin(), measurements.end(),
                                   [](const Measurement& one) { return one.kind == Kind::indentation; });
  const std::vector<std::size_t> free = is_slow ? std::vector<std::size_t>{0, 1} : std::vector<std::size_t>{0, 1, 2, 3};
  if (measurements.empty() || data.count(false) <= free.size())
    return Error{"calibrate", "there are too few rows to fit " + std::to_string(free.size()) + " numbers",
                 "every fifth row is held out"};
  Fit fit;
  const std::optional<Logs> first = scaled_start(data, measurements, logs_of(parameters_of(request.start)));
  const std::optional<Solution> best = first ? best_of(data, *first, free, request, fit) : std::nullopt;
  if (request.should_stop && request.should_stop()) return Error{"calibrate", "stopped", ""};
  if (!best) return Error{"calibrate", "the network cannot do what was measured from any start", ""};
  fit.parameters = parameters_at(best->logs);
  fit.material = with_moduli(request.start, fit.parameters);
  const Certainty certainty = certainty_of(*best);
  fit.estimates = estimates_of(fit.parameters, certainty, free);
  for (const std::size_t k : free) fit.fitted.push_back(kNames[k]);
  fit.correlation = correlations_of(certainty.covariance);
  for (std::size_t m = 0; m < measurements.size(); ++m) {
    Match match{&measurements[m], data.run(best->logs, m).value_or(std::vector<double>()), {}};
    for (std::size_t i = 0; i < measurements[m].rows.size(); ++i) match.is_held_out.push_back(Data::is_held_out(i));
    fit.matches.push_back(std::move(match));
  }
  fit.error = root_mean_square(data.residuals(best->logs).value_or(std::vector<double>()));
  fit.held_out_error = root_mean_square(data.residuals(best->logs, true).value_or(std::vector<double>()));
  fit.simulations = data.simulations;
  return fit;
}

}  // namespace ctpm::calibrate
