#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/model/axial_law.h"
#include "core/model/inputs.h"
#include "core/model/organ.h"
#include "core/model/vec3.h"

namespace ctpm {

/// One table for all elements that act between two spheres. Springs and Kelvin units come first, two-sphere TPMs last.
/// A triple A-B-C is a spring A-B and a Kelvin unit B-C (Eqs. 3, 4, 6); each names the other sphere of the triple in
/// `third`. Two-sphere TPMs fill lattice lines with one element left over, and every line of the structure `tpm`.
struct AxialElements {
  std::vector<std::int32_t> a, b;   ///< end spheres, a != b                                         (axial_count)
  std::vector<AxialLaw> law;        ///< force law (axial_count)
  std::vector<double> rest_length;  ///< [m], > 0                                                    (axial_count)
  std::vector<double> k;            ///< stiffness of the spring [N/m], > 0                          (axial_count)
  std::vector<double> c;            ///< damping [N s/m], >= 0, 0 for a spring; empty if all are 0 (axial_count)
  /// Stiffness of a two-sphere TPM's Kelvin unit [N/m], > 0, 0 for other laws; empty without two-sphere TPMs
  /// (axial_count).
  std::vector<double> kelvin_k;
  /// Index of a two-sphere TPM's internal variable in State::kelvin_elongation, -1 for other laws; empty without
  /// two-sphere TPMs (axial_count).
  std::vector<std::int32_t> internal;
  /// Third sphere of the element's triple, whose tilt softens the element too; -1 if it has none; empty if the scene
  /// has no softening (axial_count).
  std::vector<std::int32_t> third;

  std::size_t size() const { return a.size(); }

  /// Number of internal variables: one for each two-sphere TPM.
  std::size_t internal_count() const {
    return internal.empty() ? 0 : std::size_t(std::max<std::int64_t>(0, std::int64_t{internal.back()} + 1));
  }

  double damping(std::size_t i) const { return c.empty() ? 0 : c[i]; }

  /// Static stiffness, with all dashpots at rest [N/m].
  double slow_k(std::size_t i) const {
    return law[i] == AxialLaw::two_sphere_tpm ? k[i] * kelvin_k[i] / (k[i] + kelvin_k[i]) : k[i];
  }
};

/// Constraints of five-sphere lines A B C D E (Eqs. 2, 5). With u = C - (A + E) / 2 and tan theta = 2 |u| / |E - A|,
/// the force on C is -2 k' (1 - cos theta) u. A and E each get half of the opposite force.
struct Constraints {
  std::vector<std::int32_t> a, c, e;  ///< end, centre, end sphere (constraint_count)
  std::vector<double> k;              ///< k' = (K' - P2) times the calibrated area [N/m]     (constraint_count)
  std::vector<std::int32_t> edge[4];  ///< axial elements A-B, B-C, C-D, D-E; severing one ends the constraint
  std::size_t size() const { return a.size(); }
};

/// Springs that resist the angle at the middle one of three collinear neighbours A B C (Fig. 1b). The force on B is
/// -k (B - (A + C) / 2). A and C each get half of the opposite force.
struct AngleSprings {
  std::vector<std::int32_t> a, b, c;  ///< end, middle, end sphere (angle_count)
  std::vector<double> k;              ///< [N/m], > 0                                                   (angle_count)
  std::vector<std::int32_t> edge[2];  ///< axial elements A-B and B-C; severing one ends the angle spring
  std::size_t size() const { return a.size(); }
};

/// Resistance of each axial element to a blade. An element stands for an area of tissue across it: the areas of all
/// elements that a plane crosses sum to the area of the plane, whatever its orientation. Empty if the scene has no
/// scalpel or if no tissue resists.
struct CutResistance {
  std::vector<double> energy;    ///< fracture toughness J_c times area [J], >= 0                    (axial_count)
  std::vector<double> friction;  ///< friction of the blade's two flanks, stress times area [N], >= 0 (axial_count)
  bool any() const { return !energy.empty(); }
};

/// Tissue cells that resist inversion. A tissue cell is a cube of an organ's lattice whose eight corner spheres all
/// exist. Each corner spans a tetrahedron with its three neighbours along the lattice's axes; J is its signed volume
/// over that at rest. The energy of a tetrahedron is k / 2 (J0 - J)^2 where J < J0 = Model::inversion_threshold, and
/// 0 elsewhere (our choice; without it a lattice that was pushed through itself stays inside out). Empty if no organ
/// asks for it.
struct TissueCells {
  /// Corner spheres: bits 0, 1, 2 of an index are set where lattice coordinate i, j, k is the larger one; the
  /// tetrahedra have positive volumes at rest (cell_count each).
  std::array<std::vector<std::int32_t>, 8> corner;
  /// kappa times an eighth of the tissue's volume in the cell [J], > 0; kappa [Pa] is the organ's inversion resistance
  /// times its Young's modulus (cell_count).
  std::vector<double> k;
  std::size_t size() const { return k.size(); }
};

enum class ToolKind : std::int32_t {
  ball = 0,     ///< rigid ball that presses
  scalpel = 1,  ///< a blade whose edge severs what it sweeps
  pin = 2,      ///< moves one sphere exactly with the hand: the paper's pressed sphere C
};

/// A tool that a hand can hold. The tool frame's origin is the ball's centre or the blade's tip.
struct Tool {
  std::string name;
  ToolKind kind = ToolKind::ball;
  double radius = 0;         ///< of a ball [m], > 0; 0 for a scalpel
  double blade_length = 0;   ///< of a scalpel's edge, from the tip along the tool's +z axis [m], > 0; 0 for a ball
  std::int32_t sphere = -1;  ///< sphere that a pin moves; -1 for other tools

