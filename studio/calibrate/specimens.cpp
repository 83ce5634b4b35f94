#include "studio/calibrate/specimens.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel/team.h"

namespace ctpm::calibrate {
namespace {

using Measurements = std::vector<Measurement>;

void note(SpecimenFit& specimen, const std::string& what, const Errors& errors) {
  specimen.problem += (specimen.problem.empty() ? "" : "; ") + what + ": " + errors.front().message;
}

/// One specimen alone, and beside the fit of the others.
SpecimenFit fit_one(const loading::LoadedScene& tissue, const Measurements& measurements, const std::string& name,
                    const FitRequest& request) {
  SpecimenFit specimen{.name = name, .left_out_error = std::numeric_limits<double>::quiet_NaN()};
  Measurements own, others;
  for (const Measurement& one : measurements) (one.specimen == name ? own : others).push_back(one);
  if (const Result<Fit> alone = fit_material(tissue, own, request))
    specimen.estimates = alone->estimates, specimen.error = alone->error;
  else
    note(specimen, "alone", alone.errors());
  const Result<Fit> rest = fit_material(tissue, others, request);
  if (!rest) return note(specimen, "without it", rest.errors()), specimen;
  if (const std::optional<double> error = error_of(tissue, rest->material, own)) specimen.left_out_error = *error;
  return specimen;
}

}  // namespace

std::vector<std::string> specimens_of(const Measurements& measurements) {
  std::vector<std::string> names;
  for (const Measurement& one : measurements)
    if (std::find(names.begin(), names.end(), one.specimen) == names.end()) names.push_back(one.specimen);
  return names;
}

Result<std::vector<SpecimenFit>> fit_specimens(const loading::LoadedScene& tissue, const Measurements& measurements,
                                               const Fit& whole, const FitRequest& request) {
  const std::vector<std::string> names = specimens_of(measurements);
  if (names.size() < 2) return std::vector<SpecimenFit>();
  FitRequest from_whole = request;
  from_whole.start = whole.material, from_whole.starts = 1, from_whole.threads = 1, from_whole.progress = nullptr;
  std::vector<SpecimenFit> specimens(names.size());
  parallel::Team(request.threads).for_each(int(names.size()), [&](int i) {
    specimens[std::size_t(i)] = fit_one(tissue, measurements, names[std::size_t(i)], from_whole);
  });
  if (request.should_stop && request.should_stop()) return Error{"calibrate", "stopped", ""};
  return specimens;
}

SpecimenSpread spread_of(const std::vector<SpecimenFit>& specimens, std::size_t estimate) {
  std::vector<double> logs;
  for (const SpecimenFit& one : specimens)
    if (estimate < one.estimates.size() && one.estimates[estimate].is_told())
      logs.push_back(std::log(one.estimates[estimate].value));
  SpecimenSpread spread{.count = logs.size()};
  if (logs.empty()) return spread;
  double mean = 0, squares = 0;
  for (const double log : logs) mean += log / double(logs.size());
  for (const double log : logs) squares += (log - mean) * (log - mean);
  spread.mean = std::exp(mean);
  if (logs.size() > 1) spread.deviation = std::sqrt(squares / double(logs.size() - 1));
  return spread;
}

}  // namespace ctpm::calibrate
