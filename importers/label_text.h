#pragma once

#include <cstdio>
#include <string>

namespace ctpm::importers {

/// "nii" or "nrrd"; empty for the name of another file.
std::string suffix_of_map(const std::string& path);

/// A number with at most six digits.
inline std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace ctpm::importers
