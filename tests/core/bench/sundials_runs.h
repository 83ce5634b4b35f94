#pragma once

#include <cstdint>
#include <vector>

#include "tests/core/bench/network_ode.h"

namespace ctpm::testing {

/// Displacements from the start at equal intervals [m]  (sample_count, 3 x sphere_count).
using Trajectory = std::vector<elements::Coordinates>;

/// A run of any integrator.
struct Run {
  Trajectory trajectory;  ///< shorter than asked for if the integrator gave up
  double seconds = 0;     ///< processor time, without setting up [s]
  std::int64_t steps = 0;
  std::int64_t evaluations = 0;  ///< of forces: f(t, y) of SUNDIALS, which its products with the Jacobian are
                                 ///< too; iterations of the solves of core's
};

/// When to sample.
struct Samples {
  double interval = 0;  ///< [s]
  int count = 0;
};

/// CVODE's BDF, Newton with GMRES, as it comes or preconditioned by each sphere's own block.
Run run_cvode(NetworkOde& ode, const Samples& samples, double rtol, bool is_preconditioned);

/// ARKODE's explicit Runge-Kutta method of order 4 (ERKStep).
Run run_arkode(NetworkOde& ode, const Samples& samples, double rtol);

/// Processor time of this thread [s].
double processor_time();

}  // namespace ctpm::testing
