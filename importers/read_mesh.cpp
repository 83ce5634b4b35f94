#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <system_error>

#include "importers/assimp_reader.h"
#include "importers/child_process.h"
#include "importers/formats.h"
#include "importers/label_map.h"
#include "importers/mesh.h"
#include "importers/mesh_file.h"
#include "importers/text.h"
#include "importers/topology.h"
#include "importers/volume_mesh.h"
#include "importers/wire.h"

namespace ctpm::importers {

std::string in_lower_case(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return name;
}

std::string suffix_of(const std::string& path) {
  std::string suffix = in_lower_case(std::filesystem::path(path).extension().string());
  if (!suffix.empty()) suffix.erase(0, 1);
  if (suffix == "gz" && is_label_map(path)) return "nii";
  return suffix;
}

std::vector<std::string> readable_endings() {
  std::vector<std::string> endings = {".stl", ".obj", ".ply", ".off", ".gltf", ".glb", ".dae",
                                      ".fbx", ".3ds", ".3mf", ".vtk", ".vtu",  ".msh"};
  if (reads_label_maps()) endings.insert(endings.end(), {".nii", ".nii.gz", ".nrrd"});
  return endings;
}

bool has_readable_ending(const std::string& name) {
  const std::vector<std::string> endings = readable_endings();
  const std::string lower = in_lower_case(name);
  return std::any_of(endings.begin(), endings.end(),
                     [&](const std::string& ending) { return lower.ends_with(ending); });
}

namespace {

/// DICOM files have any name, and four letters behind a preamble (DICOM PS3.10, section 7.1).
bool is_dicom(const std::string& path) {
  constexpr std::streamoff kPreamble = 128;
  std::ifstream file(path, std::ios::binary);
  std::array<char, 4> mark{};
  return file.seekg(kPreamble) && file.read(mark.data(), mark.size()) && mark == std::array{'D', 'I', 'C', 'M'};
}

}  // namespace

Errors check_file(const std::string& path) {
  std::error_code trouble;
  const auto status = std::filesystem::status(path, trouble);
  if (status.type() == std::filesystem::file_type::not_found) return {{path, "no such file", "check the path"}};
  if (!trouble && access(path.c_str(), R_OK) != 0) trouble = std::error_code(errno, std::generic_category());
  if (trouble) return {{path, "cannot be read: " + trouble.message(), ""}};
  if (std::filesystem::is_directory(status)) return {{path, "is a folder, not a mesh file", "name a file in it"}};
  if (!std::filesystem::is_regular_file(status)) return {{path, "is not a regular file", ""}};
  const auto size = std::filesystem::file_size(path, trouble);
  if (trouble) return {{path, "cannot be read: " + trouble.message(), ""}};
  if (size == 0) return {{path, "is empty", "export the mesh again"}};
  if (is_dicom(path))
    return {{path, "is a DICOM file, which is not read",
             "save the segmentation as NRRD or NIfTI, as 3D Slicer does, or export its surface"}};
  return {};
}

namespace {

void put_parts(wire::Writer& message, wire::Kind kind, const std::vector<std::string>& parts) {
  message.put(kind);
  message.put<std::uint64_t>(parts.size());
  for (const std::string& name : parts) message.put_text(name);
}

}  // namespace

void send_soup(const std::vector<std::string>& parts, std::ptrdiff_t part, double unit_in_metres, const Soup& soup,
               const Send& send) {
  wire::Writer message;
  put_parts(message, wire::Kind::mesh, parts);
  message.put(unit_in_metres);
  message.put_list(soup.vertex);
  message.put_list(soup.triangle);
  message.put_list(std::vector<std::int32_t>(part < 0 ? 0 : soup.triangle.size(), std::int32_t(part)));
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  message.put_list(std::vector<Vec3>(parts.size(), Vec3{kNone, kNone, kNone}));
  send(message.bytes.data(), message.bytes.size());
}

void send_no_such_part(const std::vector<std::string>& parts, const Send& send) {
  wire::Writer message;
  put_parts(message, wire::Kind::no_such_part, parts);
  send(message.bytes.data(), message.bytes.size());
}

void send_refusal(const Error& error, const Send& send) {
  wire::Writer message;
  message.put(wire::Kind::refused);
  message.put_text(error.message);
  message.put_text(error.hint);
  send(message.bytes.data(), message.bytes.size());
}

namespace {

std::string known_formats() {
  std::string text;
  for (const std::string& ending : readable_endings()) text += (text.empty() ? "" : ", ") + ending;
  return text + " files are read, among others";
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

/// Vertices used by triangles must be finite; others do not matter. Triangles are counted, because readers number
/// vertices in different ways.
Errors check_vertices(const RawMesh& mesh) {
  const std::int64_t bad_count = std::ranges::count_if(mesh.triangle, [&](const Triangle& triangle) {
    return std::ranges::any_of(triangle, [&](std::int32_t v) { return !is_finite(mesh.vertex[std::size_t(v)]); });
  });
  if (bad_count == 0) return {};
  return {{mesh.path,
           counted(bad_count, "triangle") + " of " + std::to_string(mesh.triangle.size()) +
               (bad_count == 1 ? " has" : " have") + " corners whose coordinates are not finite numbers",
           "look for nan or inf in the file; export the mesh again, they cannot be repaired"}};
}

/// Merges repeated vertices.
void join_repeats(RawMesh& mesh) {
  Soup soup{std::move(mesh.vertex), std::move(mesh.triangle)};
  weld(soup, 0);
  mesh.vertex = std::move(soup.vertex);
  mesh.triangle = std::move(soup.triangle);
}

bool has_indices_in_range(const RawMesh& mesh) {
  const std::int32_t count = std::int32_t(mesh.vertex.size()), parts = std::int32_t(mesh.parts.size());
  const bool has_parts = (mesh.part_of_triangle.empty() || mesh.part_of_triangle.size() == mesh.triangle.size()) &&
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
  const auto reader_of_file = is_label_map(path)     ? send_label_map
                              : is_volume_mesh(path) ? send_volume_mesh
                                                     : send_mesh_file;
  const ChildResult child = run_in_child(limits, [&](const Send& send) { reader_of_file(path, options.part, send); });
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
  std::string text, hint;
  if (kind == wire::Kind::refused) {
    if (!reader.get_text(text) || !reader.get_text(hint)) return broken;
    return Error{path, text, hint};
  }
  if (kind == wire::Kind::failed) {
    if (!reader.get_text(text)) return broken;
    return Error{path, "is not a mesh that can be read: " + text, known_formats()};
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
  // assimp's reader has merged them, unless some were not finite.
  if (reader_of_file != send_mesh_file || !std::all_of(mesh.vertex.begin(), mesh.vertex.end(), is_finite))
    join_repeats(mesh);
  return mesh;
}

}  // namespace ctpm::importers
