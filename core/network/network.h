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
  mass_spring = 0,        ///< every edge a spring (Eq. 1)
  angle_mass_spring = 1,  ///< springs, and springs that resist the angle at each sphere (Fig. 1b)
  tpm = 2,                ///< a two-sphere TPM in every edge
  ctpm = 3,               ///< triples, constraints, softening
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
  double calibration_area = 0;     ///< S0 = pi R^2 of the ball the moduli were calibrated with [m^2], > 0
  double calibration_spacing = 0;  ///< spacing of that site [m], > 0
  double prestrain = 0;            ///< of the tissue in the body: an element at rest is shorter by this part of
                                   ///< its length in the lattice, in [0, 0.5]; what makes a cut gape
  double fracture_toughness = 0;   ///< J_c: energy that opens a unit of area [J/m^2], >= 0
  double blade_friction = 0;       ///< shear stress on each flank of a blade that moves [Pa], >= 0
};

/// A layer that follows the organ's surface: a capsule over a parenchyma.
struct LayerMaterial {
  double to_depth = 0;  ///< the layer ends here; depth of a sphere's centre below the surface [m], > 0
  Material material;
};

/// How one filled organ becomes part of a Model.
///
/// Layers: a sphere belongs to the first layer whose `to_depth` is more than its own depth, and to `material`
/// if there is none. Its mass is that of its material. An element takes each of its stiffness and damping
/// values, prestrain too, as the mean over its spheres' materials: the two ends of a spring or two-sphere TPM, the
/// three spheres of a triple or angle spring (so both elements of a triple have the K1, K2, v1 of one place), and for
/// K' - P2 the five of a constraint's line.
struct OrganSettings {
  std::string name;
  Structure structure = Structure::ctpm;
  LatticeKind lattice = LatticeKind::cubic_18;
  bool has_softening = true;           ///< Eq. 8, for `ctpm`; without it the network gives the TPM column of Table 1
  Material material;                   ///< below the last layer
  std::vector<LayerMaterial> layers;   ///< outermost first, `to_depth` ascending
  std::vector<std::int32_t> anchored;  ///< spheres of the organ that never move, by index within the organ
  struct Guide {
    std::int32_t sphere;  ///< index within the organ
    std::uint8_t axes;    ///< that it may not leave, as in Model::held_axes
  };
  std::vector<Guide> guides;  ///< spheres that run on rails or planes, for rigs
  double damage_depth = 0;    ///< [m]; 0: no limit
};

/// Stiffness of an edge of the given spacing per unit of modulus [m^2]: S0_cal (s / s_cal) times the
/// stiffness scale.
double edge_area(const Material& material, double spacing);

/// Appends the organ's spheres and the elements between them to `model`. Errors: an organ without spheres, a
/// modulus out of range in any layer, layers out of order, an anchor that is not a sphere of the organ.
Result<Done> add_organ(Model& model, const FilledOrgan& organ, const OrganSettings& settings);

}  // namespace ctpm::network
