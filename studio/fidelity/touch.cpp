// What the hand and the eye meet at the surface: the first contact, the drawn surface under a ball, a ball that is
// smaller than a spacing.

#include <algorithm>
#include <cmath>

#include "studio/fidelity/recipes.h"
#include "studio/output/number_text.h"

namespace ctpm::fidelity {
namespace {

constexpr double kHeight = 60e-3;
constexpr double kLeastForce = 1e-9;  // [N]

std::string in_mm(double length) { return output::short_number(1e3 * length) + " mm"; }

}  // namespace

double first_contact(const Body& body, std::int32_t tool, const PressSite& site) {
  constexpr double kStep = 0.02e-3, kFrom = -3e-3, kTo = 15e-3;
  stepping::Stepper stepper(body.model);
  State state = rest_state(body.model);
  for (double depth = kFrom; depth < kTo; depth += kStep) {
    const stepping::StepReport report = stepper.step(state, ball_at(tool, ball_centre(body, tool, site, depth)));
    if (norm(report.tool_force) > kLeastForce) return depth;
  }
  return std::nan("");
}

Result<FirstContactResult> measure_first_contact(std::span<const double> radii, int places) {
  const std::vector<double> balls{4e-3, 10e-3};
  FirstContactResult result;
  for (const double radius : radii) {
    const Result<Body> body = make_body(block({96e-3, 96e-3, kHeight}, radius, Pace::live, balls));
    if (!body) return body.errors();
    const std::vector<PressSite> sites = places_over_cell(body->spacing(), kHeight, places);
    for (std::size_t b = 0; b < balls.size(); ++b) {
      FirstContactResult::Row row{radius, balls[b], std::vector<double>(sites.size())};
      in_parallel(sites.size(),
                  [&](std::size_t i) { row.depths[i] = first_contact(*body, std::int32_t(b), sites[i]); });
      result.rows.push_back(row);
    }
  }
  return result;
}

Chapter chapter_of(const FirstContactResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "first-contact", section.title = "First contact";
  section.paragraphs = {
      "A ball comes down at 20 mm/s on a flat block, at places over one lattice cell. The depth is that of its lowest "
      "point below the drawn surface when the first force is felt: positive where the ball sinks in without a force, "
      "negative where it meets a force before it reaches the surface. It is known to 0.02 mm."};
  add_contacts(chapter, result.rows);
  return chapter;
}

void add_contacts(Chapter& chapter, const std::vector<FirstContactResult::Row>& rows) {
  reports::Table table;
  table.columns = {{"radius_mm", "r [mm]"},  {"ball_mm", "ball [mm]"}, {"least_mm", "least depth [mm]"},
                   {"mean_mm", "mean [mm]"}, {"most_mm", "most [mm]"}, {"without_force", "places without a force"}};
  for (const FirstContactResult::Row& row : rows) {
    std::vector<double> felt;
    std::copy_if(row.depths.begin(), row.depths.end(), std::back_inserter(felt),
                 [](double d) { return !std::isnan(d); });
    const auto unfelt = std::int64_t(row.depths.size() - felt.size());
    const Spread spread = felt.empty() ? Spread{} : spread_of(felt);
    table.rows.push_back({1e3 * row.radius, row.ball > 0 ? reports::Cell(1e3 * row.ball) : reports::Cell(),
                          1e3 * spread.least, 1e3 * spread.mean, 1e3 * spread.most, unfelt});
    const double worst = unfelt > 0 ? std::nan("") : std::max(std::abs(spread.least), std::abs(spread.most));
    chapter.figures.push_back(
        {.recipe = chapter.section.key,
         .name = "first force, farthest from the surface" + (row.ball > 0 ? ", ball of " + in_mm(row.ball) : ""),
         .radius = row.radius,
         .measured = 1e3 * worst,
         .unit = "mm",
         .reference = 0.0,
         .source = "the drawn surface",
         .goal = Goal{{}, 0.1},
         .note = unfelt > 0
                     ? "no force at " + std::to_string(unfelt) + " of " + std::to_string(row.depths.size()) + " places"
                     : ""});
  }
  chapter.section.tables.push_back(table);
}

Result<SurfaceResult> measure_surface(std::span<const double> radii, int places) {
  const std::vector<double> depths{6e-3, 10e-3}, small_depth{8e-3};
  SurfaceResult result;
  for (const double radius : radii) {
    const Result<Body> body = make_body(block({96e-3, 96e-3, kHeight}, radius, Pace::slow, {10e-3, 2e-3}));
    if (!body) return body.errors();
    const std::vector<PressSite> sites = places_over_cell(body->spacing(), kHeight, places);
    std::vector<std::vector<PressPoint>> wide(sites.size()), narrow(sites.size());
    in_parallel(sites.size(), [&](std::size_t i) {
      wide[i] = press(*body, 0, sites[i], depths, true);
      narrow[i] = press(*body, 1, sites[i], small_depth);
    });
    for (std::size_t d = 0; d < depths.size(); ++d) {
      SurfaceResult::Inside row{radius, depths[d], {}};
      for (const std::vector<PressPoint>& points : wide) row.inside.push_back(points[d].inside);
      result.inside.push_back(row);
    }
    SurfaceResult::Small small{radius, {}};
    for (const std::vector<PressPoint>& points : narrow) small.forces.push_back(points[0].force);
    result.small.push_back(small);
  }
  return result;
}

Chapter chapter_of(const SurfaceResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "surface", section.title = "The drawn surface under a ball, and a small ball";
  section.paragraphs = {
      "A flat block at rest under a ball of 10 mm, at places over one lattice cell: how deep the drawn surface lies in "
      "the ball. And the force on the paper's own ball of 2 mm at 8 mm at the same places."};
  reports::Table inside, small;
  inside.title = "Drawn surface inside a ball of 10 mm";
  inside.columns = {
      {"radius_mm", "r [mm]"}, {"depth_mm", "depth [mm]"}, {"mean_mm", "mean [mm]"}, {"most_mm", "most [mm]"}};
  for (const SurfaceResult::Inside& row : result.inside) {
    const Spread spread = spread_of(row.inside);
    inside.rows.push_back({1e3 * row.radius, 1e3 * row.depth, 1e3 * spread.mean, 1e3 * spread.most});
    chapter.figures.push_back({.recipe = "surface",
                               .name = "drawn surface in a ball of 10 mm at " + in_mm(row.depth),
                               .radius = row.radius,
                               .measured = 1e3 * spread.most,
                               .unit = "mm",
                               .reference = 0.0,
                               .source = "a rigid ball",
                               .goal = Goal{{}, 0.3}});
  }
  small.title = "Force on a ball of 2 mm at 8 mm";
  small.columns = {{"radius_mm", "r [mm]"},
                   {"mean_n", "mean [N]"},
                   {"least_n", "least [N]"},
                   {"most_n", "most [N]"},
                   {"scatter_percent", "scatter [%]", 3}};
  for (const SurfaceResult::Small& row : result.small) {
    const Spread spread = spread_of(row.forces);
    small.rows.push_back({1e3 * row.radius, spread.mean, spread.least, spread.most, 100 * spread.deviation});
    chapter.figures.push_back({.recipe = "surface",
                               .name = "scatter of the force on a ball of 2 mm at 8 mm",
                               .radius = row.radius,
                               .measured = 100 * spread.deviation,
                               .unit = "%",
                               .reference = {},
                               .source = "a body without a lattice has none",
                               .goal = Goal{{}, 5}});
    chapter.figures.push_back({.recipe = "surface",
                               .name = "least force on a ball of 2 mm at 8 mm",
                               .radius = row.radius,
                               .measured = spread.least,
                               .unit = "N"});
  }
  section.tables = {inside, small};
  return chapter;
}

}  // namespace ctpm::fidelity
