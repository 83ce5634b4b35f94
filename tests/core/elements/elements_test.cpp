#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/elements/forces.h"
#include "core/model/state.h"
#include "tests/core/blocks.h"

namespace ctpm {
namespace {

using testing::make_block_model;
using testing::Noise;
using testing::shake;

// Forces of a shaken liver block are about 1 N; rounding errors of sums of a few dozen of them are far smaller than
// this.
constexpr double kRounding = 1e-12;

class EveryStructure : public ::testing::TestWithParam<network::Structure> {};

State moved_rigidly(const Model& model) {
  State state = rest_state(model);
  const double c = std::cos(1.1), s = std::sin(1.1);
  const double c2 = std::cos(0.4), s2 = std::sin(0.4);
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    const Vec3 p = state.position[i], q{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    state.position.set(i, Vec3{q.x, c2 * q.y - s2 * q.z, s2 * q.y + c2 * q.z} + Vec3{0.3, -0.2, 0.1});
  }
  return state;
}

/// Net force and net torque of a shaken network with randomly stretched Kelvin units are zero.
void expect_momentum_is_kept(const Model& model, double force_bound, double torque_bound) {
  State state = rest_state(model);
  shake(state, 0.005, 0.2);
  Noise noise;
  for (double& z : state.kelvin_elongation) z = 0.001 * noise.next();
  const Vec3Array force = elements::internal_forces(model, state);
  Vec3 sum, torque;
  double largest = 0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    sum += force[i], torque += cross(state.position[i], force[i]);
    largest = std::max(largest, norm(force[i]));
  }
  EXPECT_GT(largest, 0.1);
  EXPECT_NEAR(norm(sum), 0, force_bound);
  EXPECT_NEAR(norm(torque), 0, torque_bound);
}

TEST_P(EveryStructure, RigidMotionGivesNoForce) {
  const Model model = make_block_model(6, 5, 7, GetParam());
  const Vec3Array force = elements::internal_forces(model, moved_rigidly(model));
  for (std::size_t i = 0; i < force.size(); ++i) ASSERT_NEAR(norm(force[i]), 0, 1e-10) << "sphere " << i;
}

TEST_P(EveryStructure, KeepsLinearAndAngularMomentum) {
  const Model model = make_block_model(6, 5, 7, GetParam());
  expect_momentum_is_kept(model, 1e3 * kRounding, 1e2 * kRounding);
}

TEST_P(EveryStructure, TurnsWithTheBody) {
  const Model model = make_block_model(5, 5, 5, GetParam());
  State state = rest_state(model);
  shake(state, 0.004, 0.1);
  State turned = state;  // a quarter turn about z: (x, y) -> (-y, x)
  const auto turn = [](Vec3 p) { return Vec3{-p.y, p.x, p.z}; };
  for (std::size_t i = 0; i < state.position.size(); ++i)
    turned.position.set(i, turn(state.position[i])), turned.velocity.set(i, turn(state.velocity[i]));
  const Vec3Array force = elements::internal_forces(model, state),
                  turned_force = elements::internal_forces(model, turned);
  for (std::size_t i = 0; i < force.size(); ++i) ASSERT_NEAR(norm(turned_force[i] - turn(force[i])), 0, kRounding);
}

TEST_P(EveryStructure, StaysFiniteWhenSpheresCoincide) {
  const Model model = make_block_model(5, 5, 5, GetParam());
  State state = rest_state(model);
  for (std::size_t i = 0; i < state.position.size(); ++i) state.position.set(i, {0.01, 0.02, 0.03});
  const Vec3Array force = elements::internal_forces(model, state);
  for (std::size_t i = 0; i < force.size(); ++i) ASSERT_TRUE(is_finite(force[i]));
}

INSTANTIATE_TEST_SUITE_P(Elements, EveryStructure,
                         ::testing::Values(network::Structure::mass_spring, network::Structure::angle_mass_spring,
                                           network::Structure::tpm, network::Structure::ctpm));

TEST(EdgesAndAngleSprings, AreTheGradientOfTheirEnergy) {
  const Model model = make_block_model(4, 4, 4, network::Structure::angle_mass_spring);
  State state = rest_state(model);
  shake(state, 0.004);
  const Vec3Array force = elements::internal_forces(model, state);
  constexpr double kStep = 1e-7;  // [m]; a central difference errs by about step^2 k / s^2, here 1e-8 N
  for (const std::size_t i : {0u, 21u, 42u, 63u})
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 delta{axis == 0 ? kStep : 0, axis == 1 ? kStep : 0, axis == 2 ? kStep : 0};
      State plus = state, minus = state;
      plus.position.add(i, delta), minus.position.add(i, -delta);
      const double gradient =
          (elements::elastic_energy(model, plus) - elements::elastic_energy(model, minus)) / (2 * kStep);
      EXPECT_NEAR(dot(force[i], delta / kStep), -gradient, 1e-7);
    }
}

