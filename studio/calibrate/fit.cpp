#include "studio/calibrate/fit.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "studio/calibrate/least_squares.h"

namespace ctpm::calibrate {
namespace {

constexpr const char* kNames[kAll] = {"P2", "K'/P2", "K1/K2", "P1"};
/// Within which starts lie, as factors of the first one.
constexpr double kStartFactor = 10;

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

/// Of the cost. The last one is far below what scatter does: it moves a number by a hundredth of its uncertainty.
constexpr double kEarlyTolerance = 1e-4, kLastTolerance = 1e-6;

/// The best of all starts, followed to its end, and how many came there.
std::optional<Solution> best_of(Data& data, const Logs& first, const std::vector<std::size_t>& free,
                                const FitRequest& request, Fit& fit) {
  parallel::Team team(request.threads);
  fit.starts = request.starts;
  if (request.starts == 1) return fit.same_starts = 1, solve(data, first, free, kLastTolerance, team);
  std::vector<std::optional<Solution>> ends(std::size_t(request.starts));
  team.for_each(request.starts, [&](int n) {
    parallel::Team alone(1);
    ends[std::size_t(n)] = solve(data, start_of(first, free, n), free, kEarlyTolerance, alone);
  });
  std::vector<Solution> found;
  for (std::optional<Solution>& end : ends)
    if (end) found.push_back(std::move(*end));
  if (found.empty() || (request.should_stop && request.should_stop())) return std::nullopt;
  const auto best = std::min_element(found.begin(), found.end(),
                                     [](const Solution& a, const Solution& b) { return a.cost < b.cost; });
  for (const Solution& one : found) fit.same_starts += one.cost <= best->cost * 1.01 + 1e-12;
  return solve(data, best->logs, free, kLastTolerance, team);
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

/// Matches and errors, by what the network did at each row of each measurement.
void judge(Fit& fit, const std::vector<Measurement>& measurements, const std::vector<std::vector<double>>& simulated) {
  fit.matches.clear();
  std::vector<double> used, held_out;
  for (std::size_t m = 0; m < measurements.size(); ++m) {
    Match match{&measurements[m], simulated[m], {}};
    const double scale = scale_of(measurements[m]);
    for (std::size_t i = 0; i < simulated[m].size(); ++i) {
      match.is_held_out.push_back(is_held_out(i));
      (match.is_held_out[i] ? held_out : used).push_back((simulated[m][i] - measurements[m].rows[i].measured) / scale);
    }
    fit.matches.push_back(std::move(match));
  }
  fit.error = root_mean_square(used), fit.held_out_error = held_out.empty() ? NAN : root_mean_square(held_out);
}

}  // namespace

Result<Fit> fit_material(const loading::LoadedScene& tissue, const std::vector<Measurement>& measurements,
                         const FitRequest& request) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // a start that cannot be simulated is not for the terminal
  Data data(tissue, measurements, request);
  const bool is_slow = std::all_of(measurements.begin(), measurements.end(),
                                   [](const Measurement& one) { return one.kind == Kind::indentation; });
  const std::vector<std::size_t> free = is_slow ? std::vector<std::size_t>{0, 1} : std::vector<std::size_t>{0, 1, 2, 3};
  if (measurements.empty() || data.count() <= free.size())
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
  std::vector<std::vector<double>> simulated;
  for (std::size_t m = 0; m < measurements.size(); ++m)
    simulated.push_back(data.run(best->logs, m).value_or(std::vector<double>(measurements[m].rows.size(), NAN)));
  judge(fit, measurements, simulated);
  fit.simulations = data.simulations;
  fit.block = tissue.scene.spec.organs[0].rig->block;
  return fit;
}

std::optional<double> error_of(const loading::LoadedScene& tissue, const scenes::MaterialSpec& material,
                               const std::vector<Measurement>& measurements) {
  std::vector<double> all;
  for (const Measurement& one : measurements) {
    const auto simulated = simulate(tissue, material, one);
    if (!simulated) return std::nullopt;
    const double scale = scale_of(one);
    for (std::size_t i = 0; i < simulated->size(); ++i) all.push_back(((*simulated)[i] - one.rows[i].measured) / scale);
  }
  return root_mean_square(all);
}

}  // namespace ctpm::calibrate
