#include "recordings/internal/model_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/contact/open_cuts.h"
#include "core/cutbody/cut_points.h"
#include "core/model/fields.h"
#include "recordings/internal/extent_check.h"
#include "recordings/internal/size_check.h"

namespace ctpm::recordings::session_file {
namespace {

constexpr double kFarthestVertex = 1e3;  // [m]
constexpr double kLargestWeight = 1e3;   // of a binding

/// "[i]", an index in an array.
std::string place(std::size_t i) { return std::string("[").append(std::to_string(i)).append("]"); }

/// Collects problems; every check names its array.
class Checker {
 public:
  explicit Checker(std::string where) : where_(std::move(where)) {}
  Errors take() { return std::move(errors_); }

  void require(bool good, const std::string& name, const std::string& what) {
    if (!good) errors_.push_back({where_, name + " " + what, ""});
  }

  bool length(const std::string& name, std::size_t count, std::size_t expected) {
    require(count == expected, name, "has " + std::to_string(count) + " entries, expected " + std::to_string(expected));
    return count == expected;
  }

  void indices(const std::string& name, const std::vector<std::int32_t>& values, std::int64_t lowest,
               std::int64_t end) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] >= lowest && values[i] < end) continue;
      return require(false, name + place(i), "is " + std::to_string(values[i]) + ", must be " + span(lowest, end));
    }
  }

  static std::string span(std::int64_t lowest, std::int64_t end) {
    return "in [" + std::to_string(lowest) + ", " + std::to_string(end) + ")";
  }

 private:
  std::string where_;
  Errors errors_;
};

std::size_t count_of(const Model& model, EntryOf entry) {
  switch (entry) {
    case EntryOf::none:
      break;
    case EntryOf::sphere:
      return model.sphere_count();
    case EntryOf::axial:
      return model.axial.size();
    case EntryOf::internal_variable:
      return model.axial.internal_count();
    case EntryOf::constraint:
      return model.constraints.size();
    case EntryOf::angle_spring:
      return model.angle_springs.size();
    case EntryOf::load:
      return model.loads.size();
    case EntryOf::tool:
      return model.tools.size();
    case EntryOf::blade_end:
      return 2;
    case EntryOf::touchable:
      return std::size_t(cutbody::CutPoints(model).end());
    case EntryOf::tissue_cell:
      return model.tissue_cells.size();
  }
  return 0;
}

std::string shown(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", number);
  return text;
}

/// Describes the valid values of a meaning.
std::string demand(const FieldMeaning& meaning) {
  const std::string lowest = shown(meaning.lowest);
  if (std::isfinite(meaning.highest))
    return "must be in " + std::string(meaning.is_open ? "(" : "[") + lowest + ", " + shown(meaning.highest) +
           (meaning.is_open ? ")" : "]");
  if (!std::isfinite(meaning.lowest)) return "must be finite";
  return "must be finite and " + std::string(meaning.is_open ? "above " : "not below ") + lowest;
}

/// Checks each field of a Model, a State or a nested structure against its meaning.
class FieldCheck {
 public:
  FieldCheck(Checker& check, const Model& model, std::string prefix = "")
      : check_(check), model_(model), prefix_(std::move(prefix)) {}

  template <class T>
  void operator()(std::string_view name, const T& value, const FieldMeaning& meaning) {
    const std::string full = prefix_ + std::string(name);
    if constexpr (std::is_same_v<T, Vec3>) {
      for (const double number : {value.x, value.y, value.z})
        if (!one(full, number, meaning)) return;
    } else if constexpr (std::is_arithmetic_v<T>) {
      one(full, value, meaning);
    } else if constexpr (std::is_enum_v<T>) {
      one(full, static_cast<std::underlying_type_t<T>>(value), meaning);
    } else {
      static_assert(std::is_same_v<T, Quat> || std::is_same_v<T, std::string>, "a kind of field without a check");
      CTPM_CHECK(meaning.range == FieldMeaning::Range::any, "texts and orientations have no range");
    }
  }

