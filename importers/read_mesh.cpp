#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "importers/assimp_reader.h"
#include "importers/child_process.h"
#include "importers/mesh.h"
#include "importers/topology.h"
#include "importers/wire.h"

namespace ctpm::importers {
namespace {

constexpr const char* kKnownFormats = "OBJ, STL, PLY, OFF, glTF, GLB, 3DS, DAE and FBX files are read, among others";

std::string suffix_of(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  if (!suffix.empty()) suffix.erase(0, 1);
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return suffix;
}

/// Checks that need no reader.
Errors check_file(const std::string& path) {
  std::error_code trouble;
  const auto status = std::filesystem::status(path, trouble);
  if (!std::filesystem::exists(status)) return {{path, "no such file", "check the path"}};
  if (std::filesystem::is_directory(status)) return {{path, "is a folder, not a mesh file", "name a file in it"}};
  if (!std::filesystem::is_regular_file(status)) return {{path, "is not a regular file", ""}};
  const auto size = std::filesystem::file_size(path, trouble);
  if (trouble) return {{path, "cannot be read: " + trouble.message(), ""}};
  if (size == 0) return {{path, "is empty", "export the mesh again"}};
  return {};
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMostShown = 40;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostShown); ++i) text += (i ? ", " : "") + ('"' + names[i] + '"');
  if (names.size() > kMostShown) text += " and " + std::to_string(names.size() - kMostShown) + " more";
  return text;
}

bool get_names(wire::Reader& reader, std::vector<std::string>& names) {
  std::uint64_t count = 0;
  if (!reader.get(count)) return false;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::string name;
    if (!reader.get_text(name)) return false;
    names.push_back(std::move(name));
  }
  return true;
}

/// Vertices used by triangles must be finite; others do not matter.
Errors check_vertices(const RawMesh& mesh) {
  std::int64_t bad_count = 0, first_bad = -1;
  std::vector<char> is_counted(mesh.vertex.size(), 0);
  for (const Triangle& triangle : mesh.triangle)
    for (const std::int32_t v : triangle) {
      if (is_counted[std::size_t(v)] || is_finite(mesh.vertex[std::size_t(v)])) continue;
      is_counted[std::size_t(v)] = 1;
      ++bad_count;
      if (first_bad < 0 || v < first_bad) first_bad = v;
    }
  if (bad_count == 0) return {};
  return {{mesh.path,
           std::to_string(bad_count) + " of " + std::to_string(mesh.vertex.size()) +
               " vertices are not finite numbers (the first is vertex " + std::to_string(first_bad + 1) + ")",
           "export the mesh again; NaN or infinite coordinates cannot be repaired"}};
}

/// Merges repeated vertices: assimp repeats a vertex for every face that uses it.
void join_repeats(RawMesh& mesh) {
  Soup soup{std::move(mesh.vertex), std::move(mesh.triangle)};
  weld(soup, 0);
  mesh.vertex = std::move(soup.vertex);
  mesh.triangle = std::move(soup.triangle);
}

bool has_indices_in_range(const RawMesh& mesh) {
  const std::int32_t count = std::int32_t(mesh.vertex.size()), parts = std::int32_t(mesh.parts.size());
  const bool has_parts = mesh.part_of_triangle.size() == mesh.triangle.size() &&
                         std::all_of(mesh.part_of_triangle.begin(), mesh.part_of_triangle.end(),
                                     [parts](std::int32_t part) { return part >= 0 && part < parts; });
  return has_parts && std::all_of(mesh.triangle.begin(), mesh.triangle.end(), [count](const Triangle& t) {
           return std::all_of(t.begin(), t.end(), [count](std::int32_t v) { return v >= 0 && v < count; });
         });
}

}  // namespace

Result<RawMesh> read_mesh(const std::string& path, const ReadOptions& options) {
  if (Errors errors = check_file(path); !errors.empty()) return errors;
  ChildLimits limits;
  limits.time_s = options.time_limit_s;
  limits.memory_mib = options.memory_limit_mib;
  limits.output_mib = options.memory_limit_mib;
  const ChildResult child = run_in_child(limits, [&](const Send& send) { send_mesh_file(path, options.part, send); });
  if (!child.is_whole)
    return Error{path, "the reader " + child.trouble,
                 "the file may be damaged; try to open it elsewhere and export it again"};

  RawMesh mesh;
  mesh.path = path;
  mesh.format = suffix_of(path);
  const Error broken{path, "the reader's answer is broken", "the file may be damaged"};
  wire::Reader reader(child.output);
  wire::Kind kind{};
  if (!reader.get(kind)) return broken;
  if (kind == wire::Kind::failed) {
    std::string text;
    if (!reader.get_text(text)) return broken;
    return Error{path, "is not a mesh that can be read: " + text, kKnownFormats};
  }
  if (!get_names(reader, mesh.parts)) return broken;
  if (kind == wire::Kind::no_such_part)
    return Error{path, "no mesh named \"" + options.part + "\"",
                 mesh.parts.empty() ? "the file holds no mesh" : "the file holds " + listed(mesh.parts)};
  std::vector<Vec3> colours;
  if (kind != wire::Kind::mesh || !reader.get(mesh.unit_in_metres) || !reader.get_list(mesh.vertex) ||
      !reader.get_list(mesh.triangle) || !reader.get_list(mesh.part_of_triangle) || !reader.get_list(colours) ||
      !reader.is_at_end() || !has_indices_in_range(mesh) || colours.size() != mesh.parts.size())
    return broken;
  for (const Vec3& colour : colours)
    mesh.part_colour.push_back(is_finite(colour) ? std::optional(colour) : std::nullopt);
  if (!(std::isfinite(mesh.unit_in_metres) && mesh.unit_in_metres > 0)) mesh.unit_in_metres = 0;
  if (mesh.triangle.empty())
    return Error{path, "holds no triangles", "points and lines alone cannot be filled; export the surface"};
  if (Errors errors = check_vertices(mesh); !errors.empty()) return errors;
  join_repeats(mesh);
  return mesh;
}

}  // namespace ctpm::importers
