#include "core/contact/near_triangles.h"

#include <limits>
#include <utility>

#include "core/contact/moved.h"

namespace ctpm::contact {
namespace {

/// The next look begins when this part of the margin is left (our choice).
constexpr double kLeft = 0.5;

/// So many triangles are visited in a round, where a group that is left out counts as kGroupCosts (our choice: a
/// tenth of a millisecond).
constexpr std::size_t kMostAtOnce = 384, kGroupCosts = 4;

}  // namespace

Reach Reach::grown(double by) const {
  Reach wider = *this;
  wider.box = box.grown(by), wider.farthest += by;
  return wider;
}

bool Reach::contains(const Reach& other) const {
  const auto is_in = [](double low, double high, double from, double to) { return low <= from && to <= high; };
  return is_in(box.low.x, box.high.x, other.box.low.x, other.box.high.x) &&
         is_in(box.low.y, box.high.y, other.box.low.y, other.box.high.y) &&
         is_in(box.low.z, box.high.z, other.box.low.z, other.box.high.z) &&
         norm(other.centre - centre) + other.farthest <= farthest;
}

NearTriangles::NearTriangles(const std::vector<BallPart>& whole, std::int32_t slots, CutSurfaces& cuts,
                             std::int32_t kind)
    : cuts_(cuts), kind_(kind), whole_(whole.size()), whole_slots_(slots) {
  std::size_t triangles = 0;
  for (const BallPart& part : whole) triangles += part.surface->triangles().size();
  for (Look* look : {&used_, &next_}) look->parts = whole, look->slots = slots, look->found.reserve(triangles);
}

/// Whether nothing that `now` may meet is missing, after the farthest sphere has `moved` so far since the look began
/// [m]. What was left out in a later round was farther away then by up to the drift.
bool NearTriangles::Look::holds(const Reach& now, double moved) const {
  return reach.contains(now.grown(stretch * (moved + drift)));
}

void NearTriangles::find(const Reach& reach, double margin, const Vec3Array& position) {
  const auto may_use = [&](Look& look) {
    return look.has_begun && look.version == cuts_.version() && look.position.size() == position.size();
  };
  // Whichever goes on later takes no memory then.
  for (Look* look : {&used_, &next_})
    if (!look->has_begun && look->position.size() != position.size()) look->position = position;
  const Reach wider = reach.grown(margin);
  if (!may_use(next_)) next_.has_begun = false;
  const double moved = may_use(used_) ? farthest_moved(used_.position, position) : 0;
  if (may_use(used_) && used_.holds(reach, moved)) {
    begin_round(used_);
    if (!next_.has_begun && !used_.holds(reach.grown(kLeft * margin), moved)) begin(next_, wider, position);
    if (!next_.has_begun) return;
    begin_round(next_);
    go_on(next_, position, kMostAtOnce);
    if (!next_.is_done()) return;
  } else if (next_.has_begun) {
    begin_round(next_);
    go_on(next_, position, std::numeric_limits<std::size_t>::max());
  }
  if (!next_.has_begun || !next_.holds(reach, farthest_moved(next_.position, position))) {
    begin(next_, wider, position);
    go_on(next_, position, std::numeric_limits<std::size_t>::max());
  }
  std::swap(used_, next_), next_.has_begun = false;
}

void NearTriangles::begin(Look& look, const Reach& reach, const Vec3Array& position) {
  look.has_begun = true, look.version = cuts_.version(), look.reach = reach, look.position = position;
  look.parts.resize(whole_), look.found.clear(), look.slots = whole_slots_;
  look.part = look.group = 0, look.drift = 0;
  look.stretch = cuts_.stretch();
  for (const BallPart& part : look.parts) look.stretch = std::max(look.stretch, part.surface->stretch());
  cuts_.near(reach.grown(kRounding), [&](cutbody::CutPatch& patch) {
    look.parts.push_back({look.slots, cuts_.first_point(kind_, patch), &patch.body.surface, &patch.gathering, &patch});
    look.slots += look.parts.back().slots();
  });
}

/// Visits groups until their triangles are `most` or all groups were visited.
void NearTriangles::go_on(Look& look, const Vec3Array& position, std::size_t most) {
  look.drift = std::max(look.drift, farthest_moved(look.position, position));
  const Reach around = look.reach.grown(kRounding);
  std::size_t seen = 0;
  for (; look.part < look.parts.size() && seen < most; ++look.part, look.group = 0) {
    surface::NearSurface& surface = *look.parts[look.part].surface;
    for (; look.group < surface.groups().size() && seen < most; ++look.group, seen += kGroupCosts)
      surface.near(around, look.group, [&](const surface::NearSurface::Triangle& triangle, const Vec3* corners) {
        ++seen;
        double turns = 0;
        for (const std::int32_t corner : triangle.corner) turns = std::max(turns, 2 * surface.offset_size(corner));
        if (around.meets(Box(corners[0], corners[1], corners[2]).grown(turns)))
          look.found.push_back({std::int32_t(look.part), &triangle});
      });
    if (look.group < surface.groups().size()) return;
  }
}

/// Begins the round for the patches of cuts that a look found in an earlier one.
void NearTriangles::begin_round(const Look& look) {
  for (std::size_t part = whole_; part < look.parts.size(); ++part) cuts_.begin(*look.parts[part].patch);
}

}  // namespace ctpm::contact
