#include "studio/bench/press.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/model/nearest_rank.h"
#include "core/surface/surface.h"
#include "studio/bench/motions.h"
#include "studio/loading/standing.h"
#include "studio/output/number_text.h"

namespace ctpm::bench {
namespace {

/// The ball comes down on the highest of a surface's vertices [m], 6 mm at 60 mm/s, and stays.
BenchMotion press_surface(const std::vector<Vec3>& vertices, double ball_radius, double tick) {
  constexpr double kDepth = 6e-3, kSpeed = 0.06;
  const Vec3 top = *std::max_element(vertices.begin(), vertices.end(), [](Vec3 p, Vec3 q) { return p.z < q.z; });
  BenchMotion motion;
  motion.ticks = std::llround(1.2 * kDepth / kSpeed / tick);
  motion.hand = [=](std::int64_t t) {
    Inputs inputs;
    inputs.position = top + Vec3{0, 0, ball_radius - std::min(kDepth, kSpeed * double(t + 1) * tick)};
    return inputs;
  };
  return motion;
}

}  // namespace

bool can_press(const loading::LoadedScene& scene) {
  return !scene.scene.spec.organs.empty() && !scene.scene.spec.organs[0].mesh.empty() &&
         first_tool(scene.built.model, ToolKind::ball) >= 0;
}

Result<PressedOrgan> press_organ(const loading::LoadedScene& scene, const Model& model) {
  const Surface& surface = scene.organs[0].surface;
  const std::int32_t ball = first_tool(model, ToolKind::ball);
  std::optional<loading::Standing> standing = loading::settle_scene(scene.scene.spec, model);
  std::vector<Vec3> start, drawn;
  surface::deform_surface(surface, standing->state.position, model.organs[0].first, start);
  BenchMotion motion = press_surface(start, model.tools[std::size_t(ball)].radius, model.tick);
  motion.start = std::move(standing->state);
  motion.hand = [hand = motion.hand, ball](std::int64_t tick) {
    Inputs inputs = hand(tick);
    inputs.tool = ball;
    return inputs;
  };
  const OrganRange& organ = model.organs[0];
  const double radius = scene.scene.spec.organs[0].fill.radius;
  PressedOrgan pressed{radius, organ.layer_count, organ.count, run_motion(model, motion)};
  if (pressed.run.status != stepping::StepStatus::ok)
    return Error{scene.path, "the press diverged at r = " + output::short_number(1e3 * radius) + " mm", ""};
  // Fillings come to rest in shapes that differ a little: what is compared is what the press does.
  for (Vec3Array& position : pressed.run.position) {
    surface::deform_surface(surface, position, model.organs[0].first, drawn);
    position.resize(drawn.size());
    for (std::size_t v = 0; v < drawn.size(); ++v) position.set(v, drawn[v] + (surface.vertex[v] - start[v]));
  }
  return pressed;
}

Result<loading::LoadedScene> load_refilled(const loading::LoadedScene& own, double factor) {
  return loading::load_whole_scene(own.path, {}, [&](scenes::SceneSpec& spec) {
    spec.gravity = {}, spec.loads.clear();
    spec.organs[0].fill.radius *= factor, spec.organs[0].fill.gap *= factor;
    if (own.built.model.contact_k > 0) spec.contact_stiffness = own.built.model.contact_k;
  });
}

std::string left_out_sentence(const loading::LoadedScene& own, double factor, const Errors& errors) {
  const double radius = factor * own.scene.spec.organs[0].fill.radius;
  // What is read from a file has its key in the message, what is built without one has it as the place.
  const Error& error = errors.front();
  const std::string key = error.where.starts_with('/') ? error.where + ": " : "";
  return "Spheres of r = " + output::short_number(1e3 * radius, 3) +
         " mm are too coarse for this scene and left out: " + key + error.message + ".";
}

std::vector<reports::Cell> row_of(const std::string& study, const std::string& scene, const std::string& model,
                                  const PressedOrgan& organ, double tick, reports::Cell position_error,
                                  double force_error) {
  const std::vector<double>& seconds = organ.run.seconds;
  return {study,
          scene,
          model,
          reports::Cell(),
          reports::Cell(),
          reports::Cell(),
          1e3 * organ.radius,
          organ.layers,
          organ.spheres,
          std::move(position_error),
          force_error,
          run_time_of(organ.run.seconds, tick),
          1e3 * percentile(seconds, 0.5),
          1e3 * percentile(seconds, 0.99),
          1e3 * percentile(seconds, 0.999),
          organ.run.unconverged,
          organ.run.fallbacks,
          reports::Cell()};
}

}  // namespace ctpm::bench