/// Five spheres on a line with the constraint of the paper's liver; C is displaced sideways by `tilt`.
struct Line {
  explicit Line(double tilt) : model(make_block_model(5, 1, 1)), state(rest_state(model)) {
    state.position.add(2, {0, 0, tilt});
  }
  Model model;
  State state;
};

TEST(TwoSphereTpm, ForcesAreTheGradientOfTheSeriesSpringWhileTheKelvinUnitRests) {
  const Model model = make_block_model(3, 3, 3, network::Structure::tpm);
  State state = rest_state(model);
  shake(state, 0.001);
  testing::Noise noise;
  for (double& elongation : state.kelvin_elongation) elongation = 5e-4 * noise.next();
  const auto energy = [&](const State& at) {
    const AxialElements& axial = model.axial;
    double sum = 0;
    for (std::size_t i = 0; i < axial.size(); ++i) {
      const double length = norm(at.position[std::size_t(axial.b[i])] - at.position[std::size_t(axial.a[i])]);
      const double x = length - axial.rest_length[i] - at.kelvin_elongation[std::size_t(axial.internal[i])];
      sum += 0.5 * axial.k[i] * x * x;
    }
    return sum;
  };
  const Vec3Array force = elements::internal_forces(model, state);
  constexpr double kStep = 1e-7;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
      State plus = state, minus = state;
      plus.position.add(i, kStep * axis), minus.position.add(i, -kStep * axis);
      const double gradient = (energy(plus) - energy(minus)) / (2 * kStep);
      EXPECT_NEAR(dot(force[i], axis), -gradient, 1e-6) << "sphere " << i;
    }
}

TEST(Constraint, ForceOnCIsEquation2Over8) {
  for (const double tilt : {0.001, 0.004, 0.012, 0.024}) {
    Line line(tilt);
    line.model.axial.k.assign(line.model.axial.size(), 0);  // the constraint alone
    const double arm = 0.024, k = line.model.constraints.k.at(0);
    const double cosine = arm / std::sqrt(arm * arm + tilt * tilt);
    const double expected = -2 * k * (1 - cosine) * tilt / (1 + tilt / arm);
    const Vec3Array force = elements::internal_forces(line.model, line.state);
    EXPECT_NEAR(force.z[2], expected, 1e-12);
    EXPECT_NEAR(force.z[0], -expected / 2, 1e-12);
    EXPECT_NEAR(force.z[4], -expected / 2, 1e-12);
  }
}

TEST(Constraint, IsTheGradientOfItsEnergyWithoutSoftening) {
  Line line(0.007);
  line.model.axial.k.assign(line.model.axial.size(), 0);
  // Integral of 2 k' (1 - h / sqrt(h^2 + u^2)) u du.
  const double k = line.model.constraints.k.at(0), h = 0.024;
  const auto energy = [&](double u) { return k * u * u - 2 * k * h * (std::sqrt(h * h + u * u) - h); };
  constexpr double kStep = 1e-6;
  const double gradient = (energy(0.007 + kStep) - energy(0.007 - kStep)) / (2 * kStep);
  const double softening = 1 + 0.007 / h;  // Eq. 8 divides the force of a potential
  EXPECT_NEAR(elements::internal_forces(line.model, line.state).z[2] * softening, -gradient, 1e-8);
}

