#pragma once

#include <cstdint>
#include <vector>

#include "tests/core/bench/network_ode.h"

namespace ctpm::testing {

/// Displacements from the start at equal intervals [m]  (sample_count, 3 x sphere_count).
using Trajectory = std::vector<elements::Coordinates>;

/// One run of an integrator.
struct Run {
  Trajectory trajectory;  ///< shorter than requested if the integrator failed
  double seconds = 0;     ///< processor time without setup [s]
  std::int64_t steps = 0;
  std::int64_t evaluations = 0;  ///< calls of f(t, y), also for Jacobian products; core: solver iterations
};

/// Sampling times.
struct Samples {
  double interval = 0;  ///< [s]
  int count = 0;
};

/// CVODE's BDF with Newton and GMRES, without preconditioner or with each sphere's 3x3 block.
Run run_cvode(NetworkOde& ode, const Samples& samples, double rtol, bool is_preconditioned);

/// ARKODE's explicit Runge-Kutta method of order 4 (ERKStep).
Run run_arkode(NetworkOde& ode, const Samples& samples, double rtol);

/// Processor time of this thread [s].
double processor_time();

}  // namespace ctpm::testing
