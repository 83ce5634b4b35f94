#include "core/elements/lines.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace ctpm::elements {
namespace {

/// Shorter rows are merged with their neighbours into a gathered batch.
constexpr std::size_t kShortestRow = 4;

/// Numbers in the widest vector.
constexpr std::size_t kWidest = 8;

/// Finds rows of lines whose spheres are in the same slabs.
class RowFinder {
 public:
  RowFinder(const std::vector<std::int32_t>& first, const std::vector<std::int32_t>& middle,
            const std::vector<std::int32_t>& last, const parallel::Slabs& slabs)
      : first_(first), middle_(middle), last_(last), slabs_(slabs) {}

  /// End of the batch from line `i` on: one row, or several that are too short.
  std::size_t batch_end(std::size_t i) const {
    std::size_t end = row_end(i);
    while (!is_row(i) && end < middle_.size() && slabs_of(end) == slabs_of(i) && end - i < std::size_t(kBatch)) {
      if (is_row(end)) break;
      end = row_end(end);
    }
    return std::min(end, i + std::size_t(kBatch));
  }

  /// Places of the batch of lines [i, end). A row is padded to whole vectors, if there is room.
  std::size_t places_of(std::size_t i, std::size_t end) const {
    const std::size_t count = end - i, whole_vectors = (count + kWidest - 1) / kWidest * kWidest;
    return is_row(i) ? std::min(whole_vectors, room_of(i)) : count;
  }

  bool is_row(std::size_t i) const { return row_end(i) - i >= kShortestRow; }

 private:
  std::array<int, 3> slabs_of(std::size_t i) const {
    return {slabs_.of(first_[i]), slabs_.of(middle_[i]), slabs_.of(last_[i])};
  }

  bool advance_by_one(std::size_t i) const {
    return first_[i] == first_[i - 1] + 1 && middle_[i] == middle_[i - 1] + 1 && last_[i] == last_[i - 1] + 1;
  }

  /// Capacity in places of a row from line `i` on: none of its spheres may be in another slab or in the range of
  /// another of the three spheres.
  std::size_t room_of(std::size_t i) const {
    const std::int32_t a = first_[i], c = middle_[i], e = last_[i];
    const auto left = [&](std::int32_t sphere) { return slabs_.end(slabs_.of(sphere)) - sphere; };
    return std::size_t(
        std::min({kBatch, std::abs(c - a), std::abs(e - c), std::abs(e - a), left(a), left(c), left(e)}));
  }

  /// End of the row of lines from line `i` on: all three spheres advance by one.
  std::size_t row_end(std::size_t i) const {
    const std::size_t last = std::min(middle_.size(), i + room_of(i));
    std::size_t end = i + 1;
    while (end < last && advance_by_one(end)) ++end;
    return end;
  }

  const std::vector<std::int32_t>&first_, &middle_, &last_;
  const parallel::Slabs& slabs_;
};

}  // namespace

LineElements::LineElements(const Model& model, const Constraints& lines, const parallel::Slabs& slabs,
                           const Kernels& kernels)
    : LineElements(model, true, lines.a, lines.c, lines.e, lines.k, slabs, kernels) {}

LineElements::LineElements(const Model& model, const AngleSprings& springs, const parallel::Slabs& slabs,
                           const Kernels& kernels)
    : LineElements(model, false, springs.a, springs.b, springs.c, springs.k, slabs, kernels) {}

LineElements::LineElements(const Model& model, bool is_constraint, const std::vector<std::int32_t>& first,
                           const std::vector<std::int32_t>& middle, const std::vector<std::int32_t>& last,
                           const std::vector<double>& k, const parallel::Slabs& slabs, const Kernels& kernels)
    : model_(model), kernels_(kernels), is_constraint_(is_constraint) {
  const RowFinder rows(first, middle, last, slabs);
  std::vector<std::pair<std::size_t, std::size_t>> runs;  // lines of each batch
  for (std::size_t i = 0; i < middle.size(); i = runs.back().second) runs.emplace_back(i, rows.batch_end(i));
  // Sorts lines of all directions together, so that positions and forces stay in the first-level cache.
  std::stable_sort(runs.begin(), runs.end(),
                   [&](const auto& p, const auto& q) { return middle[p.first] < middle[q.first]; });
  std::vector<LineBatch> all;
  for (const auto& [i, end] : runs) {
    const std::size_t places = rows.places_of(i, end);
    all.push_back({std::int32_t(end - i), std::int32_t(places), std::int32_t(k_.size()), rows.is_row(i) ? first[i] : -1,
                   middle[i], last[i], false, false, false});
    for (std::size_t line = i; line < i + places; ++line) {
      const std::size_t known = std::min(line, end - 1);
      const auto beyond = std::int32_t(line - known);
      first_.push_back(first[known] + beyond), middle_.push_back(middle[known] + beyond);
      last_.push_back(last[known] + beyond);
      line_.push_back(std::int32_t(known)), k_.push_back(beyond == 0 ? k[line] : 0.0);
    }
  }
  for (int slab = 0; slab < slabs.count(); ++slab) {
    const std::size_t first_batch = batches_.size();
    for (LineBatch batch : all) {
      const auto place = std::size_t(batch.place);
      batch.adds_a = slabs.of(first_[place]) == slab, batch.adds_c = slabs.of(middle_[place]) == slab;
      batch.adds_e = slabs.of(last_[place]) == slab;
      if (batch.adds_a || batch.adds_c || batch.adds_e) batches_.push_back(batch);
    }
    of_slab_.push_back({first_batch, batches_.size()});
  }
  weight_.resize(batches_.size());
  lambda_.resize(k_.size());
}

