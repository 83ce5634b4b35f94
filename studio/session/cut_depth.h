#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"
#include "importers/surface_index.h"

namespace ctpm::session {

/// Depth of a cut: the rest distance of the deepest severed axial element from the organs' surfaces. It counts an
/// element's middle.
class CutDepth {
 public:
  /// `surfaces` at rest. `model` must outlive this.
  explicit CutDepth(const Model& model);

  /// Adds the severed elements of a later State of the same session.
  void add(const State& state);

  /// Adds one axial element.
  void add(std::size_t element);

  /// The depth [m]. None if nothing was severed or there are no surfaces.
  std::optional<double> deepest() const { return deepest_; }

 private:
  const Model& model_;
  std::vector<importers::SurfaceIndex> surfaces_;
  std::vector<bool> is_added_;  ///< (axial_count)
  std::optional<double> deepest_;
};

}  // namespace ctpm::session
