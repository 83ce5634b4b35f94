#include "importers/text.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace ctpm::importers {
namespace {

/// Millimetres with four digits, no finer than a micrometre.
std::string mm_number(double metres) {
  const double mm = 1000 * metres;
  char text[48];
  std::snprintf(text, sizeof text, std::abs(mm) >= 1000 ? "%.0f" : "%.4g", std::abs(mm) < 5e-4 ? 0.0 : mm);
  return text;
}

}  // namespace

std::string mm_text(double metres) { return mm_number(metres) + " mm"; }

std::string place_text(Vec3 metres) {
  return "(" + mm_number(metres.x) + ", " + mm_number(metres.y) + ", " + mm_number(metres.z) + ") mm";
}

std::string roughly(double number) {
  char text[48];
  std::snprintf(text, sizeof text, "%.2g", number);
  std::snprintf(text, sizeof text, "%.10g", std::strtod(text, nullptr));
  return text;
}

std::string counted(std::int64_t count, const std::string& noun) {
  std::string text = std::to_string(count) + " " + noun;
  if (count == 1) return text;
  if (noun == "vertex" || noun.ends_with(" vertex")) return text.substr(0, text.size() - 2) + "ices";
  return text + "s";
}

}  // namespace ctpm::importers
