#include "importers/make_organs/obj.h"

#include <cstdio>

namespace ctpm::importers {

Result<Done> write_obj(const std::filesystem::path& path, const OrganMesh& mesh, const OrganShape& shape) {
  const auto failed = [&] { return Error{path.string(), "cannot be written", "check the folder and the space left"}; };
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return failed();

  std::fprintf(file, "# %s\n# Made by make_organs, a program of ctpm, from an implicit shape.\n",
               shape.description.c_str());
  std::fprintf(file,
               "# Unit: mm. z is up, the lowest point at z = 0, the middle of the bounding box over the origin.\n");
  std::fprintf(file, "# %zu vertices, %zu triangles, closed, counter-clockwise seen from outside.\n",
               mesh.vertex_mm.size(), mesh.triangle.size());
  std::fprintf(file, "# SPDX-License-Identifier: GPL-3.0-or-later\n");
  std::fprintf(file, "o %s\n", shape.name.c_str());
  for (const Vec3 v : mesh.vertex_mm) std::fprintf(file, "v %.3f %.3f %.3f\n", v.x, v.y, v.z);
  for (const auto& t : mesh.triangle) std::fprintf(file, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);

  const bool wrote = std::ferror(file) == 0;
  if (std::fclose(file) != 0 || !wrote) return failed();
  return Done{};
}

}  // namespace ctpm::importers
