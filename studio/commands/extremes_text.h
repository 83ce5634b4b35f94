#pragma once

#include <string>

#include "studio/output/number_text.h"

namespace ctpm::commands {

/// The largest force [N], and how deep [m] a ball or a pin pressed if one did: a blade has no such depth.
inline std::string extremes_text(double force, double depth) {
  return "at most " + output::fixed(force, 3) + " N" +
         (depth > 0 ? " and " + output::fixed(1e3 * depth, 2) + " mm deep" : "");
}

}  // namespace ctpm::commands
