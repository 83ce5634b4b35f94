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

/// Runs a suite under the integrator that most scenes get with every run, and under the others with the label slow.
#define CTPM_UNDER_EACH_INTEGRATOR(Suite)                                                                          \
  INSTANTIATE_TEST_SUITE_P(Under, Suite, ::testing::Values(Integrator::sdirk2), ::ctpm::testing::integrator_name); \
  INSTANTIATE_TEST_SUITE_P(SlowUnder, Suite, ::testing::Values(Integrator::leapfrog, Integrator::backward_euler),  \
                           ::ctpm::testing::integrator_name)
