#include "studio/server/drawn_cuts.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "studio/render/noise.h"
#include "studio/render/shading_correction.h"
#include "studio/server/message_bytes.h"

namespace ctpm::server {
namespace {

constexpr std::uint32_t kCopiesNormal = 1u << 31;

/// What is added to the normals of an organ that is cut, in bytes.
void add_corrections(MessageBytes& out, const render::CutSurface& cut) {
  constexpr double kSteps = 63.5;  // of a correction of 1
  const Surface& surface = cut.surface();
  const render::ShadingCorrections corrections =
      render::corrections_of(surface, render::count_neighbours(surface), cut.at_rest());
  out.add(std::uint32_t(corrections.size()));
  for (const render::ShadingCorrection& one : corrections)
    out.add(std::uint32_t(one.neighbour) | (one.is_copy ? kCopiesNormal : 0u));
  for (const bool is_along : {true, false})
    for (const render::ShadingCorrection& one : corrections)
      out.add(std::int8_t(std::clamp(std::round(kSteps * (is_along ? one.along : one.across)), -127.0, 127.0)));
  out.pad();
}

/// What the triangles message says of the surfaces: corners, stain and lips of every organ's.
std::string triangles_of(const std::vector<render::CutSurface>& surfaces) {
  constexpr double kStainsPerMetre = 72;  // as in videos
  MessageBytes out;
  out.add(std::uint32_t(surfaces.size()));
  for (const render::CutSurface& cut : surfaces) {
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
  for (const render::CutSurface& cut : surfaces) add_corrections(out, cut);
  return std::move(out.text);
}

/// What it begins with.
std::string head_of_triangles(std::uint32_t stage, std::uint32_t topology) {
  MessageBytes out;
  out.add(std::uint32_t(kTriangles)), out.add(stage), out.add(topology);
  return std::move(out.text);
}

}  // namespace

std::size_t DrawnCut::bytes() const {
  std::size_t bytes = sizeof *this + triangles.size();
  for (const Surface& s : surfaces)
    bytes += sizeof(Vec3) * s.vertex.size() + sizeof s.triangle[0] * s.triangle.size() +
             sizeof(std::int32_t) * (s.binding.first.size() + s.binding.sphere.size()) +
             sizeof(double) * s.binding.weight.size();
  return bytes;
}

CutFollower::CutFollower(const Model& model, std::uint32_t stage, std::shared_ptr<const DrawnCut> whole)
    : stage_(stage), drawn_(std::move(whole)) {
  for (std::size_t i = 0; i < model.surfaces.size(); ++i) surfaces_.emplace_back(model, i);
}

std::shared_ptr<const DrawnCut> CutFollower::draw(const State& state) {
  bool changed = !drawn_;
  for (render::CutSurface& cut : surfaces_) changed = cut.update(state) || changed;
  if (changed) {
    draw_surfaces(state);
  } else if (!drawn_->key.is_of(state)) {  // a blade that changed no surface
    DrawnCut same = *drawn_;
    same.key = CutKey(state);
    drawn_ = std::make_shared<const DrawnCut>(std::move(same));
  }
  return drawn_;
}

void CutFollower::draw_surfaces(const State& state) {
  static std::atomic<std::uint32_t> made{0};
  // A cut may move what its edge goes through, which comes with each frame, and leave the triangles as they are.
  const std::string triangles = triangles_of(surfaces_);
  const std::uint32_t topology = drawn_ && drawn_->triangles == head_of_triangles(stage_, drawn_->topology) + triangles
                                     ? drawn_->topology
                                     : ++made;
  DrawnCut drawn{CutKey(state), {}, {}, topology, head_of_triangles(stage_, topology) + triangles};
  for (const render::CutSurface& cut : surfaces_)
    drawn.surfaces.push_back(cut.surface()), drawn.outer_triangles.push_back(cut.outer_triangle_count());
  drawn_ = std::make_shared<const DrawnCut>(std::move(drawn));
}

DrawnCuts::DrawnCuts(const Model& model, std::uint32_t stage) {
  keep_for_good(CutFollower(model, stage).draw(rest_state(model)));
}

std::shared_ptr<const DrawnCut> DrawnCuts::whole() const {
  const std::lock_guard lock(mutex_);
  return for_good_.front();
}

std::shared_ptr<const DrawnCut> DrawnCuts::of(const State& state) const {
  const std::lock_guard lock(mutex_);
  for (const auto* kept : {&recent_, &for_good_})
    for (auto drawn = kept->rbegin(); drawn != kept->rend(); ++drawn)
      if ((*drawn)->key.is_of(state)) return *drawn;
  return nullptr;
}

std::shared_ptr<const DrawnCut> DrawnCuts::nearest(const State& state) const {
  if (auto same = of(state)) return same;
  const std::lock_guard lock(mutex_);
  std::shared_ptr<const DrawnCut> best;
  for (const auto* kept : {&recent_, &for_good_})
    for (const auto& drawn : *kept)
      if (drawn->key.is_part_of(state) && (!best || drawn->key.points() >= best->key.points())) best = drawn;
  return best;
}

void DrawnCuts::keep(const std::shared_ptr<const DrawnCut>& drawn) {
  const std::lock_guard lock(mutex_);
  if (std::find(recent_.begin(), recent_.end(), drawn) != recent_.end()) return;
  recent_.push_back(drawn);
  if (recent_.size() > kMostRecent) recent_.erase(recent_.begin());
}

bool DrawnCuts::keep_for_good(const std::shared_ptr<const DrawnCut>& drawn) {
  const std::lock_guard lock(mutex_);
  if (bytes_ + drawn->bytes() > kMostBytes) return false;
  bytes_ += drawn->bytes();
  for_good_.push_back(drawn);
  return true;
}

}  // namespace ctpm::server
