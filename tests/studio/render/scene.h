#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "core/cutting/cut_front.h"
#include "core/cutting/cutting.h"
#include "core/model/state.h"
#include "core/network/network.h"
#include "core/surface/surface.h"
#include "studio/render/renderer.h"

namespace ctpm::render_test {

/// Where an organ is: negative inside. Any smooth function whose size is about the distance [m].
using Shape = std::function<double(Vec3)>;

/// An ellipsoid with a broad dent, so that it is neither convex nor symmetric. About 13 x 9 x 6 cm.
inline double blob(Vec3 p) {
  const double q = std::sqrt(p.x * p.x / (0.065 * 0.065) + p.y * p.y / (0.045 * 0.045) + p.z * p.z / (0.03 * 0.03));
  const double dent = 0.15 * std::exp(-(p.x - 0.02) * (p.x - 0.02) / 2e-4 - (p.y + 0.04) * (p.y + 0.04) / 4e-4);
  return (q - 1 + dent) * 0.04;
}

/// A sphere's triangulation pulled onto the shape along rays from its middle.
inline Surface star_surface(const Shape& shape, int rows) {
  Surface surface;
  const int columns = 2 * rows;
  const auto on_shape = [&](Vec3 direction) {
    double low = 0, high = 0.2;
    for (int i = 0; i < 50; ++i) (shape(0.5 * (low + high) * direction) < 0 ? low : high) = 0.5 * (low + high);
    return low * direction;
  };
  surface.vertex.push_back(on_shape({0, 0, -1}));
  for (int r = 1; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double a = std::numbers::pi * (double(r) / rows - 0.5),
                   b = 2 * std::numbers::pi * (c + 0.5 * (r % 2)) / columns;
      surface.vertex.push_back(on_shape({std::cos(a) * std::cos(b), std::cos(a) * std::sin(b), std::sin(a)}));
    }
  surface.vertex.push_back(on_shape({0, 0, 1}));
  const auto at = [&](int r, int c) { return 1 + (r - 1) * columns + (c + columns) % columns; };
  const int last = int(surface.vertex.size()) - 1;
  for (int c = 0; c < columns; ++c) {
    surface.triangle.push_back({0, at(1, c + 1), at(1, c)});
    surface.triangle.push_back({last, at(rows - 1, c), at(rows - 1, c + 1)});
    for (int r = 1; r + 1 < rows; ++r) {
      const int shift = r % 2;  // rows are staggered by half a column
      const int p = at(r, c), q = at(r, c + 1), s = at(r + 1, c), t = at(r + 1, c + 1);
      if (shift)
        surface.triangle.push_back({p, q, t}), surface.triangle.push_back({p, t, s});
      else
        surface.triangle.push_back({p, q, s}), surface.triangle.push_back({q, t, s});
    }
  }
  return surface;
}

/// Fills a shape with spheres and binds its surface.
inline FilledOrgan fill(const Shape& shape, Surface surface, double radius) {
  FilledOrgan organ;
  organ.sphere_radius = radius, organ.spacing = 3 * radius;
  organ.surface = std::move(surface);
  const render::Bounds box = render::bounds_of(organ.surface.vertex);
  const auto cells = [&](double length) { return int(length / 2 / organ.spacing) + 1; };
  for (int k = -cells(box.max.z - box.min.z); k <= cells(box.max.z - box.min.z); ++k)
    for (int j = -cells(box.max.y - box.min.y); j <= cells(box.max.y - box.min.y); ++j)
      for (int i = -cells(box.max.x - box.min.x); i <= cells(box.max.x - box.min.x); ++i) {
        const Vec3 p = box.centre() + organ.spacing * Vec3{i + 0.5, j + 0.5, k + 0.5};
        const double depth = -shape(p);
        if (depth < 0.6 * radius) continue;
        organ.centre.push_back(p), organ.cell.push_back({i, j, k}), organ.depth.push_back(depth);
        organ.layer.push_back(1 + int(depth / organ.spacing));
      }
  surface::bind_surface(organ);
  return organ;
}

/// A scene of one organ with a ball (tool 0) and a scalpel (tool 1).
struct TestScene {
  Model model;
  render::SceneView view;
};

inline std::unique_ptr<TestScene> make_scene(const FilledOrgan& organ, const std::string& name = "liver") {
  auto scene = std::make_unique<TestScene>();
  network::OrganSettings settings;
  settings.name = name;
  settings.material = {15e6, 15e6, 20e6, 5e6, 1060, 1, std::numbers::pi * 4e-6, 0.012};
  scene->model.gravity = {0, 0, -9.81};
  scene->model.tools = {{"ball", ToolKind::ball, 0.008, 0}, {"scalpel", ToolKind::scalpel, 0, 0.035}};
  scene->model.contact_k = 100;
  const auto added = network::add_organ(scene->model, organ, settings);
  EXPECT_TRUE(added) << to_string(added ? Error{} : added.errors()[0]);
  scene->view.model = &scene->model;
  return scene;
}

inline std::unique_ptr<TestScene> make_blob_scene(double radius = 0.003, int rows = 40) {
  return make_scene(fill(blob, star_surface(blob, rows), radius));
}

/// A straight edge.
struct Edge {
  Vec3 tip, heel;  ///< [m]
};

/// Cuts what a straight edge sweeps through the tissue at rest, from one place to the other.
inline void cut(const Model& model, State& state, const Edge& from, const Edge& to) {
  const auto front = [](const Edge& edge) {
    cutting::Front nodes;
    for (std::size_t n = 0; n < kEdgeNodes; ++n)
      nodes[n] = edge.tip + double(n) / double(kEdgeNodes - 1) * (edge.heel - edge.tip);
    return nodes;
  };
  cutting::NewlySwept newly;
  newly.fill(1), newly.back() = 0;
  cutting::add_swept(state, front(from), front(to), newly);
  std::vector<cutting::Crossing> crossings;
  cutting::sever_swept(model, cutting::RestElements(model), front(from), front(to), newly, state, crossings);
}

/// Moves the spheres apart on both sides of the plane through `point` with the given normal, more the nearer
/// they are to `wide` times the distance from the hinge; only a picture's idea of an opened cut.
inline void spread(State& state, const Model& model, const std::function<Vec3(Vec3)>& shift) {
  for (std::size_t i = 0; i < model.sphere_count(); ++i) state.position.add(i, shift(model.rest_position[i]));
}

/// A blade along z that goes through the organ in the plane x = `x`, from one side to `end` in y, down to
/// `bottom`.
inline State cut_along_y(const Model& model, double x, double end, double bottom) {
  State state = rest_state(model);
  cut(model, state, {{x, -0.1, bottom}, {x, -0.1, 0.1}}, {{x, end, bottom}, {x, end, 0.1}});
  return state;
}

}  // namespace ctpm::render_test
