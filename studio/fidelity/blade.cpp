// A blade through a block: its force is the tissue's, whatever the lattice.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/cutting/opening.h"
#include "core/cutting/swept_surface.h"
#include "core/elements/forces.h"
#include "studio/fidelity/recipes.h"
#include "studio/output/number_text.h"

namespace ctpm::fidelity {
namespace {

constexpr double kSide = 72e-3, kHeight = 36e-3, kDepth = 20e-3, kBladeLength = 50e-3, kSpeed = 30e-3;
constexpr double kHalfWay = 60e-3, kMiddle = 15e-3, kHalfWindow = 3e-3;  // of the way; of what is read

/// The block with a scalpel, held below and at all sides.
Result<Body> make_block(double radius, double toughness) {
  const Specimen specimen = block({kSide, kSide, kHeight}, radius, Pace::live, {});
  scenes::SceneSpec scene = scene_of(specimen);
  scene.organs[0].material.fracture_toughness = toughness, scene.organs[0].material.blade_friction = 0;
  scenes::ToolSpec scalpel;
  scalpel.name = "scalpel", scalpel.kind = ToolKind::scalpel, scalpel.blade_length = kBladeLength;
  scene.tools = {scalpel};
  Result<Body> body = make_body(scene, specimen.mesh, specimen.turn, specimen.shift);
  if (!body) return body;
  std::vector<std::int32_t> sides;
  for (std::size_t i = 0; i < body->model.sphere_count(); ++i) {
    const Vec3 p = body->model.rest_position[i];
    if (std::max(std::abs(p.x), std::abs(p.y)) > kSide / 2 - 1.5 * radius) sides.push_back(std::int32_t(i));
  }
  hold(body->model, sides, kAnchored);
  return body;
}

/// Area of the swept surface inside the block [m^2].
double area_in_block(const State& state) {
  constexpr int kParts = 8;
  double area = 0;
  cutting::for_each_swept(state, [&](const cutting::SweptQuad& q) {
    const double whole =
        0.5 * (norm(cross(q.to - q.from, q.from2 - q.from)) + norm(cross(q.to2 - q.to, q.from2 - q.to)));
    int inside = 0;
    for (int i = 0; i < kParts; ++i)
      for (int j = 0; j < kParts; ++j) {
        const double u = (i + 0.5) / kParts, v = (j + 0.5) / kParts;
        const Vec3 p = (1 - v) * ((1 - u) * q.from + u * q.to) + v * ((1 - u) * q.from2 + u * q.to2);
        inside += std::max(std::abs(p.x), std::abs(p.y)) < kSide / 2 && p.z > 0 && p.z < kHeight;
      }
    area += whole * inside / (kParts * kParts);
  });
  return area;
}

/// How far the faces of the cut are apart beside the middle of the flanks, halfway down [m]. `edge`: the tip.
double opening_beside(const Model& model, const cutting::Openings& openings, const State& state, Vec3 edge,
                      Vec3 along) {
  const Vec3 across = cross(along, {0, 0, 1});
  const Vec3 place = edge - 0.5 * model.tools[0].flank_height * along + Vec3{0, 0, 0.5 * kDepth};
  cutting::Opening opening;
  openings.find(0, place, across, opening);
  cutting::Opening::Values off_cut{};
  for (std::size_t i = 0; i < std::size_t(opening.count); ++i)
    off_cut[i] = dot(across, state.position[std::size_t(opening.sphere[i])]) - opening.apart[i];
  return opening.jump(off_cut);
}

void cut(const Model& model, BladeResult::Row& row) {
  const Vec3 along{std::sin(row.angle), std::cos(row.angle), 0};
  // Off the lattice's planes of symmetry.
  const Vec3 middle{1.3e-3, 0.7e-3, kHeight - kDepth};
  stepping::Stepper stepper(model);
  const cutting::RestMap map(model);
  const cutting::Openings openings(model, map);
  State state = rest_state(model), before = state;
  int read = 0;
  Inputs hand;
  hand.tool = 0, hand.world_from_tool = turn_about({0, 0, 1}, std::numbers::pi / 2 - row.angle);
  const double per_tick = kSpeed * model.tick;
  for (double way = -kHalfWay; way < kHalfWay; way += per_tick) {
    before = state;
    hand.position = middle + way * along;
    const stepping::StepReport report = stepper.step(state, hand);
    row.way.push_back(way), row.force.push_back(-dot(report.tool_force, along));
    row.work += per_tick * row.force.back(), row.viscous += elements::viscous_work(model, before, state);
    row.severed += elements::severed_energy(model, before, state);
    if (std::abs(way) <= kMiddle) row.opening += opening_beside(model, openings, state, hand.position, along), ++read;
  }
  row.opening /= read * model.tools[0].blade_thickness;
  row.area = area_in_block(state);
}

void judge(BladeResult::Row& row, double per_tick) {
  const auto window = std::ptrdiff_t(kHalfWindow / per_tick);
  const auto count = std::ptrdiff_t(row.force.size());
  int read = 0;
  for (std::ptrdiff_t i = window + 1; i + window < count; ++i) {
    if (std::abs(row.way[std::size_t(i)]) > kMiddle) continue;
    const auto begin = row.force.begin() + i;
    const double around = std::accumulate(begin - window, begin + window + 1, 0.0) / double(2 * window + 1);
    row.mean += *begin, row.chatter += (*begin - around) * (*begin - around), ++read;
    row.jump = std::max(row.jump, std::abs(*begin - *(begin - 1)));
  }
  row.mean /= read, row.chatter = std::sqrt(row.chatter / read) / row.mean, row.jump /= row.mean;
}

std::string name_of(const BladeResult::Row& row) {
  return output::short_number(row.toughness) + " J/m^2, " + output::short_number(row.angle * 180 / std::numbers::pi) +
         " degrees to the lattice";
}

}  // namespace

Result<BladeResult> measure_blade(std::span<const double> radii, std::span<const double> toughnesses) {
  BladeResult result;
  for (const double radius : radii)
    for (const double toughness : toughnesses) {
      const Result<Body> body = make_block(radius, toughness);
      if (!body) return body.errors();
      std::vector<BladeResult::Row> rows;
      for (const double angle : {0.0, std::numbers::pi / 6, std::numbers::pi / 4}) {
        BladeResult::Row& row = rows.emplace_back();
        row.radius = radius, row.toughness = toughness, row.angle = angle;
      }
      in_parallel(rows.size(),
                  [&](std::size_t i) { cut(body->model, rows[i]), judge(rows[i], kSpeed * body->model.tick); });
      result.rows.insert(result.rows.end(), rows.begin(), rows.end());
    }
  return result;
}

Chapter chapter_of(const BladeResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "blade", section.title = "A blade through a block";
  section.paragraphs = {
      "A block of 72 x 72 x 36 mm, held below and at its sides. A blade of 50 mm goes through it at 30 mm/s, 20 mm "
      "deep. The hand's work should be the toughness times the area of the cut, which is measured on the surface that "
      "the edge swept, and what the tissue's Kelvin units dissipate. What severed elements held is lost, too, and only "
      "shown. The opening is that beside the middle of the flanks, halfway down, over the blade's thickness, 0.4 mm: "
      "tough tissue, which the edge pulls along, gapes wider by itself. Force, chatter (RMS about a moving mean of 6 "
      "mm) and the largest change in one tick are read over the "
      "middle 30 mm."};
  reports::Table table;
  table.columns = {{"radius_mm", "r [mm]"},
                   {"toughness_j_per_m2", "toughness [J/m^2]"},
                   {"angle_deg", "to the lattice [deg]", 3},
                   {"work_j", "work [J]"},
                   {"area_mm2", "area [mm^2]"},
                   {"viscous_j", "viscous losses [J]"},
                   {"severed_j", "held by severed elements [J]"},
                   {"work_ratio", "work / (J A + losses)", 3},
                   {"mean_n", "mean force [N]"},
                   {"chatter_percent", "chatter [%]", 3},
                   {"jump_percent", "largest jump [%]", 3},
                   {"opening_ratio", "opening / thickness", 3}};
  for (const BladeResult::Row& row : result.rows) {
    const double ratio = row.work / (row.toughness * row.area + row.viscous);
    table.rows.push_back({1e3 * row.radius, row.toughness, row.angle * 180 / std::numbers::pi, row.work, 1e6 * row.area,
                          row.viscous, row.severed, ratio, row.mean, 100 * row.chatter, 100 * row.jump, row.opening});
    Figure figure{.recipe = "blade", .radius = row.radius, .source = "Atkins & Mai 1985"};
    figure.name = "work over toughness times area and losses, " + name_of(row), figure.measured = ratio;
    figure.reference = 1, figure.goal = Goal{0.95, 1.05};
    chapter.figures.push_back(figure);
    figure.reference = {}, figure.unit = "%", figure.source = "a steady force";
    figure.name = "chatter, " + name_of(row), figure.measured = 100 * row.chatter;
    figure.goal = Goal{{}, row.radius > 3e-3 ? 5.0 : 3.0};
    chapter.figures.push_back(figure);
    figure.name = "largest jump in a tick, " + name_of(row), figure.measured = 100 * row.jump;
    figure.goal = Goal{{}, 5};
    chapter.figures.push_back(figure);
    figure.unit = "1", figure.source = "a rigid blade", figure.reference = 1;
    figure.name = "opening beside the flanks over the blade's thickness, " + name_of(row);
    figure.measured = row.opening;
    figure.goal = Goal{0.9, 1.1};
    chapter.figures.push_back(figure);
  }
  for (std::size_t i = 0; i + 2 < result.rows.size(); i += 3) {
    const auto [least, most] = std::minmax({result.rows[i].mean, result.rows[i + 1].mean, result.rows[i + 2].mean});
    Figure figure{.recipe = "blade", .radius = result.rows[i].radius, .source = "no direction differs"};
    figure.name = "largest over smallest mean force of three directions, " +
                  output::short_number(result.rows[i].toughness) + " J/m^2";
    figure.measured = most / least, figure.reference = 1, figure.goal = Goal{{}, 1.05};
    chapter.figures.push_back(figure);
  }
  section.tables = {table};
  reports::Plot plot{.title = "force, 200 J/m^2", .x_title = "way [mm]", .y_title = "force against the way [N]"};
  for (const BladeResult::Row& row : result.rows) {
    if (row.toughness != 200) continue;
    reports::Series series{.name = "r = " + output::short_number(1e3 * row.radius) + " mm, " +
                                   output::short_number(row.angle * 180 / std::numbers::pi) + " degrees"};
    for (std::size_t i = 0; i < row.way.size(); i += 20)
      series.x.push_back(1e3 * row.way[i]), series.y.push_back(row.force[i]);
    plot.series.push_back(series);
  }
  if (!plot.series.empty()) section.plots.push_back(plot);
  return chapter;
}

}  // namespace ctpm::fidelity
