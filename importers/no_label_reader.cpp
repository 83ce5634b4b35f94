#include "importers/label_map.h"

// In place of label_reader.cpp where ITK is missing or not wanted.
namespace ctpm::importers {

bool reads_label_maps() { return false; }

Result<LabelMap> read_label_map(const std::string& path) {
  return Error{
      path, "is a label map, which this build of ctpm does not read",
      "install libinsighttoolkit5-dev and build it again with CTPM_LABELS on, or export the surface as a mesh"};
}

}  // namespace ctpm::importers