  template <class T>
  void operator()(std::string_view name, const std::vector<T>& values, const FieldMeaning& meaning) {
    const std::string full = prefix_ + std::string(name);
    const bool is_left_out = meaning.may_be_empty && values.empty();
    if (meaning.shape != EntryOf::none && !is_left_out)
      check_.length(full, values.size(), count_of(model_, meaning.shape));
    const std::size_t end = values.empty() ? 0 : end_of(meaning);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
        if (is_good(values[i], meaning, end)) continue;
        one(full + place(i), values[i], meaning);
        return;
      } else {
        for_each_field(values[i], FieldCheck(check_, model_, full + place(i) + "."));
      }
    }
  }

 private:
  /// Of valid indices. Finding it may take longer than checking all of them.
  std::size_t end_of(const FieldMeaning& meaning) const {
    return meaning.range == FieldMeaning::Range::index ? count_of(model_, meaning.indexed) : 0;
  }

  template <class T>
  bool is_good(T value, const FieldMeaning& meaning, std::size_t end) const {
    const auto number = static_cast<double>(value);
    switch (meaning.range) {
      case FieldMeaning::Range::any:
        break;
      case FieldMeaning::Range::number:
        return std::isfinite(number) && (meaning.is_open ? number > meaning.lowest && number < meaning.highest
                                                         : number >= meaning.lowest && number <= meaning.highest);
      case FieldMeaning::Range::index:
        return number >= meaning.lowest && number < static_cast<double>(end);
      case FieldMeaning::Range::bits:
        return (static_cast<std::uint64_t>(value) & ~meaning.mask) == 0;
      case FieldMeaning::Range::one_of:
        return number >= 0 && number < 64 && (meaning.mask >> static_cast<int>(number) & 1) != 0;
    }
    return true;
  }

  template <class T>
  bool one(const std::string& name, T value, const FieldMeaning& meaning) {
    if (is_good(value, meaning, end_of(meaning))) return true;
    switch (meaning.range) {
      case FieldMeaning::Range::any:
        break;
      case FieldMeaning::Range::number:
        check_.require(false, name, demand(meaning));
        break;
      case FieldMeaning::Range::index:
        check_.require(
            false, name,
            "is " + shown(static_cast<double>(value)) + ", must be " +
                Checker::span(static_cast<std::int64_t>(meaning.lowest), static_cast<std::int64_t>(end_of(meaning))));
        break;
      case FieldMeaning::Range::bits:
        check_.require(false, name, "has unknown bits");
        break;
      case FieldMeaning::Range::one_of:
        check_.require(false, name, "is of an unknown kind");
        break;
    }
    return false;
  }

  Checker& check_;
  const Model& model_;
  std::string prefix_;
};

/// An element must not join a sphere to itself.
void check_ends(Checker& check, const std::string& name, const std::vector<std::int32_t>& a,
                const std::vector<std::int32_t>& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (a[i] == b[i]) return check.require(false, name + place(i), "joins a sphere with itself");
}

/// Checks each element: a known law, only the values of that law, and elements with internal variables last, in State's
/// order.
void check_laws(Checker& check, const AxialElements& axial) {
  std::int32_t variables = 0;
  for (std::size_t i = 0; i < axial.size(); ++i) {
    const auto require = [&](bool good, const char* array, const char* what) {
      if (!good) check.require(false, std::string("axial.") + array + place(i), what);
      return good;
    };
    const AxialLaw law = axial.law[i];
    const bool is_tpm = law == AxialLaw::two_sphere_tpm;
    const double kelvin_k = axial.kelvin_k.empty() ? 0 : axial.kelvin_k[i];
    const std::int32_t internal = axial.internal.empty() ? -1 : axial.internal[i];
    if (!require(law != AxialLaw::spring || axial.damping(i) == 0, "c", "must be 0 of a spring") ||
        !require(is_tpm ? kelvin_k > 0 : kelvin_k == 0, "kelvin_k",
                 "must be above 0 of two-sphere TPMs, 0 of others") ||
        !require(is_tpm || variables == 0, "law", "must not follow a two-sphere TPM") ||
        !require(internal == (is_tpm ? variables : -1), "internal", "is not the next internal variable"))
      return;
    variables += is_tpm;
  }
}

