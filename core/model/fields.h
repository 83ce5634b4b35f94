#pragma once

#include <string_view>
#include <utility>

#include "core/model/field_meaning.h"
#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"

namespace ctpm {

// The one list of every field of a Model and a State: storing, reading, hashing, comparing and checking all use it. It
// calls `visit(name, member, meaning)` or `visit(name, member)` for each member in a fixed order. Members are
// arithmetic values, enums, Vec3, Quat, std::string, or vectors of numbers or enums; a Vec3Array is visited as its
// three coordinates. Session files store the names: append new ones and never give one another meaning.
// recordings/internal/legacy_fields.h reads the names of earlier programs.

/// Largest solver settings that a file may ask for: iterations of a solve, substeps of a tick.
inline constexpr std::int32_t kMostIterations = 1'000'000, kMostSubsteps = 10'000;

/// Most layers of an organ: more than fit between two sides of any lattice that is stored.
inline constexpr std::int32_t kMostLayers = 10'000;

/// Largest magnitude of a lattice coordinate: more than any organ has, and well within 32 bits.
inline constexpr std::int32_t kFarthestCell = 1 << 20;

template <class Points, class Give>
void give_points(std::string_view x, std::string_view y, std::string_view z, Points& points,
                 const FieldMeaning& meaning, const Give& give) {
  give(x, points.x, meaning), give(y, points.y, meaning), give(z, points.z, meaning);
}

template <class State_, class Visit>
requires std::is_same_v<std::remove_const_t<State_>, State>
void for_each_field(State_& s, Visit&& visit) {
  using namespace meaning;
  const auto give = with_meaning(visit);
  give("tick", s.tick, within(0, 1e15));
  give_points("position.x", "position.y", "position.z", s.position, moved_place.per(EntryOf::sphere), give);
  give_points("velocity.x", "velocity.y", "velocity.z", s.velocity, speed.per(EntryOf::sphere), give);
  give("kelvin_elongation", s.kelvin_elongation, finite.per(EntryOf::internal_variable));
  give("axial_severed", s.axial_severed, bits(1).per(EntryOf::axial).or_empty());
  give("constraint_severed", s.constraint_severed, bits(1).per(EntryOf::constraint).or_empty());
  give("angle_severed", s.angle_severed, bits(1).per(EntryOf::angle_spring).or_empty());
  give("last_inputs.tool", s.last_inputs.tool, index(EntryOf::tool, -1));
  give("last_inputs.position", s.last_inputs.position, any);
  give("last_inputs.world_from_tool", s.last_inputs.world_from_tool, any);
  give("last_inputs.buttons", s.last_inputs.buttons, any);
  give("axial_crossing", s.axial_crossing, any.per(EntryOf::axial).or_empty());
  give_points("blade_trail.x", "blade_trail.y", "blade_trail.z", s.blade_trail, finite, give);
  give_points("acceleration.x", "acceleration.y", "acceleration.z", s.acceleration,
              finite.per(EntryOf::sphere).or_empty(), give);
  give("touched", s.touched, index(EntryOf::touchable));
  give_points("grip.x", "grip.y", "grip.z", s.grip, finite, give);
  give("kelvin_dent", s.kelvin_dent, finite);
  give("edge_organ", s.edge_organ, any);
  give_points("swept.x", "swept.y", "swept.z", s.swept, finite, give);
  give("swept_organ", s.swept_organ, any);
  // Written and hashed only if the second hand did anything; read from every file.
  if (!std::is_const_v<State_> || s.last_inputs.second != Hand{}) {
    give("last_inputs.second.tool", s.last_inputs.second.tool, index(EntryOf::tool, -1));
    give("last_inputs.second.position", s.last_inputs.second.position, any);
    give("last_inputs.second.world_from_tool", s.last_inputs.second.world_from_tool, any);
    give("last_inputs.second.buttons", s.last_inputs.second.buttons, any);
  }
  // Likewise only once something was cut that can be touched.
  if (!std::is_const_v<State_> || s.open_cuts != TouchedCuts{} || s.opening_cuts != TouchedCuts{} ||
      s.opening_cuts_at != 0) {
    const FieldMeaning severed = bits(1).per(EntryOf::axial).or_empty();
    give("open_cuts.rows", s.open_cuts.rows, not_negative);
    give("open_cuts.axial_severed", s.open_cuts.axial_severed, severed);
    give("opening_cuts.rows", s.opening_cuts.rows, not_negative);
    give("opening_cuts.axial_severed", s.opening_cuts.axial_severed, severed);
    give("opening_cuts.at", s.opening_cuts_at, within(0, 1e15));
  }
  // And only where tissue may sleep.
  if (!std::is_const_v<State_> || !s.still_ticks.empty()) give("still_ticks", s.still_ticks, within(0, 1e9));
}

template <class Tool_, class Visit>
requires std::is_same_v<std::remove_const_t<Tool_>, Tool>
void for_each_field(Tool_& t, Visit&& visit) {
  using namespace meaning;
  const auto give = with_meaning(visit);
  give("name", t.name, any);
  give("kind", t.kind, one_of({ToolKind::ball, ToolKind::scalpel, ToolKind::pin}));
  give("radius", t.radius, length_or_none);
  give("blade_length", t.blade_length, length_or_none);
  give("sphere", t.sphere, index(EntryOf::sphere, -1));
  give("trail_distance", t.trail_distance, length);
  give("blade_reach", t.blade_reach, length);
  give("blade_reach_spacings", t.blade_reach_spacings, within(0, 1e3));
  give("flank_height", t.flank_height, length_or_none);
  give("blade_thickness", t.blade_thickness, length);
  give("slowest_slip", t.slowest_slip, within(1e-9, 1e6));
}

template <class Organ_, class Visit>
requires std::is_same_v<std::remove_const_t<Organ_>, OrganRange>
void for_each_field(Organ_& o, Visit&& visit) {
  using namespace meaning;
  const auto give = with_meaning(visit);
  give("name", o.name, any);
  give("first", o.first, any);
  give("count", o.count, any);
  give("sphere_radius", o.sphere_radius, length_or_none);
  give("spacing", o.spacing, length_or_none);
  give("damage_depth", o.damage_depth, length_or_none);
  give("layer_count", o.layer_count, within(0, kMostLayers));
  give("modulus", o.modulus, not_negative);
  give("instant_ratio", o.instant_ratio, not_negative);
  give("kelvin_time", o.kelvin_time, time);
  give("meets_itself", o.meets_itself, any);
  give("blade_reach", o.blade_reach, length_or_none);
}

template <class Obstacle_, class Visit>
requires std::is_same_v<std::remove_const_t<Obstacle_>, Obstacle>
void for_each_field(Obstacle_& o, Visit&& visit) {
  using namespace meaning;
  const auto give = with_meaning(visit);
  give("name", o.name, any);
  give("kind", o.kind, one_of({ObstacleKind::plane, ObstacleKind::box, ObstacleKind::mesh}));
  give("position", o.position, place);
  give("world_from_obstacle", o.world_from_obstacle, any);
  give("half_size", o.half_size, length_or_none);
  give_points("vertex.x", "vertex.y", "vertex.z", o.vertex, place, give);
  give("corner", o.corner, any);
}

/// As above. `organs`, `tools` and `obstacles` are vectors of structs; for_each_field visits their fields in turn.
template <class Model_, class Visit>
requires std::is_same_v<std::remove_const_t<Model_>, Model>
void for_each_field(Model_& m, Visit&& visit) {
  using namespace meaning;
  const auto give = with_meaning(visit);
  give("tick", m.tick, within(1e-7, 1));
  give("gravity", m.gravity, within(-1e4, 1e4));
  give_points("rest_position.x", "rest_position.y", "rest_position.z", m.rest_position, place.per(EntryOf::sphere),
              give);
  give("mass", m.mass, positive.per(EntryOf::sphere));
  give("held_axes", m.held_axes, bits(kAnchored).per(EntryOf::sphere));
  give("contact_radius", m.contact_radius, length.per(EntryOf::sphere));
  give("layer", m.layer, within(0, kMostLayers).per(EntryOf::sphere));
  for (const auto& [name, coordinate] : {std::pair{"cell.i", &m.cell.i}, {"cell.j", &m.cell.j}, {"cell.k", &m.cell.k}})
    give(name, *coordinate, within(-kFarthestCell, kFarthestCell).per(EntryOf::sphere));
  give("organs", m.organs, any);
  give("axial.a", m.axial.a, index(EntryOf::sphere).per(EntryOf::axial));
  give("axial.b", m.axial.b, index(EntryOf::sphere).per(EntryOf::axial));
  give("axial.law", m.axial.law,
       one_of({AxialLaw::spring, AxialLaw::kelvin_unit, AxialLaw::two_sphere_tpm}).per(EntryOf::axial));
  give("axial.rest_length", m.axial.rest_length, length.per(EntryOf::axial));
  give("axial.k", m.axial.k, positive.per(EntryOf::axial));
  give("axial.c", m.axial.c, not_negative.per(EntryOf::axial).or_empty());
  give("axial.kelvin_k", m.axial.kelvin_k, not_negative.per(EntryOf::axial).or_empty());
  give("axial.internal", m.axial.internal, index(EntryOf::internal_variable, -1).per(EntryOf::axial).or_empty());
  give("axial.third", m.axial.third, index(EntryOf::sphere, -1).per(EntryOf::axial).or_empty());
  give("constraints.a", m.constraints.a, index(EntryOf::sphere).per(EntryOf::constraint));
  give("constraints.c", m.constraints.c, index(EntryOf::sphere).per(EntryOf::constraint));
  give("constraints.e", m.constraints.e, index(EntryOf::sphere).per(EntryOf::constraint));
  give("constraints.k", m.constraints.k, finite.per(EntryOf::constraint));
  give("constraints.edge0", m.constraints.edge[0], index(EntryOf::axial).per(EntryOf::constraint));
  give("constraints.edge1", m.constraints.edge[1], index(EntryOf::axial).per(EntryOf::constraint));
  give("constraints.edge2", m.constraints.edge[2], index(EntryOf::axial).per(EntryOf::constraint));
  give("constraints.edge3", m.constraints.edge[3], index(EntryOf::axial).per(EntryOf::constraint));
  give("angle_springs.a", m.angle_springs.a, index(EntryOf::sphere).per(EntryOf::angle_spring));
  give("angle_springs.b", m.angle_springs.b, index(EntryOf::sphere).per(EntryOf::angle_spring));
  give("angle_springs.c", m.angle_springs.c, index(EntryOf::sphere).per(EntryOf::angle_spring));
  give("angle_springs.k", m.angle_springs.k, positive.per(EntryOf::angle_spring));
  give("angle_springs.edge0", m.angle_springs.edge[0], index(EntryOf::axial).per(EntryOf::angle_spring));
  give("angle_springs.edge1", m.angle_springs.edge[1], index(EntryOf::axial).per(EntryOf::angle_spring));
  give("has_softening", m.has_softening, any);
  give("loads.sphere", m.loads.sphere, index(EntryOf::sphere).per(EntryOf::load));
  give_points("loads.force.x", "loads.force.y", "loads.force.z", m.loads.force, finite.per(EntryOf::load), give);
  give("loads.start", m.loads.start, time.per(EntryOf::load));
  give("loads.ramp", m.loads.ramp, time.per(EntryOf::load));
  give("tools", m.tools, any);
  give("contact_k", m.contact_k, not_negative);
  give("contact_friction", m.contact_friction, within(0, 1e3));
  give("solver.tolerance", m.solver.tolerance, between(1e-16, 1));
  give("solver.velocity_floor", m.solver.velocity_floor, within(1e-15, 1e3));
  give("solver.max_iterations", m.solver.max_iterations, within(1, kMostIterations));
  give("solver.substeps", m.solver.substeps, within(1, kMostSubsteps));
  give("solver.integrator", m.solver.integrator,
       one_of({Integrator::backward_euler, Integrator::leapfrog, Integrator::sdirk2}));
  give("cut_resistance.energy", m.cut_resistance.energy, not_negative.per(EntryOf::axial).or_empty());
  give("cut_resistance.friction", m.cut_resistance.friction, not_negative.per(EntryOf::axial).or_empty());
  give("lip_k", m.lip_k, not_negative);
  give("contact_damping", m.contact_damping, not_negative);
  give("cut_face_stiffening", m.cut_face_stiffening, within(0, 1e6));
  constexpr const char* corners[8] = {"tissue_cells.corner0", "tissue_cells.corner1", "tissue_cells.corner2",
                                      "tissue_cells.corner3", "tissue_cells.corner4", "tissue_cells.corner5",
                                      "tissue_cells.corner6", "tissue_cells.corner7"};
  for (std::size_t c = 0; c < 8; ++c)
    give(corners[c], m.tissue_cells.corner[c], index(EntryOf::sphere).per(EntryOf::tissue_cell));
  give("tissue_cells.k", m.tissue_cells.k, positive.per(EntryOf::tissue_cell));
  give("inversion_threshold", m.inversion_threshold, between(0, 1));
  give("obstacles", m.obstacles, any);
  give("organs_meet", m.organs_meet, any);
  // Written only of a scene whose tissue may sleep, and read from every file.
  if (!std::is_const_v<Model_> || m.solver.sleep_bound != 0)
    give("solver.sleep_bound", m.solver.sleep_bound, within(0, 1e3));
  // Likewise where less is enough after an iteration.
  if (!std::is_const_v<Model_> || m.solver.velocity_enough != 0)
    give("solver.velocity_enough", m.solver.velocity_enough, within(0, 1e3));
  // And only of a scene with two hands.
  if (!std::is_const_v<Model_> || m.hands != 1) give("hands", m.hands, within(1, kMostHands));
}

}  // namespace ctpm
