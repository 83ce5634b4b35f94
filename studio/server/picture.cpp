#include "studio/server/picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "studio/render/camera.h"
#include "studio/render/obstacle_mesh.h"
#include "studio/render/scene_view.h"
#include "studio/render/tool_mesh.h"
#include "studio/server/message_bytes.h"

namespace ctpm::server {
namespace {

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

PictureMaker::PictureMaker(const Model& model, std::uint32_t stage, std::shared_ptr<DrawnCuts> cuts)
    : model_(model), stage_(stage), cuts_(std::move(cuts)), places_(model) {}

/// Draws the cut of `state`: follows on from that cut or a part of it, else in a new place, or in that of which the
/// last use is longest ago.
std::shared_ptr<const DrawnCut> PictureMaker::draw(const State& state) {
  constexpr std::size_t kMostFollowed = 4;
  auto best = followers_.end();
  for (auto it = followers_.begin(); it != followers_.end(); ++it) {
    const CutKey& key = it->follower.drawn()->key;
    if (key.is_part_of(state) && (best == followers_.end() || key.points() > best->follower.drawn()->key.points()))
      best = it;
  }
  const bool is_begun = best != followers_.end() && !best->follower.drawn()->key.is_whole();
  if (!is_begun && followers_.size() < kMostFollowed)
    best = followers_.insert(followers_.end(), {CutFollower(model_, stage_, cuts_->whole())});
  else if (!is_begun)
    best = std::min_element(followers_.begin(), followers_.end(),
                            [](const Follower& a, const Follower& b) { return a.used < b.used; });
  best->used = ++uses_;
  return best->follower.draw(state);
}

Picture PictureMaker::make(const State& state, const FrameFacts& facts) {
  std::shared_ptr<const DrawnCut> drawn = cuts_->of(state);
  if (!drawn) cuts_->keep(drawn = draw(state));
  return make(state, facts, drawn);
}

Picture PictureMaker::make_glimpse(State state, const FrameFacts& facts) {
  const std::shared_ptr<const DrawnCut> drawn = cuts_->nearest(state);
  if (!drawn->key.is_of(state)) state.touched.clear();  // of places that these surfaces do not have
  return make(state, facts, drawn);
}

Picture PictureMaker::make(const State& state, const FrameFacts& facts, const std::shared_ptr<const DrawnCut>& drawn) {
  const Inputs& in = state.last_inputs;
  MessageBytes out;
  const auto add_pose = [&](const Hand& hand) {
    out.add(hand.tool), out.add(hand.position);
    for (const double x :
         {hand.world_from_tool.w, hand.world_from_tool.x, hand.world_from_tool.y, hand.world_from_tool.z})
      out.add(float(x));
  };
  out.add(std::uint32_t(kFrame)), out.add(stage_), out.add(drawn->topology), out.add(std::uint32_t(0));
  out.add(facts.request),
      out.add(std::uint32_t((facts.is_same ? 1 : 0) | (facts.is_live ? 2 : 0) | (facts.is_glimpse ? 4 : 0)));
  out.add(double(facts.tick) * model_.tick), out.add(double(facts.tick));
  add_pose(in);
  out.add(facts.force), out.add(float(facts.depth)), out.add(facts.contacts), out.add(std::uint32_t(facts.severed));
  out.add(facts.hand), out.add(float(facts.tick_time)), out.add(std::uint32_t(facts.late_ticks));
  out.add(float(facts.tick_p99)), out.add(float(facts.slip));
  out.add(std::uint32_t(drawn->surfaces.size()));
  vertex_.resize(drawn->surfaces.size());
  for (std::size_t i = 0; i < drawn->surfaces.size(); ++i) {
    places_.place(i, drawn->surfaces[i], state, vertex_[i]);
    add_positions(out, vertex_[i]);
  }
  if (model_.hands > 1) {
    const stepping::HandReport& report = facts.second.report;
    add_pose(in.second);
    out.add(report.tool_force), out.add(float(report.depth)), out.add(report.contacts), out.add(facts.second.hand);
  }
  Picture picture{stage_, drawn->topology, {drawn, &drawn->triangles}, std::move(out.text)};
  if (expert_) picture.expert = expert_message(state, facts.request, *drawn);
  return picture;
}

/// Message with the line of the expert's cut on the organs as they were placed last, and what is cut elsewhere.
std::string PictureMaker::expert_message(const State& state, std::uint32_t request, const DrawnCut& drawn) {
  std::vector<render::DrawnOrgan> organs;
  for (std::size_t i = 0; i < drawn.surfaces.size(); ++i)
    organs.push_back({&drawn.surfaces[i], drawn.outer_triangles[i], &vertex_[i]});
  const std::uint64_t version = std::uint64_t(drawn.topology) << 32 | std::uint32_t(drawn.key.points());
  const render::ExpertMarks marks = marker_.place(model_, expert_, organs, version, state);
  MessageBytes out;
  out.add(std::uint32_t(kExpert)), out.add(stage_), out.add(request);
  out.add(std::uint32_t(marks.line.size())), out.add(std::uint32_t(marks.strays.size()));
  for (const auto& [from, to] : marks.line) out.add(from), out.add(to);
  for (const Vec3& stray : marks.strays) out.add(stray);
  return std::move(out.text);
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

std::string spheres_message(const Model& model, const std::vector<views::OrganTissues>& tissues, std::uint32_t stage) {
  MessageBytes out;
  out.add(std::uint32_t(kSpheres)), out.add(stage), out.add(std::uint32_t(model.organs.size()));
  for (std::size_t o = 0; o < model.organs.size(); ++o) {
    const OrganRange& organ = model.organs[o];
    const std::size_t first = std::size_t(organ.first), end = first + std::size_t(organ.count);
    out.add(std::uint32_t(organ.count)), out.add(float(organ.sphere_radius));
    for (std::size_t i = first; i < end; ++i) out.add(model.rest_position[i]);
    for (std::size_t i = first; i < end; ++i) out.add(std::uint8_t(std::min(model.layer[i], 255)));
    for (std::size_t i = first; i < end; ++i) out.add(std::uint8_t(model.held_axes[i] == kAnchored ? 1 : 0));
    for (const std::int32_t tissue : tissues[o].of_sphere) out.add(std::uint8_t(std::min(tissue, 255)));
    out.pad();
  }
  return std::move(out.text);
}

}  // namespace ctpm::server
