#include "core/elements.h"

#include <algorithm>

namespace ctpm {

Elements::Elements(const Model& model, Team& team, InstructionSet set)
    : team_(team),
      slabs_(model.sphere_count()),
      schedule_(slabs_),
      axial_(model, slabs_, schedule_, kernels_for(set)),
      constraints_(model, model.constraints, slabs_, schedule_, kernels_for(set)),
      angles_(model, model.angle_springs, slabs_, schedule_, kernels_for(set)),
      softness_(model.has_softening ? model.sphere_count() : 0) {}

/// Calls task(step, number) for all tasks of the schedule; those of one step may run at the same time.
template <class Task>
void Elements::for_each_task(Task&& task) const {
  for (int step = 0; step < Schedule::kSteps; ++step)
    team_.for_each(schedule_.task_count(step), [&](int number) { task(step, number); });
}

void Elements::measure(const LineArrays& constraints, const LineArrays& angles) {
  if (kOnlySprings || (constraints_.empty() && angles_.empty())) return;
  team_.for_each(slabs_.count(), [&](int slab) {
    if (!softness_.empty()) std::fill(&softness_[0] + slabs_.begin(slab), &softness_[0] + slabs_.end(slab), 1.0);
    constraints_.measure(constraints, slab);
    angles_.measure(angles, slab);
  });
}

void Elements::add_forces(const State& state, Coordinates& force) {
  double* softness = softness_.empty() ? nullptr : softness_.data();
  const LineArrays constraints = constraints_.arrays(state, softness, force.data()),
                   angles = angles_.arrays(state, nullptr, force.data());
  const AxialArrays axial = axial_.arrays(state, softness, force.data());
  measure(constraints, angles);
  for_each_task([&](int step, int task) {
    if constexpr (!kOnlySprings) {
      constraints_.add_forces(constraints, step, task);
      angles_.add_forces(angles, step, task);
    }
    axial_.add_forces(axial, step, task);
  });
}

void Elements::linearise(const State& state, double h, Coordinates& force, DiagonalBlocks& blocks) {
  double* softness = softness_.empty() ? nullptr : softness_.data();
  LineArrays constraints = constraints_.arrays(state, softness, force.data()),
             angles = angles_.arrays(state, nullptr, force.data());
  AxialArrays axial = axial_.arrays(state, softness, force.data());
  constraints.h = angles.h = axial.h = h;
  constraints.blocks = angles.blocks = axial.blocks = blocks.data();
  constraints_.prepare_linearise(), angles_.prepare_linearise(), axial_.prepare_linearise();
  measure(constraints, angles);
  for_each_task([&](int step, int task) {
    if constexpr (!kOnlySprings) {
      constraints_.linearise(constraints, step, task);
      angles_.linearise(angles, step, task);
    }
    axial_.linearise(axial, step, task);
  });
}

void Elements::apply(const double* v, double* result) const {
  for_each_task([&](int step, int task) {
    if constexpr (!kOnlySprings) {
      constraints_.apply(step, task, v, result);
      angles_.apply(step, task, v, result);
    }
    axial_.apply(step, task, v, result);
  });
}

}  // namespace ctpm
