#pragma once

#include "core/contact/contacts.h"
#include "core/elements/elements.h"
#include "core/elements/kernels/kernels.h"
#include "core/inversion/resistance.h"
#include "core/model/model.h"
#include "core/parallel/team.h"
#include "core/stepping/motion.h"
#include "core/stepping/sleepers.h"
#include "core/stepping/step.h"

namespace ctpm::stepping {

/// A part of a tick.
struct Substep {
  double h;               ///< length [s]
  double time;            ///< simulated time at its end [s]
  double share;           ///< part of the tick's motion of the tools that is done at its end, 0 to 1
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
  Sleepers& sleepers;
};

/// Ends the contacts of a substep with the spheres in `to`: reports them, and notes what is touched.
inline void finish_contacts(const contact::ContactSet& contacts, const contact::HeldTools& tools, const Substep& part,
                            Motion& to, StepReport& report) {
  for (std::size_t hand = 0; hand < kMostHands; ++hand) {
    if (tools[hand].tool == nullptr) continue;
    report.of_hand(hand).depth = contacts.depth(hand, to.position);
    report.of_hand(hand).contacts = contacts.touched(hand);
  }
  contacts.note_touched({tools[0].at(part.share), tools[1].at(part.share)}, to.position, to.touched);
}

}  // namespace ctpm::stepping
