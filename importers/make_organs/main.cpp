// make_organs DIR [NAME...]: makes the project's organ meshes, checks them and writes DIR/NAME.obj.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "importers/make_organs/mesher.h"
#include "importers/make_organs/obj.h"
#include "importers/make_organs/shapes.h"

namespace {

using namespace ctpm::importers;

void print(const ctpm::Errors& errors) {
  for (const ctpm::Error& error : errors) std::fprintf(stderr, "%s\n", to_string(error).c_str());
}

void print(const OrganShape& shape, const OrganMesh& mesh, const MeshFacts& facts) {
  std::printf("%s: %zu vertices, %zu triangles, %.1f ml, %.0f mm2\n", shape.name.c_str(), mesh.vertex_mm.size(),
              mesh.triangle.size(), facts.volume_ml, facts.area_mm2);
  std::printf("  box x [%.3f, %.3f] y [%.3f, %.3f] z [%.3f, %.3f] mm\n", facts.low_mm.x, facts.high_mm.x,
              facts.low_mm.y, facts.high_mm.y, facts.low_mm.z, facts.high_mm.z);
  std::printf("  smallest angle %.1f deg, edges %.2f to %.2f mm\n", facts.least_angle_deg, facts.least_edge_mm,
              facts.greatest_edge_mm);
}

/// Makes, checks and writes one organ. On failure prints the reason and returns false.
bool make_organ(const OrganShape& shape, const std::string& folder) {
  const auto mesh = mesh_shape(shape);
  if (!mesh) return print(mesh.errors()), false;
  const auto facts = check_mesh(*mesh, shape);
  if (!facts) return print(facts.errors()), false;
  print(shape, *mesh, *facts);
  const auto written = write_obj(folder + "/" + shape.name + ".obj", *mesh, shape);
  if (!written) return print(written.errors()), false;
  return true;
}

int make_organs(const std::string& folder, const std::vector<std::string>& wanted) {
  const auto shapes = organ_shapes();
  const auto is_wanted = [&](const OrganShape& shape) {
    return wanted.empty() || std::find(wanted.begin(), wanted.end(), shape.name) != wanted.end();
  };
  for (const std::string& name : wanted) {
    if (std::any_of(shapes.begin(), shapes.end(), [&](const auto& shape) { return shape.name == name; })) continue;
    std::fprintf(stderr, "make_organs: error: no organ is called '%s'\n", name.c_str());
    return 2;
  }
  bool all_good = true;
  for (const OrganShape& shape : shapes) {
    if (is_wanted(shape)) all_good = make_organ(shape, folder) && all_good;
  }
  return all_good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') {
    std::fprintf(stderr, "usage: make_organs DIR [liver|kidney|skin ...]\n");
    return 2;
  }
  try {
    return make_organs(argv[1], {argv + 2, argv + argc});
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "make_organs: error: %s\n", exception.what());
    return 1;
  }
}
