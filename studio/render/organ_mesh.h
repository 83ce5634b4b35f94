#pragma once

#include <vector>

#include "core/contact/drawn_surfaces.h"
#include "core/model/organ.h"
#include "core/model/state.h"
#include "studio/render/shading.h"
#include "studio/render/shading_correction.h"

namespace ctpm::render {

/// Floats of one vertex as the organ shader reads them: position, normal, rest position [m], crevice, stain, lip, rind.
constexpr int kOrganVertexFloats = 13;

/// How often the colour of tissue wanders.
constexpr double kStainsPerMetre = 72;

/// The moving vertices of one surface, computed for every picture.
class OrganMesh {
 public:
  /// Takes over a surface whose vertices or triangles changed. `lip`: from nearness_to_lips(), or empty; `rind`,
  /// `at_rest`: as in CutSurface.
  void set_surface(const Surface& surface, const std::vector<float>& lip, const std::vector<float>& rind,
                   const Shading& at_rest);

  /// Places the surface, that of organ `organ` of the Model of `drawn`, and fills vertices().
  void update(contact::DrawnSurfaces& drawn, std::size_t organ, const Surface& surface, const State& state);

  /// Interleaved floats (vertex_count x kOrganVertexFloats). The crevice is negative in hollows and positive
  /// on ridges.
  const std::vector<float>& vertices() const { return data_; }
  const std::vector<Vec3>& positions() const { return position_; }  ///< [m]

 private:
  std::vector<Vec3> position_;
  Shading shading_;
  std::vector<Vec3> stained_;  ///< rest positions for which stain_ was computed [m]
  std::vector<float> per_neighbour_, stain_, lip_, rind_;

  ShadingCorrections corrections_;
  std::vector<float> data_;
};

}  // namespace ctpm::render