/// The relations between the arrays of axial elements.
void check_axial(Checker& check, const Model& model) {
  const AxialElements& axial = model.axial;
  check_ends(check, "axial", axial.a, axial.b);
  if (model.has_softening) check.length("axial.third", axial.third.size(), axial.size());
  const auto fits = [&](const auto& values) { return values.empty() || values.size() == axial.size(); };
  // The field check has already reported wrong lengths.
  if (axial.law.size() == axial.size() && fits(axial.c) && fits(axial.kelvin_k) && fits(axial.internal))
    check_laws(check, axial);
}

/// The lattice cells of an organ must span a box small enough for a table.
void check_cells(Checker& check, const Model& model) {
  constexpr std::int64_t most = 1 << 26;
  std::int64_t all = 0;
  std::int32_t end = 0;
  for (std::size_t o = 0; o < model.organs.size(); ++o) {
    const OrganRange& organ = model.organs[o];
    if (organ.first < end) continue;  // told by check_organs()
    std::int64_t volume = 1;
    for (const auto* coordinate : {&model.cell.i, &model.cell.j, &model.cell.k}) {
      if (organ.first < 0 || organ.count <= 0 || std::int64_t{organ.first} + organ.count > std::ssize(*coordinate))
        continue;  // reported by check_organs() and the field check
      const auto begin = coordinate->begin() + organ.first;
      const auto [low, high] = std::minmax_element(begin, begin + organ.count);
      volume = std::min(volume * (std::int64_t{*high} - *low + 1), 2 * most);
    }
    end = organ.first + std::max(organ.count, 0);
    all = std::min(all + volume, 2 * most);
    check.require(all <= most, "organs" + place(o), "spans more lattice cells than organs can have together");
  }
}

/// The arrays of cut resistance must all exist or all be empty.
void check_cut_resistance(Checker& check, const Model& model) {
  const CutResistance& cut = model.cut_resistance;
  if (!cut.any()) return;
  check.length("cut_resistance.energy", cut.energy.size(), model.axial.size());
  check.length("cut_resistance.friction", cut.friction.size(), model.axial.size());
}

/// The corner tetrahedra of a tissue cell must have positive volumes at rest, by which they are divided.
void check_tissue_cells(Checker& check, const Model& model) {
  const TissueCells& cells = model.tissue_cells;
  const auto is_sphere = [&](std::int32_t sphere) {
    return sphere >= 0 && std::size_t(sphere) < std::min({model.rest_position.x.size(), model.rest_position.y.size(),
                                                          model.rest_position.z.size()});
  };
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    for (const auto& corner : cells.corner)
      if (cell >= corner.size() || !is_sphere(corner[cell])) return;  // reported by the field check
    for (std::size_t c = 0; c < 8; ++c) {
      const auto edge = [&](std::size_t axis) {
        const std::size_t bit = std::size_t{1} << axis;
        return model.rest_position[std::size_t(cells.corner[c | bit][cell])] -
               model.rest_position[std::size_t(cells.corner[c & ~bit][cell])];
      };
      if (dot(edge(0), cross(edge(1), edge(2))) > 0) continue;
      return check.require(false, "tissue_cells" + place(cell), "is inside out or flat at rest");
    }
  }
}

void check_obstacle_mesh(Checker& check, const std::string& name, const Obstacle& obstacle) {
  const std::size_t vertices = obstacle.vertex.x.size();
  if (!check.length(name + "vertex.y", obstacle.vertex.y.size(), vertices) ||
      !check.length(name + "vertex.z", obstacle.vertex.z.size(), vertices))
    return;
  const bool is_mesh = obstacle.kind == ObstacleKind::mesh;
  check.require(obstacle.corner.size() % 3 == 0 && obstacle.corner.empty() != is_mesh, name + "corner",
                is_mesh ? "must have three entries for each triangle of a mesh" : "must be empty but of a mesh");
  check.indices(name + "corner", obstacle.corner, 0, static_cast<std::int64_t>(vertices));
}

