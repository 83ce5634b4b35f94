// A ball that is drawn over a flat block: a smooth surface gives a steady force.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "studio/fidelity/recipes.h"
#include "studio/output/number_text.h"

namespace ctpm::fidelity {
namespace {

constexpr double kHeight = 60e-3, kSpeed = 20e-3, kWait = 1.0;
constexpr double kLead = 12e-3, kHalfWay = 18e-3;  // the force is read over 36 mm, after a lead
constexpr double kLeastForce = 1e-6;               // [N]
constexpr double kAcross = std::numbers::pi / 6;   // to the lattice

/// Presses, waits and draws; fills the row's series with what is felt on the last 36 mm of the way.
void draw_ball(const Body& body, std::int32_t tool, DragResult::Row& row) {
  const Vec3 along{std::cos(row.angle), std::sin(row.angle), 0};
  const double tick = body.model.tick;
  stepping::Stepper stepper(body.model);
  State state = rest_state(body.model);
  const auto step = [&](double way, double depth) {
    const PressSite site{Vec3{0, 0, kHeight} + way * along, {0, 0, -1}};
    return stepper.step(state, ball_at(tool, ball_centre(body, tool, site, depth)));
  };
  const double from = -kHalfWay - kLead;
  for (double depth = 0; depth < row.depth; depth += kSpeed * tick) (void)step(from, depth);
  for (double time = 0; time < kWait; time += tick) (void)step(from, row.depth);
  for (double way = from; way < kHalfWay; way += kSpeed * tick) {
    const Vec3 force = step(way, row.depth).tool_force;
    if (way < -kHalfWay) continue;
    row.way.push_back(way), row.normal.push_back(force.z);
    row.tangential.push_back(std::hypot(force.x, force.y));
    row.lost_ticks += norm(force) < kLeastForce;
  }
}

/// Values without the parabola over x that fits them best: Legendre polynomials, orthogonal over an even way.
std::vector<double> without_trend(const std::vector<double>& values) {
  const auto count = double(values.size());
  const auto at = [&](std::size_t i) { return (2 * double(i) + 1) / count - 1; };
  double slope = 0, bend = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = at(i);
    slope += 3 * values[i] * x / count, bend += 5 * values[i] * 0.5 * (3 * x * x - 1) / count;
  }
  std::vector<double> rest = values;
  for (std::size_t i = 0; i < values.size(); ++i) rest[i] -= slope * at(i) + bend * 0.5 * (3 * at(i) * at(i) - 1);
  return rest;
}

void judge(DragResult::Row& row) {
  row.ripple = spread_of(without_trend(row.normal));
  row.peak_to_peak = row.ripple.mean > 0 ? (row.ripple.most - row.ripple.least) / row.ripple.mean
                                         : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < row.normal.size(); ++i)
    if (row.normal[i] > kLeastForce) row.most_friction = std::max(row.most_friction, row.tangential[i] / row.normal[i]);
}

std::string name_of(const DragResult::Row& row) {
  return "ball of " + output::short_number(1e3 * row.ball) + " mm, " + output::short_number(1e3 * row.depth) +
         " mm deep, " + (row.angle == 0 ? "along the lattice" : "30 degrees across");
}

}  // namespace

Result<DragResult> measure_drag(std::span<const double> radii, bool is_quick) {
  const std::vector<double> balls{4e-3, 10e-3, 20e-3};
  DragResult result;
  for (const double radius : radii) {
    const Specimen specimen = block({96e-3, 96e-3, kHeight}, radius, Pace::live, balls);
    result.friction = specimen.friction;
    const Result<Body> body = make_body(specimen);
    if (!body) return body.errors();
    std::vector<DragResult::Row> rows;
    std::vector<std::int32_t> tools;
    for (std::size_t b = is_quick ? 1 : 0; b < (is_quick ? 2 : balls.size()); ++b)
      for (const double depth : {2e-3, 6e-3})
        for (const double angle : is_quick ? std::vector{kAcross} : std::vector{0.0, kAcross}) {
          rows.push_back({.radius = radius,
                          .ball = balls[b],
                          .depth = depth,
                          .angle = angle,
                          .way = {},
                          .normal = {},
                          .tangential = {},
                          .ripple = {}});
          tools.push_back(std::int32_t(b));
        }
    in_parallel(rows.size(), [&](std::size_t i) { draw_ball(*body, tools[i], rows[i]), judge(rows[i]); });
    result.rows.insert(result.rows.end(), rows.begin(), rows.end());
  }
  return result;
}

Chapter chapter_of(const DragResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "drag", section.title = "A ball drawn over a flat block";
  section.paragraphs = {
      "A block of 96 x 96 x 60 mm with the preset's viscosity; the ball goes down, waits for 1 s and is drawn at 20 "
      "mm/s and constant depth. The normal force is read over 36 mm about the middle, after a lead of 12 mm; its "
      "ripple is the standard deviation over the mean, without the parabola that the ends of the block leave. "
      "Coulomb's coefficient is " +
      output::short_number(result.friction) +
      "; the sideways force also holds the dent that a viscous body drags along."};
  reports::Table table;
  table.columns = {{"radius_mm", "r [mm]"},
                   {"ball_mm", "ball [mm]"},
                   {"depth_mm", "depth [mm]"},
                   {"angle_deg", "across the lattice [deg]", 3},
                   {"mean_n", "mean force [N]"},
                   {"ripple_percent", "ripple, RMS [%]", 3},
                   {"peak_to_peak_percent", "peak to peak [%]", 3},
                   {"lost_ticks", "ticks without contact"},
                   {"most_friction", "largest friction", 3}};
  for (const DragResult::Row& row : result.rows) {
    table.rows.push_back({1e3 * row.radius, 1e3 * row.ball, 1e3 * row.depth, row.angle * 180 / std::numbers::pi,
                          row.ripple.mean, 100 * row.ripple.deviation, 100 * row.peak_to_peak, row.lost_ticks,
                          row.most_friction});
    const Figure figure{.recipe = "drag", .radius = row.radius, .source = "a smooth surface"};
    Figure ripple = figure, lost = figure, friction = figure;
    ripple.name = "ripple, " + name_of(row), ripple.measured = 100 * row.ripple.deviation, ripple.unit = "%";
    ripple.goal = Goal{{}, 3};
    lost.name = "ticks without contact, " + name_of(row), lost.measured = double(row.lost_ticks), lost.unit = "1";
    lost.goal = Goal{{}, 0};
    friction.name = "largest friction, " + name_of(row), friction.measured = row.most_friction;
    friction.reference = result.friction, friction.source = "Coulomb, without the dent that a viscous body drags along";
    chapter.figures.insert(chapter.figures.end(), {ripple, lost, friction});
  }
  section.tables = {table};
  for (const double radius : {4e-3, 2e-3}) {
    reports::Plot plot{.title = "normal force, r = " + output::short_number(1e3 * radius) + " mm, along the lattice",
                       .x_title = "way [mm]",
                       .y_title = "normal force over its mean"};
    for (const DragResult::Row& row : result.rows) {
      if (row.radius != radius || row.angle != 0 || row.depth < 6e-3) continue;
      reports::Series series{.name = "ball of " + output::short_number(1e3 * row.ball) + " mm, 6 mm deep"};
      for (std::size_t i = 0; i < row.way.size(); i += 10)
        series.x.push_back(1e3 * row.way[i]), series.y.push_back(row.normal[i] / row.ripple.mean);
      plot.series.push_back(series);
    }
    if (!plot.series.empty()) section.plots.push_back(plot);
  }
  return chapter;
}

}  // namespace ctpm::fidelity
