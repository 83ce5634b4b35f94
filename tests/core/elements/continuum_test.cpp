// The lattice in the small-strain limit: model cubic-18 with equal edge stiffness is isotropic with Poisson ratio 1/4
// and Young's modulus 2.5 k / s.

#include <gtest/gtest.h>

#include <cmath>

#include "core/stepping/step.h"
#include "tests/core/blocks.h"

namespace ctpm {
namespace {

struct Elasticity {
  double young;    ///< [Pa]
  double poisson;  ///< [1]
};

/// Pulls a free bar of n x n x nz spheres at its top and measures strain in its middle half. Each sphere counts for its
/// cell of the cross-section, so the area is (n s)^2.
Elasticity stretch_bar(int n, int nz) {
  network::Material material = testing::liver_material();
  material.viscosity = 0;
  const FilledOrgan organ = testing::make_block(n, n, nz);
  network::OrganSettings settings;
  settings.name = "bar";
  settings.structure = network::Structure::mass_spring;
  settings.material = material;
  // The foot is fixed along z; its middle line and one more sphere prevent sliding and rotation.
  for (std::int32_t i = 0; i < n * n; ++i) settings.guides.push_back({i, 4});
  settings.guides.push_back({n / 2 + n * (n / 2), 1 | 2 | 4});
  settings.guides.push_back({n - 1 + n * (n / 2), 2 | 4});
  Model model;
  CTPM_CHECK(bool(network::add_organ(model, organ, settings)), "the bar is valid");
  const double pull = 1e-3;  // [N] on each top sphere: a strain of 1e-5, in the linear range
  for (std::int32_t i = n * n * (nz - 1); i < n * n * nz; ++i) {
    model.loads.sphere.push_back(i);
    model.loads.force.push_back({0, 0, pull});
    model.loads.start.push_back(0), model.loads.ramp.push_back(0);
  }
  model.tick = 100;  // backward Euler with such a long tick is a static solve
  model.solver.tolerance = 1e-12;
  model.solver.velocity_floor = 1e-20;
  model.solver.max_iterations = 5000;
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  for (int i = 0; i < 4; ++i) (void)stepper.step(state, {});
  const auto moved = [&](int i, int j, int k) {
    const auto sphere = std::size_t(i + n * (j + n * k));
    return state.position[sphere] - model.rest_position[sphere];
  };
  const int low = nz / 4, high = 3 * nz / 4, c = n / 2, mid = nz / 2;
  const double strain = (moved(c, c, high).z - moved(c, c, low).z) / (organ.spacing * (high - low));
  const double across = (moved(n - 2, c, mid).x - moved(1, c, mid).x) / (organ.spacing * (n - 3));
  return {pull / (organ.spacing * organ.spacing) / strain, -across / strain};
}

TEST(Cubic18, IsASolidOfYoungsModulus2500OverSpacingAndPoissonRatioOneQuarter) {
  // The surface of a bar is softer than its inside. The effect falls as 1 / n, so two sizes give the limit.
  const Elasticity small = stretch_bar(7, 41), large = stretch_bar(13, 53);
  const auto limit = [](double at7, double at13) { return (13 * at13 - 7 * at7) / 6; };
  const network::Material m = testing::liver_material();
  const double k = m.spring * network::edge_area(m, 0.012), young = 2.5 * k / 0.012;
  EXPECT_NEAR(limit(small.young, large.young), young, 0.02 * young)
      << small.young / young << " " << large.young / young;
  EXPECT_NEAR(limit(small.poisson, large.poisson), 0.25, 0.02 * 0.25) << small.poisson << " " << large.poisson;
}

}  // namespace
}  // namespace ctpm
