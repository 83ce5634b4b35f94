// A tick must not ask for memory: the allocator may take long, and a haptic device does not wait.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "core/step.h"
#include "tests/core/blocks.h"

namespace {

std::atomic<long> allocations{0};

void* allocate(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace ctpm {
namespace {

class EveryIntegrator : public ::testing::TestWithParam<Integrator> {};

TEST_P(EveryIntegrator, AllocatesNothingAfterTheFirstTick) {
  Material material = testing::liver_material();
  if (GetParam() == Integrator::symplectic_euler) material.viscosity = 5e3, material.stiffness_scale = 0.3;
  for (const int threads : {1, 2}) {
    Model model = testing::make_block_model(12, 12, 12, Structure::ctpm, material);
    model.tools = {testing::ball(0.02), testing::scalpel(0.1)};
    model.solver.integrator = GetParam();
    Stepper stepper(model, {threads, best_instruction_set()});
    State state = rest_state(model);
    std::int32_t contacts = 0, severed = 0;
    // The first tick with each tool may make room.
    long before = 0;
    for (int tick = 0; tick < 24; ++tick) {
      Inputs inputs;
      inputs.tool = tick < 12 ? 0 : 1;
      inputs.position = tick < 12 ? Vec3{0, 0, 0.156 - 0.0006 * tick} : Vec3{0.0007, -0.1 + 0.01 * (tick - 12), 0.1};
      if (tick == 1 || tick == 13) before = allocations;
      const StepReport report = stepper.step(state, inputs);
      if (tick != 0 && tick != 12) {
        ASSERT_EQ(allocations, before) << "tick " << tick << ", " << threads << " threads";
      }
      contacts += report.contacts, severed += report.severed;
    }
    EXPECT_GT(contacts, 0);
    EXPECT_GT(severed, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryIntegrator,
                         ::testing::Values(Integrator::symplectic_euler, Integrator::backward_euler,
                                           Integrator::extrapolated_euler));

}  // namespace
}  // namespace ctpm
