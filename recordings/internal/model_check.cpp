#include "recordings/internal/model_check.h"

#include <algorithm>
#include <cmath>

namespace ctpm::session_file {
namespace {

// A file must not be able to ask for a tick that never ends.
constexpr std::int32_t max_iterations = 1'000'000;
constexpr std::int32_t max_substeps = 10'000;

/// "[i]", for the place in an array.
std::string place(std::ptrdiff_t i) { return std::string("[").append(std::to_string(i)).append("]"); }

/// Collects problems; every check names the array it is about.
class Checker {
 public:
  explicit Checker(std::string where) : where_(std::move(where)) {}
  Errors take() { return std::move(errors_); }

  void require(bool good, const std::string& name, const std::string& what) {
    if (!good) errors_.push_back({where_, name + " " + what, ""});
  }

  template <class T>
  bool length(const std::string& name, const std::vector<T>& values, std::size_t expected, bool may_be_empty = false) {
    const bool good = values.size() == expected || (may_be_empty && values.empty());
    require(good, name, "has " + std::to_string(values.size()) + " entries, expected " + std::to_string(expected));
    return good;
  }

  void indices(const std::string& name, const std::vector<std::int32_t>& values, std::int64_t lowest,
               std::int64_t end) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] >= lowest && values[i] < end) continue;
      return require(false, name + place(i),
                     "is " + std::to_string(values[i]) + ", must be in [" + std::to_string(lowest) + ", " +
                         std::to_string(end) + ")");
    }
  }

  void finite(const std::string& name, const std::vector<double>& values) {
    each(
        name, values, [](double v) { return std::isfinite(v); }, "must be finite");
  }
  void positive(const std::string& name, const std::vector<double>& values) {
    each(
        name, values, [](double v) { return std::isfinite(v) && v > 0; }, "must be finite and above 0");
  }
  void not_negative(const std::string& name, const std::vector<double>& values) {
    each(
        name, values, [](double v) { return std::isfinite(v) && v >= 0; }, "must be finite and not below 0");
  }

  void flags(const std::string& name, const std::vector<std::uint8_t>& values, int largest = 1) {
    each(
        name, values, [largest](std::uint8_t v) { return v <= largest; }, "has unknown bits");
  }

  void points(const std::string& name, const Vec3Array& points, std::size_t expected) {
    const auto one = [&](const char* axis, const std::vector<double>& values) {
      length(name + axis, values, expected);
      finite(name + axis, values);
    };
    one(".x", points.x), one(".y", points.y), one(".z", points.z);
  }

 private:
  template <class T, class Good>
  void each(const std::string& name, const std::vector<T>& values, Good good, const char* what) {
    const auto bad = std::find_if_not(values.begin(), values.end(), good);
    if (bad != values.end()) require(false, name + place(bad - values.begin()), what);
  }

  std::string where_;
  Errors errors_;
};

/// Ends of elements: in range and not the same sphere.
void check_ends(Checker& check, const std::string& name, const std::vector<std::int32_t>& a,
                const std::vector<std::int32_t>& b, std::int64_t sphere_count) {
  check.indices(name + ".a", a, 0, sphere_count);
  if (check.length(name + ".b", b, a.size()))
    for (std::size_t i = 0; i < a.size(); ++i)
      if (a[i] == b[i]) return check.require(false, name + place(i), "joins a sphere with itself");
  check.indices(name + ".b", b, 0, sphere_count);
}

/// Element by element: a known law, only the values that it has, and internal variables in State's order at the end.
void check_laws(Checker& check, const AxialElements& axial) {
  std::int32_t variables = 0;
  for (std::size_t i = 0; i < axial.size(); ++i) {
    const auto require = [&](bool good, const char* array, const char* what) {
      if (!good) check.require(false, std::string("axial.") + array + place(std::ptrdiff_t(i)), what);
      return good;
    };
    const AxialLaw law = axial.law[i];
    const bool is_tpm = law == AxialLaw::two_sphere_tpm;
    const double kelvin_k = axial.kelvin_k.empty() ? 0 : axial.kelvin_k[i];
    const std::int32_t internal = axial.internal.empty() ? -1 : axial.internal[i];
    if (!require(law >= AxialLaw::spring && law <= AxialLaw::two_sphere_tpm, "law", "is of an unknown kind") ||
        !require(law != AxialLaw::spring || axial.damping(i) == 0, "c", "must be 0 of a spring") ||
        !require(is_tpm ? kelvin_k > 0 : kelvin_k == 0, "kelvin_k",
                 "must be above 0 of two-sphere TPMs, 0 of others") ||
        !require(is_tpm || variables == 0, "law", "must not follow a two-sphere TPM") ||
        !require(internal == (is_tpm ? variables : -1), "internal", "is not the next internal variable"))
      return;
    variables += is_tpm;
  }
}

