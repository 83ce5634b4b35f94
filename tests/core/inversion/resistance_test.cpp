// The resistance to inversion: its cells, its energy and forces, its linearisation, and the search for cells.

#include "core/inversion/resistance.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "core/stepping/step.h"
#include "tests/core/inversion/cells.h"

namespace ctpm {
namespace {

using testing::make_block;
using testing::make_resisting_block;

/// Every sphere moved to a position drawn evenly from a cube around its place.
State shaken(const Model& model, double amount) {
  State state = rest_state(model);
  testing::shake(state, amount);
  return state;
}

/// Room for one Resistance.
struct Rig {
  explicit Rig(const Model& m, int threads = 1)
      : model(m),
        slabs(m.sphere_count()),
        team(threads),
        resistance(m, slabs, team, elements::kernels_for(elements::best_instruction_set())),
        force(3 * m.sphere_count()),
        blocks(6 * m.sphere_count()) {}

  const Model& model;
  parallel::Slabs slabs;
  parallel::Team team;
  inversion::Resistance resistance;
  elements::Coordinates force;
  elements::DiagonalBlocks blocks;
};

/// Forces of the resistance alone [N] (3 x sphere_count).
elements::Coordinates forces_of(const Model& model, const State& state) {
  Rig rig(model);
  const auto linearised = rig.resistance.linearise(state, 0, rig.force, rig.blocks);
  return rig.force;
}

// Cells of an organ.

TEST(TissueCells, AreTheCubesWhoseEightCornersExist) {
  const Model model = make_resisting_block(4, 3, 3, Integrator::backward_euler);
  ASSERT_EQ(model.tissue_cells.size(), 3u * 2 * 2);
  for (std::size_t cell = 0; cell < model.tissue_cells.size(); ++cell)
    for (std::size_t c = 0; c < 8; ++c)
      EXPECT_NEAR(testing::volume_ratio(model, model.rest_position, cell, c), 1, 1e-12) << cell;

  FilledOrgan holed = make_block(3, 3, 3);
  holed.layer.erase(holed.layer.begin()), holed.cell.erase(holed.cell.begin()),
      holed.centre.erase(holed.centre.begin()), holed.depth.erase(holed.depth.begin());
  network::OrganSettings settings;
  settings.material = testing::liver_material(), settings.inversion_resistance = 10;
  Model beside = make_resisting_block(4, 3, 3, Integrator::backward_euler);
  ASSERT_TRUE(network::add_organ(beside, holed, settings));
  EXPECT_EQ(beside.tissue_cells.size(), 12u + 7);  // the cell at the missing corner is left out
  EXPECT_GE(beside.tissue_cells.corner[0][12], 36);
}

TEST(TissueCells, GetKappaTimesAnEighthOfTheirVolume) {
  const network::Material liver = testing::liver_material();
  // E = 2.5 k / s, with k that of a spring two of which in series are as stiff as a triple at rest.
  const double series = liver.kelvin * liver.spring / (liver.kelvin + liver.spring) * network::edge_area(liver, 0.012);
  const double eighth = 0.012 * 0.012 * 0.012 / 8;
  const auto expected = [&](double resistance, double k) { return resistance * 2.5 * k / 0.012 * eighth; };
  for (const network::Structure structure : {network::Structure::ctpm, network::Structure::mass_spring}) {
    const Model model = make_resisting_block(3, 3, 3, Integrator::backward_euler, 10, structure);
    for (const double k : model.tissue_cells.k) EXPECT_NEAR(k, expected(10, 2 * series), 1e-9 * k);
  }
  // A lattice edge of this structure is a whole TPM.
  const Model tpm = make_resisting_block(3, 3, 3, Integrator::backward_euler, 3, network::Structure::tpm);
  EXPECT_NEAR(tpm.tissue_cells.k[0], expected(3, series), 1e-9 * tpm.tissue_cells.k[0]);
}

TEST(TissueCells, TakeTheMeanOfTheirCornersMaterials) {
  network::OrganSettings settings;
  settings.material = testing::liver_material(), settings.inversion_resistance = 10;
  network::Material stiff = settings.material;
  stiff.stiffness_scale = 3;
  settings.layers = {{0.012, stiff}};  // the outermost spheres of the block
  Model model;
  ASSERT_TRUE(network::add_organ(model, make_block(3, 3, 3), settings));
  const double soft = make_resisting_block(2, 2, 2, Integrator::backward_euler).tissue_cells.k[0];
  for (const double k : model.tissue_cells.k) EXPECT_NEAR(k, soft * (7 * 3 + 1) / 8, 1e-9 * k);
}

TEST(TissueCells, AreLeftOutUnlessAskedFor) {
  EXPECT_EQ(network::OrganSettings{}.inversion_resistance, 0);
  const Model model = make_resisting_block(3, 3, 3, Integrator::backward_euler, 0);
  EXPECT_EQ(model.tissue_cells.size(), 0u);
  for (const auto& corner : model.tissue_cells.corner) EXPECT_TRUE(corner.empty());
}

TEST(TissueCells, RefuseAResistanceOutOfRange) {
  for (const double resistance : {-1.0, 1e9, std::nan("")}) {
    network::OrganSettings settings;
    settings.name = "block", settings.material = testing::liver_material();
    settings.inversion_resistance = resistance;
    Model model;
    const Result<Done> added = network::add_organ(model, make_block(2, 2, 2), settings);
    ASSERT_FALSE(added);
    ASSERT_EQ(added.errors().size(), 1u);
    EXPECT_NE(added.errors()[0].message.find("inversion resistance"), std::string::npos);
    EXPECT_EQ(model.sphere_count(), 0u);
  }
}

// Energy and forces.

/// A block flattened to `part` of its height.
State flattened(const Model& model, double part) {
  State state = rest_state(model);
  for (double& z : state.position.z) z *= part;
  return state;
}

TEST(Resistance, StoresNothingAboveTheThresholdAndTheParabolaBelow) {
  const Model model = make_resisting_block(3, 3, 3, Integrator::backward_euler);
  Rig rig(model);
  EXPECT_EQ(rig.resistance.energy(flattened(model, 0.401)), 0);
  for (const double force : forces_of(model, flattened(model, 0.401))) ASSERT_EQ(force, 0);
  for (const double part : {0.399, 0.2, 0.0, -1.0}) {
    const double expected = 8 * 8 * 0.5 * model.tissue_cells.k[0] * (0.4 - part) * (0.4 - part);
    EXPECT_NEAR(rig.resistance.energy(flattened(model, part)), expected, 1e-9 * expected) << part;
  }
}

TEST(Resistance, ForcesAreMinusTheGradientOfTheEnergy) {
  const Model model = make_resisting_block(3, 3, 3, Integrator::backward_euler);
  const State state = shaken(model, 5e-3);
  ASSERT_FALSE(testing::cells_below(model, state.position, 0).empty());
  const elements::Coordinates force = forces_of(model, state);
  Rig rig(model);
  const std::size_t n = model.sphere_count();
  double largest = 0;
  for (const double f : force) largest = std::max(largest, std::abs(f));
  constexpr double kMove = 1e-7;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<double> Vec3Array::*const coordinate = std::array{&Vec3Array::x, &Vec3Array::y, &Vec3Array::z}[axis];
      State ahead = state, behind = state;
      (ahead.position.*coordinate)[i] += kMove, (behind.position.*coordinate)[i] -= kMove;
      const double slope = (rig.resistance.energy(ahead) - rig.resistance.energy(behind)) / (2 * kMove);
      EXPECT_NEAR(force[axis * n + i], -slope, 1e-5 * largest) << "sphere " << i << ", axis " << axis;
    }
}

TEST(Resistance, RigidMotionGivesNoForce) {
  const Model model = make_resisting_block(3, 4, 3, Integrator::backward_euler);
  for (const Quat turn : {Quat{1, 0, 0, 0}, Quat{0, 1, 0, 0}, Quat{0.5, 0.5, -0.5, 0.5}, Quat{0.8, 0, 0.6, 0}}) {
    State state = rest_state(model);
    for (std::size_t i = 0; i < state.position.size(); ++i)
      state.position.set(i, Vec3{0.3, -2, 5} + rotate(turn, state.position[i]));
    for (const double force : forces_of(model, state)) ASSERT_EQ(force, 0);
    EXPECT_EQ(Rig(model).resistance.count_inverted(state), 0);
  }
}

TEST(Resistance, ForcesNeitherPushNorTurnTheWhole) {
  const Model model = make_resisting_block(4, 3, 3, Integrator::backward_euler);
  const State state = shaken(model, 6e-3);
  const elements::Coordinates force = forces_of(model, state);
  const std::size_t n = model.sphere_count();
  Vec3 sum, torque;
  double size = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 f{force[i], force[n + i], force[2 * n + i]};
    sum += f, torque += cross(state.position[i], f), size += norm(f);
  }
  ASSERT_GT(size, 0);
  EXPECT_LT(norm(sum), 1e-12 * size);
  EXPECT_LT(norm(torque), 1e-12 * size);
}

