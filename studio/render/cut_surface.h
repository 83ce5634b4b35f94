#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"
#include "studio/render/shading.h"

namespace ctpm::render {

/// Share of the outermost layer of spheres in tissue of that mean layer: 1 in the first, 0 in the second and below.
float rind_of_layer(double layer);

/// An organ's surface as it is drawn: cutbody::CutBody, and what its colours need. In a scene without a blade it is the
/// organ's own surface. The States may come in any order.
class CutSurface {
 public:
  /// `model` must outlive the CutSurface.
  CutSurface(const Model& model, std::size_t organ);
  ~CutSurface();
  CutSurface(CutSurface&&) noexcept;

  /// Takes over the cuts of `state`. Returns whether surface() changed.
  bool update(const State& state);

  /// Finds the surface of a State that update() will be called with, so that it need not. For another thread than all
  /// else; the States must come in the order in which they are drawn.
  void follow_ahead(const State& state);

  /// How often surface() has changed.
  std::uint64_t changes() const;

  /// Outer triangles first, then the wall's. The wall has its own vertices, so that normals break at the cut edge.
  /// Vertices are at rest, where both sides of a cut coincide; deform_surface() opens the cut.
  const Surface& surface() const;
  std::size_t outer_triangle_count() const;
  std::size_t outer_vertex_count() const;

  /// 1 for outer vertices on the edge of a cut                      (outer_vertex_count, or empty without a cut)
  const std::vector<std::uint8_t>& is_lip() const;

  /// Share of the outermost layer in a vertex of the wall: 1 in that layer, 0 in the second and below. 0 for outer
  /// vertices, and in organs of one layer                           (vertex_count, or empty without a cut)
  const std::vector<float>& rind() const;

  /// The shading of the organ's own surface at rest, at the outer vertices; normals are 0 where it is not known
  /// (outer_vertex_count, or empty without a cut)
  const Shading& at_rest() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ctpm::render