void check_axial(Checker& check, const Model& model) {
  const auto spheres = static_cast<std::int64_t>(model.sphere_count());
  const AxialElements& axial = model.axial;
  const std::size_t count = axial.size();
  check_ends(check, "axial", axial.a, axial.b, spheres);
  check.length("axial.rest_length", axial.rest_length, count);
  check.positive("axial.rest_length", axial.rest_length);
  check.length("axial.k", axial.k, count);
  check.positive("axial.k", axial.k);
  check.not_negative("axial.c", axial.c);
  check.not_negative("axial.kelvin_k", axial.kelvin_k);
  check.length("axial.third", axial.third, count, !model.has_softening);
  check.indices("axial.third", axial.third, -1, spheres);
  const bool has_law = check.length("axial.law", axial.law, count),
             has_c = check.length("axial.c", axial.c, count, true),
             has_kelvin_k = check.length("axial.kelvin_k", axial.kelvin_k, count, true),
             has_internal = check.length("axial.internal", axial.internal, count, true);
  if (has_law && has_c && has_kelvin_k && has_internal) check_laws(check, axial);
}

/// Lattice cells: near enough to each other for a table of all cells of an organ.
void check_cells(Checker& check, const Model& model) {
  constexpr std::int32_t farthest = 1 << 20;
  constexpr std::int64_t most = 1 << 26;
  std::vector<std::int64_t> volume(model.organs.size(), 1);
  const auto one = [&](const std::string& name, const std::vector<std::int32_t>& values) {
    if (!check.length(name, values, model.sphere_count())) return;
    check.indices(name, values, -farthest, farthest + 1);
    for (std::size_t o = 0; o < model.organs.size(); ++o) {
      const OrganRange& organ = model.organs[o];
      if (organ.first < 0 || organ.count <= 0 || std::int64_t{organ.first} + organ.count > std::int64_t(values.size()))
        continue;  // told by check_organs()
      const auto begin = values.begin() + organ.first;
      const auto [low, high] = std::minmax_element(begin, begin + organ.count);
      volume[o] = std::min(volume[o] * (std::int64_t{*high} - *low + 1), 2 * most);
    }
  };
  one("cell.i", model.cell.i), one("cell.j", model.cell.j), one("cell.k", model.cell.k);
  for (std::size_t o = 0; o < volume.size(); ++o)
    check.require(volume[o] <= most, "organs" + place(std::ptrdiff_t(o)), "spans more lattice cells than it can have");
}

void check_elements(Checker& check, const Model& model) {
  const auto spheres = static_cast<std::int64_t>(model.sphere_count());
  const auto axial_count = static_cast<std::int64_t>(model.axial.size());
  check_axial(check, model);
  const Constraints& constraints = model.constraints;
  check.indices("constraints.a", constraints.a, 0, spheres);
  check.length("constraints.c", constraints.c, constraints.size());
  check.indices("constraints.c", constraints.c, 0, spheres);
  check.length("constraints.e", constraints.e, constraints.size());
  check.indices("constraints.e", constraints.e, 0, spheres);
  check.length("constraints.k", constraints.k, constraints.size());
  check.finite("constraints.k", constraints.k);
  for (int i = 0; i < 4; ++i) {
    const std::string name = "constraints.edge" + std::to_string(i);
    check.length(name, constraints.edge[i], constraints.size());
    check.indices(name, constraints.edge[i], 0, axial_count);
  }

  const AngleSprings& angles = model.angle_springs;
  check.indices("angle_springs.a", angles.a, 0, spheres);
  check.length("angle_springs.b", angles.b, angles.size());
  check.indices("angle_springs.b", angles.b, 0, spheres);
  check.length("angle_springs.c", angles.c, angles.size());
  check.indices("angle_springs.c", angles.c, 0, spheres);
  check.length("angle_springs.k", angles.k, angles.size());
  check.positive("angle_springs.k", angles.k);
  for (int i = 0; i < 2; ++i) {
    const std::string name = "angle_springs.edge" + std::to_string(i);
    check.length(name, angles.edge[i], angles.size());
    check.indices(name, angles.edge[i], 0, axial_count);
  }
}

