#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "importers/mesh.h"
#include "importers/size.h"
#include "importers/topology.h"

namespace ctpm::importers {
namespace {

constexpr double kDecimetre = 0.1, kInch = 0.0254;  // [m]

bool is_usual(double diagonal, UsualSize usual) { return diagonal >= usual.least && diagonal <= usual.most; }

}  // namespace

UnitChoice choose_unit(const RawMesh& mesh, std::optional<double> given_in_metres, UsualSize usual) {
  return choose_unit(bounding_box({mesh.vertex, mesh.triangle}).diagonal(), mesh.unit_in_metres, given_in_metres,
                     usual);
}

UnitChoice choose_unit(double diagonal, double unit_of_file, std::optional<double> given_in_metres, UsualSize usual) {
  const auto choice = [&](double in_metres, UnitSource source) {
    return UnitChoice{in_metres, source, is_usual(in_metres * diagonal, usual)};
  };
  if (given_in_metres) return choice(*given_in_metres, UnitSource::given);
  const auto ratio_to = [&](double bound, double in_metres) { return in_metres * diagonal / bound; };
  if (const double unit = unit_of_file;
      unit > 0 && ratio_to(usual.least, unit) >= 1 / kWrongSize && ratio_to(usual.most, unit) <= kWrongSize)
    return choice(unit, UnitSource::file);

  // |log| of the ratio between the organ's diagonal and the geometric mean of the usual range.
  const double middle = std::sqrt(usual.least * usual.most);
  const auto misfit = [&](double in_metres) { return std::abs(std::log(ratio_to(middle, in_metres))); };
  for (const std::vector<double>& units : {std::vector{1.0, 0.01, 0.001}, std::vector{kDecimetre, kInch}}) {
    const double best =
        *std::min_element(units.begin(), units.end(), [&](double a, double b) { return misfit(a) < misfit(b); });
    if (is_usual(best * diagonal, usual)) return choice(best, UnitSource::guessed);
  }
  // A mesh without extent keeps a unit; the repair refuses it.
  if (!(diagonal > 0)) return choice(0.001, UnitSource::guessed);
  return choice(middle / diagonal, UnitSource::scaled);
}

std::string unit_name(double in_metres) {
  struct Named {
    double in_metres;
    const char* name;
  };
  constexpr std::array<Named, 5> kUnits{{{1.0, "m"}, {kDecimetre, "dm"}, {0.01, "cm"}, {0.001, "mm"}, {kInch, "inch"}}};
  for (const Named& unit : kUnits)
    if (std::abs(in_metres / unit.in_metres - 1) < 1e-9) return unit.name;
  char text[48];
  std::snprintf(text, sizeof text, "%g m", in_metres);
  return text;
}

}  // namespace ctpm::importers
