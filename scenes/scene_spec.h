#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/vec3.h"
#include "core/network/network.h"

// A scene as its author wrote it, in SI units. scene_keys.h holds the keys, units and ranges of the text form. An unset
// optional means that the author did not write the key; the default is then chosen where the value is used.
namespace ctpm::scenes {

/// Unit in which a mesh file holds its coordinates.
enum class LengthUnit : std::int32_t { millimetre = 0, centimetre = 1, metre = 2, inch = 3 };

/// [m] of one unit of the mesh file.
constexpr double metres_of(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::millimetre:
      return 1e-3;
    case LengthUnit::centimetre:
      return 1e-2;
    case LengthUnit::metre:
      return 1.0;
    case LengthUnit::inch:
      return 25.4e-3;
  }
  return 1.0;
}

/// How an organ's inside is filled with spheres.
struct FillSpec {
  double radius = 4e-3;  ///< r [m]
  double gap = 4e-3;     ///< surface to surface [m]; spacing s = 2 r + gap

  double spacing() const { return 2 * radius + gap; }
  friend bool operator==(const FillSpec&, const FillSpec&) = default;
};

/// The press that a stiffness scale was fitted to: a ball presses one sphere to a depth and feels a force.
struct FittedForSpec {
  Vec3 place;                ///< of the pressed sphere at rest [m]
  double ball_radius = 0;    ///< [m]
  double sphere_radius = 0;  ///< r of the filling [m]
  double depth = 0;          ///< [m]
  double force = 0;          ///< [N]

  friend bool operator==(const FittedForSpec&, const FittedForSpec&) = default;
};

/// A tissue: a preset (presets.h), single values instead of the preset's, or all values without a preset.
struct MaterialSpec {
  std::string preset;                         ///< empty: none
  std::optional<double> spring;               ///< K2 [Pa/m]
  std::optional<double> kelvin;               ///< K1 [Pa/m]
  std::optional<double> constraint;           ///< K' [Pa/m]
  std::optional<double> viscosity;            ///< v1 [Pa s/m]
  std::optional<double> density;              ///< [kg/m^3]
  std::optional<double> stiffness_scale;      ///< multiplies every stiffness and damping
  std::optional<double> calibration_ball;     ///< radius R of the ball the moduli belong to [m]
  std::optional<double> calibration_spacing;  ///< spacing of the site the moduli belong to [m]
  std::optional<double> prestrain;            ///< in [-0.2, 0.5]
  std::optional<double> fracture_toughness;   ///< J_c [J/m^2]
  std::optional<double> blade_friction;       ///< [Pa]
  std::optional<FittedForSpec> fitted_for;    ///< for information only

  friend bool operator==(const MaterialSpec&, const MaterialSpec&) = default;
};

struct BoxRegion {
  Vec3 min, max;  ///< corners [m]
  friend bool operator==(const BoxRegion&, const BoxRegion&) = default;
};
struct SphereRegion {
  Vec3 centre;        ///< [m]
  double radius = 0;  ///< [m]
  friend bool operator==(const SphereRegion&, const SphereRegion&) = default;
};
struct PlaneRegion {
  Vec3 point;   ///< [m]
  Vec3 normal;  ///< points to the side that is free; any length but zero
  friend bool operator==(const PlaneRegion&, const PlaneRegion&) = default;
};

/// A region whose spheres never move. Exactly one member is set.
struct AnchorSpec {
  std::optional<double> lowest;  ///< centres at most this far above the organ's lowest point, against gravity [m]
  std::optional<BoxRegion> box;
  std::optional<SphereRegion> sphere;
  std::optional<PlaneRegion> plane;

  friend bool operator==(const AnchorSpec&, const AnchorSpec&) = default;
};

/// A sphere of a rig that moves only along a line or in a plane.
struct GuideSpec {
  Vec3 cell;         ///< lattice coordinates of the sphere, whole numbers
  std::string axes;  ///< axes along which it does not move: letters of "xyz"

  friend bool operator==(const GuideSpec&, const GuideSpec&) = default;
};