  // Contact of a scalpel with tissue; other tools do not use these values.

  /// How far the front of a cut is behind the edge while it goes through tissue that resists [m], > 0. Default: our
  /// choice; what is pressed ahead of a sharp edge before it cuts.
  double trail_distance = 0.2e-3;
  /// Radius of the tissue around the edge that takes up its force [m], > 0; OrganRange::blade_reach where that is
  /// larger. Default: our choice. It must not shrink with the lattice: soft, tough tissue would be crushed at the edge,
  /// and dragged along before it is cut.
  double blade_reach = 15e-3;
  /// The same radius in spacings of the organ; the larger of the two applies [1], > 0. Default: all corners of the cell
  /// around the edge, and little more, so that the edge hardly follows the faces that gape behind it.
  double blade_reach_spacings = 1.5;
  /// Height of the flanks behind the edge [m], >= 0. Default: about that of a surgical blade No. 10 (estimate).
  double flank_height = 6e-3;
  /// How thick the blade is behind its bevel, and so far it holds the faces of a cut apart (contact::BladeWedge). Faces
  /// that gape twice as wide do not touch the flanks [m], > 0. Default: estimate, kept for sessions that do not store
  /// it.
  double blade_thickness = 1e-3;
  double slowest_slip = 1e-3;  ///< retired with physics revision 4, where the front is held as a ball grips
};

/// External forces on spheres. Each rises linearly from 0 at `start` to its full size at `start + ramp`, and then
/// stays.
struct Loads {
  std::vector<std::int32_t> sphere;  ///< (load_count)
  Vec3Array force;                   ///< full size [N]                 (load_count)
  std::vector<double> start, ramp;   ///< [s], >= 0                     (load_count)
  std::size_t size() const { return sphere.size(); }
};

/// Coordinates i, j, k in an organ's lattice, counted from the organ's first sphere.
using LatticeCell = std::array<std::int32_t, 3>;

/// Many cells, one array per coordinate.
struct LatticeCells {
  std::vector<std::int32_t> i, j, k;  ///< each (count)

