#include "core/contact/cut_overlaps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/surface/line_hit.h"

namespace ctpm::contact {
namespace {

using surface::Body, surface::NearSurface, surface::Overlap;

/// How deep surfaces may overlap and still be found, in spacings (our choice).
constexpr double kReach = 0.25;

/// Lines leave tissue through triangles that they meet at less than 60 degrees from their normals (our choice): near
/// the sharp rims of cuts others lead along a wall.
constexpr double kStraightOut = 0.5;

constexpr std::size_t kPerRun = 16;

/// Near any of some boxes, or everywhere.
struct NearOthers {
  bool is_everywhere;
  std::vector<Box> boxes{};

  bool meets(const Box& box) const {
    return is_everywhere || std::any_of(boxes.begin(), boxes.end(), [&](const Box& other) { return other.meets(box); });
  }
};

/// The sphere that a point follows most.
std::int32_t strongest(const surface::Follower& follows) {
  const auto most = std::max_element(follows.weight.begin(), follows.weight.end());
  return follows.sphere[std::size_t(most - follows.weight.begin())];
}

}  // namespace

CutOverlaps::CutOverlaps(const Model& model, std::vector<Body>& bodies, CutSurfaces& cuts)
    : model_(model), bodies_(bodies), cuts_(cuts) {}

bool CutOverlaps::meets(Tissue a, Tissue b) const {
  if (a.organ != b.organ) return model_.organs_meet;
  return model_.organs[std::size_t(a.organ)].meets_itself && a.piece != b.piece && a.piece >= 0 && b.piece >= 0;
}

bool CutOverlaps::may_meet_anything(std::size_t organ) const {
  return model_.organs_meet || (model_.organs[organ].meets_itself && cuts_.has_pieces(organ));
}

bool CutOverlaps::replaces() const {
  for (std::size_t organ = 0; organ < model_.organs.size(); ++organ)
    if (may_meet_anything(organ)) return true;
  return false;
}

double CutOverlaps::reach(std::size_t organ) const { return kReach * model_.organs[organ].spacing; }

Box CutOverlaps::box_of(const Body& body) { return body.surface.rest_box().moved(body.surface.displacements()); }

std::int32_t CutOverlaps::piece_at(const Body& body, std::int32_t vertex) const {
  const std::vector<std::int32_t>& pieces = piece_of_vertex_[std::size_t(&body - bodies_.data())];
  return pieces.empty() ? -1 : pieces[std::size_t(vertex)];
}

void CutOverlaps::begin() {
  if (version_ == cuts_.version() && piece_of_vertex_.size() == bodies_.size()) return;
  version_ = cuts_.version();
  piece_of_vertex_.assign(bodies_.size(), {});
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto organ = std::size_t(bodies_[b].organ);
    if (!cuts_.has_pieces(organ)) continue;
    for (std::size_t v = 0; v < bodies_[b].surface.vertex_count(); ++v) {
      const std::int32_t sphere = strongest(bodies_[b].surface.follower(std::int32_t(v))) - model_.organs[organ].first;
      piece_of_vertex_[b].push_back(cuts_.piece_of_sphere(organ)[std::size_t(sphere)]);
    }
  }
}

void CutOverlaps::add_candidate(const Body& body, const NearSurface::Triangle& triangle, const Vec3* corners) {
  const Box box(corners[0], corners[1], corners[2]);
  if (runs_.empty() || runs_.back().last - runs_.back().first == kPerRun)
    runs_.push_back({candidates_.size(), candidates_.size(), box});
  Run& run = runs_.back();
  run.box.add(box.low), run.box.add(box.high), ++run.last;
  candidates_.push_back(
      {&body, std::int32_t(&triangle - body.surface.triangles().data()), {corners[0], corners[1], corners[2]}, box});
}

/// Adds the triangles near `box` that `tissue` meets.
void CutOverlaps::add_candidates_near(const Box& box, Tissue tissue) {
  for (Body& body : bodies_) {
    const bool is_own = body.organ == tissue.organ;
    if (is_own ? !model_.organs[std::size_t(body.organ)].meets_itself : !model_.organs_meet) continue;
    body.surface.near(box, [&](const NearSurface::Triangle& triangle, const Vec3* corners) {
      if (!Box(corners[0], corners[1], corners[2]).meets(box)) return;
      if (is_own && !meets(tissue, {body.organ, piece_at(body, triangle.corner[0])})) return;
      if (std::all_of(std::begin(triangle.corner), std::end(triangle.corner),
                      [&](std::int32_t corner) { return cuts_.hides(body.first_vertex + corner); }))
        return;
      add_candidate(body, triangle, corners);
    });
  }
  cuts_.near(box, [&](cutbody::CutPatch& patch) {
    if (!meets(tissue, {patch.body.organ, patch.piece})) return;
    patch.body.surface.near(box, [&](const NearSurface::Triangle& triangle, const Vec3* corners) {
      if (Box(corners[0], corners[1], corners[2]).meets(box)) add_candidate(patch.body, triangle, corners);
    });
  });
}

