#include "core/elements/parts.h"

#include <algorithm>

namespace ctpm::elements {
namespace {

/// Bounds between ranges of spheres, of which elements take away those that they reach across.
class Bounds {
 public:
  explicit Bounds(const Model& model) : is_bound_(model.sphere_count() + 1) {
    is_bound_.front() = is_bound_.back() = 1;
    for (const OrganRange& organ : model.organs)
      for (const std::int32_t at : {organ.first, organ.first + organ.count})
        if (at > 0 && std::size_t(at) < model.sphere_count()) is_bound_[std::size_t(at)] = 1;
    from_.resize(model.sphere_count() + 1);
    for (std::size_t i = 0; i < from_.size(); ++i) from_[i] = i;
  }

  /// Joins all spheres from one to the other.
  void join(std::int32_t one, std::int32_t other) {
    const auto [low, high] = std::minmax(one, other);
    from_[std::size_t(high)] = std::min(from_[std::size_t(high)], std::size_t(low));
  }

  std::vector<parallel::SphereRange> ranges() {
    // A bound stays where no sphere from it on is joined to one before it.
    std::size_t earliest = from_.size();
    for (std::size_t i = from_.size() - 1; i-- > 1;) {
      earliest = std::min(earliest, from_[i]);
      if (earliest < i) is_bound_[i] = 0;
    }
    std::vector<parallel::SphereRange> ranges;
    if (is_bound_.size() == 1) return {{0, 0}};
    for (std::size_t i = 1, begin = 0; i < is_bound_.size(); ++i) {
      if (is_bound_[i] == 0) continue;
      ranges.push_back({std::int32_t(begin), std::int32_t(i)});
      begin = i;
    }
    return ranges;
  }

 private:
  std::vector<std::uint8_t> is_bound_;  ///< 1: a range begins at this sphere                         (sphere_count + 1)
  std::vector<std::size_t> from_;  ///< the first sphere that each is joined to, or itself        (sphere_count + 1)
};

}  // namespace

std::vector<parallel::SphereRange> parts_of(const Model& model) {
  Bounds bounds(model);
  const AxialElements& axial = model.axial;
  for (std::size_t i = 0; i < axial.size(); ++i) {
    bounds.join(axial.a[i], axial.b[i]);
    if (!axial.third.empty() && axial.third[i] >= 0) bounds.join(axial.a[i], axial.third[i]);
  }
  const Constraints& lines = model.constraints;
  for (std::size_t i = 0; i < lines.size(); ++i)
    bounds.join(lines.a[i], lines.c[i]), bounds.join(lines.c[i], lines.e[i]);
  const AngleSprings& angles = model.angle_springs;
  for (std::size_t i = 0; i < angles.size(); ++i)
    bounds.join(angles.a[i], angles.b[i]), bounds.join(angles.b[i], angles.c[i]);
  for (const auto& corner : model.tissue_cells.corner)
    for (std::size_t cell = 0; cell < corner.size(); ++cell)
      bounds.join(model.tissue_cells.corner[0][cell], corner[cell]);
  return bounds.ranges();
}

}  // namespace ctpm::elements
