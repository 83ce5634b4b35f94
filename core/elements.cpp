#include "core/elements.h"

namespace ctpm {

Elements::Elements(const Model& model)
    : model_(model),
      axial_(model),
      constraints_(model),
      angles_(model),
      softness_(model.has_softening ? model.sphere_count() : 0) {}

void Elements::add_forces(const State& state, Coordinates& force) {
  if (model_.constraints.size() > 0) {
    constraints_.measure_tilt(state, softness_);
    constraints_.add_forces(state, softness_, force);
  }
  if (model_.angle_springs.size() > 0) angles_.add_forces(state, force);
  axial_.add_forces(state, softness_, force);
}

void Elements::linearise(const State& state, double h, Coordinates& force, DiagonalBlocks& blocks) {
  if (model_.constraints.size() > 0) {
    constraints_.measure_tilt(state, softness_);
    constraints_.linearise(state, softness_, h, force, blocks);
  }
  if (model_.angle_springs.size() > 0) angles_.linearise(state, h, force, blocks);
  axial_.linearise(state, softness_, h, force, blocks);
}

void Elements::apply(const State& state, double h, const Coordinates& v, Coordinates& result) const {
  axial_.apply(v, result);
  if (model_.constraints.size() > 0) constraints_.apply(v, result);
  if (model_.angle_springs.size() > 0) angles_.apply(state, h, v, result);
}

}  // namespace ctpm
