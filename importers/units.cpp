#include <array>
#include <cmath>
#include <cstdio>

#include "importers/mesh.h"
#include "importers/topology.h"

namespace ctpm::importers {
namespace {

constexpr double kInch = 0.0254;  // [m]

bool is_usual(double diagonal, UsualSize usual) { return diagonal >= usual.least && diagonal <= usual.most; }

}  // namespace

UnitChoice choose_unit(const RawMesh& mesh, std::optional<double> given_in_metres, UsualSize usual) {
  const double diagonal = bounding_box({mesh.vertex, mesh.triangle}).diagonal();  // in the file's unit
  const auto choice = [&](double in_metres, UnitSource source) {
    return UnitChoice{in_metres, source, is_usual(in_metres * diagonal, usual)};
  };
  if (given_in_metres) return choice(*given_in_metres, UnitSource::given);
  if (mesh.unit_in_metres > 0) return choice(mesh.unit_in_metres, UnitSource::file);

  // |log| of the ratio between the organ's diagonal and the geometric mean of the usual range.
  const double middle = std::sqrt(usual.least * usual.most);
  const auto misfit = [&](double in_metres) { return std::abs(std::log(in_metres * diagonal / middle)); };
  double best = 1.0;
  for (const double unit : {0.01, 0.001})
    if (misfit(unit) < misfit(best)) best = unit;
  if (!is_usual(best * diagonal, usual) && is_usual(kInch * diagonal, usual)) best = kInch;
  return choice(best, UnitSource::guessed);
}

std::string unit_name(double in_metres) {
  struct Named {
    double in_metres;
    const char* name;
  };
  constexpr std::array<Named, 4> kUnits{{{1.0, "m"}, {0.01, "cm"}, {0.001, "mm"}, {kInch, "inch"}}};
  for (const Named& unit : kUnits)
    if (std::abs(in_metres / unit.in_metres - 1) < 1e-9) return unit.name;
  char text[48];
  std::snprintf(text, sizeof text, "%g m", in_metres);
  return text;
}

}  // namespace ctpm::importers
