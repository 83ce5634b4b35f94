#pragma once

#include <string>

#include "core/model/result.h"
#include "studio/calibrate/fit.h"
#include "studio/calibrate/specimens.h"

namespace ctpm::calibrate {

/// A number with as many digits as its interval leaves; "cannot be told" where it leaves none.
std::string told(const Estimate& estimate);
/// The interval in the same digits: "3.1 to 3.6".
std::string interval_text(const Estimate& estimate);

/// What a reader must know to believe a fit, one sentence each. `specimens`: of fit_specimens().
std::vector<std::string> remarks_of(const Fit& fit, const std::vector<SpecimenFit>& specimens);

/// Writes report.html, results.json and materials.json, which an import in that folder takes by `name`, to `folder`,
/// which is made if missing. `start_name`: whose values stand in for what the data cannot tell. Error: a file cannot be
/// written.
Result<Done> write_calibration(const Fit& fit, const std::vector<SpecimenFit>& specimens, const std::string& name,
                               const std::string& start_name, const std::string& folder);

}  // namespace ctpm::calibrate