void check_loads(Checker& check, const Model& model) {
  const Loads& loads = model.loads;
  check.indices("loads.sphere", loads.sphere, 0, static_cast<std::int64_t>(model.sphere_count()));
  check.points("loads.force", loads.force, loads.size());
  check.length("loads.start", loads.start, loads.size());
  check.not_negative("loads.start", loads.start);
  check.length("loads.ramp", loads.ramp, loads.size());
  check.not_negative("loads.ramp", loads.ramp);
}

void check_cut_resistance(Checker& check, const Model& model) {
  const CutResistance& cut = model.cut_resistance;
  const auto one = [&](const std::string& name, const std::vector<double>& values) {
    check.length(name, values, cut.any() ? model.axial.size() : 0);
    check.not_negative(name, values);
  };
  one("cut_resistance.energy", cut.energy);
  one("cut_resistance.friction", cut.friction);
  check.require(std::isfinite(model.lip_k) && model.lip_k >= 0, "lip_k", "must be finite and not below 0");
}

void check_organs(Checker& check, const Model& model) {
  const auto spheres = static_cast<std::int64_t>(model.sphere_count());
  for (std::size_t i = 0; i < model.organs.size(); ++i) {
    const OrganRange& organ = model.organs[i];
    const std::string name = "organs" + place(i);
    check.require(organ.first >= 0 && organ.count >= 0 && std::int64_t{organ.first} + organ.count <= spheres, name,
                  "is not a range of spheres");
    check.require(
        std::isfinite(organ.sphere_radius) && std::isfinite(organ.spacing) && std::isfinite(organ.damage_depth), name,
        "has a length that is not finite");
  }
}

void check_tools(Checker& check, const Model& model) {
  for (std::size_t i = 0; i < model.tools.size(); ++i) {
    const Tool& tool = model.tools[i];
    const std::string name = "tools" + place(i);
    check.require(tool.kind >= ToolKind::ball && tool.kind <= ToolKind::pin, name, "is of an unknown kind");
    const std::int64_t lowest = tool.kind == ToolKind::pin ? 0 : -1;
    check.require(tool.sphere >= lowest && tool.sphere < static_cast<std::int64_t>(model.sphere_count()), name,
                  "holds a sphere that is not there");
    check.require(
        std::isfinite(tool.radius) && tool.radius >= 0 && std::isfinite(tool.blade_length) && tool.blade_length >= 0,
        name, "has a size that is not finite or below 0");
  }
}

}  // namespace

Errors check_model(const Model& model) {
  Checker check("model");
  const std::size_t spheres = model.sphere_count();
  check.require(std::isfinite(model.tick) && model.tick > 0, "tick", "must be finite and above 0");
  check.require(is_finite(model.gravity), "gravity", "must be finite");
  check.points("rest_position", model.rest_position, spheres);
  check.positive("mass", model.mass);
  check.length("held_axes", model.held_axes, spheres);
  check.flags("held_axes", model.held_axes, kAnchored);
  check.length("contact_radius", model.contact_radius, spheres);
  check.positive("contact_radius", model.contact_radius);
  check.length("layer", model.layer, spheres);
  check_organs(check, model);
  check_cells(check, model);
  check_elements(check, model);
  check_loads(check, model);
  check_tools(check, model);
  check_cut_resistance(check, model);
  check.require(std::isfinite(model.contact_k) && model.contact_k >= 0, "contact_k", "must be finite and not below 0");
  check.require(std::isfinite(model.contact_friction) && model.contact_friction >= 0, "contact_friction",
                "must be finite and not below 0");

  const SolverSettings& solver = model.solver;
  check.require(solver.tolerance > 0 && solver.tolerance < 1, "solver.tolerance", "must be in (0, 1)");
  check.require(std::isfinite(solver.velocity_floor) && solver.velocity_floor > 0, "solver.velocity_floor",
                "must be above 0");
  check.require(solver.max_iterations >= 1 && solver.max_iterations <= max_iterations, "solver.max_iterations",
                "must be in [1, " + std::to_string(max_iterations) + "]");
  check.require(solver.substeps >= 1 && solver.substeps <= max_substeps, "solver.substeps",
                "must be in [1, " + std::to_string(max_substeps) + "]");
  check.require(solver.integrator >= Integrator::automatic && solver.integrator <= Integrator::sdirk2,
                "solver.integrator", "is of an unknown kind");
  return check.take();
}

