#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/model/axial_law.h"
#include "core/model/vec3.h"

namespace ctpm {

/// Axial elements between two spheres, one table for all laws. Springs and Kelvin units come first, two-sphere TPMs
/// last. The two elements of a triple A-B-C (spring A-B, Kelvin unit B-C; Eqs. 3, 4, 6) know each other by `third`;
/// two-sphere TPMs stand where a lattice line has an element left over, and everywhere in the structure `tpm`.
struct AxialElements {
  std::vector<std::int32_t> a, b;      ///< end spheres, a != b                                         (axial_count)
  std::vector<AxialLaw> law;           ///< how the force follows from the motion                       (axial_count)
  std::vector<double> rest_length;     ///< [m], > 0                                                    (axial_count)
  std::vector<double> k;               ///< stiffness of the spring [N/m], > 0                          (axial_count)
  std::vector<double> c;               ///< damping [N s/m], >= 0, 0 of a spring; empty if all are 0    (axial_count)
  std::vector<double> kelvin_k;        ///< stiffness of a two-sphere TPM's Kelvin unit [N/m], > 0, 0 of the others;
                                       ///< empty without two-sphere TPMs                               (axial_count)
  std::vector<std::int32_t> internal;  ///< index of a two-sphere TPM's internal variable in State::kelvin_elongation,
                                       ///< -1 of the others; empty without two-sphere TPMs          (axial_count)
  std::vector<std::int32_t> third;     ///< third sphere of the element's triple, whose tilt counts too; -1 if it has
                                       ///< none; empty if the scene has no softening                (axial_count)

  std::size_t size() const { return a.size(); }

  /// Two-sphere TPMs, each of which has one internal variable.
  std::size_t internal_count() const {
    return internal.empty() ? 0 : std::size_t(std::max<std::int64_t>(0, std::int64_t{internal.back()} + 1));
  }

  double damping(std::size_t i) const { return c.empty() ? 0 : c[i]; }

  /// Stiffness once dashpots have come to rest [N/m].
  double slow_k(std::size_t i) const {
    return law[i] == AxialLaw::two_sphere_tpm ? k[i] * kelvin_k[i] / (k[i] + kelvin_k[i]) : k[i];
  }
};

/// Constraints of five-sphere lines A B C D E (Eqs. 2, 5): force on C is -2 k' (1 - cos theta) u, u = C - (A
/// + E) / 2, tan theta = |u| / (|E - A| / 2), and half of the opposite on A and on E.
struct Constraints {
  std::vector<std::int32_t> a, c, e;  ///< end, centre, end sphere (constraint_count)
  std::vector<double> k;              ///< k' = (K' - P2) times the calibrated area [N/m]     (constraint_count)
  std::vector<std::int32_t> edge[4];  ///< axial elements A-B, B-C, C-D, D-E; severing one ends the constraint
  std::size_t size() const { return a.size(); }
};

/// Springs that resist the angle at the middle one of three collinear neighbours A B C (Fig. 1b): force on B
/// is -k (B - (A + C) / 2), and half of the opposite on A and on C.
struct AngleSprings {
  std::vector<std::int32_t> a, b, c;  ///< end, middle, end sphere (angle_count)
  std::vector<double> k;              ///< [N/m], > 0                                                   (angle_count)
  std::vector<std::int32_t> edge[2];  ///< axial elements A-B and B-C; severing one ends the angle spring
  std::size_t size() const { return a.size(); }
};

/// What a blade has to overcome at each axial element. An element stands for an area of tissue across it, so
/// that the areas of all elements that a plane crosses add up to the plane's area, whichever way it lies.
/// Empty if the scene has no scalpel or no tissue resists.
struct CutResistance {
  std::vector<double> energy;    ///< fracture toughness J_c times area [J], >= 0                    (axial_count)
  std::vector<double> friction;  ///< of the blade's two flanks, stress times area [N], >= 0         (axial_count)
  bool any() const { return !energy.empty(); }
};

enum class ToolKind : std::int32_t {
  ball = 0,     ///< rigid ball that presses
  scalpel = 1,  ///< blade edge that severs what it sweeps
  pin = 2,      ///< holds one sphere exactly where the hand is: the paper's pressed sphere C
};

/// A tool that the session's input can hold. The tool frame's origin is the ball's centre or the blade's tip.
struct Tool {
  std::string name;
  ToolKind kind = ToolKind::ball;
  double radius = 0;         ///< of a ball [m], > 0; 0 for a scalpel
  double blade_length = 0;   ///< of a scalpel's edge, from the tip along the tool's +z axis [m], > 0; 0 for a ball
  std::int32_t sphere = -1;  ///< that a pin holds; -1 for the others

