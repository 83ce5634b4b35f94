// A frictionless ball that presses a block, against finite elements.

#include <algorithm>
#include <cmath>

#include "studio/fidelity/meshes.h"
#include "studio/fidelity/recipes.h"
#include "studio/fidelity/references.h"
#include "studio/output/number_text.h"

namespace ctpm::fidelity {

Specimen block(Vec3 size, double radius, Pace pace, const std::vector<double>& balls) {
  Specimen specimen;
  specimen.mesh = box_mesh({-0.5 * size.x, -0.5 * size.y, 0}, {0.5 * size.x, 0.5 * size.y, size.z}, 2e-3);
  specimen.radius = radius, specimen.pace = pace, specimen.balls = balls;
  // The bottom is held within half a spacing: its outermost spheres, wherever the lattice lies.
  specimen.clamp = scenes::PlaneRegion{{0, 0, 1.5 * radius + 1e-6}, {0, 0, 1}};
  return specimen;
}

double order_of(const std::vector<double>& radii, const std::vector<double>& errors) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double x = std::log(radii[i]), y = std::log(errors[i]);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return n < 2 ? std::nan("") : (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

Result<IndentationResult> measure_indentation(std::span<const double> radii, int places) {
  constexpr double kBall = 20e-3, kHeight = 60e-3;
  IndentationResult result;
  result.places = places;
  std::vector<double> depths;
  for (const Indentation& i : kIndentations) depths.push_back(i.depth);
  for (const double radius : radii) {
    Specimen specimen = block({96e-3, 96e-3, kHeight}, radius, Pace::slow, {kBall});
    specimen.friction = 0;
    const Result<Body> body = make_body(specimen);
    if (!body) return body.errors();
    const std::vector<PressSite> sites = places_over_cell(body->spacing(), kHeight, places);
    std::vector<std::vector<PressPoint>> presses(sites.size());
    in_parallel(sites.size(), [&](std::size_t i) { presses[i] = press(*body, 0, sites[i], depths); });
    for (std::size_t d = 0; d < depths.size(); ++d) {
      IndentationResult::Row row{.radius = radius, .depth = depths[d], .forces = {}};
      for (const std::vector<PressPoint>& points : presses)
        row.forces.push_back(points[d].force), row.rests = row.rests && points[d].rests;
      result.rows.push_back(row);
    }
  }
  return result;
}

Chapter chapter_of(const IndentationResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "indentation", section.title = "Indentation of a block";
  section.paragraphs = {
      "A block of 96 x 96 x 60 mm with its bottom held; a rigid ball of 20 mm without friction at " +
          std::to_string(result.places * result.places) +
          " places over one lattice cell, waiting at each depth until the block rests. The scatter is the standard "
          "deviation over the mean.",
      "The reference has small strains and the exact shape of the ball. Where strains are large a force depends on the "
      "material's law: with that of St. Venant and Kirchhoff, which is softer in compression, CalculiX gives the "
      "column of large strains."};
  reports::Table table;
  table.columns = {{"radius_mm", "r [mm]"},
                   {"depth_mm", "depth [mm]"},
                   {"mean_n", "mean force [N]"},
                   {"reference_n", "CalculiX [N]"},
                   {"hertz_n", "Hertz [N]"},
                   {"svk_n", "large strains [N]"},
                   {"ratio", "mean over CalculiX", 3},
                   {"scatter_percent", "scatter [%]", 3},
                   {"most_over_least", "most over least", 3},
                   {"rests", "at rest"}};
  for (const IndentationResult::Row& row : result.rows) {
    const Indentation& reference = *std::find_if(std::begin(kIndentations), std::end(kIndentations),
                                                 [&](const Indentation& i) { return i.depth == row.depth; });
    const Spread spread = spread_of(row.forces);
    table.rows.push_back({1e3 * row.radius, 1e3 * row.depth, spread.mean, reference.force.value, reference.hertz,
                          reference.svk, spread.mean / reference.force.value, 100 * spread.deviation, spread.ratio(),
                          std::string(row.rests ? "yes" : "no")});
    const std::string at = " at " + output::short_number(1e3 * row.depth) + " mm";
    chapter.figures.push_back({.recipe = "indentation",
                               .name = "mean force" + at,
                               .radius = row.radius,
                               .measured = spread.mean,
                               .unit = "N",
                               .reference = reference.force.value,
                               .source = reference.force.source,
                               .goal = Goal{0.9 * reference.force.value, 1.1 * reference.force.value},
                               .note = row.rests ? "" : "still moved"});
    chapter.figures.push_back({.recipe = "indentation",
                               .name = "scatter over a cell" + at,
                               .radius = row.radius,
                               .measured = 100 * spread.deviation,
                               .unit = "%",
                               .reference = {},
                               .source = "a body without a lattice has none",
                               .goal = Goal{{}, 5}});
  }
  section.tables = {table};
  for (const Indentation& reference : kIndentations) {
    std::vector<double> radii, errors;
    for (const IndentationResult::Row& row : result.rows)
      if (row.depth == reference.depth)
        radii.push_back(row.radius), errors.push_back(std::abs(spread_of(row.forces).mean / reference.force.value - 1));
    if (radii.size() > 1)
      chapter.figures.push_back(
          {.recipe = "indentation",
           .name = "order of convergence at " + output::short_number(1e3 * reference.depth) + " mm",
           .measured = order_of(radii, errors)});
  }
  return chapter;
}

}  // namespace ctpm::fidelity
