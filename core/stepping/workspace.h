#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "core/contact/blade_force.h"
#include "core/contact/contact.h"
#include "core/contact/lips.h"
#include "core/contact/pair_contact.h"
#include "core/cutting/cutting.h"
#include "core/cutting/near_elements.h"
#include "core/cutting/pieces.h"
#include "core/elements/elements.h"
#include "core/stepping/backward_euler.h"
#include "core/stepping/leapfrog.h"
#include "core/stepping/outside.h"
#include "core/stepping/step.h"

namespace ctpm {

/// What the tool in the hand is in one tick.
struct Grip {
  const Tool* tool = nullptr;  ///< null: the hand is empty
  Vec3 from, to;               ///< way of the tool's origin in this tick [m]
  BladeMotion blade;           ///< of a scalpel
  std::size_t swept = 0;       ///< elements that a scalpel severed on its way

  /// Where the hand is at `share` of its way.
  Vec3 at(double share) const { return from + share * (to - from); }

  bool is(ToolKind kind) const { return tool != nullptr && tool->kind == kind; }
};

/// A part of a tick.
struct Substep {
  double h;      ///< length [s]
  double time;   ///< simulated time at its end [s]
  double share;  ///< of the hand's way done at its end
};

/// How a State moves.
struct Kinematics {
  Vec3Array position, velocity;           ///< [m], [m/s] (sphere_count)
  std::vector<double> kelvin_elongation;  ///< [m] (internal_count)
};

/// Kernels and scratch of one Model. A tick is done in step.cpp, its parts by each integrator in substeps.cpp.
struct Stepper::Workspace {
  Workspace(const Model& m, const StepperOptions& options)
      : model(m),
        choice(choose_integrator(m)),
        kernels(kernels_for(options.instruction_set)),
        team(options.threads),
        elements(m, team, options.instruction_set),
        contact(m, kernels),
        blade(m),
        lips(m),
        pairs(m, m.has_scalpel() ? blade.most() + lips.most() : 0),
        pieces(m),
        held_axes(m.held_axes),
        velocity(3 * m.sphere_count()) {
    for (const double length : m.axial.rest_length) shortest_element = std::min(shortest_element, length);
    if (m.has_scalpel()) near.emplace(m), crossings.reserve(m.axial.size()), pieces.reserve();
    if (choice.integrator == Integrator::leapfrog)
      explicit_solver.emplace(m, elements.slabs());
    else
      implicit_solver.emplace(m, elements.slabs(), team, kernels);
    if (choice.integrator == Integrator::backward_euler) return;
    other.position.resize(m.sphere_count()), other.kelvin_elongation.resize(m.axial.internal_count());
    if (choice.integrator == Integrator::sdirk2) other.velocity.resize(m.sphere_count()), start = other;
  }

  void sweep(State& state, const Inputs& last, const Inputs& inputs, Grip& grip, StepReport& report);
  void find_pairs(const State& state, const Grip& grip);
  void find_contacts(const State& state, const Grip& grip, double h, double share, bool is_guess);
  bool advance(State& state, const Grip& grip, const Substep& part, StepReport& report);
  bool leap(State& state, const Grip& grip, const Substep& part, StepReport& report);
  bool euler(State& state, const Grip& grip, const Substep& part, StepReport& report);
  bool sdirk(State& state, const Grip& grip, const Substep& part, StepReport& report);
  bool two_stages(State& state, const Grip& grip, const Substep& part, double h, StepReport& report);
  bool stage(State& state, const Grip& grip, const Substep& part, bool is_second, StepReport& report);
  bool check(StepReport& report);
  void drift(double h, const State& state, Vec3Array& position);
  void go_on(State& state, double h);
  void report_tool(const State& state, StepReport& report) const;

  const Model& model;
  IntegratorChoice choice;
  const Kernels& kernels;
  Team team;
  Elements elements;
  BallContact contact;
  BladeForce blade;
  LipContact lips;
  PairContacts pairs;  ///< of the blade and of the lips of cuts
  Pieces pieces;
  std::optional<NearElements> near;  ///< the blade, if the Model has one
  std::vector<Crossing> crossings;   ///< elements severed in this tick
  std::optional<Leapfrog> explicit_solver;
  std::optional<BackwardEuler> implicit_solver;
  std::vector<std::uint8_t> held_axes;
  std::int32_t pinned = -1;
  bool has_loads = true;
  Coordinates velocity;
  std::vector<double> fastest_of_slab;                                ///< squared speed [m^2/s^2] (slab_count)
  double shortest_element = std::numeric_limits<double>::infinity();  ///< at rest [m]
  Vec3Array before;  ///< positions before the substep, for what moves through a blade
  State backup;      ///< State before the tick, in case it has to be refused
  Kinematics start;  ///< of a substep in stages
  Kinematics other;  ///< what State was, or is to be, while it is in the middle of a substep or at a guess of its end
};

}  // namespace ctpm