TEST(Constraint, AStraightStretchedLineHasNone) {
  Line line(0);
  for (std::size_t i = 0; i < 5; ++i) line.state.position.x[i] *= 1.5;
  line.model.axial.k.assign(line.model.axial.size(), 0);
  const Vec3Array force = elements::internal_forces(line.model, line.state);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(norm(force[i]), 0);
}

TEST(Constraint, PullsWithTwiceKWhereItsEndsMeetAndNotAtAllWhereItIsAPoint) {
  Line line(0.01);
  line.model.axial.k.assign(line.model.axial.size(), 0);
  line.model.has_softening = false, line.model.axial.third = {};
  line.state.position.x.assign(5, 0);
  const Vec3Array force = elements::internal_forces(line.model, line.state);
  EXPECT_NEAR(force.z[2], -2 * line.model.constraints.k.at(0) * 0.01, 1e-12);
  line.state.position.z[2] = line.state.position.z[0];
  const Vec3Array none = elements::internal_forces(line.model, line.state);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(norm(none[i]), 0);
}

TEST(Softening, HalvesATripleAt45Degrees) {
  Line line(0.024);  // tan(theta) = 1
  const double soft = elements::internal_forces(line.model, line.state).x[1];
  line.model.has_softening = false;
  line.model.axial.third = {};
  const double hard = elements::internal_forces(line.model, line.state).x[1];
  ASSERT_NE(hard, 0);
  EXPECT_NEAR(soft, hard / 2, 1e-12);
}

TEST(Softening, DoesWorkInAClosedCycle) {
  // E moves out while the line is straight, C tilts, E returns while the line is softened, C returns.
  Line line(0);
  line.model.constraints.k.assign(line.model.constraints.k.size(), 0);  // springs alone are conservative
  double work = 0;
  const auto move = [&](std::size_t sphere, Vec3 way) {
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
      line.state.position.add(sphere, 0.5 / kSteps * way);
      work += dot(elements::internal_forces(line.model, line.state)[sphere], way) / kSteps;
      line.state.position.add(sphere, 0.5 / kSteps * way);
    }
  };
  const Vec3 out{0.006, 0, 0}, down{0, 0, 0.012};
  move(4, out), move(2, down), move(4, -out), move(2, -down);
  const double stored = 0.5 * line.model.axial.k[0] * 0.006 * 0.006;
  EXPECT_GT(std::abs(work), 0.01 * stored);
  line.model.has_softening = false, work = 0;
  move(4, out), move(2, down), move(4, -out), move(2, -down);
  EXPECT_LT(std::abs(work), 0.005 * stored);
}

TEST(Softening, StaysFiniteAt90Degrees) {
  Line line(0.01);
  for (const std::size_t i : {0u, 1u, 3u, 4u}) line.state.position.set(i, {0, 0, 0});
  const Vec3Array force = elements::internal_forces(line.model, line.state);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_TRUE(is_finite(force[i]));
}

TEST(Network, TilesARunIntoMirroredTriplesThatShareEnds) {
  const Model model = make_block_model(10, 1, 1);
  ASSERT_EQ(model.axial.size(), 9u);  // four triples and one single element
  ASSERT_EQ(model.constraints.size(), 2u);
  const std::vector<bool> is_kelvin{false, true, true, false, false, true, true, false};
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(model.axial.law[i], is_kelvin[i] ? AxialLaw::kelvin_unit : AxialLaw::spring) << "element " << i;
    EXPECT_EQ(model.axial.c[i] > 0, is_kelvin[i]) << "element " << i;
    EXPECT_EQ(model.axial.internal[i], -1);
  }
  EXPECT_EQ(model.constraints.c, (std::vector<std::int32_t>{2, 6}));
  EXPECT_EQ(model.constraints.a, (std::vector<std::int32_t>{0, 4}));
  EXPECT_EQ(model.constraints.e, (std::vector<std::int32_t>{4, 8}));
  EXPECT_EQ(model.axial.a[8], 8);
  EXPECT_EQ(model.axial.law[8], AxialLaw::two_sphere_tpm);
  EXPECT_EQ(model.axial.internal[8], 0);
}