void check_obstacles(Checker& check, const Model& model) {
  for (std::size_t i = 0; i < model.obstacles.size(); ++i) {
    const Obstacle& obstacle = model.obstacles[i];
    const Quat q = obstacle.world_from_obstacle;
    const double length = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    check.require(std::abs(length - 1) < 1e-6, "obstacles" + place(i) + ".world_from_obstacle", "has no unit length");
    const Vec3 half = obstacle.half_size;
    check.require(obstacle.kind != ObstacleKind::box || (half.x > 0 && half.y > 0 && half.z > 0),
                  "obstacles" + place(i) + ".half_size", "must be above 0 of a box");
    check_obstacle_mesh(check, "obstacles" + place(i) + ".", obstacle);
  }
}

void check_organs(Checker& check, const Model& model) {
  const auto spheres = static_cast<std::int64_t>(model.sphere_count());
  std::int32_t end = 0;
  for (std::size_t i = 0; i < model.organs.size(); ++i) {
    const OrganRange& organ = model.organs[i];
    const bool is_range = organ.first >= 0 && organ.count >= 0 && std::int64_t{organ.first} + organ.count <= spheres;
    check.require(is_range, "organs" + place(i), "is not a range of spheres");
    check.require(!is_range || organ.first >= end, "organs" + place(i), "overlaps the organ before it");
    if (is_range) end = organ.first + organ.count;
  }
}

/// Grids over an organ or a surface have bounded sizes.
void check_extents(Checker& check, const Model& model) {
  for (std::size_t i = 0; i < model.organs.size(); ++i) {
    const std::string problem = problem_of_lattice(model, model.organs[i]);
    check.require(problem.empty(), "organs" + place(i), problem);
  }
  const std::string problem = problem_of_rest(model);
  check.require(problem.empty(), "rest_position", problem);
}

/// The coordinates of an optional array must all exist or all be empty.
void check_together(Checker& check, const std::string& name, const Vec3Array& points) {
  check.require(points.x.size() == points.y.size() && points.x.size() == points.z.size(), name,
                "has coordinates of different lengths");
}

}  // namespace

Errors check_model(const Model& model) {
  Checker check("model");
  if (Errors errors = check_sizes(model); !errors.empty()) return errors;
  for_each_field(model, FieldCheck(check, model));
  check_organs(check, model);
  check_cells(check, model);
  check_axial(check, model);
  check_cut_resistance(check, model);
  check_tissue_cells(check, model);
  check_obstacles(check, model);
  for (std::size_t i = 0; i < model.tools.size(); ++i)
    check.require(model.tools[i].kind != ToolKind::pin || model.tools[i].sphere >= 0, "tools" + place(i),
                  "is a pin that holds no sphere");
  if (Errors errors = check.take(); !errors.empty()) return errors;
  check_extents(check, model);
  return check.take();
}

/// The front of the cut and the swept surface. Before physics revision 4 a blade had two towed points instead.
void check_edge(Checker& check, const Model& model, const State& state) {
  constexpr std::size_t kEarlierTrail = 2;
  const std::size_t nodes = state.edge_organ.empty() ? kEarlierTrail : kEdgeNodes;
  check.length("edge_organ", state.edge_organ.size(), state.edge_organ.empty() ? 0 : kEdgeNodes);
  if (!state.blade_trail.x.empty()) check.length("blade_trail", state.blade_trail.x.size(), nodes);
  const auto organs = std::int64_t(model.organs.size());
  for (const std::int32_t organ : state.edge_organ)
    if (organ < -1 || organ >= organs) {
      check.require(false, "edge_organ", "names an organ that does not exist");
      break;
    }
  check_together(check, "swept", state.swept);
  check.length("swept_organ", state.swept_organ.size(), state.swept.x.size());
  check.require(state.swept.x.size() % kEdgeNodes == 0, "swept", "must hold whole rows");
  for (const std::uint8_t organ : state.swept_organ)
    if (organ > organs) {
      check.require(false, "swept_organ", "names an organ that does not exist");
      return;
    }
  const Vec3Array& swept = state.swept;
  if (swept.y.size() != swept.x.size() || swept.z.size() != swept.x.size() ||
      state.swept_organ.size() != swept.x.size())
    return;
  const std::string problem = problem_of_swept(state);
  check.require(problem.empty(), "swept", problem);
  const auto rows = std::int64_t(swept.x.size() / kEdgeNodes);
  for (const auto& [name, cuts] : {std::pair{"open_cuts", &state.open_cuts}, {"opening_cuts", &state.opening_cuts}}) {
    check.require(cuts->rows <= rows, name, "has more rows than the swept surface");
    check.require(cuts->rows > 0 || cuts->axial_severed.empty(), name, "knows severed elements of no cut");
  }
  check.require((state.opening_cuts_at > 0) == (state.opening_cuts.rows > 0), "opening_cuts.at",
                "must be set exactly where rows open");
  check.require(state.opening_cuts_at <= state.tick + contact::ticks_until_open(model), "opening_cuts.at",
                "is later than a cut opens");
  check.require(state.opening_cuts_at == 0 || state.opening_cuts.rows >= state.open_cuts.rows, "opening_cuts",
                "has fewer rows than are open");
}

