// Blades that go through the shipped organs as they are simulated: what is drawn stays whole while they cut.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/cutbody/cut_body.h"
#include "core/stepping/step.h"
#include "core/surface/surface.h"
#include "studio/fidelity/recipes.h"
#include "studio/fidelity/topology.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm::fidelity {
namespace {

constexpr double kSpeed = 40e-3;         // of the blade [m/s]
constexpr double kBeyond = 10e-3;        // how far strokes begin and end beside the organ [m]
constexpr double kWait = 0.5;            // after the last stroke [s]
constexpr std::int64_t kLookEvery = 25;  // ticks
constexpr double kMostStretched = 6;

/// What is shorter than this at rest is a place rather than a length, in spacings: a fifth of a step of the grid on
/// which cuts are meshed.
constexpr double kShort = 0.05;

/// A stroke on a level line, its tip at `bottom` [m]; `beside`: off the line at a way along it [m].
struct Stroke {
  Vec3 from, to;
  double bottom;
  std::function<double(double)> beside = [](double) { return 0.0; };

  double ticks(double tick) const { return std::ceil(norm(to - from) / kSpeed / tick); }
  Inputs at(double t, std::int32_t tool) const {
    const Vec3 way = to - from, ahead = way / norm(way), left{-ahead.y, ahead.x, 0};
    Inputs inputs;
    inputs.tool = tool, inputs.position = from + t * way + beside(t * norm(way)) * left;
    inputs.position.z = bottom;
    // The blade cuts towards its x.
    const double angle = std::atan2(ahead.y, ahead.x);
    inputs.world_from_tool = {std::cos(angle / 2), 0, 0, std::sin(angle / 2)};
    return inputs;
  }
};

std::vector<std::pair<const char*, std::vector<Stroke>>> strokes_over(const Surface& surface) {
  Box box(surface.vertex[0]);
  for (const Vec3& v : surface.vertex) box.add(v);
  const Vec3 middle = 0.5 * (box.low + box.high);
  // Half of the organ's thickness deep, where the lines cross.
  const double bottom = middle.z;
  const Stroke along{{middle.x + 2e-3, box.low.y - kBeyond, 0}, {middle.x + 2e-3, box.high.y + kBeyond, 0}, bottom},
      across{{box.low.x - kBeyond, middle.y + 1e-3, 0}, {box.high.x + kBeyond, middle.y + 1e-3, 0}, bottom};
  Stroke tremor = along;
  // 1 mm at 8 Hz.
  tremor.beside = [](double way) { return 1e-3 * std::sin(2 * std::numbers::pi * 8 * way / kSpeed); };
  return {{"straight", {along}}, {"X", {along, across}}, {"tremor", {tremor}}};
}

double longest_edge(const Vec3* p) { return std::max({norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])}); }

class Look {
 public:
  Look(const Model& model, StrokesResult::Row& row) : model_(model), row_(row), drawn_(model, 0) {}

  void at(const State& state) {
    const bool is_swept = has_grown(state);
    const bool has_changed = drawn_.update(state);
    ++row_.looks;
    if (has_changed && !is_swept) ++row_.changed_uncut;
    if (has_changed) {
      const Topology topology = topology_of(drawn_.surface());
      row_.wrong += topology.components != drawn_.piece_count() || topology.open_edges > 0;
    }
    find_stretched(state);
  }

 private:
  /// Whether the swept surface is another than at the last look. Its last row may still move.
  bool has_grown(const State& state) {
    const std::size_t points = state.swept.size(), row = std::min(points, kEdgeNodes);
    std::vector<Vec3> last;
    for (std::size_t n = points - row; n < points; ++n) last.push_back(state.swept[n]);
    const bool is_same = points == points_ && last == last_row_;
    points_ = points, last_row_ = std::move(last);
    return !is_same;
  }

  void find_stretched(const State& state) {
    const Surface& surface = drawn_.surface();
    surface::deform_surface(surface, state.position, model_.organs[0].first, vertex_);
    const double least = kShort * model_.organs[0].spacing;
    for (const auto& t : surface.triangle) {
      Vec3 rest[3], now[3];
      for (std::size_t c = 0; c < 3; ++c)
        rest[c] = surface.vertex[std::size_t(t[c])], now[c] = vertex_[std::size_t(t[c])];
      const double stretch = longest_edge(now) / std::max(longest_edge(rest), least);
      row_.stretch = std::max(row_.stretch, stretch);
      row_.stretched += stretch > kMostStretched;
      for (std::size_t c = 0; c < 3; ++c)
        if (const double edge = norm(rest[(c + 1) % 3] - rest[c]); edge < least)
          row_.torn = std::max(row_.torn, (norm(now[(c + 1) % 3] - now[c]) - edge) / model_.organs[0].spacing);
    }
  }

