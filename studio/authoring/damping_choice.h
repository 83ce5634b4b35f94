#pragma once

#include "core/model/model.h"

namespace ctpm::authoring {

/// Whether the integrator has to damp: softening (Eq. 8) gives energy to what swings, and cuts leave flaps that swing.
/// It does where the Model's own integrator does not and the tissue's viscosity hardly does.
bool needs_damping(const Model& model);

}  // namespace ctpm::authoring