/// Spheres given one by one instead of by a mesh: the paper's test rig (Fig. 3), blocks for studies.
struct RigSpec {
  std::vector<Vec3> cells;    ///< lattice coordinates, whole numbers; cell 0, 0, 0 is at the origin
  std::optional<Vec3> block;  ///< instead of cells: spheres along x, y and z of a full block, centred over
                              ///< the origin, standing on z = 0
  std::vector<GuideSpec> guides;

  friend bool operator==(const RigSpec&, const RigSpec&) = default;
};

/// Tissue from the layer above, or the surface, down to a depth: a capsule over a parenchyma.
struct LayerSpec {
  double to_depth = 0;  ///< the layer ends here, below the organ's surface [m]
  MaterialSpec material;

  friend bool operator==(const LayerSpec&, const LayerSpec&) = default;
};

/// Scene key `tiling`, of `ctpm`; automatic: two spheres in a mesh, three in a rig, as in the paper.
enum class TilingSpec { automatic, two_spheres, three_spheres };

struct OrganSpec {
  std::string name;
  std::string mesh;  ///< path, relative to the scene's folder, with '/'; empty: the organ is a rig
  std::optional<RigSpec> rig;
  LengthUnit mesh_unit = LengthUnit::millimetre;
  Vec3 at;                                     ///< place of the mesh file's origin in the scene [m]
  Vec3 turn;                                   ///< of the mesh about that origin, along x, then y, then z [degrees]
  double scale = 1;                            ///< of the mesh, about that origin
  bool all_parts = false;                      ///< every closed part of the mesh, not only the largest
  std::optional<std::int32_t> most_triangles;  ///< of the drawn surface, which is made coarser if it has more
  network::Structure structure = network::Structure::ctpm;  ///< which elements join the spheres; the key is `model`
  network::LatticeKind lattice = network::LatticeKind::cubic_18;
  TilingSpec tiling = TilingSpec::automatic;
  bool softening = true;  ///< Eq. 8
  FillSpec fill;
  MaterialSpec material;          ///< below the last layer
  std::vector<LayerSpec> layers;  ///< outermost first, depths ascending
  std::vector<AnchorSpec> anchors;
  double damage_depth = 0;  ///< [m]; 0: no limit
  double damage_force = 0;  ///< on the tool [N]; 0: no limit
  /// kappa over Young's modulus, with which tissue resists being turned inside out [1]; 0: it does not; unset: see
  /// inversion_resistance_of().
  std::optional<double> inversion_resistance{};
  bool meets_itself = false;             ///< parts of the surface that lie apart touch each other
  Vec3 surface_color{0.62, 0.24, 0.20};  ///< red, green, blue in [0, 1]
  Vec3 inner_color{0.80, 0.42, 0.36};    ///< of cut faces and spheres

  friend bool operator==(const OrganSpec&, const OrganSpec&) = default;
};

struct ToolSpec {
  std::string name;
  ToolKind kind = ToolKind::ball;
  std::optional<double> radius;        ///< of a ball [m]
  std::optional<double> blade_length;  ///< of a scalpel [m]
  std::optional<Vec3> holds;           ///< of a pin: it holds the sphere nearest to here at rest [m]
  // Of a scalpel; unset ones are those of core's Tool.
  std::optional<double> blade_reach{};      ///< least distance ahead of the edge over which tissue resists [m]
  std::optional<double> flank_height{};     ///< [m]
  std::optional<double> blade_thickness{};  ///< [m]
  // Where a hand that has no place of its own takes it up; unset: it decides. As ScriptStep::Take.
  std::optional<Vec3> at{};        ///< of a ball's centre or a blade's tip [m]
  std::optional<Vec3> pointing{};  ///< from handle to tip; any length but zero; unset: against +z
  std::optional<Vec3> facing{};    ///< of a blade's cutting side; not along `pointing`

  friend bool operator==(const ToolSpec&, const ToolSpec&) = default;
};

/// An external force on one sphere.
struct LoadSpec {
  Vec3 at;           ///< acts on the tissue here, or on a rig's nearest sphere [m]
  Vec3 force;        ///< [N]
  double start = 0;  ///< [s]
  double ramp = 0;   ///< time in which it rises linearly from zero [s]