TEST(Network, TwoSphereTpmsOfAllOrgansComeLast) {
  Model model;
  network::OrganSettings settings;
  settings.material = testing::liver_material();
  for (const double toughness : {100.0, 300.0}) {
    settings.material.fracture_toughness = toughness;
    ASSERT_TRUE(network::add_organ(model, testing::make_block(6, 4, 5), settings));
  }
  const AxialElements& axial = model.axial;
  const std::size_t first_tpm = axial.size() - axial.internal_count();
  ASSERT_GT(first_tpm, 0u);
  ASSERT_GT(axial.internal_count(), 0u);
  const auto is_second = [&](std::int32_t sphere) { return sphere >= model.organs[1].first; };
  for (std::size_t i = 0; i < axial.size(); ++i) {
    const bool is_tpm = axial.law[i] == AxialLaw::two_sphere_tpm;
    EXPECT_EQ(is_tpm, i >= first_tpm) << "element " << i;
    EXPECT_EQ(axial.internal[i], is_tpm ? std::int32_t(i - first_tpm) : -1);
    EXPECT_EQ(is_second(axial.a[i]), is_second(axial.b[i]));
    // Each element keeps the resistance of its own organ.
    const double per_toughness = model.cut_resistance.energy[i] / (is_second(axial.a[i]) ? 300 : 100);
    EXPECT_NEAR(per_toughness, model.cut_resistance.energy[0] / 100, 1e-18);
  }
  for (std::size_t c = 0; c < model.constraints.size(); ++c) {
    const Constraints& lines = model.constraints;
    const auto element = [&](std::size_t n) { return std::size_t(lines.edge[n][c]); };
    EXPECT_EQ(axial.a[element(0)], lines.a[c]);
    EXPECT_EQ(axial.b[element(1)], lines.c[c]);
    EXPECT_EQ(axial.a[element(2)], lines.c[c]);
    EXPECT_EQ(axial.b[element(3)], lines.e[c]);
  }
}

TEST(Network, SpheresKeepTheirCellsCountedFromTheOrgansFirst) {
  FilledOrgan organ = testing::make_block(4, 3, 2);
  for (auto& cell : organ.cell) cell = {cell[0] + 7, cell[1] - 5, cell[2] + 2};
  Model model;
  network::OrganSettings settings;
  settings.material = testing::liver_material();
  ASSERT_TRUE(network::add_organ(model, organ, settings));
  ASSERT_TRUE(network::add_organ(model, organ, settings));
  ASSERT_EQ(model.cell.size(), model.sphere_count());
  for (std::int32_t i = 0; i < 48; ++i)
    EXPECT_EQ(model.cell[std::size_t(i)], (LatticeCell{i % 4, i % 24 / 4 % 3, i % 24 / 12})) << "sphere " << i;
}

TEST(Network, InnerSpheresOfCubic18Have18Edges) {
  const Model model = make_block_model(5, 5, 5, network::Structure::mass_spring);
  std::vector<int> degree(model.sphere_count());
  for (std::size_t i = 0; i < model.axial.size(); ++i)
    ++degree[std::size_t(model.axial.a[i])], ++degree[std::size_t(model.axial.b[i])];
  EXPECT_EQ(degree[62], 18);  // the middle
  EXPECT_EQ(degree[0], 6);    // a corner: 3 axis and 3 diagonal neighbours
}

TEST(Network, StiffnessIsThePapersModulusTimesProbeArea) {
  const Model model = make_block_model(3, 1, 1);
  EXPECT_NEAR(model.axial.k[0], 15e6 * 3.14159265358979 * 4e-6, 1e-9);  // 188.5 N/m
  EXPECT_NEAR(model.mass[0], 1060 * 0.012 * 0.012 * 0.012, 1e-15);
}

