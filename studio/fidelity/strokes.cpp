// Blades that go through the shipped organs as they are simulated: what is drawn stays whole while they cut.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/contact/drawn_surfaces.h"
#include "core/cutbody/cut_body.h"
#include "core/stepping/step.h"
#include "core/surface/stretch.h"
#include "core/surface/surface.h"
#include "studio/fidelity/recipes.h"
#include "studio/fidelity/topology.h"

namespace ctpm::fidelity {
namespace {

constexpr double kSpeed = 40e-3;         // of the blade [m/s]
constexpr double kBeyond = 10e-3;        // how far strokes begin and end beside the organ [m]
constexpr double kLongBlade = 0.25;      // [m]
constexpr double kSettle = 1;            // before the first stroke, as a session does [s]
constexpr double kWait = 0.5;            // after the last stroke [s]
constexpr std::int64_t kLookEvery = 25;  // ticks
constexpr double kMostStretched = 6;
/// A triangle has a force to show for its stretch if elements under it are stretched by this part of it.
constexpr double kPulled = 0.5;

/// What the blade does in a time.
struct Stroke {
  std::function<Inputs(double)> at;  ///< at a time from 0 to 1
  double length;                     ///< [m]

  double ticks(double tick) const { return std::ceil(length / kSpeed / tick); }
};

struct Cut {
  const char* name;
  std::vector<Stroke> strokes;
};

/// The strokes over an organ in its box.
class Strokes {
 public:
  Strokes(const Surface& surface, double spacing, std::int32_t tool) : box_(surface.vertex[0]), tool_(tool) {
    for (const Vec3& v : surface.vertex) box_.add(v);
    middle_ = 0.5 * (box_.low + box_.high), half_ = 0.5 * (box_.high - box_.low), spacing_ = spacing;
  }

  std::vector<Cut> cuts() const {
    const double below = box_.low.z - kBeyond, deep = middle_.z;
    const Stroke straight = along_y(2e-3, deep);
    const auto wave = [](double way) { return 0.15 * std::sin(2 * std::numbers::pi * way); };
    // 1 mm at 8 Hz.
    const auto tremor = [&](double way) {
      return 1e-3 / half_.x * std::sin(2 * std::numbers::pi * 8 * way * straight.length / kSpeed);
    };
    const auto parallel = [&](double apart) {
      return std::vector{along_y(2e-3, below), along_y(2e-3 + apart * spacing_, below)};
    };
    return {
        {"straight", {straight}},
        {"S", {along_y(2e-3, deep, wave)}},
        {"closed ellipse", {ring(0.35, deep)}},
        {"X", {straight, along_x(1e-3, deep)}},
        {"cap", {level(middle_.z + 0.5 * half_.z, box_.high.x + kBeyond, 1.0)}},
        {"disc",
         {ring(0.35, middle_.z + 0.25 * half_.z), level(middle_.z + 0.3 * half_.z, middle_.x + 0.7 * half_.x, 0.6)}},
        {"parallel, 1 spacing", parallel(1)},
        {"parallel, 0.5 spacings", parallel(0.5)},
        {"parallel, 0.3 spacings", parallel(0.3)},
        {"tremor", {along_y(2e-3, deep, tremor)}}};
  }

 private:
  /// The blade upright, which cuts towards its x.
  Inputs upright(Vec3 tip, double angle) const {
    Inputs inputs;
    inputs.tool = tool_, inputs.position = tip;
    inputs.world_from_tool = {std::cos(angle / 2), 0, 0, std::sin(angle / 2)};
    return inputs;
  }

  /// Along y beside the middle [m], the tip at `bottom` [m]; `beside`: off the line at a part of the way, in halves of
  /// the box.
  Stroke along_y(
      double x, double bottom, std::function<double(double)> beside = [](double) { return 0.0; }) const {
    const double length = 2 * (half_.y + kBeyond);
    const auto at = [=, this](double t) {
      const Vec3 tip{middle_.x + x + beside(t) * half_.x, box_.low.y - kBeyond + t * length, bottom};
      return upright(tip, std::numbers::pi / 2);
    };
    return {at, length};
  }
  Stroke along_x(double y, double bottom) const {
    const double length = 2 * (half_.x + kBeyond);
    return {[=, this](double t) {
              return upright({box_.low.x - kBeyond + t * length, middle_.y + y, bottom}, 0);
            },
            length};
  }
  /// Goes into the tissue to where a stroke begins, as a hand does that cannot appear in it: by `from` [m] from
  /// outside.
  Stroke entered(Stroke stroke, Vec3 from) const {
    const double way = norm(from), length = way + stroke.length;
    const auto at = [=](double t) {
      const double gone = t * length;
      Inputs inputs = stroke.at(std::max(0.0, gone - way) / stroke.length);
      inputs.position += std::max(0.0, 1 - gone / way) * from;
      return inputs;
    };
    return {at, length};
  }
  Vec3 above(double bottom) const { return {0, 0, box_.high.z + kBeyond - bottom}; }

