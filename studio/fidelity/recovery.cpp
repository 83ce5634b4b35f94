// Abuse, and what is left of it 4 s later.

#include <algorithm>
#include <cmath>
#include <functional>

#include "studio/fidelity/recipes.h"

namespace ctpm::fidelity {
namespace {

constexpr Vec3 kSize{72e-3, 72e-3, 48e-3};
constexpr double kRest = 4.0;  // [s] after the abuse
constexpr std::int32_t kLarge = 0, kMedium = 1;

/// One kind of abuse: the input at a time [s], how long it lasts, and gravity meanwhile.
struct Abuse {
  const char* name;
  double time;
  std::function<Inputs(const Body& body, double time)> hand;
  double gravity = 0;
};

Inputs ball_over(const Body& body, std::int32_t tool, double x, double depth) {
  return ball_at(tool, ball_centre(body, tool, {{x, 0, kSize.z}, {0, 0, -1}}, depth));
}

/// 25 mm in half a second, and half a second there.
Inputs press_hand(const Body& body, double time) {
  return ball_over(body, kLarge, 0, 25e-3 * std::min(1.0, time / 0.5));
}

/// 20 mm down, 48 mm along, up, all at 100 mm/s.
Inputs stroke_hand(const Body& body, double time) {
  constexpr double kSpeed = 0.1, kDeep = 20e-3, kHalf = 24e-3;
  const double way = kSpeed * time, along = std::clamp(way - kDeep, 0.0, 2 * kHalf);
  const double depth = std::min(way, kDeep) - std::max(0.0, way - kDeep - 2 * kHalf);
  return ball_over(body, kMedium, along - kHalf, depth);
}

/// Another place in the block every 20 ms (a 64-bit linear congruential generator).
Inputs teleport_hand(const Body&, double time) {
  std::uint64_t seed = 42 + std::uint64_t(time / 0.02);
  const auto next = [&] {
    for (int i = 0; i < 3; ++i) seed = seed * 6364136223846793005ull + 1442695040888963407ull;
    return double(seed >> 11) / double(1ull << 53);
  };
  const double x = next() - 0.5, y = next() - 0.5, z = next();
  return ball_at(kMedium, {x * kSize.x, y * kSize.y, z * kSize.z});
}

double distance_from_rest(const Model& model, const State& state) {
  double most = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    most = std::max(most, norm(state.position[i] - model.rest_position[i]));
  return most;
}

RecoveryResult::Row endure(const Body& body, const Abuse& abuse) {
  RecoveryResult::Row row;
  row.name = abuse.name;
  Model abused = body.model;
  abused.gravity = {0, 0, -abuse.gravity};
  stepping::Stepper during(abused), after(body.model);
  State state = rest_state(body.model);
  const double tick = body.model.tick;
  const auto note = [&](double time, bool is_abuse) {
    const double distance = distance_from_rest(body.model, state);
    row.distance.x.push_back(time), row.distance.y.push_back(1e3 * distance);
    const CellCount count = count_cells(body, state);
    row.cells = count.cells;
    if (is_abuse) {
      row.reach = std::max(row.reach, distance);
      row.worst_inside_out = std::max(row.worst_inside_out, count.inside_out);
    } else {
      row.residual = distance, row.inside_out = count.inside_out;
    }
  };
  for (std::int64_t t = 0; double(t) * tick < abuse.time + kRest; ++t) {
    const double time = double(t) * tick;
    const bool is_abuse = time < abuse.time;
    const Inputs inputs = is_abuse && abuse.hand ? abuse.hand(body, time) : Inputs{};
    row.refused_ticks += stepping::is_refused((is_abuse ? during : after).step(state, inputs).status);
    if (t % 20 == 0) note(time, is_abuse);
  }
  note(abuse.time + kRest, false);
  return row;
}

}  // namespace

Result<RecoveryResult> measure_recovery(std::span<const double> radii) {
  const std::vector<Abuse> abuses{{"ball of 20 mm pressed 25 mm deep", 1.0, press_hand},
                                  {"stroke of a ball of 10 mm, 20 mm deep, 100 mm/s", 0.9, stroke_hand},
                                  {"ball of 10 mm teleported at random for 1 s", 1.0, teleport_hand},
                                  {"fifty times gravity for 2 s", 2.0, {}, 50 * 9.81}};
  RecoveryResult result;
  for (const double radius : radii) {
    const Result<Body> body = make_body(block(kSize, radius, Pace::live, {20e-3, 10e-3}));
    if (!body) return body.errors();
    std::vector<RecoveryResult::Row> rows(abuses.size());
    in_parallel(abuses.size(), [&](std::size_t i) { rows[i] = endure(*body, abuses[i]), rows[i].radius = radius; });
    result.rows.insert(result.rows.end(), rows.begin(), rows.end());
  }
  return result;
}

Chapter chapter_of(const RecoveryResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "recovery", section.title = "Recovery from abuse";
  section.paragraphs = {
      "A block of 72 x 72 x 48 mm with the preset's viscosity is abused and then left alone for 4 s. A lattice cell is "
      "inside out if a corner's three edges no longer span a positive volume. Without gravity except where it is the "
      "abuse."};
  reports::Table table;
  table.columns = {{"radius_mm", "r [mm]"},
                   {"abuse", "abuse"},
                   {"reach_mm", "farthest from rest [mm]"},
                   {"residual_mm", "4 s later [mm]"},
                   {"cells", "cells"},
                   {"worst_inside_out", "most inside out"},
                   {"inside_out", "inside out 4 s later"},
                   {"refused_ticks", "ticks refused"}};
  reports::Plot plot{
      .title = "largest distance from rest, coarsest filling", .x_title = "time [s]", .y_title = "distance [mm]"};
  for (const RecoveryResult::Row& row : result.rows) {
    table.rows.push_back({1e3 * row.radius, row.name, 1e3 * row.reach, 1e3 * row.residual, row.cells,
                          row.worst_inside_out, row.inside_out, row.refused_ticks});
    chapter.figures.push_back({.recipe = "recovery",
                               .name = "distance from rest 4 s after: " + row.name,
                               .radius = row.radius,
                               .measured = 1e3 * row.residual,
                               .unit = "mm",
                               .reference = 0.0,
                               .source = "tissue comes back",
                               .goal = Goal{{}, 1}});
    chapter.figures.push_back({.recipe = "recovery",
                               .name = "cells inside out 4 s after: " + row.name,
                               .radius = row.radius,
                               .measured = double(row.inside_out),
                               .reference = 0.0,
                               .source = "tissue comes back",
                               .goal = Goal{{}, 0}});
    if (row.radius != result.rows[0].radius) continue;
    reports::Series series = row.distance;
    series.name = row.name;
    plot.series.push_back(series);
  }
  section.tables = {table}, section.plots = {plot};
  return chapter;
}

}  // namespace ctpm::fidelity
