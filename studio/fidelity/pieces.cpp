// A blade cuts pieces off a block; they fall on the ground and rest there.

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "core/cutbody/cut_body.h"
#include "core/cutting/pieces.h"
#include "core/stepping/step.h"
#include "core/surface/surface.h"
#include "studio/fidelity/meshes.h"
#include "studio/fidelity/recipes.h"
#include "studio/fidelity/topology.h"

namespace ctpm::fidelity {
namespace {

constexpr Vec3 kHalf{27e-3, 27e-3, 15e-3};  // of the block [m]
constexpr double kClearance = 6e-3;         // between block and ground [m]
constexpr double kStroke = 1.2, kRest = 4;  // [s] of one stroke, and after the last one
constexpr double kReach = 1.3;              // how far strokes go beyond the block
constexpr std::int64_t kLookEvery = 100;    // ticks

/// A stroke: the blade's tip and orientation at a time from 0 to 1.
using Stroke = std::function<Inputs(double)>;

struct Cut {
  const char* name;
  std::vector<Stroke> strokes;
  scenes::AnchorSpec anchor;
  int pieces;
};

Inputs blade(Vec3 tip, Quat turn) {
  Inputs inputs;
  inputs.tool = 0, inputs.position = tip, inputs.world_from_tool = turn;
  return inputs;
}

double along(double t) { return kReach * (2 * t - 1); }

/// The block hangs with what is cut below.
std::vector<Cut> cuts() {
  const Quat level{std::sqrt(0.5), 0, std::sqrt(0.5), 0};  // the edge along x
  const Stroke cap = [=](double t) { return blade({-kReach * kHalf.x, along(t) * kHalf.y, -2e-3}, level); };
  const auto behind = [](Vec3 point, Vec3 normal) {
    scenes::AnchorSpec anchor;
    anchor.plane = scenes::PlaneRegion{point, normal};
    return anchor;
  };
  return {{"cap", {cap}, behind({0, 0, 9e-3}, {0, 0, -1}), 2}};
}

Result<Body> block(const Cut& cut, double radius) {
  Specimen specimen;
  specimen.radius = radius, specimen.pace = Pace::live, specimen.gravity = {0, 0, -9.81};
  scenes::SceneSpec scene = scene_of(specimen);
  scene.organs[0].anchors = {cut.anchor};
  // Tissue that does not resist the blade, and is not dragged along before it parts.
  scene.organs[0].material.fracture_toughness = scene.organs[0].material.blade_friction = 0;
  scene.obstacles.push_back({"ground", scenes::PlaneRegion{{0, 0, -kHalf.z - kClearance}, {0, 0, 1}}, {}});
  scenes::ToolSpec scalpel;
  scalpel.name = "scalpel", scalpel.kind = ToolKind::scalpel;
  scalpel.blade_length = 80e-3;
  scene.tools = {scalpel};
  return make_body(scene, box_mesh(-kHalf, kHalf, 0.75 * radius), {}, {});
}

/// Compares the drawn surface with the pieces.
void look(cutbody::CutBody& drawn, const State& state, PiecesResult::Row& row) {
  (void)drawn.update(state);
  const Topology topology = topology_of(drawn);
  ++row.looks;
  row.wrong += topology.components != drawn.piece_count() || topology.open_edges > 0;
}

/// What is left when all is at rest.
void judge(const Model& model, const cutbody::CutBody& drawn, const State& state, PiecesResult::Row& row) {
  cutting::Pieces pieces(model);
  row.of_tissue = pieces.find(state);
  std::set<std::int32_t> held, grounded;
  const double ground = model.obstacles[0].position.z;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    row.speed = std::max(row.speed, norm(state.velocity[i]));
    if (model.held_axes[i] == kAnchored) held.insert(pieces.piece()[i]);
  }
  std::vector<Vec3> vertex;
  surface::deform_surface(drawn.surface(), state.position, 0, vertex);
  const SurfaceBinding& binding = drawn.surface().binding;
  for (std::size_t v = 0; v < vertex.size(); ++v) {
    row.inside = std::max(row.inside, ground - vertex[v].z);
    if (vertex[v].z < ground + 0.5e-3)
      grounded.insert(pieces.piece()[std::size_t(binding.sphere[std::size_t(binding.first[v])])]);
  }
  row.on_ground = int(grounded.size()) == row.of_tissue - int(held.size());
}

PiecesResult::Row measure(const Cut& cut, const Body& body, double radius) {
  PiecesResult::Row row;
  row.cut = cut.name, row.radius = radius, row.pieces = cut.pieces;
  const Model& model = body.model;
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  cutbody::CutBody drawn(model, 0);
  const auto step = [&](const Inputs& inputs) {
    row.came_loose += stepper.step(state, inputs).came_loose;
    if (inputs.tool >= 0 && state.tick % kLookEvery == 0) look(drawn, state, row);
  };
  const auto ticks = std::int64_t(kStroke / model.tick);
  for (const Stroke& stroke : cut.strokes) {
    for (std::int64_t i = 0; i <= ticks; ++i) step(stroke(double(i) / double(ticks)));
    step({});
  }
  look(drawn, state, row);
  for (std::int64_t i = 0; i < std::int64_t(kRest / model.tick); ++i) step({});
  look(drawn, state, row);
  judge(model, drawn, state, row);
  return row;
}

}  // namespace

