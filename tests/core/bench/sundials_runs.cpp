#include "tests/core/bench/sundials_runs.h"

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <time.h>

#include <algorithm>
#include <memory>
#include <sundials/sundials_context.hpp>

namespace ctpm::testing {
namespace {

/// Dimension of the Krylov space. At equal error, 5 (CVODE's default) and 60 take about as long.
constexpr int kKrylov = 30;

constexpr long kMostSteps = 100'000'000;

struct Destroy {
  void operator()(N_Vector v) const { N_VDestroy(v); }
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
};
using Vector = std::unique_ptr<std::remove_pointer_t<N_Vector>, Destroy>;
using LinearSolver = std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, Destroy>;

NetworkOde& ode_of(void* data) { return *static_cast<NetworkOde*>(data); }

int derive(double time, N_Vector y, N_Vector derivative, void* data) {
  ode_of(data).derive(time, N_VGetArrayPointer(y), N_VGetArrayPointer(derivative));
  return 0;
}

int take_blocks(double time, N_Vector y, N_Vector, int, int* is_current, double gamma, void* data) {
  ode_of(data).take_blocks(time, gamma, N_VGetArrayPointer(y));
  *is_current = 1;
  return 0;
}

int precondition(double, N_Vector, N_Vector, N_Vector r, N_Vector z, double gamma, double, int, void* data) {
  ode_of(data).precondition(gamma, N_VGetArrayPointer(r), N_VGetArrayPointer(z));
  return 0;
}

Vector vector_of(const std::vector<double>& values, SUNContext context) {
  Vector v(N_VNew_Serial(sunindextype(values.size()), context));
  std::copy(values.begin(), values.end(), N_VGetArrayPointer(v.get()));
  return v;
}

Vector tolerances(const NetworkOde& ode, double rtol, SUNContext context) {
  std::vector<double> scale = ode.scales();
  for (double& value : scale) value *= rtol;
  return vector_of(scale, context);
}

/// Calls go_on(time) to advance `y` to each sample time; a result of false ends the run.
template <class GoOn>
void sample(Run& run, const Samples& samples, N_Vector y, std::size_t coordinates, GoOn&& go_on) {
  const double* values = N_VGetArrayPointer(y);
  for (int k = 1; k <= samples.count; ++k) {
    const double start = processor_time();
    if (!go_on(k * samples.interval)) return;
    run.seconds += processor_time() - start;
    run.trajectory.emplace_back(values, values + coordinates);
  }
}

}  // namespace

double processor_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

Run run_cvode(NetworkOde& ode, const Samples& samples, double rtol, bool is_preconditioned) {
  sundials::Context context;
  const Vector y = vector_of(ode.start_values(), context), atol = tolerances(ode, rtol, context);
  const LinearSolver gmres(
      SUNLinSol_SPGMR(y.get(), is_preconditioned ? SUN_PREC_LEFT : SUN_PREC_NONE, kKrylov, context));
  void* cvode = CVodeCreate(CV_BDF, context);
  CVodeInit(cvode, derive, 0, y.get());
  CVodeSVtolerances(cvode, rtol, atol.get());
  CVodeSetUserData(cvode, &ode);
  CVodeSetMaxNumSteps(cvode, kMostSteps);
  CVodeSetLinearSolver(cvode, gmres.get(), nullptr);
  if (is_preconditioned) CVodeSetPreconditioner(cvode, take_blocks, precondition);
  Run run;
  sample(run, samples, y.get(), 3 * ode.sphere_count(), [&](double time) {
    double reached = 0;
    return CVode(cvode, time, y.get(), &reached, CV_NORMAL) >= 0;
  });
  long steps = 0, own = 0, products = 0;
  CVodeGetNumSteps(cvode, &steps), CVodeGetNumRhsEvals(cvode, &own), CVodeGetNumLinRhsEvals(cvode, &products);
  run.steps = steps, run.evaluations = own + products;
  CVodeFree(&cvode);
  return run;
}

Run run_arkode(NetworkOde& ode, const Samples& samples, double rtol) {
  sundials::Context context;
  const Vector y = vector_of(ode.start_values(), context), atol = tolerances(ode, rtol, context);
  void* arkode = ERKStepCreate(derive, 0, y.get(), context);
  ERKStepSVtolerances(arkode, rtol, atol.get());
  ERKStepSetUserData(arkode, &ode);
  ERKStepSetMaxNumSteps(arkode, kMostSteps);
  Run run;
  sample(run, samples, y.get(), 3 * ode.sphere_count(), [&](double time) {
    double reached = 0;
    return ERKStepEvolve(arkode, time, y.get(), &reached, ARK_NORMAL) >= 0;
  });
  long steps = 0, own = 0;
  ERKStepGetNumSteps(arkode, &steps), ERKStepGetNumRhsEvals(arkode, &own);
  run.steps = steps, run.evaluations = own;
  ERKStepFree(&arkode);
  return run;
}

}  // namespace ctpm::testing