// Linearisation.

TEST(LinearisedResistance, IsTheSecondDerivativeWhereLittleIsMissing) {
  const Model model = make_resisting_block(3, 3, 3, Integrator::backward_euler);
  const State state = flattened(model, 0.4 - 1e-4);
  const std::size_t n = model.sphere_count();
  State moving = state;
  testing::shake(moving, 0, 1);
  elements::Coordinates v(3 * n), product(3 * n);
  for (std::size_t i = 0; i < n; ++i)
    v[i] = moving.velocity.x[i], v[n + i] = moving.velocity.y[i], v[2 * n + i] = moving.velocity.z[i];
  constexpr double kStep = 1e-3, kMove = 1e-9;
  Rig rig(model);
  const auto linearised = rig.resistance.linearise(state, kStep, rig.force, rig.blocks);
  linearised.apply(v.data(), product.data());
  State ahead = state, behind = state;
  for (std::size_t i = 0; i < n; ++i)
    ahead.position.add(i, kMove * moving.velocity[i]), behind.position.add(i, -kMove * moving.velocity[i]);
  const elements::Coordinates f = forces_of(model, ahead), g = forces_of(model, behind);
  double largest = 0;
  for (const double p : product) largest = std::max(largest, std::abs(p));
  // The part of the second derivative that is left out is proportional to what is missing.
  for (std::size_t i = 0; i < 3 * n; ++i)
    EXPECT_NEAR(product[i], -kStep * kStep * (f[i] - g[i]) / (2 * kMove), 2e-3 * largest) << i;
}

