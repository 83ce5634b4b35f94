#pragma once

#include <cstdint>
#include <vector>

#include "core/organ.h"
#include "core/state.h"

namespace ctpm {

/// Floats of one vertex as the organ shader reads them: position, normal, rest position [m], crevice.
constexpr int kOrganVertexFloats = 10;

/// The moving vertices of one surface, made new for every picture.
class OrganMesh {
 public:
  /// Deforms `surface` and fills vertices(). `first_sphere`: of the organ, in the State.
  void update(const Surface& surface, const State& state, std::int32_t first_sphere);

  /// Interleaved floats (vertex_count x kOrganVertexFloats). The crevice is negative in hollows and positive
  /// on ridges.
  const std::vector<float>& vertices() const { return data_; }
  const std::vector<Vec3>& positions() const { return position_; }  ///< [m]

 private:
  std::vector<Vec3> position_, normal_;
  std::vector<double> crevice_;
  std::vector<std::int32_t> valence_;
  std::vector<float> data_;
};

}  // namespace ctpm