  // How a scalpel meets tissue; other tools do not use these.
  double trail_distance = 0.5e-3;  ///< The heading points from points towed this far behind both ends of the blade
                                   ///< [m], > 0; default: our choice, longer than a hand trembles
  double blade_reach = 9e-3;  ///< Least distance ahead of the edge over which an element resists [m], > 0; default: our
                              ///< choice. It must not shrink with the lattice: soft tissue would be dragged farther
                              ///< along before it is cut.
  double blade_reach_spacings = 0.75;  ///< The same in spacings of the widest lattice, where that is more [1], >= 0;
                                       ///< default: rows lie half a spacing apart, so that the next one resists before
                                       ///< one is severed
  double flank_height = 6e-3;     ///< The flanks reach so far behind the edge [m], >= 0; default: about the height of a
                                  ///< surgical blade No. 10 (estimate)
  double blade_thickness = 1e-3;  ///< Cut faces that have opened this far do not touch the flanks [m], > 0; default:
                                  ///< estimate
  double slowest_slip = 1e-3;     ///< Friction of the flanks falls to 0 linearly below this speed [m/s], > 0; default:
                                  ///< our choice, so that a resting blade creeps and does not chatter
};

/// Forces that act on spheres from outside: each rises from 0 at `start` to its full size within `ramp`, and
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
};

/// How the positions follow from the forces. Session files store the numbers; 0 (automatic), 1 (symplectic Euler) and 3
/// (extrapolated Euler) are retired and never used again.
enum class Integrator : std::int32_t {
  backward_euler = 2,  ///< implicit, first order, L-stable
  leapfrog = 4,        ///< explicit, second order (position Verlet)
  sdirk2 = 5,          ///< implicit, second order, L-stable: two stages of backward Euler (Alexander 1977)
};

/// How a tick is solved; all limits are counts or residuals, never times.
struct SolverSettings {
  double tolerance = 1e-4;  ///< residual at which the implicit solve stops, against that of its first guess (of the
                            ///< velocity), so that it does not depend on how fast the body moves; in (0, 1)
  double velocity_floor = 1e-6;                        ///< residuals below this velocity [m/s] count as solved, > 0
  std::int32_t max_iterations = 200;                   ///< of one solve, >= 1
  std::int32_t substeps = 1;                           ///< equal parts of a tick, >= 1
  Integrator integrator = Integrator::backward_euler;  ///< see resolve_integrator()
};

/// Everything about a scene that never changes while it runs. Features that the scene does not have are empty
/// arrays.
struct Model {
  double tick = 1e-3;  ///< length of a tick [s], > 0
  Vec3 gravity;        ///< [m/s^2]; zero: no gravity

  Vec3Array rest_position;              ///< [m]                                                     (sphere_count)
  std::vector<double> mass;             ///< [kg], > 0                                               (sphere_count)
  std::vector<std::uint8_t> held_axes;  ///< bit 0: x never changes, bit 1: y, bit 2: z; 7: anchored  (sphere_count)
  std::vector<double> contact_radius;   ///< distance at which a tool touches the sphere [m], > 0    (sphere_count)
  std::vector<std::int32_t> layer;      ///< 1 = outermost (sphere_count)
  LatticeCells cell;                    ///< in the lattice of the sphere's organ                    (sphere_count)
  std::vector<OrganRange> organs;

  AxialElements axial;
  Constraints constraints;
  AngleSprings angle_springs;
  bool has_softening = false;  ///< Eq. 8: forces are divided by 1 + tan theta

  Loads loads;

  std::vector<Tool> tools;
  double contact_k = 0;  ///< stiffness of a tool's contact with one sphere [N/m], > 0 if there are tools that press
  double contact_friction = 0;      ///< Coulomb coefficient between tool and tissue, >= 0
  double contact_damping = 50;      ///< Hunt-Crossley damping of a tool's contact [s/m], >= 0. Default: an impact at
                                    ///< 30 mm/s keeps 25 % of its kinetic energy (our choice).
  double contact_stick_time = 0.1;  ///< While surfaces stick, their drag is contact_k times this [s], >= 0. Default: a
                                    ///< sphere under a resting tool creeps over seconds (our choice).

  SolverSettings solver;

  CutResistance cut_resistance;
  double lip_k = 0;  ///< stiffness of the contact of the two faces of a cut, sphere to sphere [N/m]; 0: the faces
                     ///< pass through each other
  double cut_face_stiffening = 8;  ///< Growth of that stiffness with penetration: factor b in 1 + (b p / s)^2 at a
                                   ///< penetration p and a spacing s [1], >= 0; default: our choice, nothing slips
                                   ///< through

  std::size_t sphere_count() const { return mass.size(); }
  bool has_tool(ToolKind kind) const {
    return std::any_of(tools.begin(), tools.end(), [kind](const Tool& tool) { return tool.kind == kind; });
  }
  bool has_scalpel() const { return has_tool(ToolKind::scalpel); }
  std::size_t element_count() const { return axial.size() + constraints.size() + angle_springs.size(); }
};

}  // namespace ctpm
