#include "studio/loading/tick_time.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

#include "core/model/state.h"
#include "core/stepping/step.h"
#include "studio/loading/tools_aside.h"

namespace ctpm::loading {
namespace {

constexpr int kWarmUp = kTicksToMeasure - kMeasuredTicks;

}  // namespace

std::optional<double> measure_tick(const Model& model, State state, const std::function<bool()>& should_stop,
                                   const std::function<void(std::int64_t done)>& progress) {
  using Clock = std::chrono::steady_clock;
  stepping::Stepper stepper(model);
  std::vector<double> times;
  for (int i = 0; i < kTicksToMeasure; ++i) {
    if (should_stop && should_stop()) return std::nullopt;
    if (progress) progress(i);
    const Clock::time_point start = Clock::now();
    (void)stepper.step(state, {});
    if (i >= kWarmUp) times.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  }
  std::nth_element(times.begin(), times.begin() + kMeasuredTicks / 2, times.end());
  return times[kMeasuredTicks / 2];
}

std::optional<double> measure_tick_work(Model& model, const std::function<bool()>& should_stop) {
  State state = rest_state(model);
  const ToolsAside aside(model);
  stepping::Stepper stepper(model);
  std::clock_t start = 0;
  for (int i = 0; i < kTicksToMeasure; ++i) {
    if (should_stop && should_stop()) return std::nullopt;
    if (i == kWarmUp) start = std::clock();
    (void)stepper.step(state, {});
  }
  return double(std::clock() - start) / CLOCKS_PER_SEC / kMeasuredTicks;
}

}  // namespace ctpm::loading
