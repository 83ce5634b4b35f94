#include "studio/paper/pictures.h"

#include <algorithm>
#include <array>
#include <map>

#include "core/surface/surface.h"
#include "studio/render/renderer.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::paper {
namespace {

constexpr int kWidth = 640, kHeight = 420;

}  // namespace

void add_box_surface(FilledOrgan& block, int steps) {
  Vec3 low = block.centre.front(), high = low;
  for (const Vec3& p : block.centre) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 margin = 0.5 * block.spacing * Vec3{1, 1, 1};
  low = low - margin, high = high + margin;
  const double edge = block.spacing / steps;
  const std::array<double, 3> from{low.x, low.y, low.z}, size{high.x - low.x, high.y - low.y, high.z - low.z};
  std::array<int, 3> count{};
  for (std::size_t axis = 0; axis < 3; ++axis) count[axis] = int(size[axis] / edge + 0.5);
  Surface& surface = block.surface;
  surface = {};
  // Vertices on the box's edges belong to several faces and are created once.
  std::map<std::array<int, 3>, std::int32_t> vertex_at;
  const auto vertex = [&](const std::array<int, 3>& place) {
    const auto [it, is_new] = vertex_at.emplace(place, std::int32_t(surface.vertex.size()));
    if (is_new)
      surface.vertex.push_back({from[0] + edge * place[0], from[1] + edge * place[1], from[2] + edge * place[2]});
    return it->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool is_high : {false, true}) {
      const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int i = 0; i < count[u]; ++i)
        for (int j = 0; j < count[v]; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> place{};
            place[axis] = is_high ? count[axis] : 0, place[u] = i + di, place[v] = j + dj;
            return vertex(place);
          };
          const std::int32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          // u, v, axis are right-handed: counter-clockwise seen from the high side.
          if (is_high)
            surface.triangle.push_back({a, b, c}), surface.triangle.push_back({a, c, d});
          else
            surface.triangle.push_back({a, c, b}), surface.triangle.push_back({a, d, c});
        }
    }
  surface::bind_surface(block);
}

Result<std::vector<reports::Picture>> draw_shots(const scenes::SceneSpec& scene, const std::vector<FilledOrgan>& organs,
                                                 const Model& model, const render::Camera& camera,
                                                 const std::vector<PaperShot>& shots) {
  // A rig has no surface of its own; blocks are drawn with the faces that were bound to their spheres.
  Model drawn = model;
  drawn.surfaces.clear();
  for (const FilledOrgan& organ : organs) drawn.surfaces.push_back(organ.surface);
  render::SceneView view = views::view_of(scene, drawn);
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(kWidth, kHeight, std::move(view));
  if (!renderer) return renderer.errors();
  std::vector<reports::Picture> pictures;
  for (const PaperShot& shot : shots) {
    State state = shot.state;
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      state.position.set(i, model.rest_position[i] + shot.exaggeration * (state.position[i] - model.rest_position[i]));
    // Hidden spheres move behind the camera.
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      if (model.rest_position[i].y < shot.from_y)
        state.position.set(i, camera.eye + 0.5 * (camera.eye - camera.target));
    render::DrawOptions options;
    options.camera = camera;
    options.view = shot.is_inside ? render::View::spheres : render::View::surface;
    options.show_tool = shot.show_tool;
    pictures.push_back({(*renderer)->draw(state, options), shot.caption});
  }
  return pictures;
}

}  // namespace ctpm::paper
