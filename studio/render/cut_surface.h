#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"

namespace ctpm::render {

/// An organ's surface as it is drawn: split where the organ was cut, its lips on their own sides, and the
/// wall of the cut between them. Nothing is remembered from tick to tick but what is severed, so any State
/// may follow any other.
class CutSurface {
 public:
  /// `whole` is the uncut surface of organ `organ`, bound to its spheres.
  CutSurface(const Model& model, std::size_t organ, const Surface& whole);
  ~CutSurface();
  CutSurface(CutSurface&&) noexcept;

  /// Takes over what is severed in `state`. Returns whether surface() changed.
  bool update(const State& state);

  /// Outer triangles first, then the wall's. The wall has its own vertices, so that normals break at the lip.
  /// Vertices are given at rest, where both lips of a cut coincide; deform_surface() opens it.
  const Surface& surface() const;
  std::size_t outer_triangle_count() const;
  std::size_t outer_vertex_count() const;

  /// 1 where an outer vertex lies on the lip of a cut                        (outer_vertex_count, or empty
  /// without a cut)
  const std::vector<std::uint8_t>& is_lip() const;

  /// How much a vertex of the wall belongs to the outermost layer: 1 in it, 0 in the second and below. 0 for
  /// outer vertices, and in organs of one layer                     (vertex_count, or empty without a cut)
  const std::vector<float>& rind() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ctpm::render
