#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/cutting/rest_map.h"
#include "core/cutting/swept_surface.h"
#include "core/cutting/tissue_depth.h"
#include "core/model/model.h"
#include "core/model/state.h"
#include "importers/surface_index.h"

namespace ctpm::session {

/// Size of all cuts of a State, in the tissue at rest.
struct CutSize {
  double depth = 0;   ///< of the deepest place below the organs' surfaces [m]
  double length = 0;  ///< along the organs' surfaces [m]
  double area = 0;    ///< of one side [m^2]
};

/// Measures cuts on the surface that the blade's edge swept, whatever the lattice.
class CutMeasures {
 public:
  /// `model` must outlive this.
  explicit CutMeasures(const Model& model);

  /// Measures the cuts of a State; fast if it is a later one of the same session.
  void measure(const State& state);

  /// None if nothing was cut, or if no organ has a surface. Sessions of physics revisions before 4 do not store the
  /// swept surface: of a State of theirs, only what was cut in the present replay is known.
  std::optional<CutSize> size() const { return size_; }

  /// How deep a blade's edge is in an organ of the State, in the tissue at rest [m]; 0 where no node of it is inside.
  double edge_depth(const State& state) const;

 private:
  void add(const cutting::SweptQuad& quad, CutSize& size) const;

  cutting::RestMap map_;
  cutting::TissueDepth depth_;
  std::vector<std::optional<importers::SurfaceIndex>> surfaces_;  ///< of each organ
  std::size_t rows_ = 0;                                          ///< measured; those after it may still move
  Vec3 last_;                                                     ///< first place of the last of them [m]
  CutSize measured_;                                              ///< of these
  bool any_ = false;
  std::optional<CutSize> size_;
};

}  // namespace ctpm::session