LineArrays LineElements::arrays(const StateView& state, double* softness) {
  const std::vector<std::uint8_t>& severed = is_constraint_ ? state.constraint_severed : state.angle_severed;
  LineArrays m{};
  m.spheres = state.position.size();
  m.x = state.position.x.data(), m.y = state.position.y.data(), m.z = state.position.z.data();
  m.a = first_.data(), m.c = middle_.data(), m.e = last_.data(), m.k = k_.data(), m.line = line_.data();
  m.severed = severed.empty() ? nullptr : severed.data();
  m.is_constraint = is_constraint_;
  m.softness = is_constraint_ ? softness : nullptr;
  m.mass = model_.mass.data();
  m.lambda = lambda_.data();
  return m;
}

void LineElements::measure(const LineArrays& m, int slab) const {
  const Range range = of_slab_[std::size_t(slab)];
  for (std::size_t i = range.first; i < range.last; ++i)
    if (batches_[i].adds_c) kernels_.measure_line(m, batches_[i]);
}

void LineElements::add_forces(const LineArrays& m, int slab) const {
  const Range range = of_slab_[std::size_t(slab)];
  for (std::size_t i = range.first; i < range.last; ++i) kernels_.add_line_forces(m, batches_[i]);
}

void LineElements::prepare_linearise() {
  if (isotropic_.size() == k_.size()) return;
  for (auto* array : {&along_[0], &along_[1], &along_[2], &isotropic_}) array->assign(k_.size(), 0.0f);
}

void LineElements::linearise(LineArrays m, int slab) {
  m.along_x = along_[0].data(), m.along_y = along_[1].data(), m.along_z = along_[2].data(),
  m.isotropic = isotropic_.data();
  const Range range = of_slab_[std::size_t(slab)];
  for (std::size_t i = range.first; i < range.last; ++i) weight_[i] = kernels_.linearise_line(m, batches_[i]);
}

/// Arrays for loops that only read the coupling.
LineArrays LineElements::coupling_arrays() const {
  LineArrays m{};
  m.spheres = model_.sphere_count();
  m.a = first_.data(), m.c = middle_.data(), m.e = last_.data();
  m.along_x = const_cast<float*>(along_[0].data()), m.along_y = const_cast<float*>(along_[1].data());
  m.along_z = const_cast<float*>(along_[2].data()), m.isotropic = const_cast<float*>(isotropic_.data());
  return m;
}

template <class Real>
void LineElements::apply(int slab, const Real* v, SlabTarget<Real> result) const {
  const LineArrays m = coupling_arrays();
  const Range range = of_slab_[std::size_t(slab)];
  for (std::size_t i = range.first; i < range.last; ++i)
    if (weight_[i] != LineWeight::negligible) solver_kernels<Real>(kernels_).apply_line(m, batches_[i], v, result);
}
template void LineElements::apply(int slab, const float* v, SlabTarget<float> result) const;
template void LineElements::apply(int slab, const double* v, SlabTarget<double> result) const;

template <class Real>
void LineElements::apply_lagged(int slab, const Real* v, SlabTarget<Real> result) const {
  apply(slab, v, result);
  const LineArrays m = coupling_arrays();
  const Range range = of_slab_[std::size_t(slab)];
  for (std::size_t i = range.first; i < range.last; ++i)
    if (weight_[i] == LineWeight::full) solver_kernels<Real>(kernels_).take_line_blocks(m, batches_[i], v, result);
}
template void LineElements::apply_lagged(int slab, const float* v, SlabTarget<float> result) const;
template void LineElements::apply_lagged(int slab, const double* v, SlabTarget<double> result) const;

}  // namespace ctpm::elements
