// One body and one tool, turned against the lattice: a body without a lattice answers with one force.

#include "studio/fidelity/meshes.h"
#include "studio/fidelity/recipes.h"
#include "studio/output/number_text.h"

namespace ctpm::fidelity {
namespace {

constexpr double kBody = 40e-3, kBall = 10e-3;
constexpr double kDepths[] = {4e-3, 8e-3, 12e-3};

}  // namespace

Specimen ball_organ(double radius, Pace pace) {
  Specimen specimen;
  specimen.mesh = ball_mesh(kBody, 2e-3);
  specimen.radius = radius, specimen.pace = pace;
  return specimen;
}

Result<OrientationResult> measure_orientation(std::span<const double> radii, std::span<const Quat> turns) {
  OrientationResult result;
  for (const double radius : radii) {
    std::vector<std::vector<PressPoint>> presses(turns.size());
    std::vector<Errors> errors(turns.size());
    in_parallel(turns.size(), [&](std::size_t i) {
      Specimen specimen = ball_organ(radius, Pace::slow);
      specimen.balls = {kBall}, specimen.turn = turns[i];
      specimen.clamp = scenes::PlaneRegion{{0, 0, -28e-3}, {0, 0, 1}};
      const Result<Body> body = make_body(specimen);
      if (body)
        presses[i] = press(*body, 0, {{0, 0, kBody}, {0, 0, -1}}, kDepths);
      else
        errors[i] = body.errors();
    });
    for (const Errors& e : errors)
      if (!e.empty()) return e;
    const std::vector<OrientationResult::Row> rows = rows_of(presses, radius, kDepths);
    result.rows.insert(result.rows.end(), rows.begin(), rows.end());
  }
  return result;
}

std::vector<OrientationResult::Row> rows_of(const std::vector<std::vector<PressPoint>>& presses, double radius,
                                            std::span<const double> depths) {
  std::vector<OrientationResult::Row> rows;
  for (std::size_t d = 0; d < depths.size(); ++d) {
    OrientationResult::Row row{.radius = radius, .depth = depths[d], .forces = {}};
    for (const std::vector<PressPoint>& points : presses)
      row.forces.push_back(points[d].force), row.rests = row.rests && points[d].rests;
    rows.push_back(row);
  }
  return rows;
}

void add_scatter(Chapter& chapter, const std::vector<OrientationResult::Row>& rows, const std::string& over) {
  reports::Table table;
  table.columns = {{"radius_mm", "r [mm]"},
                   {"depth_mm", "depth [mm]"},
                   {"mean_n", "mean force [N]"},
                   {"least_n", "least [N]"},
                   {"most_n", "most [N]"},
                   {"scatter_percent", "scatter [%]", 3},
                   {"most_over_least", "most over least", 3},
                   {"rests", "at rest"}};
  for (const OrientationResult::Row& row : rows) {
    const Spread spread = spread_of(row.forces);
    table.rows.push_back({1e3 * row.radius, 1e3 * row.depth, spread.mean, spread.least, spread.most,
                          100 * spread.deviation, spread.ratio(), std::string(row.rests ? "yes" : "no")});
    const std::string at = " at " + output::short_number(1e3 * row.depth) + " mm";
    chapter.figures.push_back({.recipe = chapter.section.key,
                               .name = "scatter over " + over + at,
                               .radius = row.radius,
                               .measured = 100 * spread.deviation,
                               .unit = "%",
                               .reference = {},
                               .source = "a body without a lattice has none",
                               .goal = Goal{{}, 5},
                               .note = row.rests ? "" : "some still moved"});
    chapter.figures.push_back({.recipe = chapter.section.key,
                               .name = "most over least force over " + over + at,
                               .radius = row.radius,
                               .measured = spread.ratio(),
                               .reference = 1.0,
                               .source = "a body without a lattice",
                               .goal = Goal{{}, 1.2},
                               .note = spread.least > 0 ? "" : "without a force at some of the " + over});
  }
  chapter.section.tables.push_back(table);
}

Chapter chapter_of(const OrientationResult& result) {
  Chapter chapter;
  chapter.section.key = "orientation", chapter.section.title = "Orientation of the lattice";
  chapter.section.paragraphs = {
      "A ball organ of 40 mm radius whose lowest 12 mm are anchored; a ball of 10 mm presses its pole. Body, anchors "
      "and tool are turned together against the lattice, " +
      std::to_string(result.rows.empty() ? 0 : result.rows[0].forces.size()) +
      " times. The scatter is the standard deviation over the mean."};
  add_scatter(chapter, result.rows, "turns");
  return chapter;
}

}  // namespace ctpm::fidelity