Errors check_state(const Model& model, const State& state) {
  Checker check("state");
  check.points("position", state.position, model.sphere_count());
  check.points("velocity", state.velocity, model.sphere_count());
  check.length("kelvin_elongation", state.kelvin_elongation, model.axial.internal_count());
  check.finite("kelvin_elongation", state.kelvin_elongation);

  // The sets of severed elements are there together or not at all.
  const bool cuts =
      !state.axial_severed.empty() || !state.constraint_severed.empty() || !state.angle_severed.empty() ||
      std::any_of(model.tools.begin(), model.tools.end(), [](const Tool& t) { return t.kind == ToolKind::scalpel; });
  check.length("axial_severed", state.axial_severed, cuts ? model.axial.size() : 0);
  check.flags("axial_severed", state.axial_severed);
  check.length("constraint_severed", state.constraint_severed, cuts ? model.constraints.size() : 0);
  check.flags("constraint_severed", state.constraint_severed);
  check.length("angle_severed", state.angle_severed, cuts ? model.angle_springs.size() : 0);
  check.flags("angle_severed", state.angle_severed);
  // Older sessions do not say where the blade passed.
  check.length("axial_crossing", state.axial_crossing, cuts ? model.axial.size() : 0, true);
  const Vec3Array& trail = state.blade_trail;
  if (!trail.x.empty() || !trail.y.empty() || !trail.z.empty()) check.points("blade_trail", state.blade_trail, 2);
  const Vec3Array& acceleration = state.acceleration;
  if (!acceleration.x.empty() || !acceleration.y.empty() || !acceleration.z.empty())
    check.points("acceleration", acceleration, model.sphere_count());
  const auto tools = static_cast<std::int32_t>(model.tools.size());
  check.require(state.last_inputs.tool >= -1 && state.last_inputs.tool < tools, "last_inputs.tool",
                "is not a tool of the model");
  return check.take();
}

Errors check_surfaces(const Model& model, const std::vector<Surface>& surfaces) {
  Checker check("surfaces");
  if (!surfaces.empty() && surfaces.size() != model.organs.size())
    check.require(
        false, "list",
        "has " + std::to_string(surfaces.size()) + " entries for " + std::to_string(model.organs.size()) + " organs");
  for (std::size_t i = 0; i < std::min(surfaces.size(), model.organs.size()); ++i) {
    const Surface& surface = surfaces[i];
    const std::string name = place(i) + ".";
    const auto vertices = static_cast<std::int32_t>(surface.vertex.size());
    for (const Vec3& vertex : surface.vertex)
      if (!is_finite(vertex)) {
        check.require(false, name + "vertex", "is not finite");
        break;
      }
    std::vector<std::int32_t> corners;
    for (const auto& triangle : surface.triangle) corners.insert(corners.end(), triangle.begin(), triangle.end());
    check.indices(name + "triangle", corners, 0, vertices);

    const SurfaceBinding& binding = surface.binding;
    const auto entries = static_cast<std::int64_t>(binding.sphere.size());
    check.indices(name + "binding.sphere", binding.sphere, 0, model.organs[i].count);
    check.length(name + "binding.weight", binding.weight, binding.sphere.size());
    check.finite(name + "binding.weight", binding.weight);
    if (check.length(name + "binding.first", binding.first, surface.vertex.size() + 1, surface.vertex.empty()) &&
        !binding.first.empty()) {
      check.indices(name + "binding.first", binding.first, 0, entries + 1);
      check.require(binding.first.front() == 0 && binding.first.back() == entries &&
                        std::is_sorted(binding.first.begin(), binding.first.end()),
                    name + "binding.first", "does not divide the entries among the vertices");
    }
  }
  return check.take();
}

}  // namespace ctpm::session_file
