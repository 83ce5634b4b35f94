#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/result.h"

namespace ctpm::network {

/// Which structure joins the spheres (scene key `model`).
enum class Structure : std::int32_t {
  mass_spring = 0,        ///< every element a spring (Eq. 1)
  angle_mass_spring = 1,  ///< springs, and springs that resist the angle at each sphere (Fig. 1b)
  tpm = 2,                ///< every element a two-sphere TPM
  ctpm = 3,               ///< triples, constraints, softening
};

/// How a `ctpm` structure lays three-parameter models along its lines (scene key `tiling`).
enum class Tiling : std::int32_t {
  three_spheres = 0,  ///< the paper's: three spheres share one, so a spring and a Kelvin unit take turns
  two_spheres = 1,    ///< every element is one, so that all spheres are damped alike; the same static stiffness
};

/// Which lines of the lattice carry elements (scene key `lattice`).
enum class LatticeKind : std::int32_t {
  cubic_6 = 0,   ///< 3 axis lines; no shear stiffness, for rigs only
  cubic_18 = 1,  ///< 3 axis and 6 face-diagonal lines; isotropic, Poisson ratio 1/4, Young's modulus 2.5 k / s
};

/// A tissue's moduli and the site they were calibrated on.
struct Material {
  double spring = 0;               ///< K2 [Pa/m], > 0
  double kelvin = 0;               ///< K1 [Pa/m], > 0
  double constraint = 0;           ///< K' [Pa/m], >= P2 = K1 K2 / (K1 + K2)
  double viscosity = 0;            ///< v1 [Pa s/m], >= 0
  double density = 1060;           ///< [kg/m^3], > 0
  double stiffness_scale = 1;      ///< multiplies every stiffness and damping, > 0
  double calibration_area = 0;     ///< S0 = pi R^2 of the ball with which the moduli were calibrated [m^2], > 0
  double calibration_spacing = 0;  ///< spacing of that site [m], > 0
  /// In-situ strain: the rest length of an element is shorter than its length in the lattice by this part, in
  /// [-0.2, 0.5]. Tissue under more of it than what is below it makes a cut gape; pressed tissue has a negative one.
  double prestrain = 0;
  double fracture_toughness = 0;  ///< J_c: energy to open a unit of area [J/m^2], >= 0
  double blade_friction = 0;      ///< shear stress on each flank of a moving blade [Pa], >= 0
};

/// A layer that follows the organ's surface: a capsule over a parenchyma.
struct LayerMaterial {
  /// Depth at which the layer ends, of a sphere's centre below the surface [m], > 0.
  double to_depth = 0;
  Material material;
};

/// How one filled organ becomes part of a Model.
///
/// A sphere belongs to the first layer whose `to_depth` is more than its own depth, or to `material` if there is none.
/// The mass of a sphere is that of its material in the volume that moves with it (FilledOrgan::shares), and stiffness,
/// damping and resistance to a blade are those of the element's share of a full lattice. A constraint or angle spring
/// has the least share of its elements. An element takes the mean of its spheres' materials for each of
/// stiffness, damping and prestrain. These spheres are the two ends of a spring or two-sphere TPM, the three spheres of
/// a triple or angle spring (so both elements of a triple have the same K1, K2, v1), and the five spheres of a
/// constraint's line for K' - P2.
struct OrganSettings {
  std::string name;
  Structure structure = Structure::ctpm;
  LatticeKind lattice = LatticeKind::cubic_18;
  Tiling tiling = Tiling::three_spheres;  ///< of `ctpm`
  bool has_softening = true;              ///< Eq. 8, for `ctpm`; without it the network gives the TPM column of Table 1
  Material material;                      ///< below the last layer
  std::vector<LayerMaterial> layers;      ///< outermost first, `to_depth` ascending
  std::vector<std::int32_t> anchored;     ///< spheres of the organ that never move, by index within the organ
  struct Guide {
    std::int32_t sphere;  ///< index within the organ
    std::uint8_t axes;    ///< axes along which it is held, as in Model::held_axes
  };
  std::vector<Guide> guides;  ///< spheres that run on rails or planes, for rigs
  double damage_depth = 0;    ///< [m]; 0: no limit
  /// kappa over Young's modulus, with which the organ's cells resist being turned inside out [1], >= 0; 0: they do not.
  /// See TissueCells.
  double inversion_resistance = 0;
};

/// Stiffness of an element per unit of modulus at `spacing` [m^2]: S0_cal (s / s_cal) times the stiffness scale.
double edge_area(const Material& material, double spacing);

/// Appends the organ's spheres and the elements between them to `model`. Errors: an organ without spheres, a modulus
/// out of range in any layer, layers out of order, an anchor or guide that is not a sphere of the organ.
Result<Done> add_organ(Model& model, const FilledOrgan& organ, const OrganSettings& settings);

}  // namespace ctpm::network
