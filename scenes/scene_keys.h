#pragma once

#include <span>

#include "scenes/key_types.h"
#include "scenes/scene_spec.h"

// Every key of a scene with its type, unit, range and sentence. A key gets its range here and nowhere else. Defaults
// are those of the structs in scene_spec.h. The reader, the writer, FORMAT.md and scene.schema.json use this table.
// Internal to scenes.
namespace ctpm::scenes {

inline constexpr const char* scene_format_name = "ctpm-scene";
inline constexpr int scene_format_version = 1;

template <>
inline std::span<const Choice<LengthUnit>> choices_of<LengthUnit>() {
  static constexpr Choice<LengthUnit> choices[] = {{"mm", LengthUnit::millimetre},
                                                   {"cm", LengthUnit::centimetre},
                                                   {"m", LengthUnit::metre},
                                                   {"in", LengthUnit::inch}};
  return choices;
}
template <>
inline std::span<const Choice<network::Structure>> choices_of<network::Structure>() {
  static constexpr Choice<network::Structure> choices[] = {
      {"ctpm", network::Structure::ctpm},
      {"tpm", network::Structure::tpm},
      {"mass-spring", network::Structure::mass_spring},
      {"angle-mass-spring", network::Structure::angle_mass_spring}};
  return choices;
}
template <>
inline std::span<const Choice<TilingSpec>> choices_of<TilingSpec>() {
  static constexpr Choice<TilingSpec> choices[] = {{"auto", TilingSpec::automatic},
                                                   {"two-spheres", TilingSpec::two_spheres},
                                                   {"three-spheres", TilingSpec::three_spheres}};
  return choices;
}

template <>
inline std::span<const Choice<network::LatticeKind>> choices_of<network::LatticeKind>() {
  static constexpr Choice<network::LatticeKind> choices[] = {{"cubic-18", network::LatticeKind::cubic_18},
                                                             {"cubic-6", network::LatticeKind::cubic_6}};
  return choices;
}
template <>
inline std::span<const Choice<ToolKind>> choices_of<ToolKind>() {
  static constexpr Choice<ToolKind> choices[] = {
      {"ball", ToolKind::ball}, {"scalpel", ToolKind::scalpel}, {"pin", ToolKind::pin}};
  return choices;
}

template <>
inline std::span<const Choice<IntegratorSpec>> choices_of<IntegratorSpec>() {
  static constexpr Choice<IntegratorSpec> choices[] = {{"auto", IntegratorSpec::automatic},
                                                       {"leapfrog", IntegratorSpec::leapfrog},
                                                       {"backward-euler", IntegratorSpec::backward_euler},
                                                       {"sdirk2", IntegratorSpec::sdirk2}};
  return choices;
}

inline constexpr Range any_coordinate_mm = within(-100000, 100000);
inline constexpr Range any_direction = within(-1e6, 1e6);

inline RecordInfo info_of(const FillSpec&) { return {"fill", "How the organ's inside is filled with spheres."}; }
template <class V>
void describe_fields(V& v, FillSpec& fill) {
  v.number(Key{"radius_mm", "Radius r of every sphere."}, fill.radius, units::millimetre, within(0.01, 100));
  v.number(Key{"gap_mm", "Gap from surface to surface; the spacing is 2 r + gap."}, fill.gap, units::millimetre,
           within(0, 100));
}

inline RecordInfo info_of(const FittedForSpec&) {
  return {
      "fitted_for",
      "The press that the stiffness scale was fitted to, as `ctpm fit` stores it: a ball presses one sphere to this "
      "depth and feels this force. For information only."};
}
template <class V>
void describe_fields(V& v, FittedForSpec& fitted) {
  v.point(required("place_mm", "Rest position of the pressed sphere."), fitted.place, units::millimetre,
          any_coordinate_mm);
  v.number(required("ball_radius_mm", "Radius of the ball that pressed it."), fitted.ball_radius, units::millimetre,
           within(0.01, 1000));
  v.number(required("sphere_radius_mm", "Radius of the organ's spheres."), fitted.sphere_radius, units::millimetre,
           within(0.01, 100));
  v.number(required("depth_mm", "Depth of the sphere below its rest position."), fitted.depth, units::millimetre,
           above(0, 1000));
  v.number(required("force_n", "Force on the ball at that depth."), fitted.force, units::newton, above(0, 1e6));
}

inline RecordInfo info_of(const MaterialSpec&) {
  return {
      "material",
      "A preset; or a preset of which some values are replaced; or every value without a preset. An edge of spacing "
      "s has the stiffness K S0 (s / s_cal), S0 = pi R^2, with the ball R and the spacing s_cal of the calibration."};
}
template <class V>
void describe_fields(V& v, MaterialSpec& material) {
  constexpr Unit modulus = units::kilopascal_per_millimetre;
  v.preset(Key{"preset", "Name of a shipped material.", false, "none; then every modulus must be given"},
           material.preset);
  v.number(Key{"spring_kpa_per_mm", "Modulus K2 of the spring.", false, "the preset's"}, material.spring, modulus,
           within(1e-6, 1e6));
  v.number(Key{"kelvin_kpa_per_mm", "Modulus K1 of the Kelvin unit.", false, "the preset's"}, material.kelvin, modulus,
           within(1e-6, 1e6));
  v.number(
      Key{"constraint_kpa_per_mm", "Modulus K' of the constraint, at least K1 K2 / (K1 + K2).", false, "the preset's"},
      material.constraint, modulus, within(1e-6, 1e6));
  v.number(Key{"viscosity_kpa_s_per_mm", "Viscosity v1 of the Kelvin unit.", false, "the preset's"}, material.viscosity,
           units::kilopascal_second_per_millimetre, within(0, 1e6));
  v.number(Key{"density_kg_per_m3", "Mass per volume.", false, "the preset's, else 1060"}, material.density,
           units::kilogram_per_metre3, within(1, 30000));
  v.number(Key{"stiffness_scale", "Multiplies every stiffness and damping.", false, "the preset's, else 1"},
           material.stiffness_scale, units::none, within(1e-6, 1e6));
  v.number(Key{"calibration_ball_radius_mm", "Radius R of the ball that the moduli were measured with.", false,
               "the preset's"},
           material.calibration_ball, units::millimetre, within(0.01, 1000));
  v.number(Key{"calibration_spacing_mm", "Spacing of the spheres that the moduli belong to.", false, "the preset's"},
           material.calibration_spacing, units::millimetre, within(0.01, 1000));
  v.number(Key{"prestrain",
               "In-situ strain: an element's length without force is shorter by this fraction than its length in the "
               "lattice; negative where the tissue is pressed. A capsule with more prestrain than the tissue below it "
               "makes a "
               "cut gape.",
               false, "0"},
           material.prestrain, units::none, within(-0.2, 0.5));
  v.number(
      Key{"fracture_toughness_j_per_m2", "Fracture energy J_c of a cut per area; 0: a blade cuts without resistance.",
          false, "the preset's, else 0"},
      material.fracture_toughness, units::joule_per_metre2, within(0, 1e6));
  v.number(Key{"blade_friction_kpa", "Shear stress on each flank of a moving blade.", false, "the preset's, else 0"},
           material.blade_friction, units::kilopascal, within(0, 1e4));
  v.record(Key{"fitted_for", "The press that the stiffness scale was fitted to."}, material.fitted_for);
}

inline RecordInfo info_of(const BoxRegion&) { return {"box", "An axis-aligned box; its faces belong to it."}; }
template <class V>
void describe_fields(V& v, BoxRegion& box) {
  v.point(required("min_mm", "Corner with the smallest coordinates."), box.min, units::millimetre, any_coordinate_mm);
  v.point(required("max_mm", "Corner with the largest coordinates."), box.max, units::millimetre, any_coordinate_mm);
}

inline RecordInfo info_of(const SphereRegion&) { return {"sphere", "A ball-shaped region."}; }
template <class V>
void describe_fields(V& v, SphereRegion& sphere) {
  v.point(required("centre_mm", "Its centre."), sphere.centre, units::millimetre, any_coordinate_mm);
  v.number(required("radius_mm", "Its radius."), sphere.radius, units::millimetre, above(0, 100000));
}

inline RecordInfo info_of(const PlaneRegion&) {
  return {"plane", "The half-space behind a plane; the plane belongs to it."};
}
template <class V>
void describe_fields(V& v, PlaneRegion& plane) {
  v.point(required("point_mm", "A point of the plane."), plane.point, units::millimetre, any_coordinate_mm);
  v.point(required("normal", "Normal towards the side that stays free; any length but zero."), plane.normal,
          units::none, any_direction);
}

inline RecordInfo info_of(const AnchorSpec&) {
  return {"anchor", "A region whose spheres never move: those whose rest centre lies in it."};
}
template <class V>
void describe_fields(V& v, AnchorSpec& anchor) {
  v.number(Key{"lowest_mm", "Centres at most this far above the organ's lowest point, against gravity."}, anchor.lowest,
           units::millimetre, within(0, 100000));
  v.record(Key{"box", "Centres in a box."}, anchor.box);
  v.record(Key{"sphere", "Centres in a ball."}, anchor.sphere);
  v.record(Key{"plane", "Centres behind a plane."}, anchor.plane);
  v.exactly_one();
}

inline RecordInfo info_of(const GuideSpec&) {
  return {"guide", "A sphere that moves only along a line or in a plane."};
}
template <class V>
void describe_fields(V& v, GuideSpec& guide) {
  v.point(required("cell", "Lattice coordinates of the sphere."), guide.cell, units::none, within(-1000, 1000));
  v.text(required("axes", "Axes along which it may not move: letters of xyz."), guide.axes);
}

inline RecordInfo info_of(const RigSpec&) {
  return {"rig", "Spheres given one by one or as a block, in place of a mesh. Give either cells or block."};
}
template <class V>
void describe_fields(V& v, RigSpec& rig) {
  v.points(Key{"cells", "Lattice coordinates of the spheres, whole numbers; cell 0, 0, 0 is at the origin."}, rig.cells,
           units::none, within(-1000, 1000), 0);
  v.point(Key{"block", "Spheres along x, y and z of a full block, centred over the origin and standing on z = 0."},
          rig.block, units::none, within(1, 200));
  v.list(Key{"guides", "Spheres that do not move along some axes."}, rig.guides, 0);
}

inline RecordInfo info_of(const LayerSpec&) {
  return {"layer",
          "Tissue from the layer above, or the surface, down to a depth. A sphere belongs to the first layer that ends "
          "below its centre. Elements between spheres of different layers have the mean of their values."};
}
template <class V>
void describe_fields(V& v, LayerSpec& layer) {
  v.number(required("to_depth_mm", "Depth at which it ends; more than that of the layer above, and within the organ."),
           layer.to_depth, units::millimetre, above(0, 1000));
  v.record(required("material", "Its tissue."), layer.material);
}

inline RecordInfo info_of(const OrganSpec&) { return {"organ", "One piece of tissue, from a closed mesh, or a rig."}; }
template <class V>
void describe_fields(V& v, OrganSpec& organ) {
  v.text(required("name", "Name of the organ, unique in the scene."), organ.name);
  v.text(Key{"mesh",
             "Path of the mesh file from the scene's folder; it may not leave that folder unless the user "
             "allows it."},
         organ.mesh);
  v.record(Key{"rig", "Spheres given one by one, in place of a mesh."}, organ.rig);
  v.choice(Key{"mesh_unit", "Unit of the mesh file's coordinates."}, organ.mesh_unit);
  v.point(Key{"at_mm", "Place of the mesh file's origin in the scene; not allowed for a rig."}, organ.at,
          units::millimetre, any_coordinate_mm);
  v.point(
      Key{"turn_deg",
          "Turns the mesh about its file's origin: about the scene's x, then its y, then its z axis; not allowed for "
          "a rig."},
      organ.turn, units::degree, within(-360, 360));
  v.number(Key{"scale", "Multiplies the size of the mesh, about its file's origin; not allowed for a rig."},
           organ.scale, units::none, within(0.001, 1000));
  v.flag(Key{"all_parts", "Keep every closed part of the mesh, not only the largest."}, organ.all_parts);
  v.integer(Key{"most_triangles", "The drawn surface is made coarser if it has more; the spheres stay the same.", false,
                "as many as the mesh has"},
            organ.most_triangles, within(100, 10000000));
  v.choice(Key{"model", "Structure that joins the spheres."}, organ.structure);
  v.choice(Key{"lattice", "Neighbours that are joined; cubic-6 has no shear stiffness and is for rigs."},
           organ.lattice);
  v.choice(
      Key{"tiling",
          "For model ctpm: `three-spheres`, as in the paper, where three spheres share a spring and a Kelvin unit, or "
          "`two-spheres`, where every element is a whole three-parameter model of the same static stiffness and all "
          "spheres are damped alike. `auto`: two spheres in a mesh, three in a rig."},
      organ.tiling);
  v.flag(Key{"softening", "Forces of triples and constraints are divided by 1 + tan(theta), Eq. 8; for model ctpm."},
         organ.softening);
  v.record(Key{"fill", "The spheres."}, organ.fill);
  v.record(required("material", "The tissue, below the last layer."), organ.material);
  v.list(Key{"layers", "Layers of other tissue that follow the surface, outermost first.", false, "none"}, organ.layers,
         0);
  v.list(Key{"anchors", "Regions whose spheres never move."}, organ.anchors, 0);
  v.number(Key{"damage_depth_mm", "Indentation depth beyond which the tissue counts as damaged; 0: no limit."},
           organ.damage_depth, units::millimetre, within(0, 1000));
  v.number(Key{"damage_force_n", "Force on a tool beyond which the tissue counts as damaged; 0: no limit."},
           organ.damage_force, units::newton, within(0, 1e6));
  v.number(
      Key{"inversion_resistance",
          "Stiffness over Young's modulus with which tissue that is pressed to less than 0.4 of its volume resists "
          "being turned inside out; 0: it does not, and costs nothing.",
          false, "10, or 0 for a rig"},
      organ.inversion_resistance, units::none, within(0, 1000));
  v.flag(Key{"meets_itself",
             "Parts of the organ's surface that lie apart touch each other, and so do the pieces into which it was "
             "cut; for a mesh."},
         organ.meets_itself);
  v.point(Key{"surface_color", "Red, green and blue of the outside."}, organ.surface_color, units::none, within(0, 1));
  v.point(Key{"inner_color", "Red, green and blue of cut faces and spheres."}, organ.inner_color, units::none,
          within(0, 1));
}

inline RecordInfo info_of(const ToolSpec&) { return {"tool", "A tool that the hand or a script can hold."}; }
template <class V>
void describe_fields(V& v, ToolSpec& tool) {
  v.text(required("name", "Name of the tool in scripts and recordings, unique in the scene."), tool.name);
  v.choice(required("kind",
                    "A rigid ball presses; a scalpel severs what its blade sweeps; a pin holds one sphere "
                    "where the hand is."),
           tool.kind);
  v.number(Key{"radius_mm", "Radius of a ball; needed by a ball, not allowed for others."}, tool.radius,
           units::millimetre, within(0.01, 200));
  v.number(
      Key{"blade_length_mm", "Length of a scalpel's edge from its tip; needed by a scalpel, not allowed for others."},
      tool.blade_length, units::millimetre, within(0.01, 500));
  v.point(Key{"holds_mm", "A pin holds the sphere nearest to here; needed by a pin, not allowed for others."},
          tool.holds, units::millimetre, any_coordinate_mm);
  v.number(
      Key{"blade_reach_mm",
          "Radius of the tissue around a scalpel's edge that takes up its force; at least 1.5 spacings of the "
          "organ are taken, and 5.3 times the toughness over Young's modulus (at most 2.6 spacings); not allowed for "
          "others.",
          false, "15"},
      tool.blade_reach, units::millimetre, within(0.01, 100));
  v.number(Key{"flank_height_mm",
               "Height of a scalpel's flanks behind the edge, along which cut faces rub; not allowed for others.",
               false, "6"},
           tool.flank_height, units::millimetre, within(0, 200));
  v.number(Key{"blade_thickness_mm",
               "How thick a scalpel is behind its bevel: so far it holds the faces of a cut apart. Faces that gape "
               "twice as wide do not rub; not allowed for others.",
               false, "0.4"},
           tool.blade_thickness, units::millimetre, within(0.01, 100));
  v.point(
      Key{"at_mm", "Where a hand in the browser takes it up: a ball's centre, a blade's tip; not allowed for a pin.",
          false, "above the organs"},
      tool.at, units::millimetre, any_coordinate_mm);
  v.point(Key{"pointing", "With at_mm: direction from handle to tip; any length but zero.", false, "`[0, 0, -1]`"},
          tool.pointing, units::none, any_direction);
  v.point(Key{"facing", "With at_mm: direction of a blade's cutting side; not along pointing.", false,
              "the shortest turn decides"},
          tool.facing, units::none, any_direction);
}

inline RecordInfo info_of(const ObstacleSpec&) {
  return {"obstacle",
          "A rigid ground, table or wall, which tissue touches and does not enter. Give one of plane, box and mesh."};
}
template <class V>
void describe_fields(V& v, ObstacleSpec& obstacle) {
  v.text(required("name", "Name of the obstacle, unique in the scene."), obstacle.name);
  v.record(Key{"plane", "Everything behind a plane."}, obstacle.plane);
  v.record(Key{"box", "A box."}, obstacle.box);
  v.text(Key{"mesh",
             "Path of a mesh file, as of an organ. The mesh is repaired as an organ's is, and must be closed then."},
         obstacle.mesh);
  v.choice(Key{"mesh_unit", "Unit of the mesh file's coordinates."}, obstacle.mesh_unit);
}

inline RecordInfo info_of(const ZoneSpec&) {
  return {"zone", "A place in space where no tool should be. Nothing that is simulated depends on it."};
}
template <class V>
void describe_fields(V& v, ZoneSpec& zone) {
  v.text(required("name", "Name of the zone, unique in the scene."), zone.name);
  v.record(Key{"box", "Points in a box."}, zone.box);
  v.record(Key{"sphere", "Points in a ball."}, zone.sphere);
  v.record(Key{"plane", "Points behind a plane."}, zone.plane);
  v.exactly_one("name");
}

inline RecordInfo info_of(const LoadSpec&) { return {"load", "An external force on one sphere."}; }
template <class V>
void describe_fields(V& v, LoadSpec& load) {
  v.point(required("at_mm", "The force acts on the sphere whose rest position is nearest to this point."), load.at,
          units::millimetre, any_coordinate_mm);
  v.point(required("force_n", "The force after the ramp."), load.force, units::newton, within(-1e6, 1e6));
  v.number(Key{"start_s", "Start of the ramp."}, load.start, units::second, within(0, 1e6));
  v.number(Key{"ramp_s", "Time in which the force rises linearly from zero."}, load.ramp, units::second,
           within(0, 1e6));
}

inline RecordInfo info_of(const ProbeSpec&) {
  return {"probe", "A point whose motion is recorded: that of the sphere whose rest position is nearest."};
}
template <class V>
void describe_fields(V& v, ProbeSpec& probe) {
  v.text(required("name", "Name of the probe in tables, unique in the scene."), probe.name);
  v.point(required("at_mm", "Rest position of the point."), probe.at, units::millimetre, any_coordinate_mm);
}

inline RecordInfo info_of(const SolverSpec&) { return {"solver", "Settings of the time integration."}; }
template <class V>
void describe_fields(V& v, SolverSpec& solver) {
  v.choice(Key{"integrator",
               "`leapfrog` is explicit and of second order, `backward-euler` implicit and of first, `sdirk2` implicit "
               "and of second, but a step that is too long for the motion is left to backward Euler (`record`, "
               "`bench` and `stability` count such ticks). `auto` takes the one with the least error for its time: "
               "`sdirk2`; `leapfrog` where it "
               "is cheaper, nothing is cut and nothing is under tension at rest; `backward-euler`, which damps, where "
               "tissue "
               "is stiff or hardly damps what a cut or that tension sets swinging. `ctpm plan` says which and why.",
               false},
           solver.integrator);
  v.number(Key{"tolerance", "Relative residual at which the solve of a tick stops.", false, "1e-4"}, solver.tolerance,
           units::none, between(0, 1));
  v.number(Key{"velocity_floor_mm_per_s", "Absolute tolerance of the velocities.", false, "0.001"},
           solver.velocity_floor, units::millimetre_per_second, above(0, 1000));
  v.number(Key{"velocity_enough_mm_per_s",
               "Absolute tolerance of the velocities once a solve has made an iteration. A tick takes less time then; "
               "what it leaves goes to the next one.",
               false, "0.002, or `velocity_floor_mm_per_s` where a scene has that"},
           solver.velocity_enough, units::millimetre_per_second, above(0, 1000));
  v.integer(Key{"max_iterations", "Largest number of iterations of one solve.", false, "200"}, solver.max_iterations,
            within(1, 100000));
  v.integer(Key{"substeps", "Equal parts of a tick; `auto` may take more.", false, "1"}, solver.substeps,
            within(1, 1000));
  v.number(Key{"sleep_below_mm_per_s",
               "An organ sleeps once nothing of it has moved faster than this for a tenth of a second: it costs hardly "
               "any time then, and time stands still in it. It wakes in the tick in which a tool, or an organ that is "
               "awake, touches it. For scenes with several organs; 0.01 is a good value.",
               false, "nothing sleeps"},
           solver.sleep_below, units::millimetre_per_second, above(0, 1000));
}

inline RecordInfo info_of(const CameraSpec&) { return {"camera", "A view for pictures and videos."}; }
template <class V>
void describe_fields(V& v, CameraSpec& camera) {
  v.text(required("name", "Name of the camera in commands, unique in the scene."), camera.name);
  v.point(required("eye_mm", "Position of the camera."), camera.eye, units::millimetre, any_coordinate_mm);
  v.point(required("target_mm", "Point that the camera looks at."), camera.target, units::millimetre,
          any_coordinate_mm);
  v.point(Key{"up", "Upward direction of the picture; any length but zero."}, camera.up, units::none, any_direction);
  v.number(Key{"field_of_view_deg", "Angle from the lower to the upper edge of the picture."}, camera.field_of_view,
           units::degree, within(1, 150));
}

inline RecordInfo info_of(const SceneSpec&) { return {"scene", "The whole file."}; }
template <class V>
void describe_fields(V& v, SceneSpec& scene) {
  v.constant(required("format", "Says that this is a scene."), scene_format_name);
  v.constant(required("version", "Version of the format."), scene_format_version);
  v.text(required("name", "Name of the scene."), scene.name);
  v.text(Key{"task", "What a trainee is to do here; it stands beside the picture where the scene is trained.", false,
             "none is told"},
         scene.task);
  v.point(Key{"gravity_m_per_s2", "Acceleration of free fall; all zero: no gravity."}, scene.gravity,
          units::metre_per_second2, within(-1000, 1000));
  v.number(Key{"tick_s", "Length of a tick."}, scene.tick, units::second, within(1e-6, 0.1));
  v.number(Key{"settle_s", "Longest time for the scene to come to rest before its first tick."}, scene.settle,
           units::second, within(0, 60));
  v.list(required("organs", "The tissue."), scene.organs, 1);
  v.list(Key{"tools", "The tools."}, scene.tools, 0);
  v.integer(Key{"hands",
                "Hands that hold tools at once. Two never hold the same tool, two scalpels, or two pins of the same "
                "sphere.",
                false, "1"},
            scene.hands, within(1, kMostHands));
  v.number(Key{"contact_stiffness_n_per_m", "Stiffness of a tool against one sphere of a rig.", false,
               "20 times the stiffest edge"},
           scene.contact_stiffness, units::newton_per_metre, within(1e-6, 1e12));
  v.number(Key{"contact_friction", "Coulomb coefficient of tissue against tools, obstacles and other tissue."},
           scene.contact_friction, units::none, within(0, 10));
  v.number(Key{"contact_damping_s_per_m",
               "Hunt-Crossley damping c of a tool's contact: at a penetration p it pushes with k p (1 + c p'); with 50 "
               "s/m an impact at 30 mm/s keeps 25 % of its kinetic energy.",
               false, "50"},
           scene.contact_damping, units::second_per_metre, within(0, 1e4));
  v.flag(Key{"lips_meet",
             "The two sides of a cut meet again without passing through each other, and what is cut off rests on what "
             "it was cut from."},
         scene.lips_meet);
  v.number(
      Key{"cut_face_stiffening",
          "With `lips_meet`: factor b by which the contact of cut faces stiffens, 1 + (b p / s)^2 at a penetration "
          "p and a spacing s.",
          false, "8"},
      scene.cut_face_stiffening, units::none, within(0, 1000));
  v.list(Key{"obstacles", "What tissue lies on or leans against.", false, "none"}, scene.obstacles, 0);
  v.flag(Key{"organs_meet", "Organs from meshes touch each other; otherwise they pass through each other."},
         scene.organs_meet);
  v.list(Key{"loads", "External forces."}, scene.loads, 0);
  v.list(Key{"probes", "Points whose motion is recorded."}, scene.probes, 0);
  v.list(
      Key{"forbidden", "Zones in which any part of a ball, or of a blade's edge, is counted against whoever leads it."},
      scene.forbidden, 0);
  v.record(Key{"solver", "Settings of the time integration."}, scene.solver);
  v.list(Key{"cameras", "Views; commands use the first unless another is named."}, scene.cameras, 0);
}

}  // namespace ctpm::scenes
