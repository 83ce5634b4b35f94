#include "studio/calibrate/least_squares.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace ctpm::calibrate {
namespace {

constexpr std::size_t kHeldOut = 5;  ///< every fifth row
constexpr double kStep = 1e-4;       ///< of a logarithm, for differences

/// The residuals for Ceres, with differences to one side for their slopes.
class Cost : public ceres::CostFunction {
 public:
  Cost(Data& data, const Logs& start, const std::vector<std::size_t>& free, parallel::Team& team)
      : data_(data), start_(start), free_(free), team_(team) {
    set_num_residuals(int(data.count()));
    mutable_parameter_block_sizes()->push_back(int(free_.size()));
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
    std::atomic<bool> is_good{true};
    team_.for_each(int(free_.size()), [&](int column) {
      const auto k = std::size_t(column);
      Logs beside = logs;
      // Away from the upper bound, where a run may be refused beyond it.
      const double step = beside[free_[k]] + kStep > std::log(kMost[free_[k]]) ? -kStep : kStep;
      beside[free_[k]] += step;
      const auto there = data_.residuals(beside);
      if (!there) return is_good.store(false);
      for (std::size_t i = 0; i < here->size(); ++i)
        jacobians[0][i * free_.size() + k] = ((*there)[i] - (*here)[i]) / step;
    });
    return is_good;
  }

 private:
  Data& data_;
  const Logs start_;
  const std::vector<std::size_t>& free_;
  parallel::Team& team_;
};

}  // namespace

Logs logs_of(const Parameters& p) {
  return {std::log(p.slow), std::log(p.constraint), std::log(p.ratio), std::log(p.time)};
}

Parameters parameters_at(const Logs& logs) {
  return {std::exp(logs[0]), std::exp(logs[1]), std::exp(logs[2]), std::exp(logs[3])};
}

double root_mean_square(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return values.empty() ? 0 : std::sqrt(squares / double(values.size()));
}

double scale_of(const Measurement& measurement) {
  std::vector<double> values;
  for (const Row& row : measurement.rows) values.push_back(row.measured);
  return root_mean_square(values);
}

bool is_held_out(std::size_t row) { return row % kHeldOut == kHeldOut - 1; }

Data::Data(const loading::LoadedScene& rig, const std::vector<Measurement>& measurements, const FitRequest& request)
    : rig_(rig), measurements_(measurements), request_(request) {
  for (const Measurement& one : measurements) scales_.push_back(scale_of(one));
}

std::size_t Data::count() const {
  std::size_t count = 0;
  for (const Measurement& one : measurements_)
    for (std::size_t i = 0; i < one.rows.size(); ++i) count += !is_held_out(i);
  return count;
}

std::optional<std::vector<double>> Data::run(const Logs& logs, std::size_t measurement) {
  {
    const std::lock_guard lock(counting_);
    ++simulations;
    if (request_.progress) request_.progress(simulations);
  }
  return simulate(rig_, with_moduli(request_.start, parameters_at(logs)), measurements_[measurement]);
}

std::optional<std::vector<double>> Data::residuals(const Logs& logs) {
  std::vector<double> all;
  for (std::size_t m = 0; m < measurements_.size(); ++m) {
    if (request_.should_stop && request_.should_stop()) return std::nullopt;
    const auto simulated = run(logs, m);
    if (!simulated) return std::nullopt;
    for (std::size_t i = 0; i < simulated->size(); ++i)
      if (!is_held_out(i)) all.push_back(((*simulated)[i] - measurements_[m].rows[i].measured) / scales_[m]);
  }
  return all;
}

std::optional<Solution> solve(Data& data, const Logs& start, const std::vector<std::size_t>& free, double tolerance,
                              parallel::Team& team) {
  std::vector<double> values;
  for (const std::size_t k : free) values.push_back(std::clamp(start[k], std::log(kLeast[k]), std::log(kMost[k])));
  Logs within = start;
  for (std::size_t i = 0; i < free.size(); ++i) within[free[i]] = values[i];
  if (!data.residuals(within)) return std::nullopt;
  ceres::Problem problem;
  auto* cost = new Cost(data, start, free, team);
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

}  // namespace ctpm::calibrate
