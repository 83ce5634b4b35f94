#pragma once

#include "core/elements/axial.h"
#include "core/model/model.h"

namespace ctpm::stepping {

/// Forces on the spheres from outside the tissue: weight, and the Model's loads at one moment.
struct ExternalLoads {
  const Model& model;
  double time;     ///< simulated time [s]
  bool has_loads;  ///< Model::loads act; the weight always does

  /// Writes the forces on spheres [begin, end) into `force` [N]  (3 x sphere_count).
  void set(std::size_t begin, std::size_t end, elements::Coordinates& force) const;

 private:
  void add_loads(std::size_t begin, std::size_t end, elements::Coordinates& force) const;
};

}  // namespace ctpm::stepping