TEST(Network, SaysEveryModulusThatIsOutOfRange) {
  Model model;
  network::OrganSettings settings;
  settings.name = "block";
  settings.material.spring = -1;
  settings.material.viscosity = NAN;
  const Result<Done> added = network::add_organ(model, testing::make_block(2, 2, 2), settings);
  ASSERT_FALSE(added);
  EXPECT_GE(added.errors().size(), 3u);
  EXPECT_EQ(model.sphere_count(), 0u);
}

/// A capsule around a parenchyma: spheres of a block up to 6 mm deep are stiffer, heavier and less viscous.
network::LayerMaterial capsule(double to_depth = 0.012) {
  network::LayerMaterial layer;
  layer.to_depth = to_depth;
  layer.material = testing::liver_material();
  layer.material.spring = 82e6, layer.material.kelvin = 58e6, layer.material.constraint = 164e6;
  layer.material.viscosity = 3e6, layer.material.density = 1200;
  return layer;
}

Result<Model> make_layered_model(int ni, int nj, int nk, network::Structure structure,
                                 const std::vector<network::LayerMaterial>& layers) {
  network::OrganSettings settings;
  settings.name = "block", settings.structure = structure;
  settings.material = testing::liver_material(), settings.layers = layers;
  for (int i = 0; i < ni * nj; ++i) settings.anchored.push_back(i);
  Model model;
  if (const Result<Done> added = network::add_organ(model, testing::make_block(ni, nj, nk), settings); !added)
    return added.errors();
  return model;
}

class EveryLayeredStructure : public EveryStructure {};

TEST_P(EveryLayeredStructure, RigidMotionGivesNoForce) {
  const Model model = *make_layered_model(6, 5, 7, GetParam(), {capsule()});
  const Vec3Array force = elements::internal_forces(model, moved_rigidly(model));
  for (std::size_t i = 0; i < force.size(); ++i) ASSERT_NEAR(norm(force[i]), 0, 1e-10) << "sphere " << i;
}

TEST_P(EveryLayeredStructure, KeepsLinearAndAngularMomentum) {
  const Model model = *make_layered_model(6, 5, 7, GetParam(), {capsule()});
  // Forces in the capsule are five times those of the liver.
  expect_momentum_is_kept(model, 5e3 * kRounding, 5e2 * kRounding);
}

TEST_P(EveryLayeredStructure, LayersOfOneMaterialAreTheOrganWithoutLayers) {
  network::LayerMaterial same{0.012, testing::liver_material()}, deeper{0.020, testing::liver_material()};
  const Model plain = make_block_model(6, 5, 7, GetParam());
  const Model layered = *make_layered_model(6, 5, 7, GetParam(), {same, deeper});
  EXPECT_EQ(layered.mass, plain.mass);
  EXPECT_EQ(layered.axial.law, plain.axial.law);
  EXPECT_EQ(layered.axial.k, plain.axial.k);
  EXPECT_EQ(layered.axial.c, plain.axial.c);
  EXPECT_EQ(layered.axial.kelvin_k, plain.axial.kelvin_k);
  EXPECT_EQ(layered.constraints.k, plain.constraints.k);
  EXPECT_EQ(layered.angle_springs.k, plain.angle_springs.k);
}

INSTANTIATE_TEST_SUITE_P(Elements, EveryLayeredStructure,
                         ::testing::Values(network::Structure::mass_spring, network::Structure::angle_mass_spring,
                                           network::Structure::tpm, network::Structure::ctpm));

TEST(Layers, EdgesAndAngleSpringsAreTheGradientOfTheirEnergy) {
  const Model model = *make_layered_model(4, 4, 4, network::Structure::angle_mass_spring, {capsule()});
  State state = rest_state(model);
  shake(state, 0.004);
  const Vec3Array force = elements::internal_forces(model, state);
  constexpr double kStep = 1e-7;  // [m]; a central difference errs by about step^2 k / s^2, here 5e-8 N
  for (const std::size_t i : {0u, 21u, 42u, 63u}) {
    State plus = state, minus = state;
    plus.position.add(i, {0, kStep, 0}), minus.position.add(i, {0, -kStep, 0});
    const double gradient =
        (elements::elastic_energy(model, plus) - elements::elastic_energy(model, minus)) / (2 * kStep);
    EXPECT_NEAR(force.y[i], -gradient, 5e-7);
  }
}