TEST(LinearisedResistance, HasTheBlocksOfItsMatrixAndTakesThemBackToTheBit) {
  const Model model = make_resisting_block(3, 3, 3, Integrator::backward_euler);
  const State state = shaken(model, 6e-3);
  const std::size_t n = model.sphere_count();
  Rig rig(model);
  testing::Noise noise;
  for (double& entry : rig.blocks) entry = noise.next();
  const elements::DiagonalBlocks before = rig.blocks;
  {
    const auto linearised = rig.resistance.linearise(state, 1e-3, rig.force, rig.blocks);
    ASSERT_NE(rig.blocks, before);
    constexpr std::size_t kEntry[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    for (std::size_t column = 0; column < 3 * n; ++column) {
      elements::Coordinates unit(3 * n), product(3 * n);
      unit[column] = 1;
      linearised.apply(unit.data(), product.data());
      EXPECT_GE(product[column], 0);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t entry = kEntry[column / n][axis] * n + column % n;
        EXPECT_NEAR(product[axis * n + column % n], rig.blocks[entry] - before[entry], 1e-12);
      }
    }
  }
  EXPECT_EQ(rig.blocks, before);
}

TEST(LinearisedResistance, IsNothingInAModelWithoutCells) {
  const Model model = make_resisting_block(3, 3, 3, Integrator::backward_euler, 0);
  const State state = flattened(model, -1);
  Rig rig(model);
  EXPECT_FALSE(rig.resistance.any());
  const auto linearised = rig.resistance.linearise(state, 1e-3, rig.force, rig.blocks);
  for (const double force : rig.force) ASSERT_EQ(force, 0);
  const elements::Coordinates unit(rig.force.size(), 1.0);
  linearised.apply(unit.data(), rig.force.data());
  for (const double product : rig.force) ASSERT_EQ(product, 0);
  EXPECT_EQ(rig.resistance.count_inverted(state), 0);
}