  std::size_t size() const { return i.size(); }
  void push_back(LatticeCell cell) { i.push_back(cell[0]), j.push_back(cell[1]), k.push_back(cell[2]); }
  LatticeCell operator[](std::size_t n) const { return {i[n], j[n], k[n]}; }

  friend bool operator==(const LatticeCells&, const LatticeCells&) = default;
};

/// Model::held_axes of a sphere that never moves.
inline constexpr std::uint8_t kAnchored = 7;

/// A range of spheres that were filled into one organ.
struct OrganRange {
  std::string name;
  std::int32_t first = 0, count = 0;  ///< spheres [first, first + count)
  double sphere_radius = 0;           ///< r [m]
  double spacing = 0;                 ///< s [m]
  double damage_depth = 0;            ///< depth beyond which the tissue is damaged [m]; 0: no limit
  std::int32_t layer_count = 0;
  // The tissue just below the surface, which what presses it dents where the lattice does not resolve that; see
  // contact::Foundation.
  double modulus = 0;        ///< static Young's modulus [Pa], >= 0
  double instant_ratio = 1;  ///< stiffness at once over static stiffness, >= 1
  double kelvin_time = 0;    ///< viscosity over stiffness of the Kelvin unit [s], >= 0
  /// Radius of the tissue around a blade's edge that must take up its force, so that the pull of the edge strains
  /// tough, soft tissue little; see Tool::blade_reach [m], >= 0.
  double blade_reach = 0;
  /// Whether parts of the organ's surface that lie apart touch each other (contact::BodyContact).
  bool meets_itself = false;
};

enum class ObstacleKind : std::int32_t {
  plane = 0,  ///< the half space z <= 0 of the obstacle's frame
  box = 1,    ///< centred in the obstacle's frame
  mesh = 2,   ///< a closed mesh
};

/// A rigid thing that never moves and that the surfaces of organs cannot enter: a ground, a table, a bowl.
struct Obstacle {
  std::string name;
  ObstacleKind kind = ObstacleKind::plane;
  Vec3 position;             ///< of the frame's origin [m]
  Quat world_from_obstacle;  ///< orientation of the frame, unit length
  Vec3 half_size;            ///< of a box [m], > 0
  Vec3Array vertex{};        ///< of a mesh, in the obstacle's frame [m]
  /// Of a mesh: vertices of its triangles, three of each, counter-clockwise seen from outside.
  std::vector<std::int32_t> corner{};
};

/// Method of time integration. Session files store the numbers; 0 (automatic), 1 (symplectic Euler) and 3 (extrapolated
/// Euler) are retired and never used again.
enum class Integrator : std::int32_t {
  backward_euler = 2,  ///< implicit, first order, L-stable
  leapfrog = 4,        ///< explicit, second order (position Verlet)
  sdirk2 = 5,          ///< implicit, second order, L-stable: two stages of backward Euler (Alexander 1977)
};

/// Settings of the time integration and of its solver. All limits are counts or residuals, never times.
struct SolverSettings {
  /// Residual at which an implicit solve stops, relative to that of its first guess of the velocity; the speed of the
  /// body therefore does not matter. In (0, 1). See solver::SolverLimits.
  double tolerance = 1e-4;
  double velocity_floor = 1e-6;  ///< residuals below this velocity [m/s] count as solved, > 0
  /// Residuals below this velocity [m/s] count as solved once a solve has made an iteration, >= 0; below velocity_floor
  /// it has no effect. A floor as high as this would leave slow motions undone for ever.
  double velocity_enough = 0;
  std::int32_t max_iterations = 200;                   ///< iterations of one solve at most, >= 1
  std::int32_t substeps = 1;                           ///< equal parts of a tick, >= 1
  Integrator integrator = Integrator::backward_euler;  ///< see resolve_integrator()
  /// A part of the tissue that has not moved faster than this for a while sleeps [m/s], >= 0; 0: nothing does. See
  /// stepping::Sleepers.
  double sleep_bound = 0;
};

/// Everything about a scene that never changes while it runs. Arrays of features that the scene does not have are
/// empty.
struct Model {
  double tick = 1e-3;  ///< length of a tick [s], > 0
  Vec3 gravity;        ///< [m/s^2]; zero: no gravity

