#include "studio/server/picture.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>

#include "studio/render/camera.h"
#include "studio/render/noise.h"
#include "studio/render/obstacle_mesh.h"
#include "studio/render/scene_view.h"
#include "studio/render/tool_mesh.h"

namespace ctpm::server {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

enum Kind : std::uint32_t { kTriangles = 1, kFrame = 2, kShapes = 3, kSpheres = 4 };

/// Appends plain values to a message.
class MessageBytes {
 public:
  template <class T>
  void add(T value) {
    add_all(&value, 1);
  }
  void add(Vec3 v) {
    for (const double x : {v.x, v.y, v.z}) add(float(x));
  }
  template <class T>
  void add_all(const T* values, std::size_t count) {
    text.append(reinterpret_cast<const char*>(values), count * sizeof(T));
  }
  void pad() { text.append((4 - text.size() % 4) % 4, '\0'); }

  std::string text;
};

/// Positions as shares of their box, which spans the 16-bit numbers.
void add_positions(MessageBytes& out, const std::vector<Vec3>& vertex) {
  const render::Bounds box = render::bounds_of(vertex);
  const Vec3 size = box.max - box.min;
  out.add(std::uint32_t(vertex.size()));
  out.add(box.min), out.add(size);
  const auto step = [](double extent) { return extent > 0 ? 65535 / extent : 0; };
  const Vec3 scale{step(size.x), step(size.y), step(size.z)};
  std::vector<std::uint16_t> numbers;
  numbers.reserve(3 * vertex.size());
  for (const Vec3& p : vertex) {
    numbers.push_back(std::uint16_t((p.x - box.min.x) * scale.x + 0.5));
    numbers.push_back(std::uint16_t((p.y - box.min.y) * scale.y + 0.5));
    numbers.push_back(std::uint16_t((p.z - box.min.z) * scale.z + 0.5));
  }
  out.add_all(numbers.data(), numbers.size());
  out.pad();
}

}  // namespace

PictureMaker::PictureMaker(const Model& model, std::uint32_t stage)
    : model_(model), stage_(stage), places_(std::make_unique<contact::DrawnSurfaces>(model)) {}

/// What is drawn of the cut of `state`: as it was before, or continued from a part of it, or built in a new place or in
/// that of which the last use is longest ago.
PictureMaker::Drawn& PictureMaker::drawn_of(const State& state) {
  constexpr std::size_t kMostKept = 4;
  auto found = std::find_if(drawn_.begin(), drawn_.end(), [&](const Drawn& drawn) { return drawn.key.is_of(state); });
  if (found == drawn_.end())
    found = std::find_if(drawn_.begin(), drawn_.end(),
                         [&](const Drawn& drawn) { return !drawn.key.is_whole() && drawn.key.is_part_of(state); });
  if (found == drawn_.end() && drawn_.size() < kMostKept) {
    Drawn made;
    for (std::size_t i = 0; i < model_.surfaces.size(); ++i) made.surfaces.emplace_back(model_, i);
    found = drawn_.insert(drawn_.end(), std::move(made));
  } else if (found == drawn_.end()) {
    found =
        std::min_element(drawn_.begin(), drawn_.end(), [](const Drawn& a, const Drawn& b) { return a.used < b.used; });
  }
  bool changed = !found->triangles;
  for (render::CutSurface& cut : found->surfaces) changed = cut.update(state) || changed;
  found->key = CutKey(state), found->used = ++uses_;
  if (changed) make_triangles(*found);
  return *found;
}

void PictureMaker::make_triangles(Drawn& drawn) const {
  static std::atomic<std::uint32_t> made{0};
  drawn.topology = ++made;
  constexpr double kStainsPerMetre = 72;  // as in videos
  MessageBytes out;
  out.add(std::uint32_t(kTriangles)), out.add(stage_), out.add(drawn.topology),
      out.add(std::uint32_t(drawn.surfaces.size()));
  for (const render::CutSurface& cut : drawn.surfaces) {
    const Surface& surface = cut.surface();
    out.add(std::uint32_t(surface.vertex.size())), out.add(std::uint32_t(cut.outer_vertex_count()));
    out.add(std::uint32_t(surface.triangle.size())), out.add(std::uint32_t(cut.outer_triangle_count()));
    out.add_all(surface.triangle.data(), surface.triangle.size());
    for (const Vec3& p : surface.vertex)
      out.add(std::uint8_t(std::clamp(127.5 + 127.5 * render::noise_at(kStainsPerMetre * p), 0.0, 255.0)));
    for (std::size_t v = 0; v < surface.vertex.size(); ++v)
      out.add(std::uint8_t(v < cut.is_lip().size() && cut.is_lip()[v] ? 255 : 0));
    out.pad();
  }
  drawn.triangles = std::make_shared<const std::string>(std::move(out.text));
}