  /// An ellipse around the middle, closed and a little more, of a part of the box.
  Stroke ring(double size, double bottom) const {
    const auto at = [=, this](double t) {
      const double a = 1.03 * 2 * std::numbers::pi * t;
      const Vec3 way{-half_.x * std::sin(a), half_.y * std::cos(a), 0};
      return upright({middle_.x + size * half_.x * std::cos(a), middle_.y + size * half_.y * std::sin(a), bottom},
                     std::atan2(way.y, way.x));
    };
    return entered({at, 2 * std::numbers::pi * size * std::max(half_.x, half_.y)}, above(bottom));
  }
  /// The blade lies level along x, its tip at `tip` [m] and its heel beyond the organ, and goes along y; through a part
  /// of the organ, where it begins with a stab along its length.
  Stroke level(double z, double tip, double part) const {
    const double length = 2 * (part * half_.y + (part < 1 ? 0 : kBeyond));
    const auto at = [=, this](double t) {
      Inputs inputs;
      inputs.tool = tool_, inputs.position = {tip, middle_.y + length * (t - 0.5), z};
      inputs.world_from_tool = {0.5, -0.5, -0.5, 0.5};  // its edge towards -x, what it cuts towards y
      return inputs;
    };
    if (part >= 1) return {at, length};
    return entered({at, length}, {box_.low.x - kBeyond - tip, 0, 0});
  }

  Box box_;
  std::int32_t tool_;
  Vec3 middle_, half_;  ///< [m]
  double spacing_ = 0;  ///< [m]
};

class Look {
 public:
  Look(const Model& model, StrokesResult::Row& row)
      : model_(model), row_(row), drawn_(model, 0), places_(model), elements_of_(std::size_t(model.organs[0].count)) {
    for (std::size_t i = 0; i < model.axial.size(); ++i)
      for (const std::int32_t sphere : {model.axial.a[i], model.axial.b[i]})
        elements_of_[std::size_t(sphere - model.organs[0].first)].push_back(i);
  }

