#include "studio/bench/motions.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/surface/surface.h"

namespace ctpm::bench {
namespace {

/// The highest sphere that is free to move.
std::size_t top_of(const Model& model) {
  std::size_t top = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.held_axes[i] == 0 && (model.held_axes[top] != 0 || model.rest_position.z[i] > model.rest_position.z[top]))
      top = i;
  return top;
}

/// The tool goes down by `depth` [m] from `start` at 100 mm/s, stays, and leaves.
BenchMotion press_and_release(const Model& model, std::int32_t tool, Vec3 start, double depth) {
  constexpr double kSpeed = 0.1;
  const double in = depth / kSpeed, hold = 0.02, tick = model.tick;
  BenchMotion motion;
  motion.ticks = std::llround((2 * in + 1.5 * hold) / tick);
  motion.hand = [=](std::int64_t t) {
    const double time = double(t + 1) * tick;
    const double gone = time < in ? kSpeed * time : std::min(depth, depth - kSpeed * (time - in - hold));
    Inputs inputs;
    inputs.tool = tool, inputs.position = start - Vec3{0, 0, gone};
    return inputs;
  };
  return motion;
}

}  // namespace

std::int32_t first_tool(const Model& model, ToolKind kind) {
  const auto it = std::find_if(model.tools.begin(), model.tools.end(), [&](const Tool& t) { return t.kind == kind; });
  return it == model.tools.end() ? -1 : std::int32_t(it - model.tools.begin());
}

BenchMotion press_the_top(const Model& model, std::int32_t ball, const State& start) {
  const std::size_t top = top_of(model);
  Vec3 place = start.position[top] + Vec3{0, 0, model.contact_radius[top]};
  if (!model.surfaces.empty() && !model.surfaces[0].vertex.empty()) {
    std::vector<Vec3> drawn;
    surface::deform_surface(model.surfaces[0], start.position, model.organs[0].first, drawn);
    place = *std::max_element(drawn.begin(), drawn.end(), [](Vec3 p, Vec3 q) { return p.z < q.z; });
  }
  return press_and_release(model, ball, place + Vec3{0, 0, model.tools[std::size_t(ball)].radius}, 6e-3);
}

BenchMotion move_the_top(Model& model, const State& start) {
  const std::size_t top = top_of(model);
  model.tools.push_back({"pin", ToolKind::pin, 0, 0, std::int32_t(top)});
  return press_and_release(model, std::int32_t(model.tools.size()) - 1, start.position[top], 6e-3);
}

BenchMotion press_between(const Model& model, std::int32_t ball, const State&) {
  return press_and_release(model, ball, {-0.045, 0.086, 0.075}, 21e-3);
}

BenchMotion cut_along_x(const Model& model, std::int32_t scalpel, const State&) {
  constexpr double kSpeed = 0.4;
  const Vec3Array& p = model.rest_position;
  const auto [left, right] = std::minmax_element(p.x.begin(), p.x.end());
  const auto [low, high] = std::minmax_element(p.z.begin(), p.z.end());
  const double spacing = model.organs[0].spacing;
  // Between two layers of spheres, where no sphere's centre is.
  const Vec3 from{*left - spacing, p.y[p.size() / 2] + 0.5 * spacing, *low + 0.55 * (*high - *low)};
  const double way = *right - *left + 2 * spacing, tick = model.tick;
  BenchMotion motion;
  motion.ticks = std::llround(way / kSpeed / tick) + 20;
  motion.hand = [=](std::int64_t t) {
    Inputs inputs;
    const double gone = kSpeed * double(t) * tick;
    if (gone > way) return inputs;
    inputs.tool = scalpel, inputs.position = from + Vec3{gone, 0, 0};
    return inputs;
  };
  return motion;
}

}  // namespace ctpm::bench