Picture PictureMaker::make(const State& state, const FrameFacts& facts) {
  const Drawn& drawn = drawn_of(state);
  const Inputs& in = state.last_inputs;
  MessageBytes out;
  const auto add_pose = [&](const Hand& hand) {
    out.add(hand.tool), out.add(hand.position);
    for (const double x :
         {hand.world_from_tool.w, hand.world_from_tool.x, hand.world_from_tool.y, hand.world_from_tool.z})
      out.add(float(x));
  };
  out.add(std::uint32_t(kFrame)), out.add(stage_), out.add(drawn.topology), out.add(std::uint32_t(0));
  out.add(facts.request),
      out.add(std::uint32_t((facts.is_same ? 1 : 0) | (facts.is_live ? 2 : 0) | (facts.is_glimpse ? 4 : 0)));
  out.add(double(facts.tick) * model_.tick), out.add(double(facts.tick));
  add_pose(in);
  out.add(facts.force), out.add(float(facts.depth)), out.add(facts.contacts), out.add(std::uint32_t(facts.severed));
  out.add(facts.hand), out.add(float(facts.tick_time)), out.add(std::uint32_t(facts.late_ticks));
  out.add(float(facts.tick_p99)), out.add(float(facts.slip));
  out.add(std::uint32_t(drawn.surfaces.size()));
  for (std::size_t i = 0; i < drawn.surfaces.size(); ++i) {
    places_->place(i, drawn.surfaces[i].surface(), state, vertex_);
    add_positions(out, vertex_);
  }
  if (model_.hands > 1) {
    const stepping::HandReport& report = facts.second.report;
    add_pose(in.second);
    out.add(report.tool_force), out.add(float(report.depth)), out.add(report.contacts), out.add(facts.second.hand);
  }
  return {stage_, drawn.topology, drawn.triangles, std::move(out.text)};
}

std::int64_t severed_in(const State& state) {
  std::int64_t count = 0;
  for (const auto* flags : {&state.axial_severed, &state.constraint_severed, &state.angle_severed})
    count += std::count_if(flags->begin(), flags->end(), [](std::uint8_t flag) { return flag != 0; });
  return count;
}

std::string shapes_message(const Model& model, std::uint32_t stage) {
  MessageBytes out;
  const auto add_shape = [&](const render::ToolMesh& mesh) {
    out.add(std::uint32_t(mesh.vertex.size() / 7)), out.add(std::uint32_t(mesh.index.size()));
    out.add_all(mesh.vertex.data(), mesh.vertex.size()), out.add_all(mesh.index.data(), mesh.index.size());
  };
  out.add(std::uint32_t(kShapes)), out.add(stage), out.add(std::uint32_t(model.tools.size()));
  for (const Tool& tool : model.tools)
    add_shape(tool.kind == ToolKind::pin ? render::ToolMesh{} : render::make_tool_mesh(tool));
  render::SceneView view;
  view.model = &model;
  const render::Bounds box = render::rest_bounds(view);
  constexpr double kGround = 1.45;  // side of a plane against the scene's size, as in videos
  out.add(std::uint32_t(model.obstacles.size()));
  for (const Obstacle& obstacle : model.obstacles)
    add_shape(
        render::make_obstacle_mesh(obstacle, render::up_of(model), box.centre(), kGround * norm(box.max - box.min))
            .mesh);
  return std::move(out.text);
}

std::string spheres_message(const Model& model, std::uint32_t stage) {
  MessageBytes out;
  out.add(std::uint32_t(kSpheres)), out.add(stage), out.add(std::uint32_t(model.organs.size()));
  for (const OrganRange& organ : model.organs) {
    const std::size_t first = std::size_t(organ.first), end = first + std::size_t(organ.count);
    out.add(std::uint32_t(organ.count)), out.add(float(organ.sphere_radius));
    for (std::size_t i = first; i < end; ++i) out.add(model.rest_position[i]);
    for (std::size_t i = first; i < end; ++i) out.add(std::uint8_t(std::min(model.layer[i], 255)));
    for (std::size_t i = first; i < end; ++i) out.add(std::uint8_t(model.held_axes[i] == kAnchored ? 1 : 0));
    out.pad();
  }
  return std::move(out.text);
}

}  // namespace ctpm::server