TEST(Layers, AnElementHasTheMeanOfItsSpheres) {
  // The middle line along x of a 5 x 3 x 3 block: capsule, liver, liver, liver, capsule.
  const double area = network::edge_area(testing::liver_material(), 0.012);
  const auto value = [&](double mpa) { return mpa * 1e6 * area; };
  const Model model = *make_layered_model(5, 3, 3, network::Structure::ctpm, {capsule()});
  const std::int32_t a = 20;  // of the middle line
  std::size_t spring = 0, kelvin = 0, line = 0;
  while (!(model.axial.a[spring] == a && model.axial.b[spring] == a + 1)) ++spring;
  while (!(model.axial.a[kelvin] == a + 1 && model.axial.b[kelvin] == a + 2)) ++kelvin;
  while (!(model.constraints.a[line] == a && model.constraints.e[line] == a + 4)) ++line;
  EXPECT_NEAR(model.axial.k[spring], value((82 + 15 + 15) / 3.0), 1e-9);
  EXPECT_NEAR(model.axial.k[kelvin], value((58 + 15 + 15) / 3.0), 1e-9);
  EXPECT_NEAR(model.axial.c[kelvin], value((3 + 5 + 5) / 3.0), 1e-9);
  const double capsule_p2 = 82.0 * 58 / (82 + 58);
  EXPECT_NEAR(model.constraints.k[line], value((2 * (164 - capsule_p2) + 3 * (20 - 7.5)) / 5), 1e-9);

  const Model tpm = *make_layered_model(5, 3, 3, network::Structure::tpm, {capsule()});
  std::size_t border = 0;
  while (!(tpm.axial.a[border] == a && tpm.axial.b[border] == a + 1)) ++border;
  EXPECT_NEAR(tpm.axial.k[border], value((82 + 15) / 2.0), 1e-9);
  EXPECT_NEAR(tpm.axial.c[border], value((3 + 5) / 2.0), 1e-9);
}

TEST(Layers, ASphereHasTheMassOfItsOwnLayer) {
  const double volume = 0.012 * 0.012 * 0.012;
  network::LayerMaterial second{0.018, testing::liver_material()};
  second.material.density = 1100;
  // Spheres of the second shell are 18 mm deep. A layer that ends at 18 mm does not include them; a deeper one does.
  for (const auto& [to_depth, density] : {std::pair{0.018, 1060}, {0.0181, 1100}}) {
    second.to_depth = to_depth;
    const Model model = *make_layered_model(5, 5, 5, network::Structure::ctpm, {capsule(0.012), second});
    EXPECT_NEAR(model.mass[0], 1200 * volume, 1e-15);
    EXPECT_NEAR(model.mass[31], density * volume, 1e-15);
    EXPECT_NEAR(model.mass[62], 1060 * volume, 1e-15);
  }
}

TEST(Layers, OutOfOrderOrWithABadModulusAreRefusedByNumber) {
  network::LayerMaterial bad = capsule(0.020);
  bad.material.kelvin = -1;
  const Result<Model> model =
      make_layered_model(3, 3, 3, network::Structure::ctpm, {capsule(0.012), capsule(0.012), bad});
  ASSERT_FALSE(model);
  EXPECT_EQ(model.errors()[0].where, "organ block, layer 1");
  EXPECT_NE(model.errors()[0].message.find("must be more than 0.012"), std::string::npos);
  EXPECT_EQ(model.errors()[1].where, "organ block, layer 2");
  EXPECT_NE(model.errors()[1].message.find("Kelvin modulus K1"), std::string::npos);
}

}  // namespace
}  // namespace ctpm
