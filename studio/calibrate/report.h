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

/// How a fitted material is called.
struct MaterialName {
  std::string name;        ///< by which an import takes it
  std::string start_name;  ///< of the preset whose values stand in for what the data cannot tell
  std::string beside;      ///< text of the folder's materials.json so far, whose others stay; empty: there is none
};

/// Writes report.html, results.json and materials.json to `folder`, which is made if missing. Error: a file cannot be
/// written.
Result<Done> write_calibration(const Fit& fit, const std::vector<SpecimenFit>& specimens, const MaterialName& name,
                               const std::string& folder);

}  // namespace ctpm::calibrate
