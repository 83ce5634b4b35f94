#pragma once

#include <string_view>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"

namespace ctpm {

/// The one list of everything in a Model and a State. Storing, reading, hashing and comparing are all made
/// from it. `visit(name, member)` is called for each member in a fixed order; members are arithmetic values,
/// enums, Vec3, Quat, std::string, or vectors of numbers or enums. A Vec3Array is visited as its three coordinates.
/// Names are stored in session files: never give one another meaning, append new ones. Names that earlier programs
/// wrote are read in recordings/internal/legacy_fields.h.
template <class Points, class Visit>
void visit_points(std::string_view x, std::string_view y, std::string_view z, Points& points, Visit&& visit) {
  visit(x, points.x), visit(y, points.y), visit(z, points.z);
}

template <class State_, class Visit>
requires std::is_same_v<std::remove_const_t<State_>, State>
void for_each_field(State_& s, Visit&& visit) {
  visit("tick", s.tick);
  visit_points("position.x", "position.y", "position.z", s.position, visit);
  visit_points("velocity.x", "velocity.y", "velocity.z", s.velocity, visit);
  visit("kelvin_elongation", s.kelvin_elongation);
  visit("axial_severed", s.axial_severed);
  visit("constraint_severed", s.constraint_severed);
  visit("angle_severed", s.angle_severed);
  visit("last_inputs.tool", s.last_inputs.tool);
  visit("last_inputs.position", s.last_inputs.position);
  visit("last_inputs.world_from_tool", s.last_inputs.world_from_tool);
  visit("last_inputs.buttons", s.last_inputs.buttons);
  visit("axial_crossing", s.axial_crossing);
  visit_points("blade_trail.x", "blade_trail.y", "blade_trail.z", s.blade_trail, visit);
  visit_points("acceleration.x", "acceleration.y", "acceleration.z", s.acceleration, visit);
}

template <class Tool_, class Visit>
requires std::is_same_v<std::remove_const_t<Tool_>, Tool>
void for_each_field(Tool_& t, Visit&& visit) {
  visit("name", t.name);
  visit("kind", t.kind);
  visit("radius", t.radius);
  visit("blade_length", t.blade_length);
  visit("sphere", t.sphere);
}

template <class Organ_, class Visit>
requires std::is_same_v<std::remove_const_t<Organ_>, OrganRange>
void for_each_field(Organ_& o, Visit&& visit) {
  visit("name", o.name);
  visit("first", o.first);
  visit("count", o.count);
  visit("sphere_radius", o.sphere_radius);
  visit("spacing", o.spacing);
  visit("damage_depth", o.damage_depth);
  visit("layer_count", o.layer_count);
}

/// As above; `organs` and `tools` are vectors of structs, whose own fields are visited by for_each_field.
template <class Model_, class Visit>
requires std::is_same_v<std::remove_const_t<Model_>, Model>
void for_each_field(Model_& m, Visit&& visit) {
  visit("tick", m.tick);
  visit("gravity", m.gravity);
  visit_points("rest_position.x", "rest_position.y", "rest_position.z", m.rest_position, visit);
  visit("mass", m.mass);
  visit("held_axes", m.held_axes);
  visit("contact_radius", m.contact_radius);
  visit("layer", m.layer);
  visit("cell.i", m.cell.i), visit("cell.j", m.cell.j), visit("cell.k", m.cell.k);
  visit("organs", m.organs);
  visit("axial.a", m.axial.a);
  visit("axial.b", m.axial.b);
  visit("axial.law", m.axial.law);
  visit("axial.rest_length", m.axial.rest_length);
  visit("axial.k", m.axial.k);
  visit("axial.c", m.axial.c);
  visit("axial.kelvin_k", m.axial.kelvin_k);
  visit("axial.internal", m.axial.internal);
  visit("axial.third", m.axial.third);
  visit("constraints.a", m.constraints.a);
  visit("constraints.c", m.constraints.c);
  visit("constraints.e", m.constraints.e);
  visit("constraints.k", m.constraints.k);
  visit("constraints.edge0", m.constraints.edge[0]);
  visit("constraints.edge1", m.constraints.edge[1]);
  visit("constraints.edge2", m.constraints.edge[2]);
  visit("constraints.edge3", m.constraints.edge[3]);
  visit("angle_springs.a", m.angle_springs.a);
  visit("angle_springs.b", m.angle_springs.b);
  visit("angle_springs.c", m.angle_springs.c);
  visit("angle_springs.k", m.angle_springs.k);
  visit("angle_springs.edge0", m.angle_springs.edge[0]);
  visit("angle_springs.edge1", m.angle_springs.edge[1]);
  visit("has_softening", m.has_softening);
  visit("loads.sphere", m.loads.sphere);
  visit_points("loads.force.x", "loads.force.y", "loads.force.z", m.loads.force, visit);
  visit("loads.start", m.loads.start);
  visit("loads.ramp", m.loads.ramp);
  visit("tools", m.tools);
  visit("contact_k", m.contact_k);
  visit("contact_friction", m.contact_friction);
  visit("solver.tolerance", m.solver.tolerance);
  visit("solver.velocity_floor", m.solver.velocity_floor);
  visit("solver.max_iterations", m.solver.max_iterations);
  visit("solver.substeps", m.solver.substeps);
  visit("solver.integrator", m.solver.integrator);
  visit("cut_resistance.energy", m.cut_resistance.energy);
  visit("cut_resistance.friction", m.cut_resistance.friction);
  visit("lip_k", m.lip_k);
}

}  // namespace ctpm
