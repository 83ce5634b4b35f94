#include "studio/authoring/filling_choice.h"

#include <algorithm>
#include <cmath>

#include "importers/text.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"

namespace ctpm::authoring {
namespace {

/// Spheres without a wish: enough for a press to have a shape, few enough to settle and be fitted in seconds.
constexpr std::int64_t kFew = 300, kUsual = 800, kMany = 1500;
constexpr std::int64_t kFewOfOne = 100;  ///< of an organ beside others

double rounded(double radius) { return std::stod(output::short_number(radius, 3)); }

/// Fills one mesh with about that many spheres, and with no fewer than kFewestSpheres where that is at all possible.
Result<importers::ImportedOrgan> fill_with(const importers::RepairedFile& file, std::size_t index,
                                           importers::ImportOptions options, std::int64_t spheres) {
  constexpr int kMostTries = 4;
  constexpr double kFiner = 0.85;
  options.sphere_radius = rounded(importers::radius_for(file.mesh[index], spheres));
  Result<importers::ImportedOrgan> filled = importers::fill_repaired(file, index, options);
  for (int tries = 1; filled && filled->report.fill.spheres < kFewestSpheres && tries < kMostTries; ++tries) {
    options.sphere_radius = rounded(kFiner * options.sphere_radius);
    filled = importers::fill_repaired(file, index, options);
  }
  return filled;
}

}  // namespace

std::string problem_of_volume(const importers::ImportReport& report, double enclosed) {
  constexpr double kKept = 0.05;
  const double filled = report.fill.filled_volume;
  const auto is_island = [](const importers::Finding& finding) { return finding.code == "island"; };
  const std::string volumes = output::short_number(1e6 * filled, 3) + " ml, the mesh encloses " +
                              output::short_number(1e6 * enclosed, 3) + " ml";
  // Groups of spheres that hang on nothing were left out.
  if (filled < (1 - kKept) * enclosed && std::any_of(report.findings.begin(), report.findings.end(), is_island))
    return "falls apart where it is thin: the spheres that hang together stand for " + volumes;
  if (filled > (1 + kKept) * enclosed)
    return "passes through itself, so that its volume is not certain: its triangles surround " + volumes;
  return "";
}

std::string problem_of_surface(const importers::ImportReport& report) {
  // No point of a cell is farther from the sphere in its middle.
  const double farthest = 0.5 * std::sqrt(3.0) * report.spacing;
  if (!(report.fill.mean_distance > farthest)) return "";
  return "is mostly too thin for spheres: its surface is " + importers::mm_text(report.fill.mean_distance) +
         " from the nearest of them on average, and none of it may be farther than " + importers::mm_text(farthest) +
         " where it is filled";
}

namespace {

/// Why a filled mesh is no organ; empty if it is one. An author who asks for a radius may have few spheres, and a
/// volume that is not the mesh's.
Errors problems_of(const importers::ImportedOrgan& filled, const importers::RepairedFile& file, std::size_t index,
                   bool is_asked) {
  const std::string& path = file.report.path;
  const std::string finer = output::option_name("import.spheres") + " with a larger number fills thin places";
  if (!is_asked && filled.report.fill.spheres < kFewestSpheres)
    return {{path,
             "is filled by only " + importers::counted(filled.report.fill.spheres, "sphere") +
                 " that hang together: it is too thin or in too many pieces",
             finer}};
  if (const std::string problem = problem_of_volume(filled.report, file.mesh[index].volume);
      !is_asked && !problem.empty())
    return {{path, problem, finer + ", " + output::option_name("import.names") + " takes other parts of the file"}};
  if (const std::string problem = problem_of_surface(filled.report); !problem.empty())
    return {{path, problem, finer + "; a sheet needs a thickness in a mesh editor first"}};
  return {};
}

}  // namespace

Result<std::vector<importers::ImportedOrgan>> fill_all(const importers::RepairedFile& file,
                                                       const importers::ImportOptions& options, FillingWish wish,
                                                       double usual_radius) {
  double volume = 0;
  for (const importers::CheckedMesh& mesh : file.mesh) volume += mesh.volume;
  if (!wish.radius && !wish.spheres) {
    const double cell = 27 * usual_radius * usual_radius * usual_radius, cells = volume / cell;
    // Spheres at the surface stand for half a cell, so that there are more of them than cells.
    constexpr double kLeastSurface = 1.2, kMostSurface = 3;
    if (file.mesh.size() == 1 && kMostSurface * cells >= double(kFew) && kLeastSurface * cells <= double(kMany)) {
      importers::ImportOptions usual = options;
      usual.sphere_radius = usual_radius;
      Result<importers::ImportedOrgan> filled = importers::fill_repaired(file, 0, usual);
      if (!filled) return filled.errors();
      if (filled->report.fill.spheres >= kFew && filled->report.fill.spheres <= kMany) {
        if (Errors errors = problems_of(*filled, file, 0, false); !errors.empty()) return errors;
        return std::vector<importers::ImportedOrgan>{*std::move(filled)};
      }
    }
    wish.spheres = std::clamp(std::int64_t(2 * cells), kUsual, kMany);
  }
  std::vector<importers::ImportedOrgan> organs;
  for (std::size_t i = 0; i < file.mesh.size(); ++i) {
    importers::ImportOptions own = options;
    own.sphere_radius = wish.radius.value_or(0);
    const auto share = wish.spheres ? std::int64_t(double(*wish.spheres) * file.mesh[i].volume / volume) : 0;
    const std::int64_t least = file.mesh.size() == 1 ? kFewestSpheres : kFewOfOne;
    Result<importers::ImportedOrgan> filled =
        wish.radius ? importers::fill_repaired(file, i, own) : fill_with(file, i, options, std::max(share, least));
    if (!filled) return filled.errors();
    if (Errors errors = problems_of(*filled, file, i, wish.radius.has_value()); !errors.empty()) return errors;
    organs.push_back(*std::move(filled));
  }
  return organs;
}

}  // namespace ctpm::authoring
