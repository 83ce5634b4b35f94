// A ball that holds tissue sideways: below the cone it sticks, beyond it slips.

#include <algorithm>
#include <cmath>

#include "studio/fidelity/recipes.h"
#include "studio/output/number_text.h"

namespace ctpm::fidelity {
namespace {

constexpr double kHeight = 60e-3, kBall = 10e-3, kDepth = 4e-3;
constexpr double kSideways = 0.3e-3, kSlip = 24e-3;                // [m]
constexpr double kSpeed = 10e-3, kWaitBefore = 2.0, kHold = 10.0;  // [m/s], [s], [s]
/// So slow that the dent relaxes as it moves: viscous tissue would add to Coulomb's friction.
constexpr double kSlipSpeed = 2e-3;  // [m/s]

}  // namespace

double GripResult::friction_at(double time) const {
  const auto nearest = std::min_element(held.begin(), held.end(), [&](const Sample& a, const Sample& b) {
    return std::abs(a.time - time) < std::abs(b.time - time);
  });
  return nearest == held.end() ? std::nan("") : nearest->friction;
}

Result<GripResult> measure_grip(double radius) {
  const Specimen specimen = block({96e-3, 96e-3, kHeight}, radius, Pace::live, {kBall});
  const Result<Body> body = make_body(specimen);
  if (!body) return body.errors();
  stepping::Stepper stepper(body->model);
  State state = rest_state(body->model);
  GripResult result;
  result.radius = radius, result.coefficient = specimen.friction;
  const double tick = body->model.tick;
  Vec3 before;  // an uneven surface pushes sideways before anything has moved; only what is added is grip
  const auto force_at = [&](double way, double depth) {
    const PressSite site{{way, 0, kHeight}, {0, 0, -1}};
    return stepper.step(state, ball_at(0, ball_centre(*body, 0, site, depth))).tool_force;
  };
  const auto friction = [&](double way, double depth) {
    const Vec3 force = force_at(way, depth);
    return force.z > 0 ? std::hypot(force.x - before.x, force.y - before.y) / force.z : std::nan("");
  };
  for (double depth = 0; depth < kDepth; depth += kSpeed * tick) (void)force_at(0, depth);
  for (double time = 0; time < kWaitBefore; time += tick) before = force_at(0, kDepth);
  for (double way = 0; way < kSideways; way += kSpeed * tick) (void)friction(way, kDepth);
  for (std::int64_t t = 1; double(t) * tick <= kHold + 0.5 * tick; ++t)
    result.held.push_back({double(t) * tick, friction(kSideways, kDepth)});
  before = {};
  for (std::int64_t t = 1; double(t) * tick * kSlipSpeed <= kSlip; ++t)
    result.slips.push_back({double(t) * tick, friction(kSideways + double(t) * tick * kSlipSpeed, kDepth)});
  return result;
}

Chapter chapter_of(const GripResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "grip", section.title = "Grip";
  section.paragraphs = {
      "A ball of 10 mm, 4 mm deep in a block (r = " + output::short_number(1e3 * result.radius) +
      " mm), moves sideways by 0.3 mm, far below Coulomb's cone of " + output::short_number(result.coefficient) +
      ", waits for 10 s and then moves on by 24 mm at 2 mm/s, so slowly that the dent moves with it. Tissue relaxes "
      "within 1 s, so what is lost after that is grip."};
  reports::Table table;
  table.columns = {{"time_s", "waited [s]"}, {"friction", "tangential over normal force", 3}};
  for (const double time : {0.05, 0.3, 1.0, 3.0, 6.0, 10.0}) table.rows.push_back({time, result.friction_at(time)});
  section.tables = {table};
  double slipping = 0, most = 0;
  const std::size_t half = result.slips.size() / 2;
  for (std::size_t i = 0; i < result.slips.size(); ++i) {
    most = std::max(most, result.slips[i].friction);
    if (i >= half) slipping += result.slips[i].friction / double(result.slips.size() - half);
  }
  const double mu = result.coefficient;
  chapter.figures = {{.recipe = "grip",
                      .name = "friction after 10 s over that after 1 s",
                      .radius = result.radius,
                      .measured = result.friction_at(10) / result.friction_at(1),
                      .reference = 1.0,
                      .source = "Coulomb: it sticks",
                      .goal = Goal{0.95, 1.05}},
                     {.recipe = "grip",
                      .name = "mean friction while it slips",
                      .radius = result.radius,
                      .measured = slipping,
                      .reference = mu,
                      .source = "Coulomb's cone",
                      .goal = Goal{0.9 * mu, 1.1 * mu}},
                     {.recipe = "grip",
                      .name = "largest friction while it slips",
                      .radius = result.radius,
                      .measured = most,
                      .reference = mu,
                      .source = "Coulomb's cone",
                      .goal = Goal{{}, 1.1 * mu}}};
  reports::Plot plot{.title = "friction", .x_title = "time [s]", .y_title = "tangential over normal force"};
  reports::Series held{.name = "0.3 mm sideways"}, slips{.name = "24 mm further"},
      cone{.name = "cone", .stroke = reports::Stroke::dashed};
  for (std::size_t i = 0; i < result.held.size(); i += 10)
    held.x.push_back(result.held[i].time), held.y.push_back(result.held[i].friction);
  const double last = result.held.empty() ? 0 : result.held.back().time;
  for (std::size_t i = 0; i < result.slips.size(); i += 5)
    slips.x.push_back(last + result.slips[i].time), slips.y.push_back(result.slips[i].friction);
  cone.x = {0, slips.x.empty() ? last : slips.x.back()}, cone.y = {mu, mu};
  plot.series = {held, slips, cone};
  section.plots = {plot};
  return chapter;
}

}  // namespace ctpm::fidelity