  Vec3Array rest_position;              ///< [m]                                                     (sphere_count)
  std::vector<double> mass;             ///< [kg], > 0                                               (sphere_count)
  std::vector<std::uint8_t> held_axes;  ///< bits 0, 1, 2: x, y, z never changes; 7: anchored (sphere_count)
  /// Distance at which a tool touches the sphere, in an organ without a surface [m], > 0 (sphere_count)
  std::vector<double> contact_radius;
  std::vector<std::int32_t> layer;  ///< 1 = outermost (sphere_count)
  LatticeCells cell;                ///< in the lattice of the sphere's organ (sphere_count)
  std::vector<OrganRange> organs;
  /// The organs' surfaces: drawn, and touched by tools; one without vertices where an organ has none (a rig). Empty if
  /// no organ has one, else (organ_count).
  std::vector<Surface> surfaces;

  AxialElements axial;
  Constraints constraints;
  AngleSprings angle_springs;
  bool has_softening = false;  ///< Eq. 8: forces are divided by 1 + tan theta

  Loads loads;

  std::vector<Tool> tools;
  std::int32_t hands = 1;  ///< that hold tools, 1 or kMostHands
  double contact_k = 0;    ///< stiffness of a tool's contact with one sphere of an organ without a surface [N/m], >= 0
  double contact_friction = 0;  ///< Coulomb coefficient of every contact of tissue, >= 0
  /// Hunt-Crossley damping of contacts [s/m], >= 0. Default: an impact at 30 mm/s keeps 25 % of its kinetic
  /// energy (our choice).
  double contact_damping = 50;

  SolverSettings solver;

  CutResistance cut_resistance;
  /// Stiffness of the contact between the two faces of a cut, sphere to sphere [N/m]; 0: the faces pass through each
  /// other.
  double lip_k = 0;
  /// Growth of that stiffness with penetration: factor b in 1 + (b p / s)^2, p the penetration and s the spacing [1],
  /// >= 0. Default: our choice, large enough that nothing slips through.
  double cut_face_stiffening = 8;

  TissueCells tissue_cells;
  /// J0: volume ratio below which the tetrahedra of tissue cells resist [1], in (0, 1). Default: our choice, below what
  /// a press reaches without buckling, and far enough above 0 that nothing turns over.
  double inversion_threshold = 0.4;

  std::vector<Obstacle> obstacles;
  bool organs_meet = false;  ///< whether the surfaces of different organs touch each other

  std::size_t sphere_count() const { return mass.size(); }
  /// Number of points that can be touched: the vertices of the surfaces through all organs, and after them the spheres.
  std::size_t touchable_count() const {
    std::size_t count = sphere_count();
    for (const Surface& surface : surfaces) count += surface.vertex.size();
    return count;
  }
  bool has_tool(ToolKind kind) const {
    return std::any_of(tools.begin(), tools.end(), [kind](const Tool& tool) { return tool.kind == kind; });
  }
  /// Whether tissue touches tissue.
  bool has_meeting_tissue() const {
    return organs_meet ||
           std::any_of(organs.begin(), organs.end(), [](const OrganRange& organ) { return organ.meets_itself; });
  }
  /// Whether a hand that says it holds that tool holds a blade; what a damaged file says may be no tool at all.
  bool is_scalpel(std::int32_t tool) const {
    return tool >= 0 && std::size_t(tool) < tools.size() && tools[std::size_t(tool)].kind == ToolKind::scalpel;
  }
  /// Whether tissue touches anything but tools.
  bool has_meeting_bodies() const { return has_meeting_tissue() || !obstacles.empty(); }
  bool has_scalpel() const { return has_tool(ToolKind::scalpel); }
  std::size_t element_count() const { return axial.size() + constraints.size() + angle_springs.size(); }
};

}  // namespace ctpm
