#include "core/network/axial_rows.h"

#include <algorithm>

namespace ctpm::network {
namespace {

/// Calls `change` for every array of the table.
template <class Change>
void for_each_array(Model& model, Change&& change) {
  AxialElements& axial = model.axial;
  change(axial.a), change(axial.b), change(axial.law), change(axial.rest_length), change(axial.k), change(axial.c);
  change(axial.kelvin_k), change(axial.internal), change(axial.third);
  change(model.cut_resistance.energy), change(model.cut_resistance.friction);
}

}  // namespace

void append(Model& model, const AxialRow& row) {
  AxialElements& axial = model.axial;
  const bool is_tpm = row.law == AxialLaw::two_sphere_tpm;
  axial.internal.push_back(is_tpm ? std::int32_t(axial.internal_count()) : -1);
  axial.a.push_back(row.a), axial.b.push_back(row.b), axial.law.push_back(row.law);
  axial.rest_length.push_back(row.rest_length), axial.k.push_back(row.k), axial.c.push_back(row.c);
  axial.kelvin_k.push_back(row.kelvin_k), axial.third.push_back(row.third);
  model.cut_resistance.energy.push_back(row.cut_energy), model.cut_resistance.friction.push_back(row.cut_friction);
}

std::vector<AxialRow> take_tpms(Model& model) {
  const AxialElements& axial = model.axial;
  const CutResistance& cut = model.cut_resistance;
  const std::size_t first = axial.size() - axial.internal_count();
  std::vector<AxialRow> rows;
  for (std::size_t i = first; i < axial.size(); ++i)
    rows.push_back({axial.a[i], axial.b[i], axial.law[i], axial.rest_length[i], axial.k[i], axial.c[i],
                    axial.kelvin_k[i], axial.third[i], cut.energy[i], cut.friction[i]});
  for_each_array(model, [&](auto& array) { array.resize(first); });
  return rows;
}

void bring_back_unused(Model& model) {
  AxialElements& axial = model.axial;
  const std::size_t count = axial.size();
  axial.c.resize(count, 0.0), axial.kelvin_k.resize(count, 0.0);
  axial.internal.resize(count, -1), axial.third.resize(count, -1);
  model.cut_resistance.energy.resize(count, 0.0), model.cut_resistance.friction.resize(count, 0.0);
}

void leave_out_unused(Model& model) {
  AxialElements& axial = model.axial;
  const auto is_zero = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return v == 0; });
  };
  if (is_zero(axial.c)) axial.c = {};
  if (axial.internal_count() == 0) axial.kelvin_k = {}, axial.internal = {};
  if (!model.has_softening) axial.third = {};
  CutResistance& cut = model.cut_resistance;
  if (is_zero(cut.energy) && is_zero(cut.friction)) cut = {};
}

}  // namespace ctpm::network
