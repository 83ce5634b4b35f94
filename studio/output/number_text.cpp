#include "studio/output/number_text.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace ctpm::output {
namespace {

constexpr double kMostWritten = 1e15;  // of what is written without a power of ten

}  // namespace

std::string fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string short_number(double value, int significant) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", significant, std::abs(value) < 1e-300 ? 0.0 : value);
  // People read 1060, not 1.06e+03.
  if (const double rounded = std::strtod(text, nullptr);
      std::abs(rounded) < kMostWritten && std::strchr(text, 'e') && std::abs(rounded) >= 1)
    std::snprintf(text, sizeof text, "%.0f", rounded);
  return text;
}

}  // namespace ctpm::output