  friend bool operator==(const LoadSpec&, const LoadSpec&) = default;
};

/// A point whose motion is recorded: that of the sphere whose rest position is nearest.
struct ProbeSpec {
  std::string name;
  Vec3 at;  ///< [m]

  friend bool operator==(const ProbeSpec&, const ProbeSpec&) = default;
};

/// Where no tool should be: a place in space, which changes nothing that is simulated. Exactly one of box, sphere and
/// plane is set.
struct ZoneSpec {
  std::string name;
  std::optional<BoxRegion> box;
  std::optional<SphereRegion> sphere;
  std::optional<PlaneRegion> plane;  ///< everything behind it

  friend bool operator==(const ZoneSpec&, const ZoneSpec&) = default;
};

/// Whether a ball, or a point, reaches into a zone [m].
bool is_in(const ZoneSpec& zone, Vec3 centre, double radius = 0);
/// Whether any point of a straight line lies in a zone [m].
bool is_in(const ZoneSpec& zone, Vec3 from, Vec3 to);

/// Scene key `solver.integrator`.
enum class IntegratorSpec { automatic, leapfrog, backward_euler, sdirk2 };

/// Solver settings that the scene asks for; unset ones are those of core's SolverSettings.
struct SolverSpec {
  IntegratorSpec integrator = IntegratorSpec::automatic;  ///< automatic: core decides when the Model is built
  std::optional<double> tolerance;
  std::optional<double> velocity_floor;   ///< [m/s]
  std::optional<double> velocity_enough;  ///< [m/s]
  std::optional<std::int32_t> max_iterations;
  std::optional<std::int32_t> substeps;
  std::optional<double> sleep_below;  ///< [m/s]; unset: nothing sleeps

  friend bool operator==(const SolverSpec&, const SolverSpec&) = default;
};

struct CameraSpec {
  std::string name;
  Vec3 eye, target;           ///< [m]
  Vec3 up{0, 0, 1};           ///< any length but zero
  double field_of_view = 35;  ///< vertical [degrees]

  friend bool operator==(const CameraSpec&, const CameraSpec&) = default;
};

/// A rigid thing that never moves and that tissue cannot enter. Exactly one of plane, box and mesh is set.
struct ObstacleSpec {
  std::string name;
  std::optional<PlaneRegion> plane;
  std::optional<BoxRegion> box;
  std::string mesh{};  ///< path, as that of an organ; empty: none
  LengthUnit mesh_unit = LengthUnit::millimetre;

  friend bool operator==(const ObstacleSpec&, const ObstacleSpec&) = default;
};

struct SceneSpec {
  std::string name;
  std::string task;           ///< for trainees; empty: none is told
  Vec3 gravity{0, 0, -9.81};  ///< [m/s^2]
  double tick = 1e-3;         ///< [s]
  double settle = 1.0;        ///< longest time for the scene to come to rest before the first tick [s]
  std::vector<OrganSpec> organs;
  std::vector<ToolSpec> tools;
  std::optional<std::int32_t> hands;          ///< that hold tools at once; unset: 1
  std::optional<double> contact_stiffness;    ///< of a tool against one sphere of a rig [N/m]
  double contact_friction = 0.3;              ///< Coulomb coefficient of tissue against everything that it touches
  std::optional<double> contact_damping;      ///< Hunt-Crossley damping [s/m]; unset: that of core's Model
  std::optional<double> cut_face_stiffening;  ///< [1]; unset: that of core's Model
  bool lips_meet = false;                     ///< the two sides of a cut meet again without passing through each other
  std::vector<ObstacleSpec> obstacles;
  bool organs_meet = false;  ///< organs touch each other instead of passing through each other
  std::vector<LoadSpec> loads;
  std::vector<ProbeSpec> probes;
  std::vector<ZoneSpec> forbidden;  ///< for measures alone
  SolverSpec solver;
  std::vector<CameraSpec> cameras;

  friend bool operator==(const SceneSpec&, const SceneSpec&) = default;
};

}  // namespace ctpm::scenes
