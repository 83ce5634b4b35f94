// Ticks of a scene that has springs only: no viscosity, constraint, cutting or contact. Built with core as it
// is and with everything else compiled out; springs_bench.sh runs both in turn and prints what the rest costs
// such a scene.
//   ctpm_springs_bench_core explicit 9      nanoseconds of processor time per tick, 9 x 9 x 9 spheres
//   ctpm_springs_bench_core implicit 17

#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/stepping/step.h"
#include "tests/core/blocks.h"

namespace {

double processor_time_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * double(time.tv_sec) + double(time.tv_nsec);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace ctpm;
  const std::string way = argc == 3 ? argv[1] : "";
  const int edge = argc == 3 ? std::atoi(argv[2]) : 0;
  if ((way != "explicit" && way != "implicit") || edge < 3) {
    std::fprintf(stderr, "usage: %s explicit|implicit EDGE, for example: %s explicit 9\n", argv[0], argv[0]);
    return 2;
  }
  Material material = testing::liver_material();
  material.stiffness_scale = 0.29;
  Model model = testing::make_block_model(edge, edge, edge, Structure::mass_spring, material);
  model.gravity = {0, 0, -0.1};
  testing::use_integrator(model, way == "explicit" ? Integrator::leapfrog : Integrator::backward_euler);
  Stepper stepper(model);
  State state = rest_state(model);
  constexpr int kBatches = 40;
  const int ticks = std::max(1, 200'000 / (edge * edge * edge) / (way == "explicit" ? 1 : 8));
  std::vector<double> per_tick;
  for (int batch = 0; batch < kBatches; ++batch) {
    const double start = processor_time_ns();
    for (int i = 0; i < ticks; ++i)
      if (stepper.step(state, {}).status != StepStatus::ok) return 1;
    per_tick.push_back((processor_time_ns() - start) / ticks);
  }
  std::nth_element(per_tick.begin(), per_tick.begin() + kBatches / 2, per_tick.end());
  std::printf("%.1f\n", per_tick[kBatches / 2]);
}
