#pragma once

#include <string_view>
#include <vector>

#include "recordings/internal/field_codec.h"

namespace ctpm::testing {

/// The first `count` values of an array, or those after them; empty for an empty array.
template <class T>
std::vector<T> head(const std::vector<T>& all, std::size_t count) {
  return {all.begin(), all.begin() + std::ptrdiff_t(std::min(count, all.size()))};
}
template <class T>
std::vector<T> tail(const std::vector<T>& all, std::size_t count) {
  return {all.begin() + std::ptrdiff_t(std::min(count, all.size())), all.end()};
}

/// Writes all fields of `model` except the axial elements, their cut resistance and the lattice cells.
inline void put_common_fields(recordings::session_file::FieldWriter& out, const Model& model) {
  for_each_field(model, [&](std::string_view name, const auto& value) {
    if (!name.starts_with("axial.") && !name.starts_with("cell.") && name != "cut_resistance.energy" &&
        name != "cut_resistance.friction")
      out(name, value);
  });
}

/// Writes a Model in the earlier format: two tables of axial elements and no lattice cells.
inline recordings::session_file::Bytes earlier_bytes(const Model& model) {
  const AxialElements& axial = model.axial;
  std::size_t edges = 0;
  while (edges < axial.size() && axial.law[edges] != AxialLaw::two_sphere_tpm) ++edges;
  recordings::session_file::Bytes bytes;
  recordings::session_file::put_field_set(bytes, [&](recordings::session_file::FieldWriter& out) {
    put_common_fields(out, model);
    out("edges.a", head(axial.a, edges)), out("edges.b", head(axial.b, edges));
    out("edges.rest_length", head(axial.rest_length, edges));
    out("edges.k", head(axial.k, edges)), out("edges.c", head(axial.c, edges));
    out("edges.third", head(axial.third, edges));
    out("tpms.a", tail(axial.a, edges)), out("tpms.b", tail(axial.b, edges));
    out("tpms.rest_length", tail(axial.rest_length, edges));
    out("tpms.spring_k", tail(axial.k, edges)), out("tpms.kelvin_k", tail(axial.kelvin_k, edges));
    const std::vector<double> no_damping(axial.size() - edges);
    out("tpms.kelvin_c", axial.c.empty() ? no_damping : tail(axial.c, edges));
    const CutResistance& cut = model.cut_resistance;
    out("cut_resistance.edge_energy", head(cut.energy, edges));
    out("cut_resistance.tpm_energy", tail(cut.energy, edges));
    out("cut_resistance.edge_friction", head(cut.friction, edges));
    out("cut_resistance.tpm_friction", tail(cut.friction, edges));
  });
  return bytes;
}

/// Writes a State of a Model with `edges` springs and Kelvin units in the earlier format.
inline recordings::session_file::Bytes earlier_bytes(const State& state, std::size_t edges) {
  recordings::session_file::Bytes bytes;
  recordings::session_file::put_field_set(bytes, [&](recordings::session_file::FieldWriter& out) {
    for_each_field(state, [&](std::string_view name, const auto& value) {
      if (!name.starts_with("axial_")) out(name, value);
    });
    out("edge_severed", head(state.axial_severed, edges)), out("tpm_severed", tail(state.axial_severed, edges));
    out("edge_crossing", head(state.axial_crossing, edges)), out("tpm_crossing", tail(state.axial_crossing, edges));
  });
  return bytes;
}

}  // namespace ctpm::testing
