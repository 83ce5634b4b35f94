#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "core/model/vec3.h"
#include "importers/child_process.h"

namespace ctpm::importers {

/// A label of a segmentation.
struct Label {
  std::int32_t number = 0;  ///< its value in the voxels, not 0
  std::string name;         ///< as the file says; empty: it does not
  std::int32_t layer = 0;   ///< of the voxels that hold it; files with segments that overlap have several
  std::int64_t voxels = 0;
  double volume = 0;  ///< of its voxels [m^3]

  /// Its name, else its number.
  std::string text() const { return name.empty() ? std::to_string(number) : name; }
};

/// A segmentation: whole numbers on a lattice of voxels, 0 for the background.
struct LabelMap {
  std::array<std::int32_t, 3> size{};  ///< voxels along i, j, k
  std::array<Vec3, 3> step{};          ///< from a voxel to the next along i, j, k [mm], LPS
  Vec3 origin;                         ///< centre of voxel 0, 0, 0 [mm], LPS: +x left, +y back, +z head
  std::int32_t layers = 1;
  std::vector<std::int32_t> value;  ///< i fastest, then j, then k; the layers of a voxel together (voxels x layers)
  std::vector<Label> labels;        ///< those that have voxels, by layer and number

  std::size_t voxel_count() const { return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]); }
};

/// Whether the file's name is that of a label map: .nii, .nii.gz, .nrrd.
bool is_label_map(const std::string& path);

/// Whether this build reads label maps (CTPM_LABELS, ITK).
bool reads_label_maps();

/// Reads a NIfTI or NRRD file with all its labels. Memory is bounded by the file's size: a header that promises more
/// than the file can hold is refused before anything is allocated. Errors: a build without ITK, a file that is damaged,
/// has its voxels in another file, is not three-dimensional, is sheared or flat, or holds values that are not labels.
Result<LabelMap> read_label_map(const std::string& path);

/// The labels of a file, read in a child process with limits. Errors: those of read_label_map(), a child that failed.
Result<std::vector<Label>> list_labels(const std::string& path);

/// Index of the label with that name, else with that number; -1: none.
std::ptrdiff_t find_label(const std::vector<Label>& labels, const std::string& name);

/// Reads a label map and sends the surface of one label (see wire.h), whose name or number is `part`; the only one if
/// `part` is empty. Call it in a child process.
void send_label_map(const std::string& path, const std::string& part, const Send& send);

}  // namespace ctpm::importers