  void at(const State& state) {
    const bool is_swept = has_grown(state);
    const bool has_changed = drawn_.update(state);
    ++row_.looks;
    if (has_changed && !is_swept) ++row_.changed_uncut;
    if (has_changed) {
      const Topology topology = topology_of(drawn_);
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
    const double spacing = model_.organs[0].spacing, least = surface::kShort * spacing;
    surface::deform_surface(surface, state.position, model_.organs[0].first, carried_);
    places_.place(0, surface, state, vertex_);
    for (const auto& t : surface.triangle) {
      Vec3 rest[3], carried[3], now[3];
      for (std::size_t c = 0; c < 3; ++c) {
        const auto v = std::size_t(t[c]);
        rest[c] = surface.vertex[v], carried[c] = carried_[v], now[c] = vertex_[v];
      }
      row_.carried_stretch = std::max(row_.carried_stretch, surface::stretch_of(rest, carried, spacing));
      const double stretch = surface::stretch_of(rest, now, spacing);
      row_.stretch = std::max(row_.stretch, stretch);
      if (stretch > kMostStretched) {
        const bool is_pulled = stretch_of_elements(state, t) > kPulled * stretch;
        row_.pulled += is_pulled, row_.stretched += !is_pulled;
      }
      for (std::size_t c = 0; c < 3; ++c)
        if (const double edge = norm(rest[(c + 1) % 3] - rest[c]); edge < least)
          row_.torn = std::max(row_.torn, (norm(now[(c + 1) % 3] - now[c]) - edge) / spacing);
    }
  }

  /// The largest stretch of the whole elements between spheres that a triangle follows and their neighbours: they pull
  /// by it.
  double stretch_of_elements(const State& state, const std::array<std::int32_t, 3>& triangle) const {
    const SurfaceBinding& binding = drawn_.surface().binding;
    double most = 1;
    for (const std::int32_t v : triangle)
      for (auto e = std::size_t(binding.first[std::size_t(v)]); e < std::size_t(binding.first[std::size_t(v) + 1]); ++e)
        for (const std::size_t i : elements_of_[std::size_t(binding.sphere[e])]) {
          const auto a = std::size_t(model_.axial.a[i]), b = std::size_t(model_.axial.b[i]);
          if (state.axial_severed[i] == 0)
            most = std::max(most, norm(state.position[b] - state.position[a]) / model_.axial.rest_length[i]);
        }
    return most;
  }

  const Model& model_;
  StrokesResult::Row& row_;
  cutbody::CutBody drawn_;
  contact::DrawnSurfaces places_;
  std::vector<std::vector<std::size_t>> elements_of_;  ///< of each sphere
  std::size_t points_ = 0;
  std::vector<Vec3> last_row_;
  std::vector<Vec3> carried_, vertex_;  ///< where the spheres carry vertices, and where they are drawn [m]
};

StrokesResult::Row measure(const Model& model, const std::vector<Stroke>& strokes) {
  StrokesResult::Row row;
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  (void)stepper.settle(state, std::int64_t(kSettle / model.tick));
  Look look(model, row);
  const auto step = [&](const Inputs& inputs) {
    const stepping::StepReport report = stepper.step(state, inputs);
    row.severed += report.severed, row.refused += stepping::is_refused(report.status);
    if (state.tick % kLookEvery == 0) look.at(state);
  };
  for (const Stroke& stroke : strokes) {
    const double ticks = stroke.ticks(model.tick);
    for (double i = 0; i <= ticks; ++i) step(stroke.at(i / ticks));
    step({});
  }
  for (std::int64_t i = 0; i < std::int64_t(kWait / model.tick); ++i) step({});
  return row;
}

}  // namespace

Result<StrokesResult> measure_strokes(const std::string& shipped, bool is_quick) {
  StrokesResult result;
  for (const double finer : is_quick ? std::vector{1.0} : std::vector{1.0, 2.0})
    for (const char* organ : is_quick ? std::vector{"kidney"} : std::vector{"kidney", "skin", "liver"}) {
      Result<Model> model = load_organ(shipped + "/" + organ + ".json", finer);
      if (!model) return model.errors();
      const auto scalpel = std::find_if(model->tools.begin(), model->tools.end(),
                                        [](const Tool& tool) { return tool.kind == ToolKind::scalpel; });
      if (scalpel == model->tools.end()) return Error{organ, "has no scalpel", ""};
      const Strokes strokes(model->surfaces[0], model->organs[0].spacing, std::int32_t(scalpel - model->tools.begin()));
      // It reaches through the organ, however it lies.
      scalpel->blade_length = kLongBlade;
      std::vector<Cut> cuts = strokes.cuts();
      if (is_quick) cuts.erase(cuts.begin() + 1, cuts.end());
      const std::size_t first = result.rows.size();
      result.rows.resize(first + cuts.size());
      in_parallel(cuts.size(), [&](std::size_t i) {
        StrokesResult::Row row = measure(*model, cuts[i].strokes);
        row.organ = organ, row.stroke = cuts[i].name, row.radius = model->organs[0].sphere_radius;
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
      "The blades of the shipped scenes, made long enough, go through their organs, at their own filling and at half "
      "its "
      "radius, at 40 mm/s: on a straight line half "
      "of the organ's height deep, on an S, on a closed ellipse, on two lines that cross, with a tremor of 1 mm at "
      "8 Hz; they take a cap off, a disc out, and cut strips of 1, 0.5 and 0.3 spacings. They enter from outside: "
      "for the ellipse from above, for the level cut below a disc by a stab. Every 25 ticks the drawn "
      "surface is looked "
      "at: it should be closed, with as many components as there are pieces, change only where the blade went on, and "
      "no triangle should be six times as long as at rest, or as a twentieth of a spacing where it is shorter, without "
      "a force to show for it: elements under it that are stretched by half as much. Where no element holds tissue, as "
      "in front of a cut under a flap that folds over, what is drawn spreads the stretch over its neighbours; how far "
      "the spheres alone would stretch it is told beside. Places that lie together at rest may follow different "
      "spheres; how far they came apart is in the last column."};
  reports::Table table;
  table.columns = {{"organ", "organ"},
                   {"radius_mm", "r [mm]"},
                   {"stroke", "stroke"},
                   {"severed", "severed elements"},
                   {"looks", "looks"},
                   {"wrong", "looks at a surface that is open or has other components"},
                   {"changed_uncut", "changes without a cut"},
                   {"stretch", "largest stretch", 2},
                   {"carried_stretch", "largest stretch before it is spread", 2},
                   {"stretched", "triangles beyond 6 without a force"},
                   {"pulled", "with a force"},
                   {"torn_spacings", "places came apart [spacings]", 3}};
  for (const StrokesResult::Row& row : result.rows) {
    table.rows.push_back({row.organ, 1e3 * row.radius, row.stroke, double(row.severed), double(row.looks),
                          double(row.wrong), double(row.changed_uncut), row.stretch, row.carried_stretch,
                          double(row.stretched), double(row.pulled), row.torn});
    const auto add = [&](const std::string& name, double measured, Goal goal) {
      chapter.figures.push_back({.recipe = "strokes",
                                 .name = name + ", " + row.organ + ", " + row.stroke,
                                 .radius = row.radius,
                                 .measured = measured,
                                 .unit = "1",
                                 .source = "requirement",
                                 .goal = goal});
    };
    add("severed elements", row.severed, {1.0, {}});
    add("refused ticks", row.refused, {{}, 0.0});
    add("looks at a surface that is open or has other components than pieces", row.wrong, {{}, 0.0});
    add("changes of the surface without a cut", row.changed_uncut, {{}, 0.0});
    add("triangles stretched more than six times without a force", row.stretched, {{}, 0.0});
  }
  section.tables = {table};
  return chapter;
}

}  // namespace ctpm::fidelity
