#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/stepping/integrator.h"

namespace ctpm::testing {

inline std::string integrator_name(const ::testing::TestParamInfo<Integrator>& of) {
  std::string name = stepping::name_of(of.param);
  std::erase(name, '-');
  return name;
}

}  // namespace ctpm::testing

/// Runs a suite under the integrators that `auto` takes with every run, and under the other one with the label slow.
#define CTPM_UNDER_EACH_INTEGRATOR(Suite)                                                                   \
  INSTANTIATE_TEST_SUITE_P(Under, Suite, ::testing::Values(Integrator::backward_euler, Integrator::sdirk2), \
                           ::ctpm::testing::integrator_name);                                               \
  INSTANTIATE_TEST_SUITE_P(SlowUnder, Suite, ::testing::Values(Integrator::leapfrog), ::ctpm::testing::integrator_name)
