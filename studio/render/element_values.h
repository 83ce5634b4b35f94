#pragma once

#include <cstdint>
#include <vector>

#include "core/model/model.h"
#include "core/model/state.h"
#include "studio/render/scene_view.h"

namespace ctpm::render {

/// One element as it is drawn: a rod between two spheres, and its value.
struct ElementValue {
  std::int32_t a = 0, b = 0;  ///< end spheres
  double value = 0;           ///< [1, rad or N]
};

/// Fills `values` with the unsevered elements: axial elements for stretch and force, both halves of every five-sphere
/// line for tilt. The force is that of springs and dashpots in `state`, softened (Eq. 8).
void measure_elements(const Model& model, const State& state, ElementQuantity quantity,
                      std::vector<ElementValue>& values);

}  // namespace ctpm::render
