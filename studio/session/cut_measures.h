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
#include "studio/session/depth_along_blade.h"

namespace ctpm::session {

/// Size of all cuts of a State, in the tissue at rest.
struct CutSize {
  double depth = 0;   ///< of the deepest place, from the nearest surface of its organ [m]
  double length = 0;  ///< along the organs' surfaces [m]
  double area = 0;    ///< of one side [m^2]
  /// How deep the blade was in an organ at most where it cut anything [m]: see depth_along_blade(). A cut that is
  /// deeper is more, while `depth` is never more than half of the organ's thickness. Of the blade's point only the tip
  /// counts: what the point cuts behind the edge lies higher along the blade, in a stab too.
  double along_blade = 0;
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

  /// How deep a blade's edge is in an organ of the State along the blade, in the tissue at rest [m]; 0: it is in none.
  double edge_depth(const State& state) const;

 private:
  void add(const cutting::SweptQuad& quad, CutSize& size) const;
  double along_blade(const State& state, std::size_t row, Vec3& way) const;

  cutting::RestMap map_;
  cutting::TissueDepth depth_;
  std::vector<std::optional<importers::SurfaceIndex>> surfaces_;  ///< of each organ
  std::size_t rows_ = 0;                                          ///< measured; those after it may still move
  Vec3 last_;                                                     ///< first place of the last of them [m]
  CutSize measured_;                                              ///< of these
  Vec3 way_;                                                      ///< along the blade in these: depth_along_blade()
  bool any_ = false;
  std::optional<CutSize> size_;
};

}  // namespace ctpm::session
