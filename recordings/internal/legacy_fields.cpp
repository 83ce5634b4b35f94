#include "recordings/internal/legacy_fields.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "recordings/internal/field_codec.h"

namespace ctpm::recordings::session_file {
namespace {

/// Bound on cell coordinates of malformed lattices: more than any organ has, less than the range of i32.
constexpr double kFarthestCell = 1 << 20;

/// One of the two earlier tables of axial elements.
struct EarlierElements {
  std::vector<std::int32_t> a, b, third;
  std::vector<double> rest_length, k, c, kelvin_k, energy, friction;
};

/// Springs and Kelvin units.
void read_edges(FieldReader& reader, EarlierElements& edges) {
  reader("edges.a", edges.a), reader("edges.b", edges.b), reader("edges.third", edges.third);
  reader("edges.rest_length", edges.rest_length), reader("edges.k", edges.k), reader("edges.c", edges.c);
  reader("cut_resistance.edge_energy", edges.energy), reader("cut_resistance.edge_friction", edges.friction);
}

/// Two-sphere TPMs.
void read_tpms(FieldReader& reader, EarlierElements& tpms) {
  reader("tpms.a", tpms.a), reader("tpms.b", tpms.b);
  reader("tpms.rest_length", tpms.rest_length), reader("tpms.spring_k", tpms.k);
  reader("tpms.kelvin_k", tpms.kelvin_k), reader("tpms.kelvin_c", tpms.c);
  reader("cut_resistance.tpm_energy", tpms.energy), reader("cut_resistance.tpm_friction", tpms.friction);
}

/// Whether the arrays of a table have matching lengths. A mismatch would shift the rows behind it when the tables are
/// joined.
template <class T>
bool fits(const std::vector<T>& values, std::size_t expected, const char* name, std::string& problem) {
  if (values.size() == expected || !problem.empty()) return problem.empty();
  problem = "field " + std::string(name) + " has " + std::to_string(values.size()) + " entries, expected " +
            std::to_string(expected);
  return false;
}

bool tables_fit(const EarlierElements& edges, const EarlierElements& tpms, bool has_softening, std::string& problem) {
  const std::size_t edge_count = edges.a.size(), tpm_count = tpms.a.size();
  const bool resists = !edges.energy.empty() || !tpms.energy.empty();
  return fits(edges.b, edge_count, "edges.b", problem) &&
         fits(edges.rest_length, edge_count, "edges.rest_length", problem) &&
         fits(edges.k, edge_count, "edges.k", problem) &&
         fits(edges.c, edges.c.empty() ? 0 : edge_count, "edges.c", problem) &&
         fits(edges.third, edges.third.empty() && !has_softening ? 0 : edge_count, "edges.third", problem) &&
         fits(tpms.b, tpm_count, "tpms.b", problem) && fits(tpms.rest_length, tpm_count, "tpms.rest_length", problem) &&
         fits(tpms.k, tpm_count, "tpms.spring_k", problem) &&
         fits(tpms.kelvin_k, tpm_count, "tpms.kelvin_k", problem) &&
         fits(tpms.c, tpm_count, "tpms.kelvin_c", problem) &&
         fits(edges.energy, resists ? edge_count : 0, "cut_resistance.edge_energy", problem) &&
         fits(edges.friction, resists ? edge_count : 0, "cut_resistance.edge_friction", problem) &&
         fits(tpms.energy, resists ? tpm_count : 0, "cut_resistance.tpm_energy", problem) &&
         fits(tpms.friction, resists ? tpm_count : 0, "cut_resistance.tpm_friction", problem);
}

template <class T>
std::vector<T> joined(std::vector<T> first, const std::vector<T>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Joins the two tables, edges first.
void join_tables(EarlierElements& edges, const EarlierElements& tpms, Model& model) {
  const std::size_t edge_count = edges.a.size(), tpm_count = tpms.a.size();
  AxialElements& axial = model.axial;
  edges.c.resize(edge_count, 0.0);
  for (const double c : edges.c) axial.law.push_back(c != 0 ? AxialLaw::kelvin_unit : AxialLaw::spring);
  axial.law.resize(edge_count + tpm_count, AxialLaw::two_sphere_tpm);
  axial.a = joined(edges.a, tpms.a), axial.b = joined(edges.b, tpms.b);
  axial.rest_length = joined(edges.rest_length, tpms.rest_length);
  axial.k = joined(edges.k, tpms.k), axial.c = joined(edges.c, tpms.c);
  if (std::all_of(axial.c.begin(), axial.c.end(), [](double c) { return c == 0; })) axial.c = {};
  if (tpm_count > 0) {
    axial.kelvin_k = joined(std::vector<double>(edge_count), tpms.kelvin_k);
    axial.internal.assign(edge_count, -1);
    for (std::size_t i = 0; i < tpm_count; ++i) axial.internal.push_back(std::int32_t(i));
  }
  if (!edges.third.empty() || model.has_softening)
    axial.third = joined(edges.third, std::vector<std::int32_t>(tpm_count, -1));
  model.cut_resistance = {joined(edges.energy, tpms.energy), joined(edges.friction, tpms.friction)};
}

/// The lattice axes of an organ, each one cell long [m]: the first element whose length is the spacing, the first such
/// element perpendicular to it, and their cross product. A scene can rotate an organ.
struct LatticeAxes {
  Vec3 along[3];

  LatticeAxes(const Model& model, const OrganRange& organ) {
    const AxialElements& axial = model.axial;
    const double spacing = organ.spacing;
    int found = 0;
    for (std::size_t i = 0; i < std::min(axial.a.size(), axial.b.size()) && found < 2; ++i) {
      if (!holds(organ, axial.a[i]) || !holds(organ, axial.b[i])) continue;
      const Vec3 d = model.rest_position[std::size_t(axial.b[i])] - model.rest_position[std::size_t(axial.a[i])];
      if (!(std::abs(norm(d) - spacing) <= 0.05 * spacing)) continue;
      if (found == 1 && std::abs(dot(d, along[0])) > 0.1 * spacing * spacing) continue;
      along[found++] = spacing / norm(d) * d;
    }
    if (found == 0) along[0] = {spacing, 0, 0};
    if (found < 2) {
      const Vec3 beside = std::abs(along[0].x) < 0.9 * spacing ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
      const Vec3 across = cross(along[0], beside);
      along[1] = spacing / norm(across) * across;
    }
    along[2] = cross(along[0], along[1]) / spacing;
  }

  static bool holds(const OrganRange& organ, std::int32_t sphere) {
    return sphere >= organ.first && std::int64_t{sphere} < std::int64_t{organ.first} + organ.count;
  }
};

std::int32_t rounded(double cells) {
  return std::isfinite(cells) ? std::int32_t(std::lround(std::clamp(cells, -kFarthestCell, kFarthestCell))) : 0;
}

/// Assigns every sphere its cell. check_model() reports malformed positions or organs.
void find_cells(Model& model) {
  const std::size_t count = model.sphere_count();
  const Vec3Array& rest = model.rest_position;
  if (rest.x.size() != count || rest.y.size() != count || rest.z.size() != count) return;
  for (auto* coordinates : {&model.cell.i, &model.cell.j, &model.cell.k}) coordinates->assign(count, 0);
  std::int32_t end = 0;
  for (const OrganRange& organ : model.organs) {
    if (organ.count == 0) continue;
    if (organ.first < end) return;  // overlaps the organ before it
    const bool is_range = organ.first >= 0 && organ.count > 0 && std::size_t(organ.first) < count &&
                          std::size_t(organ.count) <= count - std::size_t(organ.first);
    if (!is_range) return;
    end = organ.first + organ.count;
    if (!(organ.spacing > 0)) continue;
    const LatticeAxes axes(model, organ);
    const double per_cell = 1 / (organ.spacing * organ.spacing);
    const Vec3 origin = rest[std::size_t(organ.first)];
    for (std::int32_t i = organ.first; i < organ.first + organ.count; ++i) {
      const Vec3 d = rest[std::size_t(i)] - origin;
      const auto along = [&](int axis) { return rounded(dot(d, axes.along[axis]) * per_cell); };
      const auto sphere = std::size_t(i);
      model.cell.i[sphere] = along(0), model.cell.j[sphere] = along(1), model.cell.k[sphere] = along(2);
    }
  }
}

/// Joins two arrays of a State, of edges and of two-sphere TPMs. Both or neither must exist.
void join_states(const std::vector<std::uint8_t>& of_edges, const std::vector<std::uint8_t>& of_tpms,
                 std::size_t tpm_count, const char* tpm_name, std::vector<std::uint8_t>& all, std::string& problem) {
  if (!of_edges.empty() || !of_tpms.empty()) fits(of_tpms, tpm_count, tpm_name, problem);
  all = joined(of_edges, of_tpms);
}

constexpr const char* kBoth = "fields of two versions stand beside each other: edges and axial elements";

}  // namespace

void get_model(ByteReader& in, Model& model, std::string& problem) {
  EarlierElements edges, tpms;
  bool is_earlier = false, has_cells = true;
  take_field_set(in, problem, [&](FieldSet& set, FieldReader& reader) {
    is_earlier = set.find("edges.a") != nullptr, has_cells = set.find("cell.i") != nullptr;
    if (is_earlier && set.find("axial.a") != nullptr) problem = kBoth;
    if (is_earlier) read_edges(reader, edges), read_tpms(reader, tpms);
    // Retired with physics revision 3, where a grip takes the place of a sticking drag.
    double stick_time = 0;
    if (set.find("contact_stick_time") != nullptr) reader("contact_stick_time", stick_time);
    for_each_field(model, reader);
  });
  if (!problem.empty()) return;
  if (is_earlier && !tables_fit(edges, tpms, model.has_softening, problem)) return;
  if (is_earlier) join_tables(edges, tpms, model);
  if (!has_cells) find_cells(model);
}

void get_state(ByteReader& in, State& state, std::string& problem) {
  std::vector<std::uint8_t> edge_severed, tpm_severed, edge_crossing, tpm_crossing;
  bool is_earlier = false;
  take_field_set(in, problem, [&](FieldSet& set, FieldReader& reader) {
    is_earlier = set.find("edge_severed") != nullptr;
    if (is_earlier && set.find("axial_severed") != nullptr) problem = kBoth;
    if (is_earlier) {
      reader("edge_severed", edge_severed), reader("tpm_severed", tpm_severed);
      reader("edge_crossing", edge_crossing), reader("tpm_crossing", tpm_crossing);
    }
    for_each_field(state, reader);
  });
  if (!problem.empty() || !is_earlier) return;
  const std::size_t tpm_count = state.kelvin_elongation.size();
  join_states(edge_severed, tpm_severed, tpm_count, "tpm_severed", state.axial_severed, problem);
  join_states(edge_crossing, tpm_crossing, tpm_count, "tpm_crossing", state.axial_crossing, problem);
}

}  // namespace ctpm::recordings::session_file