Errors check_state(const Model& model, const State& state) {
  Checker check("state");
  for_each_field(state, FieldCheck(check, model));
  check_together(check, "blade_trail", state.blade_trail);
  check_edge(check, model, state);
  check_together(check, "acceleration", state.acceleration);
  check.length("grip", state.grip.size(), state.touched.size());
  check_together(check, "grip", state.grip);
  check.length("kelvin_dent", state.kelvin_dent.size(), state.touched.size());
  check.require(std::is_sorted(state.touched.begin(), state.touched.end()), "touched", "must ascend");

  check.require(model.hands > 1 || state.last_inputs.second == Hand{}, "last_inputs.second",
                "must be empty in a scene with one hand");
  const std::size_t most_parts = model.solver.sleep_bound > 0 ? std::max<std::size_t>(model.organs.size(), 1) : 0;
  check.require(state.still_ticks.size() <= most_parts, "still_ticks",
                "must have no more entries than there are organs that may sleep");
  // The arrays of severed elements exist where a tool can cut. Older sessions do not store crossings.
  const bool cuts = model.has_scalpel();
  check.length("axial_severed", state.axial_severed.size(), cuts ? model.axial.size() : 0);
  check.length("constraint_severed", state.constraint_severed.size(), cuts ? model.constraints.size() : 0);
  check.length("angle_severed", state.angle_severed.size(), cuts ? model.angle_springs.size() : 0);
  check.require(cuts || state.axial_crossing.empty(), "axial_crossing", "must be empty where nothing is cut");
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
      if (!is_finite(vertex) || norm(vertex) > kFarthestVertex) {
        check.require(false, name + "vertex", "is not finite, or farther than 1 km");
        break;
      }
    std::vector<std::int32_t> corners;
    for (const auto& triangle : surface.triangle) corners.insert(corners.end(), triangle.begin(), triangle.end());
    check.indices(name + "triangle", corners, 0, vertices);

    const SurfaceBinding& binding = surface.binding;
    const auto entries = static_cast<std::int64_t>(binding.sphere.size());
    check.indices(name + "binding.sphere", binding.sphere, 0, model.organs[i].count);
    check.length(name + "binding.weight", binding.weight.size(), binding.sphere.size());
    check.require(std::all_of(binding.weight.begin(), binding.weight.end(),
                              [](double w) { return std::abs(w) <= kLargestWeight; }),
                  name + "binding.weight", "must be in [-1000, 1000]");
    const std::string problem = problem_of_surface(model, model.organs[i], surface);
    check.require(problem.empty(), name + "vertex", problem);
    if (surface.vertex.empty() && binding.first.empty()) continue;
    if (check.length(name + "binding.first", binding.first.size(), surface.vertex.size() + 1)) {
      check.indices(name + "binding.first", binding.first, 0, entries + 1);
      check.require(binding.first.front() == 0 && binding.first.back() == entries &&
                        std::is_sorted(binding.first.begin(), binding.first.end()),
                    name + "binding.first", "does not divide the entries among the vertices");
    }
  }
  return check.take();
}

}  // namespace ctpm::recordings::session_file
