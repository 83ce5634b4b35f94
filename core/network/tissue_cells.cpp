#include "core/network/tissue_cells.h"

#include <array>
#include <map>
#include <optional>

namespace ctpm::network {
namespace {

using Corners = std::array<std::int32_t, 8>;

}  // namespace

double filled_share(const FilledOrgan& organ, std::size_t lowest) {
  return organ.shares.empty() ? 1 : organ.shares.cell[lowest];
}

void add_tissue_cells(Model& model, const FilledOrgan& organ, std::int32_t first_sphere, double inversion_resistance,
                      std::span<const double> edge_k) {
  std::map<LatticeCell, std::int32_t> sphere_at;
  for (std::size_t i = 0; i < organ.cell.size(); ++i) sphere_at.emplace(organ.cell[i], std::int32_t(i));
  const auto corners_above = [&](LatticeCell lowest) -> std::optional<Corners> {
    Corners corners;
    for (std::size_t c = 0; c < 8; ++c) {
      const auto sphere =
          sphere_at.find({lowest[0] + int(c & 1), lowest[1] + int(c >> 1 & 1), lowest[2] + int(c >> 2)});
      if (sphere == sphere_at.end()) return std::nullopt;
      corners[c] = sphere->second;
    }
    return corners;
  };
  const double s = organ.spacing, eighth = s * s * s / 8;
  for (std::size_t i = 0; i < organ.cell.size(); ++i) {
    const double share = filled_share(organ, i);
    const std::optional<Corners> corners = corners_above(organ.cell[i]);
    if (!corners || share == 0) continue;
    double k = 0;
    for (std::size_t c = 0; c < 8; ++c) {
      model.tissue_cells.corner[c].push_back(first_sphere + (*corners)[c]);
      k += edge_k[std::size_t((*corners)[c])] / 8;
    }
    const double kappa = inversion_resistance * kYoungOverEdge * k / s;
    model.tissue_cells.k.push_back(kappa * share * eighth);
  }
}

}  // namespace ctpm::network
