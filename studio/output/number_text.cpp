#include "studio/output/number_text.h"

#include <cmath>
#include <cstdio>

namespace ctpm::output {

std::string fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string short_number(double value, int significant) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", significant, std::abs(value) < 1e-300 ? 0.0 : value);
  return text;
}

}  // namespace ctpm::output
