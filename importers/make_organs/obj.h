#pragma once

#include <filesystem>

#include "core/model/result.h"
#include "importers/make_organs/mesher.h"
#include "importers/make_organs/shapes.h"

namespace ctpm::importers {

/// Writes the mesh as a Wavefront OBJ file in [mm] with three decimals, with its description, maker and licence in the
/// header. Error: the file cannot be written.
Result<Done> write_obj(const std::filesystem::path& path, const OrganMesh& mesh, const OrganShape& shape);

}  // namespace ctpm::importers