// The search for cells.

TEST(CellCheck, FindsExactlyTheCellsBelowALimitInOrder) {
  Model model = make_resisting_block(18, 11, 9, Integrator::backward_euler);
  FilledOrgan ragged = make_block(7, 6, 5);
  for (std::size_t i : {100u, 57u, 3u})
    ragged.cell.erase(ragged.cell.begin() + long(i)), ragged.centre.erase(ragged.centre.begin() + long(i)),
        ragged.layer.erase(ragged.layer.begin() + long(i)), ragged.depth.erase(ragged.depth.begin() + long(i));
  network::OrganSettings settings;
  settings.material = testing::liver_material(), settings.inversion_resistance = 1;
  ASSERT_TRUE(network::add_organ(model, ragged, settings));
  // A third organ whose lattice lies across the world's axes.
  for (Vec3& centre : ragged.centre) centre = rotate({0.8, 0, 0.6, 0}, centre);
  ASSERT_TRUE(network::add_organ(model, ragged, settings));
  const parallel::Slabs slabs(model.sphere_count());
  ASSERT_GT(slabs.count(), 1);
  for (const elements::InstructionSet set :
       {elements::InstructionSet::baseline, elements::InstructionSet::avx2, elements::InstructionSet::avx512}) {
    inversion::CellCheck check(model, slabs, elements::kernels_for(set));
    std::size_t all = 0;
    for (const double amount : {0.0, 1e-3, 2e-3, 3e-3, 4e-3, 6e-3, 10e-3})
      for (const double limit : {0.0, model.inversion_threshold}) {
        const State state = shaken(model, amount);
        std::vector<std::size_t> found;
        for (int slab = 0; slab < slabs.count(); ++slab)
          check.find(slab, state.position, limit, [&](std::size_t cell) { found.push_back(cell); });
        EXPECT_EQ(found, testing::cells_below(model, state.position, limit)) << amount << ", " << limit;
        all += found.size();
      }
    EXPECT_GT(all, 100u);
  }
}

TEST(CellCheck, FindsASingleCellThatIsInsideOut) {
  const Model model = make_resisting_block(5, 4, 4, Integrator::backward_euler);
  Rig rig(model);
  for (std::size_t sphere = 0; sphere < model.sphere_count(); ++sphere)
    for (const Vec3 push : {Vec3{0.013, 0, 0}, {0, -0.013, 0}, {0, 0, 0.013}, {0, 0.013, 0.013}}) {
      State state = rest_state(model);
      state.position.add(sphere, push);
      EXPECT_EQ(std::size_t(rig.resistance.count_inverted(state)),
                testing::cells_below(model, state.position, 0).size());
    }
}

// Cells that a blade cut.

TEST(Resistance, EndsInACellThatLostOneOfItsTwelveEdges) {
  Model model = make_resisting_block(2, 2, 2, Integrator::backward_euler);
  model.tools = {testing::scalpel(0.05)};
  ASSERT_EQ(model.tissue_cells.size(), 1u);
  Rig rig(model);
  State state = flattened(model, -1);
  const double whole = rig.resistance.energy(state);
  EXPECT_GT(whole, 0);
  int edges = 0;
  for (std::size_t e = 0; e < model.axial.size(); ++e) {
    const bool is_edge = model.axial.rest_length[e] < 0.013;
    edges += is_edge;
    state.axial_severed[e] = 1;
    EXPECT_EQ(rig.resistance.energy(state), is_edge ? 0 : whole) << e;
    EXPECT_EQ(rig.resistance.count_inverted(state), is_edge ? 0 : 1) << e;
    state.axial_severed[e] = 0;
  }
  EXPECT_EQ(edges, 12);
  EXPECT_EQ(rig.resistance.energy(state), whole);
}

}  // namespace
}  // namespace ctpm