Result<PiecesResult> measure_pieces(double radius) {
  PiecesResult result;
  for (const Cut& cut : cuts()) {
    const Result<Body> body = block(cut, radius);
    if (!body) return body.errors();
    result.rows.push_back(measure(cut, *body, radius));
  }
  return result;
}

Chapter chapter_of(const PiecesResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "pieces", section.title = "Pieces that fall";
  section.paragraphs = {
      "A blade cuts a block of liver of 54 x 54 x 30 mm, of which one side is held, and which does not resist the "
      "blade: "
      "a cap. It falls on the ground, 6 mm below, and is looked at 4 s later. The drawn surface should at all times "
      "have as many closed components as there are pieces."};
  reports::Table table;
  table.columns = {{"cut", "cut"},
                   {"radius_mm", "r [mm]"},
                   {"pieces", "pieces"},
                   {"came_loose", "came loose"},
                   {"wrong", "looks at another number of components"},
                   {"looks", "looks"},
                   {"speed_mm_s", "speed [mm/s]", 3},
                   {"inside_mm", "inside the ground [mm]", 3}};
  for (const PiecesResult::Row& row : result.rows) {
    table.rows.push_back({row.cut, 1e3 * row.radius, double(row.of_tissue), double(row.came_loose), double(row.wrong),
                          double(row.looks), 1e3 * row.speed, 1e3 * row.inside});
    const auto add = [&](const std::string& name, double measured, const std::string& unit, double reference,
                         Goal goal) {
      chapter.figures.push_back({.recipe = "pieces",
                                 .name = name + ", " + row.cut,
                                 .radius = row.radius,
                                 .measured = measured,
                                 .unit = unit,
                                 .reference = reference,
                                 .source = "requirement",
                                 .goal = goal});
    };
    const double pieces = row.pieces, loose = pieces - 1;
    add("pieces of tissue", row.of_tissue, "1", pieces, {pieces, pieces});
    add("pieces that came loose", row.came_loose, "1", loose, {loose, loose});
    add("looks at which the drawn surface had other components than pieces", row.wrong, "1", 0, {{}, 0.0});
    add("loose pieces all lie on the ground", row.on_ground ? 1 : 0, "1", 1, {1.0, 1.0});
    add("speed 4 s after the cut", 1e3 * row.speed, "mm/s", 0, {{}, 2.0});
    add("surface inside the ground", 1e3 * row.inside, "mm", 0, {{}, 0.5});
  }
  section.tables = {table};
  return chapter;
}

}  // namespace ctpm::fidelity
