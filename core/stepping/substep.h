#pragma once

#include "core/contact/contacts.h"
#include "core/elements/elements.h"
#include "core/elements/kernels/kernels.h"
#include "core/model/model.h"
#include "core/parallel/team.h"

namespace ctpm {

/// A part of a tick.
struct Substep {
  double h;               ///< length [s]
  double time;            ///< simulated time at its end [s]
  double share;           ///< of the tool's motion in the tick that is done at its end, 0 to 1
  bool has_loads = true;  ///< Model::loads act (they do not while a scene settles)
};

/// What the integrator of one Model works with; all of it outlives the integrator.
struct StepContext {
  const Model& model;
  const Kernels& kernels;
  Team& team;
  Elements& elements;
  Contacts& contacts;
};

}  // namespace ctpm
