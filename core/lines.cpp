#include "core/lines.h"

#include <algorithm>

namespace ctpm {
namespace {

/// Shorter rows are gathered with their neighbours instead.
constexpr std::size_t kShortestRow = 4;

}  // namespace

LineElements::LineElements(const Model& model, const Constraints& lines, const Slabs& slabs, const Schedule& schedule,
                           const Kernels& kernels)
    : LineElements(model, true, lines.a, lines.c, lines.e, lines.k, slabs, schedule, kernels) {}

LineElements::LineElements(const Model& model, const AngleSprings& springs, const Slabs& slabs,
                           const Schedule& schedule, const Kernels& kernels)
    : LineElements(model, false, springs.a, springs.b, springs.c, springs.k, slabs, schedule, kernels) {}

LineElements::LineElements(const Model& model, bool is_constraint, const std::vector<std::int32_t>& first,
                           const std::vector<std::int32_t>& middle, const std::vector<std::int32_t>& last,
                           const std::vector<double>& k, const Slabs& slabs, const Schedule& schedule,
                           const Kernels& kernels)
    : model_(model), kernels_(kernels), is_constraint_(is_constraint), first_(&first), middle_(&middle), last_(&last), k_(&k) {
  for (int step = 0; step < Schedule::kSteps; ++step)
    tasks_[std::size_t(step)].resize(std::size_t(schedule.task_count(step)));
  of_slab_.resize(std::size_t(slabs.count()));
  const auto group_of = [&](std::size_t i) {
    const auto [low, high] = std::minmax({first[i], middle[i], last[i]});
    return std::array{slabs.of(low), slabs.of(high), slabs.of(middle[i])};
  };
  const auto row_end = [&](std::size_t i, const auto& group) {
    std::size_t end = i + 1;
    while (end < middle.size() && advance_by_one(end) && group_of(end) == group) ++end;
    return end;
  };
  for (std::size_t i = 0; i < middle.size();) {
    const auto group = group_of(i);
    std::size_t end = row_end(i, group);
    const bool is_row = end - i >= kShortestRow;
    while (!is_row && end < middle.size() && group_of(end) == group && end - i < std::size_t(kBatch)) {
      const std::size_t next = row_end(end, group);
      if (next - end >= kShortestRow) break;
      end = next;
    }
    end = std::min(end, i + std::size_t(kBatch));
    const auto number = std::int32_t(batches_.size());
    batches_.push_back({std::int32_t(end - i), std::int32_t(i), is_row ? first[i] : -1, middle[i], last[i]});
    const auto [step, task] = schedule.place(group[0], group[1]);
    tasks_[std::size_t(step)][std::size_t(task)].push_back(number);
    of_slab_[std::size_t(group[2])].push_back(number);
    i = end;
  }
  matters_.resize(batches_.size());
  for (auto* array : {&offset_[0], &offset_[1], &offset_[2], &half_length_}) array->resize(middle.size());
}

bool LineElements::advance_by_one(std::size_t i) const {
  return (*first_)[i] == (*first_)[i - 1] + 1 && (*middle_)[i] == (*middle_)[i - 1] + 1 &&
         (*last_)[i] == (*last_)[i - 1] + 1;
}

LineArrays LineElements::arrays(const State& state, double* softness, double* force) {
  const std::vector<std::uint8_t>& severed = is_constraint_ ? state.constraint_severed : state.angle_severed;
  LineArrays m{};
  m.spheres = state.position.size();
  m.x = state.position.x.data(), m.y = state.position.y.data(), m.z = state.position.z.data();
  m.a = first_->data(), m.c = middle_->data(), m.e = last_->data(), m.k = k_->data();
  m.severed = severed.empty() ? nullptr : severed.data();
  m.is_constraint = is_constraint_;
  m.softness = is_constraint_ ? softness : nullptr;
  m.mass = model_.mass.data();
  m.force = force;
  m.ux = offset_[0].data(), m.uy = offset_[1].data(), m.uz = offset_[2].data(), m.half = half_length_.data();
  return m;
}

void LineElements::measure(const LineArrays& m, int slab) const {
  for (const std::int32_t batch : of_slab_[std::size_t(slab)]) kernels_.measure_line(m, batches_[std::size_t(batch)]);
}

void LineElements::add_forces(const LineArrays& m, int step, int task) const {
  for (const std::int32_t batch : tasks_[std::size_t(step)][std::size_t(task)])
    kernels_.add_line_forces(m, batches_[std::size_t(batch)]);
}

void LineElements::prepare_linearise() {
  if (isotropic_.size() == middle_->size()) return;
  for (auto* array : {&along_[0], &along_[1], &along_[2], &isotropic_}) array->assign(middle_->size(), 0.0);
}

void LineElements::linearise(LineArrays m, int step, int task) {
  m.along_x = along_[0].data(), m.along_y = along_[1].data(), m.along_z = along_[2].data(), m.isotropic = isotropic_.data();
  for (const std::int32_t batch : tasks_[std::size_t(step)][std::size_t(task)])
    matters_[std::size_t(batch)] = kernels_.linearise_line(m, batches_[std::size_t(batch)]) ? 1 : 0;
}

void LineElements::apply(int step, int task, const double* v, double* result) const {
  LineArrays m{};
  m.spheres = model_.sphere_count();
  m.a = first_->data(), m.c = middle_->data(), m.e = last_->data();
  // The loops only read these here.
  m.along_x = const_cast<double*>(along_[0].data()), m.along_y = const_cast<double*>(along_[1].data());
  m.along_z = const_cast<double*>(along_[2].data()), m.isotropic = const_cast<double*>(isotropic_.data());
  for (const std::int32_t batch : tasks_[std::size_t(step)][std::size_t(task)])
    if (matters_[std::size_t(batch)] != 0) kernels_.apply_line(m, batches_[std::size_t(batch)], v, result);
}

}  // namespace ctpm
