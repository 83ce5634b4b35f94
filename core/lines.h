#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/axial.h"
#include "core/kernels/kernels.h"
#include "core/model.h"
#include "core/slabs.h"
#include "core/state.h"

namespace ctpm {

/// Elements that draw the middle sphere of a lattice line towards the middle of its ends, u = C - (A + E) / 2: the
/// constraints of five-sphere lines (Eqs. 2, 5), whose stiffness grows with the tilt, or the angle springs of Fig. 1b,
/// whose stiffness is constant.
class LineElements {
 public:
  LineElements(const Model& model, const Constraints& constraints, const Slabs& slabs, const Schedule& schedule,
               const Kernels& kernels);
  LineElements(const Model& model, const AngleSprings& angle_springs, const Slabs& slabs, const Schedule& schedule,
               const Kernels& kernels);

  bool empty() const { return middle_->empty(); }

  /// What the loops of one call read and write. `softness` [1] = 1 / (1 + tan theta) of each sphere, null without
  /// softening.
  LineArrays arrays(const State& state, double* softness, double* force);

  /// u of every line whose middle sphere is in `slab`, and from its tilt the softness of that sphere: the least of all
  /// lines centred on it (Eq. 8).
  void measure(const LineArrays& m, int slab) const;

  /// Adds the forces [N] of one task's elements to `m.force`. measure() of all slabs comes first.
  void add_forces(const LineArrays& m, int step, int task) const;

  /// Adds the forces to `m.force` and the diagonal of h^2 K [kg] to `m.blocks`, and keeps the coupling for apply().
  void linearise(LineArrays m, int step, int task);
  void prepare_linearise();

  /// result += coupling times `v`.
  void apply(int step, int task, const double* v, double* result) const;


 private:
  LineElements(const Model& model, bool is_constraint, const std::vector<std::int32_t>& first,
               const std::vector<std::int32_t>& middle, const std::vector<std::int32_t>& last,
               const std::vector<double>& k, const Slabs& slabs, const Schedule& schedule, const Kernels& kernels);
  bool advance_by_one(std::size_t line) const;

  const Model& model_;
  const Kernels& kernels_;
  bool is_constraint_;
  const std::vector<std::int32_t>*first_, *middle_, *last_;
  const std::vector<double>* k_;
  std::vector<LineBatch> batches_;
  std::array<std::vector<std::vector<std::int32_t>>, Schedule::kSteps> tasks_;  ///< batches of each task
  std::vector<std::vector<std::int32_t>> of_slab_;  ///< batches whose middle spheres are in the slab
  std::vector<std::uint8_t> matters_;               ///< of each batch, whether its coupling does
  std::vector<double> offset_[3], half_length_;     ///< u and |E - A| / 2 [m] (line_count)
  std::vector<double> along_[3], isotropic_;        ///< coupling: along u its root [kg^1/2], and in all directions [kg]
};

}  // namespace ctpm
