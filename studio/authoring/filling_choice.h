#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "importers/import.h"

namespace ctpm::authoring {

/// Fewer spheres than this are no organ: its tissue would have no inside.
inline constexpr std::int64_t kFewestSpheres = 50;

/// Radii that a filling may have.
struct FillingWish {
  std::optional<double> radius;         ///< of every organ [m]
  std::optional<std::int64_t> spheres;  ///< in all organs together
};

/// Why the spheres of a filling do not stand for what the mesh encloses [m^3]; empty if they do to 5 %, or if tissue
/// that overlaps itself counts once.
std::string problem_of_volume(const importers::ImportReport& report, double enclosed);

/// Why the spheres of a filling do not carry the mesh's surface; empty if they do.
std::string problem_of_surface(const importers::ImportReport& report);

/// Fills every mesh of a file. Without a wish, `usual_radius` [m] is taken if it gives a few hundred to some 1500
/// spheres in all, else the radius that does. A wish for spheres is divided by volume; every organ gets some. `options`
/// has the gap and everything else. Errors: those of fill_organ(); an organ of fewer than kFewestSpheres spheres;
/// the problems above.
Result<std::vector<importers::ImportedOrgan>> fill_all(const importers::RepairedFile& file,
                                                       const importers::ImportOptions& options, FillingWish wish,
                                                       double usual_radius);

}  // namespace ctpm::authoring
