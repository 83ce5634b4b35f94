#include "core/network/network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "core/network/axial_rows.h"
#include "core/network/tissue_cells.h"

namespace ctpm::network {
namespace {

using Cell = LatticeCell;

constexpr double kFewestPascalPerMetre = 1e-6;
constexpr double kMostPascalPerMetre = 1e15;

/// Beyond this a cell would be stiffer than the contact of a tool.
constexpr double kMostInversionResistance = 1000;

Cell operator+(Cell a, Cell b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Cell operator-(Cell a, Cell b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double length_of(Cell direction, double spacing) {
  const int steps = std::abs(direction[0]) + std::abs(direction[1]) + std::abs(direction[2]);
  return steps == 1 ? spacing : spacing * std::sqrt(double(steps));
}

double series(double k1, double k2) { return k1 * k2 / (k1 + k2); }

void check_positive(Errors& errors, const std::string& where, const char* what, double value) {
  if (!(value >= kFewestPascalPerMetre && value <= kMostPascalPerMetre))
    errors.push_back(
        {where, std::string(what) + ": got " + std::to_string(value) + " Pa/m, must be in [1e-6, 1e15]", ""});
}

void check_material(Errors& errors, const std::string& where, const Material& m, Structure structure) {
  check_positive(errors, where, "spring modulus K2", m.spring);
  check_positive(errors, where, "Kelvin modulus K1", m.kelvin);
  if (structure == Structure::ctpm && !(m.constraint >= series(m.kelvin, m.spring)))
    errors.push_back({where,
                      "constraint modulus K': got " + std::to_string(m.constraint) +
                          " Pa/m, must be at least K1 K2 / (K1 + K2), which the triples already give",
                      ""});
  if (!(m.viscosity >= 0) || !std::isfinite(m.viscosity))
    errors.push_back({where, "viscosity v1: got " + std::to_string(m.viscosity) + " Pa s/m, must be 0 or more", ""});
  if (!(m.prestrain >= -0.2 && m.prestrain <= 0.5))
    errors.push_back({where, "prestrain: got " + std::to_string(m.prestrain) + ", must be in [-0.2, 0.5]", ""});
  if (!(m.fracture_toughness >= 0 && std::isfinite(m.fracture_toughness) && m.blade_friction >= 0 &&
        std::isfinite(m.blade_friction)))
    errors.push_back({where, "fracture toughness and blade friction must be 0 or more", ""});
  if (!(m.density > 0 && m.stiffness_scale > 0 && m.calibration_area > 0 && m.calibration_spacing > 0))
    errors.push_back({where, "density, stiffness scale, calibration area and spacing must all be more than 0", ""});
}

Errors check_organ(const FilledOrgan& organ, const OrganSettings& settings) {
  Errors errors;
  const std::string where = "organ " + settings.name;
  if (organ.centre.empty()) errors.push_back({where, "has no spheres", "fill it with smaller spheres"});
  double above = 0;
  for (std::size_t i = 0; i < settings.layers.size(); ++i) {
    const LayerMaterial& layer = settings.layers[i];
    const std::string where_layer = where + ", layer " + std::to_string(i);
    if (!(layer.to_depth > above))
      errors.push_back({where_layer,
                        "ends at a depth of " + std::to_string(layer.to_depth) + " m, must be more than " +
                            std::to_string(above) + " m, where it begins",
                        ""});
    above = layer.to_depth;
    check_material(errors, where_layer, layer.material, settings.structure);
  }
  check_material(errors, where, settings.material, settings.structure);
  if (!(settings.inversion_resistance >= 0 && settings.inversion_resistance <= kMostInversionResistance))
    errors.push_back(
        {where, "inversion resistance: got " + std::to_string(settings.inversion_resistance) + ", must be in [0, 1000]",
         ""});
  const auto check_sphere = [&](const char* what, std::int32_t sphere) {
    if (sphere < 0 || std::size_t(sphere) >= organ.centre.size())
      errors.push_back({where, std::string(what) + " sphere " + std::to_string(sphere) + " does not exist", ""});
  };
  for (const std::int32_t sphere : settings.anchored) check_sphere("anchored", sphere);
  for (const OrganSettings::Guide& guide : settings.guides) check_sphere("guided", guide.sphere);
  return errors;
}

const Material& material_of(const FilledOrgan& organ, const OrganSettings& settings, std::size_t sphere) {
  for (const LayerMaterial& layer : settings.layers)
    if (layer.to_depth > organ.depth[sphere]) return layer.material;
  return settings.material;
}

/// Stiffness, damping and prestrain that one sphere's material gives to elements.
struct Stiffness {
  double spring_k, kelvin_k, kelvin_c, constraint_k;
  double rest_part;  ///< rest length over the length in the lattice
};

Stiffness stiffness_of(const Material& m, double spacing) {
  const double area = edge_area(m, spacing);
  // The triples beside C stretch when C dips and add their own 2 P2 (1 - cos theta) u; K' counts both.
  return {m.spring * area, m.kelvin * area, m.viscosity * area, (m.constraint - series(m.kelvin, m.spring)) * area,
          1 - m.prestrain};
}

/// Stiffness of a spring two of which in series are as stiff as one slow triple.
double single_spring(const Stiffness& s) { return 2 * series(s.kelvin_k, s.spring_k); }

/// Static stiffness of an element along a lattice axis [N/m].
double slow_edge_k(Structure structure, const Stiffness& s) {
  return structure == Structure::tpm ? series(s.kelvin_k, s.spring_k) : single_spring(s);
}

/// Area that an element stands for when a cut crosses it at right angles [m^2]. Per area, a plane with the unit normal
/// n crosses |n . D| / s^3 elements of direction D. Each counts with this area times |n . D| / |D|. The sum is 1 for
/// every n, since the squared components of all directions add up to a multiple of |n|^2.
double crossed_area(LatticeKind lattice, double spacing) {
  return spacing * spacing / (lattice == LatticeKind::cubic_18 ? 1 + 2 * std::sqrt(2.0) : 1);
}

/// Builds the elements of one organ line by line, and sorts those of a direction into the order of computation. Springs
/// and Kelvin units go to the end of Model::axial, two-sphere TPMs to `tpms`.
class LineTiler {
 public:
  LineTiler(Model& model, const FilledOrgan& organ, const OrganSettings& settings, std::int32_t first_sphere)
      : model_(model), organ_(organ), settings_(settings), first_sphere_(first_sphere) {
    for (std::size_t i = 0; i < organ.cell.size(); ++i) sphere_at_.emplace(organ.cell[i], std::int32_t(i));
    for (std::size_t i = 0; i < organ.cell.size(); ++i)
      stiffness_.push_back(stiffness_of(material_of(organ, settings, i), organ.spacing));
  }

  /// Tiles all lines along kLatticeDirections[`direction`].
  void tile(std::size_t direction) {
    const Cell step = kLatticeDirections[direction];
    const auto share_from = [&](const Cell& cell) {
      const auto it = sphere_at_.find(cell);
      if (it == sphere_at_.end() || !sphere_at_.contains(cell + step)) return 0.0;
      return organ_.shares.of_element(std::size_t(it->second), direction);
    };
    for (const Cell& start : organ_.cell) {
      if (share_from(start - step) > 0 || !(share_from(start) > 0)) continue;
      Run run;
      run.sphere.push_back(sphere_at_.at(start) + first_sphere_);
      for (Cell cell = start; share_from(cell) > 0;) {
        run.share.push_back(share_from(cell));
        cell = cell + step;
        run.sphere.push_back(sphere_at_.at(cell) + first_sphere_);
      }
      tile_run(run, length_of(step, organ_.spacing));
    }
    flush_direction();
  }

  /// The organ's two-sphere TPMs, direction by direction.
  const std::vector<AxialRow>& tpms() const { return tpms_; }

 private:
  /// A line of spheres that elements join one to the next.
  struct Run {
    std::vector<std::int32_t> sphere;
    std::vector<double> share;  ///< of the element from each sphere to the next (one less than spheres)

    std::size_t size() const { return sphere.size(); }
    /// The least share of `count` elements.
    double least_share(std::size_t first, std::size_t count) const {
      return *std::min_element(share.begin() + std::ptrdiff_t(first), share.begin() + std::ptrdiff_t(first + count));
    }
  };
  struct Element {
    AxialRow row;
    std::int32_t line_number;  ///< position in the order of tiling, by which constraints refer to their elements
  };
  struct Angle {
    std::int32_t a, middle, c, line_number;
    double k;
  };
  struct Constraint {
    std::int32_t a, middle, e, line_number;  ///< line number of the first of its four elements
    double k;
  };

  /// Mean over `count` spheres of a run; exact if all are equal.
  Stiffness mean_over(const Run& run, std::size_t first, std::size_t count) const {
    const auto of = [&](std::size_t i) -> const Stiffness& {
      return stiffness_[std::size_t(run.sphere[first + i] - first_sphere_)];
    };
    const auto mean = [&](double Stiffness::*value) {
      double sum = 0;
      for (std::size_t i = 1; i < count; ++i) sum += of(i).*value - of(0).*value;
      return of(0).*value + sum / double(count);
    };
    return {mean(&Stiffness::spring_k), mean(&Stiffness::kelvin_k), mean(&Stiffness::kelvin_c),
            mean(&Stiffness::constraint_k), mean(&Stiffness::rest_part)};
  }

  void tile_run(const Run& run, double rest_length) {
    switch (settings_.structure) {
      case Structure::mass_spring:
        tile_springs(run, rest_length);
        break;
      case Structure::angle_mass_spring:
        for (std::size_t i = 0; i + 2 < run.size(); ++i)
          angles_.push_back({run.sphere[i], run.sphere[i + 1], run.sphere[i + 2], next_line_number_ + std::int32_t(i),
                             run.least_share(i, 2) * single_spring(mean_over(run, i, 3))});
        tile_springs(run, rest_length);
        break;
      case Structure::tpm:
        for (std::size_t i = 0; i + 1 < run.size(); ++i) add_tpm(run, i, rest_length, 1);
        break;
      case Structure::ctpm:
        if (settings_.tiling == Tiling::three_spheres)
          tile_triples(run, rest_length);
        else
          tile_tpms(run, rest_length);
        break;
    }
  }

  void tile_springs(const Run& run, double rest_length) {
    for (std::size_t i = 0; i + 1 < run.size(); ++i) {
      const Stiffness s = mean_over(run, i, 2);
      add_spring(run, i, -1, s.rest_part * rest_length, single_spring(s), 0);
    }
  }

  /// Triples A-B-C, C-B-A, A-B-C ... that share ends. Where two share C, the five spheres carry a constraint.
  void tile_triples(const Run& run, double rest_length) {
    const std::size_t triple_count = (run.size() - 1) / 2;
    for (std::size_t t = 0; t < triple_count; ++t) {
      const std::int32_t p = run.sphere[2 * t], r = run.sphere[2 * t + 2];
      const bool starts_at_a = t % 2 == 0;
      const Stiffness s = mean_over(run, 2 * t, 3);
      const double length = s.rest_part * rest_length;
      if (starts_at_a) {
        add_spring(run, 2 * t, r, length, s.spring_k, 0);
        add_spring(run, 2 * t + 1, p, length, s.kelvin_k, s.kelvin_c);
      } else {
        add_constraint(run, 2 * t - 2, next_line_number_ - 2);
        add_spring(run, 2 * t, r, length, s.kelvin_k, s.kelvin_c);
        add_spring(run, 2 * t + 1, p, length, s.spring_k, 0);
      }
    }
    if (run.size() % 2 == 0) add_tpm(run, run.size() - 2, rest_length, 1);
  }

  /// A two-sphere TPM at every element, twice as stiff as a triple, so that two in series are as stiff; and the
  /// constraints of the same five-sphere lines that triples would carry.
  void tile_tpms(const Run& run, double rest_length) {
    const std::int32_t first_line_number = next_line_number_;
    for (std::size_t i = 0; i + 1 < run.size(); ++i) add_tpm(run, i, rest_length, 2);
    for (std::size_t i = 0; i + 4 < run.size(); i += 4) add_constraint(run, i, first_line_number + std::int32_t(i));
  }

  /// The constraint of the five spheres from `first`, whose first element has the line number given.
  void add_constraint(const Run& run, std::size_t first, std::int32_t line_number) {
    constraints_.push_back({run.sphere[first], run.sphere[first + 2], run.sphere[first + 4], line_number,
                            run.least_share(first, 4) * mean_over(run, first, 5).constraint_k});
  }

  /// A spring between a sphere of a run and the next, or a Kelvin unit if it is damped.
  void add_spring(const Run& run, std::size_t at, std::int32_t third, double rest_length, double k, double c) {
    const AxialLaw law = c > 0 ? AxialLaw::kelvin_unit : AxialLaw::spring;
    const double share = run.share[at];
    const auto [energy, friction] = cut_resistance_of(run, at);
    springs_.push_back(
        {{run.sphere[at], run.sphere[at + 1], law, rest_length, share * k, share * c, 0, third, energy, friction},
         next_line_number_++});
  }

  /// A two-sphere TPM between a sphere of a run and the next, `times` as stiff as a triple.
  void add_tpm(const Run& run, std::size_t at, double rest_length, double times) {
    const Stiffness s = mean_over(run, at, 2);
    const double share = times * run.share[at];
    const auto [energy, friction] = cut_resistance_of(run, at);
    tpms_of_direction_.push_back(
        {{run.sphere[at], run.sphere[at + 1], AxialLaw::two_sphere_tpm, s.rest_part * rest_length, share * s.spring_k,
          share * s.kelvin_c, share * s.kelvin_k, -1, energy, friction},
         next_line_number_++});
  }

  /// Resistance to a blade of the element after a sphere of a run: energy [J] and friction [N], as in CutResistance.
  std::pair<double, double> cut_resistance_of(const Run& run, std::size_t at) const {
    const double area = run.share[at] * crossed_area(settings_.lattice, organ_.spacing);
    const auto material = [&](std::size_t i) -> const Material& {
      return material_of(organ_, settings_, std::size_t(run.sphere[i] - first_sphere_));
    };
    const Material &p = material(at), &q = material(at + 1);
    const double friction = 2 * area * 0.5 * (p.blade_friction + q.blade_friction);  // two flanks
    return {area * 0.5 * (p.fracture_toughness + q.fracture_toughness), friction};
  }

  /// Moves the elements of one direction into the Model, sorted by their first sphere. Along a lattice row both ends
  /// then advance by one from element to element, and the element loops gather no indices.
  void flush_direction() {
    const auto by_first = [](const Element& p, const Element& q) { return p.row.a < q.row.a; };
    std::stable_sort(springs_.begin(), springs_.end(), by_first);
    std::stable_sort(tpms_of_direction_.begin(), tpms_of_direction_.end(), by_first);
    const auto by_middle = [](const auto& p, const auto& q) { return p.middle < q.middle; };
    std::stable_sort(constraints_.begin(), constraints_.end(), by_middle);
    std::stable_sort(angles_.begin(), angles_.end(), by_middle);
    // Two-sphere TPMs get their place in the table at the end: here they count backwards from -1.
    std::vector<std::int32_t> element_of_line_number(std::size_t(next_line_number_), 0);
    for (const Element& spring : springs_) {
      element_of_line_number[std::size_t(spring.line_number)] = std::int32_t(model_.axial.size());
      append(model_, spring.row);
    }
    for (const Element& tpm : tpms_of_direction_) {
      element_of_line_number[std::size_t(tpm.line_number)] = -1 - std::int32_t(tpms_.size());
      tpms_.push_back(tpm.row);
    }
    for (const Constraint& c : constraints_) {
      Constraints& all = model_.constraints;
      all.a.push_back(c.a), all.c.push_back(c.middle), all.e.push_back(c.e), all.k.push_back(c.k);
      for (std::size_t i = 0; i < 4; ++i) all.edge[i].push_back(element_of_line_number[std::size_t(c.line_number) + i]);
    }
    for (const Angle& angle : angles_) {
      AngleSprings& all = model_.angle_springs;
      all.a.push_back(angle.a), all.b.push_back(angle.middle), all.c.push_back(angle.c);
      all.k.push_back(angle.k);
      for (std::size_t i = 0; i < 2; ++i)
        all.edge[i].push_back(element_of_line_number[std::size_t(angle.line_number) + i]);
    }
    springs_.clear(), tpms_of_direction_.clear(), constraints_.clear(), angles_.clear();
    next_line_number_ = 0;
  }

  Model& model_;
  const FilledOrgan& organ_;
  const OrganSettings& settings_;
  std::int32_t first_sphere_;
  std::map<Cell, std::int32_t> sphere_at_;
  std::vector<Stiffness> stiffness_;        // (sphere_count)
  std::vector<Element> springs_;            // of the direction
  std::vector<Element> tpms_of_direction_;  // of the direction
  std::vector<AxialRow> tpms_;
  std::vector<Constraint> constraints_;
  std::vector<Angle> angles_;
  std::int32_t next_line_number_ = 0;
};

/// Distance from the centre of a sphere at which a tool touches it. In the outermost layer this is the depth of the
/// centre, so that the tool meets the visible surface, limited to [r, spacing]; further in it is r.
double contact_radius_of(const FilledOrgan& organ, std::size_t sphere) {
  if (organ.layer[sphere] != 1) return organ.sphere_radius;
  return std::clamp(organ.depth[sphere], organ.sphere_radius, organ.spacing);
}

/// Static Young's modulus of the full lattice of a material [Pa].
double modulus_of(const Material& material, const FilledOrgan& organ, Structure structure) {
  return kYoungOverEdge * slow_edge_k(structure, stiffness_of(material, organ.spacing)) / organ.spacing;
}

/// The tissue that a tool dents: that half a spacing below the surface, with the static modulus of the full lattice.
void set_foundation(OrganRange& range, const FilledOrgan& organ, const OrganSettings& settings) {
  const Material* material = &settings.material;
  for (auto layer = settings.layers.rbegin(); layer != settings.layers.rend(); ++layer)
    if (layer->to_depth > 0.5 * organ.spacing) material = &layer->material;
  range.modulus = modulus_of(*material, organ, settings.structure);
  if (settings.structure != Structure::tpm && settings.structure != Structure::ctpm) return;
  const Stiffness s = stiffness_of(*material, organ.spacing);
  range.instant_ratio = 1 + s.spring_k / s.kelvin_k;
  range.kelvin_time = s.kelvin_c / s.kelvin_k;
}

/// Strain to which the pull of a blade's edge may stretch the tissue that takes it up (our choice). An edge draws with
/// its toughness J_c per length. Spread over the half cylinder ahead of it with radius rho, that is the stress
/// J_c / (pi rho).
constexpr double kEdgeStrain = 0.06;

/// Radius around a blade's edge at which its pull strains no layer of the organ by more than kEdgeStrain [m].
double blade_reach_of(const FilledOrgan& organ, const OrganSettings& settings) {
  double reach = 0;
  const auto add = [&](const Material& material) {
    const double modulus = modulus_of(material, organ, settings.structure);
    reach = std::max(reach, material.fracture_toughness / (std::numbers::pi * kEdgeStrain * modulus));
  };
  add(settings.material);
  for (const LayerMaterial& layer : settings.layers) add(layer.material);
  return reach;
}

void add_spheres(Model& model, const FilledOrgan& organ, const OrganSettings& settings) {
  const std::size_t first = model.sphere_count();
  for (std::size_t i = 0; i < organ.centre.size(); ++i) {
    model.rest_position.push_back(organ.centre[i]);
    model.contact_radius.push_back(contact_radius_of(organ, i));
    model.layer.push_back(organ.layer[i]);
    model.cell.push_back(organ.cell[i] - organ.cell[0]);
    const double volume = organ.shares.of_sphere(i) * organ.spacing * organ.spacing * organ.spacing;
    model.mass.push_back(material_of(organ, settings, i).density * volume);
  }
  model.held_axes.resize(first + organ.centre.size(), 0);
  for (const OrganSettings::Guide& guide : settings.guides)
    model.held_axes[first + std::size_t(guide.sphere)] = guide.axes;
  for (const std::int32_t sphere : settings.anchored) model.held_axes[first + std::size_t(sphere)] = kAnchored;
  const int layers = *std::max_element(organ.layer.begin(), organ.layer.end());
  model.organs.push_back({settings.name, std::int32_t(first), std::int32_t(organ.centre.size()), organ.sphere_radius,
                          organ.spacing, settings.damage_depth, layers});
  set_foundation(model.organs.back(), organ, settings);
  model.organs.back().blade_reach = blade_reach_of(organ, settings);
  // Organs that were added without a surface have an empty one.
  model.surfaces.resize(model.organs.size());
  model.surfaces.back() = organ.surface;
}

}  // namespace

double edge_area(const Material& material, double spacing) {
  return material.calibration_area * (spacing / material.calibration_spacing) * material.stiffness_scale;
}

Result<Done> add_organ(Model& model, const FilledOrgan& organ, const OrganSettings& settings) {
  if (Errors errors = check_organ(organ, settings); !errors.empty()) return errors;
  bring_back_unused(model);
  const std::vector<AxialRow> earlier_tpms = take_tpms(model);
  const std::size_t earlier_springs = model.axial.size(), earlier_constraints = model.constraints.size();
  const auto first_sphere = std::int32_t(model.sphere_count());
  add_spheres(model, organ, settings);
  LineTiler tiler(model, organ, settings, first_sphere);
  const bool has_diagonals = settings.lattice == LatticeKind::cubic_18;
  for (std::size_t d = 0; d < (has_diagonals ? kLatticeDirections.size() : kAxisDirectionCount); ++d) tiler.tile(d);
  const auto added_springs = std::int32_t(model.axial.size() - earlier_springs);
  for (const AxialRow& tpm : earlier_tpms) append(model, tpm);
  const auto first_tpm = std::int32_t(model.axial.size());
  for (const AxialRow& tpm : tiler.tpms()) append(model, tpm);
  for (auto& edge : model.constraints.edge)
    for (std::size_t i = 0; i < edge.size(); ++i) {
      if (i < earlier_constraints && edge[i] >= std::int32_t(earlier_springs)) edge[i] += added_springs;
      if (edge[i] < 0) edge[i] = first_tpm - 1 - edge[i];
    }
  const bool softens = settings.structure == Structure::ctpm && settings.has_softening && model.constraints.size() > 0;
  model.has_softening = model.has_softening || softens;
  if (settings.inversion_resistance > 0) {
    std::vector<double> edge_k;
    for (std::size_t i = 0; i < organ.centre.size(); ++i)
      edge_k.push_back(slow_edge_k(settings.structure, stiffness_of(material_of(organ, settings, i), organ.spacing)));
    add_tissue_cells(model, organ, first_sphere, settings.inversion_resistance, edge_k);
  }
  leave_out_unused(model);
  return Done{};
}

}  // namespace ctpm::network
