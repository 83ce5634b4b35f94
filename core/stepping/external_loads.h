#pragma once

#include "core/elements/axial.h"
#include "core/model/model.h"

namespace ctpm::stepping {

/// External forces on the spheres: their weight, and the Model's loads at one time.
struct ExternalLoads {
  const Model& model;
  double time;     ///< simulated time [s]
  bool has_loads;  ///< whether Model::loads act; the weight always does

  /// Writes the forces on spheres [begin, end) into `force` [N]  (3 x sphere_count).
  void set(std::size_t begin, std::size_t end, elements::Coordinates& force) const;

 private:
  void add_loads(std::size_t begin, std::size_t end, elements::Coordinates& force) const;
};

}  // namespace ctpm::stepping
