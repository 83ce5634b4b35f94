#pragma once

#include "core/contact/contacts.h"
#include "core/elements/elements.h"
#include "core/elements/kernels/kernels.h"
#include "core/inversion/resistance.h"
#include "core/model/model.h"
#include "core/parallel/team.h"
#include "core/stepping/motion.h"
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

/// Ends the contacts of a substep with the spheres in `to`: reports them, and notes what a ball touches.
inline void finish_contacts(const contact::ContactSet& contacts, const contact::HeldTool& tool, const Substep& part,
                            Motion& to, StepReport& report) {
  report.depth = contacts.depth(to.position), report.contacts = contacts.touched();
  contacts.note_touched(tool.at(part.share), to.position, to.touched);
}

}  // namespace ctpm::stepping
