#pragma once

#include "core/contact/contacts.h"
#include "core/elements/elements.h"
#include "core/elements/kernels/kernels.h"
#include "core/inversion/resistance.h"
#include "core/model/model.h"
#include "core/parallel/team.h"
#include "core/stepping/step.h"

namespace ctpm::stepping {

/// A part of a tick.
struct Substep {
  double h;               ///< length [s]
  double time;            ///< simulated time at its end [s]
  double share;           ///< part of the tick's tool motion that is done at its end, 0 to 1
  bool has_loads = true;  ///< whether Model::loads act (they do not while a scene settles)
};

/// What an integrator refers to; all of it must outlive the integrator.
struct StepContext {
  const Model& model;
  const elements::Kernels& kernels;
  parallel::Team& team;
  elements::Elements& elements;
  contact::Contacts& contacts;
  inversion::Resistance& resistance;
};

/// Reports the contacts at the end of a substep, with the spheres at `position` [m].
inline void report_contacts(const contact::ContactSet& contacts, const Vec3Array& position, StepReport& report) {
  report.depth = contacts.depth(position), report.contacts = contacts.touched();
}

}  // namespace ctpm::stepping