/// Finds what the line inwards from a vertex meets first, if that is nearer than what it met before.
void CutOverlaps::look_from(Vec3 place, Vec3 inwards, double reach, Hit& hit) const {
  const Box line(place, place + reach * inwards);
  for (const Run& run : runs_) {
    if (!run.box.meets(line)) continue;
    for (std::size_t i = run.first; i < run.last; ++i) {
      const Candidate& candidate = candidates_[i];
      if (!candidate.box.meets(line)) continue;
      const auto met =
          surface::meet_line(place, inwards, reach, candidate.corner[0], candidate.corner[1], candidate.corner[2]);
      if (!met || met->distance >= hit.overlap.depth) continue;
      Overlap& overlap = hit.overlap;
      overlap.depth = met->distance, overlap.axis = inwards;
      overlap.other = candidate.body, overlap.triangle = candidate.triangle;
      const Vec3 normal = cross(candidate.corner[1] - candidate.corner[0], candidate.corner[2] - candidate.corner[0]);
      hit.is_exit = dot(normal, inwards) > kStraightOut * norm(normal);
      std::copy(std::begin(met->at), std::end(met->at), std::begin(overlap.at));
    }
  }
}

const std::vector<CutOverlaps::OfPatch>& CutOverlaps::find_on_patches(std::size_t organ,
                                                                      std::vector<Overlap>& overlaps) {
  found_.clear();
  if (!may_meet_anything(organ)) return found_;
  const double reach = this->reach(organ);
  NearOthers near{.is_everywhere = model_.organs[organ].meets_itself && cuts_.has_pieces(organ)};
  for (const Body& body : bodies_)
    if (std::size_t(body.organ) != organ && model_.organs_meet) near.boxes.push_back(box_of(body).grown(reach));
  cuts_.near(organ, near, [&](cutbody::CutPatch& patch) {
    const Body& body = patch.body;
    clear_candidates();
    add_candidates_near(box_of(body).grown(reach), {body.organ, patch.piece});
    if (candidates_.empty()) return;
    const std::size_t first = overlaps.size();
    const auto place = [&](std::int32_t v) { return patch.body.surface.place(v); };
    Box around = runs_.front().box;
    for (const Run& run : runs_) around.add(run.box.low), around.add(run.box.high);
    for (std::int32_t v = 0; std::size_t(v) < body.surface.vertex_count(); ++v) {
      if (!around.meets(Box(place(v)).grown(reach))) continue;
      Hit hit(body, v);
      look_from(place(v), -body.facets.normal(v, place), reach, hit);
      if (hit.is_exit) overlaps.push_back(hit.overlap);
    }
    if (overlaps.size() > first) found_.push_back({&patch, first, overlaps.size()});
  });
  return found_;
}

void CutOverlaps::find_on_body(std::size_t index, std::vector<Overlap>& overlaps) {
  Body& body = bodies_[index];
  const auto organ = std::size_t(body.organ);
  const bool meets_own = model_.organs[organ].meets_itself && cuts_.has_pieces(organ);
  const auto place = [&](std::int32_t v) { return body.surface.place(v); };
  const double reach = this->reach(organ);
  hits_.clear(), hit_of_vertex_.assign(body.surface.vertex_count(), -1);
  cuts_.near(box_of(body).grown(reach), [&](cutbody::CutPatch& patch) {
    if (patch.body.organ == body.organ ? !meets_own : !model_.organs_meet) return;
    clear_candidates();
    patch.body.surface.near(box_of(body).grown(reach), [&](const NearSurface::Triangle& triangle, const Vec3* corners) {
      add_candidate(patch.body, triangle, corners);
    });
    body.surface.near(box_of(patch.body).grown(reach), [&](const NearSurface::Triangle& triangle, const Vec3*) {
      for (const std::int32_t v : triangle.corner) {
        if (cuts_.hides(body.first_vertex + v)) continue;
        if (!meets({body.organ, piece_at(body, v)}, {patch.body.organ, patch.piece})) continue;
        std::int32_t& known = hit_of_vertex_[std::size_t(v)];
        if (known < 0) known = std::int32_t(hits_.size()), hits_.emplace_back(body, v);
        Hit& hit = hits_[std::size_t(known)];
        if (std::exchange(hit.patch, &patch) == &patch) continue;
        look_from(place(v), -body.facets.normal(v, place), reach, hit);
      }
    });
  });
  for (const Hit& hit : hits_)
    if (hit.is_exit) overlaps.push_back(hit.overlap);
}

}  // namespace ctpm::contact