  const Model& model_;
  StrokesResult::Row& row_;
  cutbody::CutBody drawn_;
  std::size_t points_ = 0;
  std::vector<Vec3> last_row_;
  std::vector<Vec3> vertex_;
};

StrokesResult::Row measure(const Model& model, std::int32_t tool, const std::vector<Stroke>& strokes) {
  StrokesResult::Row row;
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  Look look(model, row);
  const auto step = [&](const Inputs& inputs) {
    const stepping::StepReport report = stepper.step(state, inputs);
    row.severed += report.severed, row.refused += stepping::is_refused(report.status);
    if (state.tick % kLookEvery == 0) look.at(state);
  };
  for (const Stroke& stroke : strokes) {
    const double ticks = stroke.ticks(model.tick);
    for (double i = 0; i <= ticks; ++i) step(stroke.at(i / ticks, tool));
    step({});
  }
  for (std::int64_t i = 0; i < std::int64_t(kWait / model.tick); ++i) step({});
  return row;
}

}  // namespace

Result<StrokesResult> measure_strokes(const std::string& shipped, bool is_quick) {
  StrokesResult result;
  for (const char* organ : {"kidney", "skin", "liver"}) {
    const Result<loading::LoadedScene> loaded = loading::load_whole_scene(shipped + "/" + organ + ".json", {});
    if (!loaded) return loaded.errors();
    const Model& model = loaded->built.model;
    const auto scalpel = std::find_if(model.tools.begin(), model.tools.end(),
                                      [](const Tool& tool) { return tool.kind == ToolKind::scalpel; });
    if (scalpel == model.tools.end()) return Error{organ, "has no scalpel", ""};
    auto strokes = strokes_over(model.surfaces[0]);
    if (is_quick) strokes.erase(strokes.begin() + 1, strokes.end());
    const std::size_t first = result.rows.size();
    result.rows.resize(first + strokes.size());
    in_parallel(strokes.size(), [&](std::size_t i) {
      StrokesResult::Row row = measure(model, std::int32_t(scalpel - model.tools.begin()), strokes[i].second);
      row.organ = organ, row.stroke = strokes[i].first;
      result.rows[first + i] = row;
    });
  }
  return result;
}

Chapter chapter_of(const StrokesResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "strokes", section.title = "Strokes through the shipped organs";
  section.paragraphs = {
      "The blades of the shipped scenes go through their organs at 40 mm/s, half of the organ's height deep, on a "
      "straight line, on two that cross, and with a tremor of 1 mm at 8 Hz. Every 25 ticks the drawn surface is looked "
      "at: it should be closed, with as many components as there are pieces, change only where the blade went on, and "
      "no triangle should be six times as long as at rest, or as a twentieth of a spacing where it is shorter. Places "
      "that lie together at rest may follow different spheres; how far they came apart is in the last column."};
  reports::Table table;
  table.columns = {{"organ", "organ"},
                   {"stroke", "stroke"},
                   {"severed", "severed elements"},
                   {"looks", "looks"},
                   {"wrong", "looks at a surface that is open or has other components"},
                   {"changed_uncut", "changes without a cut"},
                   {"stretch", "largest stretch", 2},
                   {"stretched", "triangles beyond 6"},
                   {"torn_spacings", "places came apart [spacings]", 3}};
  for (const StrokesResult::Row& row : result.rows) {
    table.rows.push_back({row.organ, row.stroke, double(row.severed), double(row.looks), double(row.wrong),
                          double(row.changed_uncut), row.stretch, double(row.stretched), row.torn});
    const auto add = [&](const std::string& name, double measured, Goal goal) {
      chapter.figures.push_back({.recipe = "strokes",
                                 .name = name + ", " + row.organ + ", " + row.stroke,
                                 .measured = measured,
                                 .unit = "1",
                                 .source = "requirement",
                                 .goal = goal});
    };
    add("severed elements", row.severed, {1.0, {}});
    add("refused ticks", row.refused, {{}, 0.0});
    add("looks at a surface that is open or has other components than pieces", row.wrong, {{}, 0.0});
    add("changes of the surface without a cut", row.changed_uncut, {{}, 0.0});
    add("triangles stretched more than six times", row.stretched, {{}, 0.0});
  }
  section.tables = {table};
  return chapter;
}

}  // namespace ctpm::fidelity
