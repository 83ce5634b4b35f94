// Forces on a blade.

#include "core/contact/blade_force.h"

#include <numbers>
#include <numeric>
#include <tuple>

#include "core/elements/forces.h"
#include "tests/core/blade_blocks.h"

namespace ctpm {
namespace {

using testing::blade_at;
using testing::block_with_blade;
using testing::cut_through;
using testing::free_block;
using testing::held_block;
using testing::kFriction;
using testing::kinetic_energy;
using testing::kToughness;
using testing::make_block;
using testing::momentum;
using testing::resisting;
using testing::Work;

TEST(BladeForce, EveryPlaneOpensItsOwnAreaWhicheverWayItLies) {
  for (const network::LatticeKind lattice : {network::LatticeKind::cubic_18, network::LatticeKind::cubic_6}) {
    network::OrganSettings settings;
    settings.material = resisting(), settings.lattice = lattice;
    Model model;
    const FilledOrgan block = make_block(7, 7, 7);
    ASSERT_TRUE(network::add_organ(model, block, settings));
    const std::int32_t middle = 3 + 7 * (3 + 7 * 3);
    testing::Noise noise;
    for (int trial = 0; trial < 50; ++trial) {
      const Vec3 wild = noise.next_vec3(), n = wild / norm(wild);
      double opened = 0;  // energy per area of a plane with the normal n, from the elements of one sphere
      const AxialElements& axial = model.axial;
      for (std::size_t e = 0; e < axial.size(); ++e) {
        if (axial.a[e] != middle && axial.b[e] != middle) continue;
        const Vec3 d = model.rest_position[std::size_t(axial.b[e])] - model.rest_position[std::size_t(axial.a[e])];
        // A sphere has two elements of each direction; a volume s^3 has one.
        opened += 0.5 * model.cut_resistance.energy[e] * std::abs(dot(n, d)) / norm(d) * std::abs(dot(n, d)) /
                  std::pow(block.spacing, 3);
      }
      EXPECT_NEAR(opened, kToughness, 1e-9 * kToughness);
    }
  }
}

TEST(BladeForce, TheHandsWorkIsTheToughnessTimesTheAreaAtEverySpeed) {
  const Model model = held_block(6, 5, 4);
  for (const double per_tick : {2e-5, 1e-4, 1e-3})
    for (const Vec3 way : {Vec3{0, 0.12, 0}, Vec3{0.03, 0.12, 0}}) {
      const Work work = cut_through(model, per_tick, {-0.0131 * way.x / 0.03 + 0.0002, -0.06, -0.05}, way);
      const double expected = kToughness * 0.048 * 0.036 * norm(way) / way.y;
      // The force of a tick is that at its start, so the blade pays for up to one tick more than it cuts.
      const double most = 0.005 + per_tick * way.y / norm(way) / 0.048;
      EXPECT_NEAR(work.by_hand, expected, most * expected) << per_tick * 1e3 << " mm a tick along " << way.x;
      const double area = testing::swept_area(work.state, {-1, -0.024, 0}, {1, 0.024, 0.036});
      EXPECT_NEAR(kToughness * area, expected, 0.01 * expected);
    }
}

TEST(BladeForce, IsTakenUpByMoreTissueWhereThatIsToughAndSoft) {
  const auto reach = [](double toughness, double young_ratio, double layer_ratio) {
    network::OrganSettings settings;
    settings.material = resisting(toughness), settings.material.stiffness_scale *= young_ratio;
    settings.layers = {{0.012, settings.material}};
    settings.layers[0].material.stiffness_scale *= layer_ratio;
    Model model;
    EXPECT_TRUE(network::add_organ(model, make_block(5, 5, 5), settings));
    return std::pair(model.organs[0].blade_reach, model.organs[0].modulus);
  };
  const auto [of_liver, modulus] = reach(kToughness, 1, 1);
  // The pull J_c per length, spread over a half cylinder, strains the tissue by 6 %.
  EXPECT_NEAR(of_liver, kToughness / (std::numbers::pi * 0.06 * modulus), 1e-12);
  EXPECT_NEAR(reach(2 * kToughness, 1, 1).first, 2 * of_liver, 1e-12);
  EXPECT_NEAR(reach(kToughness, 0.5, 1).first, 2 * of_liver, 1e-12);
  EXPECT_NEAR(reach(kToughness, 1, 0.5).first, 2 * of_liver, 1e-12) << "the softest layer counts";
  EXPECT_NEAR(reach(kToughness, 1, 2).first, of_liver, 1e-12);
  EXPECT_EQ(reach(0, 1, 1).first, 0) << "nothing resists";
}

/// A block that is held all around but above, with sides of 36 mm and 18 mm and one row of spheres more.
Model clamped_block(double spacing, const network::Material& material) {
  const int f = int(std::lround(0.012 / spacing)), n = 6 * f;
  Model model =
      testing::make_block_model(n, n, 3 * f, network::Structure::ctpm, material, spacing, /*inversion_resistance=*/10);
  const auto at_rim = [&](std::int32_t cell) { return cell == 0 || cell == n - 1; };
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    model.held_axes[i] = at_rim(model.cell.i[i]) || at_rim(model.cell.j[i]) || model.cell.k[i] == 0 ? kAnchored : 0;
  model.tools = {testing::scalpel(0.05)};
  return model;
}

/// A straight cut through the middle of a clamped block.
struct Cut {
  double ratio;    ///< of the hand's work to toughness times area plus viscous losses
  double mean;     ///< force in the middle 30 mm [N]
  double chatter;  ///< RMS about a moving mean of 6 mm, over the mean
  double jump;     ///< largest change of the force in a tick, over the mean
};

Cut cut_block(double spacing, double toughness, double degrees) {
  constexpr double kPerTick = 3e-5, kHalfWay = 0.055, kMiddle = 0.015, kHalfWindow = 0.003;
  const Model model = clamped_block(spacing, resisting(toughness));
  stepping::Stepper stepper(model);
  State state = rest_state(model), before = state;
  const double angle = degrees * 3.14159265358979323846 / 180;
  const Vec3 way{std::sin(angle), std::cos(angle), 0};
  std::vector<double> force, place;
  double by_hand = 0, lost = 0;
  for (double y = -kHalfWay; y <= kHalfWay; y += kPerTick) {
    before = state;
    const stepping::StepReport report = stepper.step(state, blade_at(Vec3{0.0013, 0.0007, -0.008} + y * way));
    force.push_back(-dot(report.tool_force, way)), place.push_back(y);
    by_hand += kPerTick * force.back(), lost += elements::viscous_work(model, before, state);
  }
  const Vec3 high{2.5 * 0.012 + (0.012 - spacing) / 2, 2.5 * 0.012 + (0.012 - spacing) / 2, 0.036 - spacing};
  const double area = testing::swept_area(state, {-high.x, -high.y, 0}, high);
  Cut cut{by_hand / (toughness * area + lost), 0, 0, 0};
  const auto window = std::ptrdiff_t(kHalfWindow / kPerTick);
  int count = 0;
  for (std::ptrdiff_t i = window + 1; i + window < std::ptrdiff_t(force.size()); ++i) {
    if (std::abs(place[std::size_t(i)]) > kMiddle) continue;
    const double around =
        std::accumulate(force.begin() + i - window, force.begin() + i + window + 1, 0.0) / double(2 * window + 1);
    const double f = force[std::size_t(i)], off = f - around;
    cut.mean += f, cut.chatter += off * off, ++count;
    cut.jump = std::max(cut.jump, std::abs(f - force[std::size_t(i) - 1]));
  }
  cut.mean /= count, cut.chatter = std::sqrt(cut.chatter / count) / cut.mean, cut.jump /= cut.mean;
  return cut;
}

void expect_no_lattice(double spacing, double most_chatter, double toughness, const std::vector<double>& turns) {
  double least = INFINITY, most = 0;
  for (const double degrees : turns) {
    const Cut cut = cut_block(spacing, toughness, degrees);
    const auto where = ::testing::Message() << spacing << " m, " << toughness << " J/m^2, " << degrees << " degrees";
    EXPECT_NEAR(cut.ratio, 1, 0.05) << where;
    EXPECT_LT(cut.chatter, most_chatter) << where;
    EXPECT_LT(cut.jump, 0.05) << where;
    least = std::min(least, cut.mean), most = std::max(most, cut.mean);
  }
  EXPECT_LT(most, 1.05 * least) << spacing << " m, " << toughness << " J/m^2";
}

TEST(BladeForce, IsTheTissuesAndNotTheLattices) {
  for (const double toughness : {20.0, 1000.0}) expect_no_lattice(0.012, 0.05, toughness, {0, 30, 45});
}

TEST(BladeForce, IsTheTissuesAtEveryToughnessTurnAndSpacingSlow) {
  for (const double toughness : {20.0, kToughness, 500.0, 1000.0})
    expect_no_lattice(0.012, 0.05, toughness, {0, 20, 30, 45});
  for (const double toughness : {200.0, 1000.0}) expect_no_lattice(0.006, 0.03, toughness, {0, 20, 30, 45});
}

TEST(BladeForce, RisesFromNothingAndIsGoneAfterTheCut) {
  const Model model = block_with_blade(6, 5, 4, resisting());
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  double before = 0, while_cutting = 0;
  int severed = 0;
  stepping::StepReport report;
  for (int i = 0; i < 2400; ++i) {
    report = stepper.step(state, blade_at({0.0002, -0.06 + 5e-5 * i, -0.05}));
    ASSERT_EQ(report.status, stepping::StepStatus::ok);
    severed += report.severed;
    const double force = norm(report.tool_force);
    if (i < 300) {
      EXPECT_EQ(force, 0) << "far from the block, tick " << i;
    }
    EXPECT_LT(force, before + 0.2 * kToughness * 0.036) << "the force jumps up in tick " << i;
    before = force;
    while_cutting = std::max(while_cutting, force);
  }
  EXPECT_GT(severed, 0);
  // The cutting force is J_c times the height of the block.
  const double steady = kToughness * 0.036;
  EXPECT_GT(while_cutting, 0.95 * steady);
  EXPECT_LT(while_cutting, 1.5 * steady) << "soft tissue is stretched along the edge";
  EXPECT_EQ(norm(report.tool_force), 0) << "the blade has left";
}

TEST(BladeForce, ARestingBladeGoesOnHoldingTheTissueBack) {
  const Model model = block_with_blade(6, 5, 4, resisting());
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  stepping::StepReport report;
  double y = -0.06;
  for (; y < 0 && report.tool_force.y > -1; y += 5e-5) report = stepper.step(state, blade_at({0.0002, y, -0.05}));
  ASSERT_LT(y, 0);
  for (int i = 0; i < 50; ++i) {
    // The hand trembles by 20 micrometres; the force must not jump.
    const double before = report.tool_force.y;
    report = stepper.step(state, blade_at({0.0002, y + (i % 2 ? 2e-5 : 0.0), -0.05}));
    EXPECT_LT(report.tool_force.y, -0.1);
    if (i > 0) {
      EXPECT_NEAR(report.tool_force.y, before, 0.15 * kToughness * 0.036) << i;
    }
  }
}

TEST(BladeForce, FlanksRubUntilTheBladeLeavesWhateverTheSpheres) {
  for (const auto& [spacing, flank_height] : {std::pair{0.012, 0.006}, {0.006, 0.006}, {0.006, 0.009}}) {
    Model model = clamped_block(spacing, resisting(0, kFriction));
    model.held_axes.assign(model.sphere_count(), kAnchored);
    model.tools[0].flank_height = flank_height;
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    double sum = 0;
    int inside = 0;
    stepping::StepReport report;
    for (int i = 0; i < 1200; ++i) {
      const double y = -0.06 + 1e-4 * i;
      report = stepper.step(state, blade_at({0.0002, y, -0.01}));
      EXPECT_LE(report.tool_force.y, 0);
      if (std::abs(y) < 0.015) sum -= report.tool_force.y, ++inside;
    }
    const double expected = 2 * kFriction * flank_height * (0.036 - spacing);  // two flanks
    EXPECT_NEAR(sum / inside, expected, 0.02 * expected) << spacing;
    EXPECT_EQ(norm(report.tool_force), 0);
  }
}

/// Force [N] on a blade halfway through a held block, at `per_tick` [m] per tick, after the right half of the block has
/// moved to the right by `opened` [m].
double friction_in_opened_cut(const Tool& blade, double opened, double per_tick) {
  Model model = held_block(6, 5, 4, resisting(0, kFriction));
  model.tools = {blade};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  double y = -0.06;
  for (; y < 0; y += 1e-3) (void)stepper.step(state, blade_at({0.0002, y, -0.05}));
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (state.position.x[i] > 0) state.position.x[i] += opened;
  (void)stepper.step(state, blade_at({0.0002, y, -0.05}));
  return -stepper.step(state, blade_at({0.0002, y + per_tick, -0.05})).tool_force.y;
}

TEST(BladeForce, CutFacesLeaveTheFlanksWhereTheyOpenWiderThanTheBlade) {
  Tool blade = testing::scalpel(0.2);
  const double closed = friction_in_opened_cut(blade, 0, 1e-3);
  EXPECT_GT(closed, 0.1);
  EXPECT_EQ(friction_in_opened_cut(blade, 0.003, 1e-3), 0) << "1 mm thick";
  blade.blade_thickness = 0.03;
  EXPECT_GT(friction_in_opened_cut(blade, 0.003, 1e-3), 0.8 * closed) << "30 mm thick";
}

TEST(BladeForce, SlicingAlongTheEdgeMakesPushingEasier) {
  // Atkins, Xu & Jeronimidis, "Cutting, by pressing and slicing", J. Mater. Sci. 39, 2004: with the
  // slice-push ratio xi the push falls to 1 / (1 + xi^2), and the slice is xi times that.
  Model model = clamped_block(0.006, resisting());
  model.held_axes.assign(model.sphere_count(), kAnchored);
  model.tools = {testing::scalpel(0.2)};
  const auto mean_force = [&](double xi) {
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    Vec3 sum;
    int inside = 0;
    for (int i = 0; i < 600; ++i) {
      const double y = -0.05 + 1e-4 * i;
      const stepping::StepReport report = stepper.step(state, blade_at({0.0002, y, -0.1 + xi * (y + 0.05)}));
      if (std::abs(y) < 0.012) sum += report.tool_force, ++inside;
    }
    return sum / inside;
  };
  const double push = -mean_force(0).y;
  EXPECT_NEAR(push, kToughness * 0.030, 0.02 * push);
  for (const double xi : {0.5, 1.0}) {
    const Vec3 force = mean_force(xi);
    EXPECT_NEAR(-force.y, push / (1 + xi * xi), 0.03 * push) << xi;
    EXPECT_NEAR(-force.z, xi * push / (1 + xi * xi), 0.03 * push) << xi;
  }
}

TEST(BladeForce, TheTissueFeelsWhatTheHandFeels) {
  const Model model = free_block(6, 5, 4, resisting(kToughness, kFriction));
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  Vec3 before;
  double largest = 0;
  for (const double per_tick : {1e-4, 4e-3})
    for (int i = 0; i < 300; ++i) {
      const Vec3 middle = state.position[70];
      const stepping::StepReport report =
          stepper.step(state, blade_at({0.0002 + 1e-5 * i, middle.y - 0.04 + per_tick * (i % 25), -0.05}));
      const Vec3 now = momentum(model, state), gained = now - before;
      EXPECT_NEAR(norm(gained + model.tick * report.tool_force), 0, 1e-9 + 1e-5 * norm(gained)) << i;
      largest = std::max(largest, norm(report.tool_force));
      before = now;
    }
  EXPECT_GT(largest, 1);
}

TEST(BladeForce, TissueNeverGainsMoreEnergyThanTheHandGives) {
  for (const double per_tick : {1e-4, 2e-3, 0.03}) {
    const Model model = free_block(6, 5, 4, resisting(kToughness, kFriction));
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    double given = 0;
    const int ticks = int(0.12 / per_tick);
    for (int i = 0; i <= ticks + 50; ++i) {
      const int moved = std::min(i, ticks);
      const stepping::StepReport report = stepper.step(state, blade_at({0.0002, -0.06 + per_tick * moved, -0.05}));
      if (i > 0 && i <= ticks) given -= per_tick * report.tool_force.y;
      EXPECT_LE(elements::elastic_energy(model, state) + kinetic_energy(model, state), given + 1e-9) << "tick " << i;
    }
    // A blade that is through within a few ticks has not been felt.
    if (per_tick < 0.01) {
      EXPECT_GT(given, 0);
    }
  }
}

TEST(BladeForce, LightTissueIsDrawnAlongAndNotThrownPastTheBlade) {
  // The force that holds such a sheet would bring it to many times the blade's speed within a tick.
  for (const Integrator integrator : {Integrator::backward_euler, Integrator::sdirk2}) {
    Model model = free_block(7, 7, 2);
    for (double& mass : model.mass) mass *= 1e-3;
    model.solver.integrator = integrator;
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    constexpr double kPerTick = 5e-4;
    double fastest = 0;
    for (int i = 0; i < 200; ++i) {
      ASSERT_LE(stepper.step(state, blade_at({0.0002, -0.04 + kPerTick * i, -0.05})).status,
                stepping::StepStatus::not_converged);
      for (std::size_t s = 0; s < model.sphere_count(); ++s) fastest = std::max(fastest, norm(state.velocity[s]));
    }
    EXPECT_GT(fastest, 0) << "the blade never touched";
    EXPECT_LT(fastest, 2 * kPerTick / model.tick) << int(integrator);
  }
}

TEST(BladeForce, AStabAlongTheBladeCutsASlitAsWideAsTheBlade) {
  Model model = testing::held_block(9, 9, 6);
  model.tools[0].blade_thickness = 1e-6;  // a held block gives way to no wedge
  const double height = model.tools[0].flank_height, deep = 0.03;
  Vec3 low = model.rest_position[0], high = low;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const Vec3 p = model.rest_position[i];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 above{0.5 * (low.x + high.x) + 0.0013, 0.5 * (low.y + high.y) + 0.0021, high.z + 0.02};
  const testing::Work work = testing::cut_through(model, 2e-5, above, {0, 0, -(0.02 + deep)});
  const double area = testing::swept_area(work.state, low, high);
  // The point is ground at 45 degrees: its corner is missing from the slit.
  EXPECT_NEAR(area, height * deep - 0.5 * height * height, 0.1 * height * deep);
  EXPECT_NEAR(work.by_hand, testing::kToughness * area, 0.1 * testing::kToughness * area);
  EXPECT_GT(std::count(work.state.axial_severed.begin(), work.state.axial_severed.end(), 1), 0);
}

}  // namespace
}  // namespace ctpm
