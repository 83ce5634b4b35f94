#include "core/contact/ball_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/contact/contact_law.h"
#include "core/surface/line_hit.h"
#include "core/surface/surface.h"

namespace ctpm::contact {
namespace {

/// Spheres per block. A block is checked as a whole before its spheres are checked one by one.
constexpr std::size_t kLookedAtOnce = 128;

/// Triangles are divided into parts with edges of at most this part of the ball's radius, but into no more than
/// kMostDivisions squared.
constexpr double kLongestPart = 0.25;
constexpr int kMostDivisions = 8;

/// A surface that the ball left farther behind than so many of its radii is not touched any more.
constexpr double kDeepest = 12;

/// A line upwards from a ball's centre, beside it by this part of its radius (our choice): there it does not run along
/// the edges of a regular mesh.
constexpr Vec3 kBeside{1.3e-3, 0.7e-3, 0};
constexpr Vec3 kUpwards{0, 0, 1};

/// Where the walls of a cut are nearer to each other than this part of the ball's radius, they count less, and not at
/// all where they touch (our choice): a ball that presses on a closed cut dents its lips, and does not wedge it open.
constexpr double kOpen = 0.1;

/// Triangles are looked for within so many radii of where they may be touched (our choice): a wider margin looks less
/// often, at more triangles.
constexpr double kMargin = 0.3;

/// Pressure is gathered within this part of a spacing and of the smallest ball's radius (our choice).
constexpr double kGatherRadius = 0.125, kGatherShare = 0.25;

constexpr double kPi = 3.14159265358979323846;

/// Where tool and tissue coincide, no direction is better than another.
Vec3 unit_or_down(Vec3 v, double least) {
  const double length = norm(v);
  return length > least ? v / length : Vec3{0, 0, -1};
}

double smallest_ball(const Model& model) {
  double radius = std::numeric_limits<double>::infinity();
  for (const Tool& tool : model.tools)
    if (tool.kind == ToolKind::ball) radius = std::min(radius, tool.radius);
  return radius;
}

/// Calls `visit(w0, w1, w2)` with the barycentric coordinates of the centre of each of n^2 equal parts of a triangle.
template <class Visit>
void for_each_part(int n, const Visit& visit) {
  const double unit = 1.0 / (3 * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      visit((3 * (n - i - j) - 2) * unit, (3 * i + 1) * unit, (3 * j + 1) * unit);
      if (i + j + 1 < n) visit((3 * (n - i - j) - 4) * unit, (3 * i + 2) * unit, (3 * j + 2) * unit);
    }
}

/// What a line upwards from a point may meet.
struct Above {
  Vec3 from;
  bool meets(const Box& box) const {
    return box.low.x <= from.x && from.x <= box.high.x && box.low.y <= from.y && from.y <= box.high.y &&
           from.z <= box.high.z;
  }
};

}  // namespace

BallContact::BallContact(const Model& model, std::vector<surface::Body>& bodies, CutSurfaces& cuts,
                         const elements::Kernels& kernels)
    : model_(model),
      kernels_(kernels),
      cuts_(cuts),
      own_(model, 0, model.has_tool(ToolKind::ball) && bodies.empty() ? model.surfaces.size() : 0) {
  if (!model.has_tool(ToolKind::ball)) return;
  touchable_count_ = std::int32_t(model.touchable_count());
  if (!own_.empty()) whole_.push_back({0, 0, &own_, &gathering_});
  for (surface::Body& body : bodies)
    whole_.push_back({body.first_vertex, body.first_vertex, &body.surface, &gathering_});
  const double finest = kGatherShare * smallest_ball(model);
  for (std::size_t i = 0; i < model.surfaces.size(); ++i) {
    gathering_.add(model.surfaces[i], std::min(kGatherRadius * model.organs[i].spacing, finest));
    vertex_count_ += std::int32_t(model.surfaces[i].vertex.size());
  }
  for (std::size_t hand = 0; hand < std::size_t(model.hands); ++hand)
    near_.emplace_back(whole_, vertex_count_, cuts, cuts.points().kind_of_ball(hand));
  const auto vertices = std::size_t(vertex_count_);
  pressed_.resize(vertices), touched_.reserve(vertices), was_touched_.assign(vertices, 0);
  for (std::size_t i = 0; i < model.surfaces.size(); ++i)
    organ_of_.resize(organ_of_.size() + model.surfaces[i].vertex.size(), std::int32_t(i));
  for (std::size_t i = 0; i < model.organs.size(); ++i) {
    if (i < model.surfaces.size() && !model.surfaces[i].triangle.empty()) continue;
    const auto first = std::size_t(model.organs[i].first);
    bare_.emplace_back(first, first + std::size_t(model.organs[i].count));
  }
  if (model.organs.empty()) bare_.emplace_back(0, model.sphere_count());
  for (std::int32_t v = 0; v < vertex_count_; ++v)
    if (gathering_.at(v) == v) ++capacity_.first, capacity_.second += follower(v).sphere.size();
  for (const auto& [first, last] : bare_) {
    capacity_.first += last - first, capacity_.second += last - first;
    for (std::size_t i = first; i < last; ++i) largest_radius_ = std::max(largest_radius_, model.contact_radius[i]);
  }
}

const BallContact::Part& BallContact::part_of(std::int32_t slot) const {
  const auto after = std::upper_bound(parts_->begin(), parts_->end(), slot,
                                      [](std::int32_t s, const Part& part) { return s < part.first_slot; });
  return *(after - 1);
}

std::int32_t BallContact::organ_of(const Part& part, std::int32_t slot) const {
  return part.patch != nullptr ? part.patch->body.organ : organ_of_[std::size_t(slot)];
}

surface::Follower BallContact::follower(std::int32_t slot) const {
  const Part& part = part_of(slot);
  return part.surface->follower(slot - part.first_slot);
}

Vec3 BallContact::carried(std::int32_t slot) const {
  const Part& part = part_of(slot);
  return part.surface->carried(slot - part.first_slot);
}

/// Marks what the ball touched at the start of the substep.
void BallContact::mark_touched(const StateView& state, const BallMotion& ball, std::uint8_t value) {
  const std::int32_t first = first_point_of(ball.hand);
  for (const std::int32_t point : state.touched)
    if (point >= first && point - first < vertex_count_) was_touched_[std::size_t(point - first)] = value;
  for (const Part& part : std::span(*parts_).subspan(whole_.size())) {
    auto point = std::lower_bound(state.touched.begin(), state.touched.end(), part.first_point);
    for (; point != state.touched.end() && *point < part.first_point + part.slots(); ++point)
      was_touched_[std::size_t(part.first_slot + *point - part.first_point)] = value;
  }
}

/// Whether patches may stand for parts of a triangle.
bool BallContact::may_be_hidden(const Part& part, const surface::NearSurface::Triangle& triangle) const {
  return part.patch == nullptr && cuts_.any() &&
         std::any_of(std::begin(triangle.corner), std::end(triangle.corner),
                     [&](std::int32_t corner) { return cuts_.hides(part.first_slot + corner); });
}

/// Whether a patch stands for a place in a triangle, given by its barycentric coordinates.
bool BallContact::is_hidden(const Part& part, const surface::NearSurface::Triangle& triangle,
                            const double* weights) const {
  Vec3 rest;
  for (std::size_t c = 0; c < 3; ++c) rest += weights[c] * part.surface->rest(triangle.corner[c]);
  return cuts_.covers(std::size_t(organ_of(part, part.first_slot + triangle.corner[0])), rest);
}

void BallContact::find(const StateView& state, const BallMotion& ball, PointContacts& contacts) {
  if (!whole_.empty()) find_on_surfaces(state, ball, contacts);
  find_on_spheres(state, ball, contacts);
}

/// What is near a ball, or was touched by it at the start of the substep.
Reach BallContact::reach_of(const StateView& state, const BallMotion& ball) {
  Reach reach(ball.centre, ball.radius);
  const auto add = [&](Vec3 place) { reach.distance = std::max(reach.distance, reach.add(place)); };
  const std::int32_t first = first_point_of(ball.hand);
  for (const std::int32_t point : state.touched) {
    // At each of these points the pressure on all vertices of a facet was gathered.
    if (point >= first && point - first < vertex_count_) {
      add(carried(point - first));
      for (const std::int32_t v : gathering_.gathered_at(point - first)) reach.add(carried(v));
    }
    if (!cuts_.any() || !cuts_.points().is_of_ball(point, ball.hand)) continue;
    const cutbody::CutPoints::Place at = cuts_.points().place(point);
    cutbody::CutPatch* const patch = cuts_.patch(at);
    if (patch == nullptr) continue;
    const std::int32_t own = at.vertex - patch->body.first_vertex;
    add(patch->body.surface.place(own));
    for (const std::int32_t v : patch->gathering.gathered_at(own)) reach.add(patch->body.surface.place(v));
  }
  const double deepest = kDeepest * ball.radius;
  if (reach.distance > deepest) {
    reach = Reach(ball.centre, deepest);
    reach.farthest = std::numeric_limits<double>::infinity();  // the box bounds it
  }
  return reach;
}

void BallContact::find_on_surfaces(const StateView& state, const BallMotion& ball, PointContacts& contacts) {
  if (!own_.empty()) own_.begin(state.position);
  Reach reach = reach_of(state, ball);
  if (!own_.empty()) {
    Box asked = reach.box;
    asked.high.z = std::numeric_limits<double>::infinity();  // for is_inside()
    if (cuts_.wait_near(asked, state, own_)) reach = reach_of(state, ball);
  }
  NearTriangles& near = near_[ball.hand];
  near.find(reach, kMargin * ball.radius, state.position);
  parts_ = &near.parts();
  const auto slots = std::size_t(near.slots());
  if (pressed_.size() < slots) pressed_.resize(slots), was_touched_.resize(slots, 0);
  opening_.assign(slots - std::size_t(vertex_count_), -1.0);
  mark_touched(state, ball, 1);
  pressed_area_ = {};
  behind_.clear();
  for (const NearTriangles::Found& found : near.triangles())
    if (dent((*parts_)[std::size_t(found.part)], *found.triangle, ball, reach.distance, false, near.least_apart(found)))
      behind_.push_back(found);
  dent_behind(ball, reach.distance);
  mark_touched(state, ball, 0);
  const double a = std::sqrt(norm(pressed_area_) / kPi);
  std::sort(touched_.begin(), touched_.end());
  for (const std::int32_t slot : touched_) press_slot(state, ball, slot, a, contacts);
  touched_.clear();
  parts_ = &whole_;
}

/// A surface that faces away from the ball's centre touches only while the ball is in the organ, deeper than the
/// lattice follows. A ball that has left the organ may stay behind a fold or an overhanging wall, and one that presses
/// a thin flap reaches through it to its far side: that is no contact.
void BallContact::dent_behind(const BallMotion& ball, double reach) {
  std::int32_t organ = -1;
  bool is_in = false;
  for (const NearTriangles::Found& found : behind_) {
    const Part& part = (*parts_)[std::size_t(found.part)];
    const std::int32_t its = organ_of(part, part.first_slot + found.triangle->corner[0]);
    if (its != organ) organ = its, is_in = is_inside(organ, ball.centre + ball.radius * kBeside);
    if (is_in) dent(part, *found.triangle, ball, reach, true, 0);
  }
}

/// Whether a point is in an organ: a line from there leaves it more often than it enters.
bool BallContact::is_inside(std::int32_t organ, Vec3 point) {
  const Above above{point};
  int more_exits = 0;
  const auto count = [&](const Part& part) {
    part.surface->near(above, [&](const surface::NearSurface::Triangle& triangle, const Vec3* corners) {
      if (organ_of(part, part.first_slot + triangle.corner[0]) != organ) return;
      const auto met = surface::meet_line(point, kUpwards, std::numeric_limits<double>::infinity(), corners[0],
                                          corners[1], corners[2]);
      if (met && !(may_be_hidden(part, triangle) && is_hidden(part, triangle, met->at)))
        more_exits += met->is_exit ? 1 : -1;
    });
  };
  for (const Part& part : whole_) count(part);
  cuts_.near(std::size_t(organ), above, [&](cutbody::CutPatch& patch) {
    count({0, 0, &patch.body.surface, &patch.gathering, &patch});
  });
  return more_exits > 0;
}

/// Adds the contact of what was gathered at a slot, with the radius of all that the ball touches [m].
void BallContact::press_slot(const StateView& state, const BallMotion& ball, std::int32_t slot, double radius,
                             PointContacts& contacts) {
  const Part& part = part_of(slot);
  const Pressed pressed = std::exchange(pressed_[std::size_t(slot)], Pressed{});
  const surface::Follower follows = part.surface->follower(slot - part.first_slot);
  const Carriers carriers{follows.sphere, follows.weight};
  const double volume = norm(pressed.volume);
  if (!(volume > 0) || !(contacts.mobility(carriers) > 0)) return;
  const OrganRange& organ = model_.organs[std::size_t(organ_of(part, slot))];
  const double k = dent_stiffness(organ.modulus, radius, surface::kUnresolvedLength * organ.spacing) * pressed.area;
  add(state, ball,
      {.axis = pressed.volume / volume,
       .point = slot - part.first_slot + part.first_point + (part.patch == nullptr ? first_point_of(ball.hand) : 0),
       .dent = volume / pressed.area,
       .foundation = Foundation(organ, k, ball.step.elapsed)},
      carriers, part.surface->place(slot - part.first_slot), contacts);
}

/// Part with which the wall of a cut counts at a vertex.
double BallContact::share_of(const Part& part, std::int32_t slot, double radius) {
  const std::int32_t vertex = slot - part.first_slot;
  if (vertex < part.patch->first_wall) return 1;
  double& opening = opening_[std::size_t(slot - vertex_count_)];
  if (opening < 0) opening = part.patch->opening(vertex);
  return std::min(1.0, opening / (kOpen * radius));
}

/// Adds to a triangle's corners those of its parts in the ball that face the ball's centre or, with `behind`, those
/// that do not, in the ball or outside of it where they were touched. Returns whether it has parts of the other kind.
/// `reach`: of the ball where it touched before [m]. `apart`: the triangle is at least so far from its centre [m].
bool BallContact::dent(const Part& part, const surface::NearSurface::Triangle& triangle, const BallMotion& ball,
                       double reach, bool behind, double apart) {
  std::int32_t vertex[3];
  for (std::size_t c = 0; c < 3; ++c) vertex[c] = part.first_slot + triangle.corner[c];
  std::int32_t slot[3];
  for (std::size_t c = 0; c < 3; ++c) slot[c] = part.gathers_at(triangle.corner[c]);
  const bool was_touched =
      was_touched_[std::size_t(slot[0])] || was_touched_[std::size_t(slot[1])] || was_touched_[std::size_t(slot[2])];
  if (!was_touched && apart > ball.radius) return false;
  const Box near = Box(ball.centre).grown(was_touched ? reach : ball.radius);
  if (part.patch != nullptr && !near.meets(part.surface->around(triangle))) return false;  // to turn costs more
  const Vec3 corners[3] = {part.surface->place(triangle.corner[0]), part.surface->place(triangle.corner[1]),
                           part.surface->place(triangle.corner[2])};
  if (!near.meets(Box(corners[0], corners[1], corners[2]))) return false;
  double shares[3] = {1, 1, 1};
  for (std::size_t c = 0; c < 3 && part.patch != nullptr; ++c) shares[c] = share_of(part, vertex[c], ball.radius);
  if (shares[0] == 0 && shares[1] == 0 && shares[2] == 0) return false;
  const Vec3 across = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double size = norm(across), squared = ball.radius * ball.radius;
  if (!(size > 0)) return false;
  const Vec3 outward = across / size;
  const int n = std::clamp(int(std::ceil(triangle.longest_edge / (kLongestPart * ball.radius))), 1, kMostDivisions);
  const bool looks_hidden = may_be_hidden(part, triangle);
  bool has_others = false;
  for_each_part(n, [&](double w0, double w1, double w2) {
    const Vec3 apart = w0 * corners[0] + w1 * corners[1] + w2 * corners[2] - ball.centre;
    // Along the line inwards, the far side of the ball is `through` away.
    const double distance_squared = dot(apart, apart), height = dot(apart, outward);
    const double half_chord_squared = height * height - distance_squared + squared;
    const bool is_behind = height > 0;
    if (half_chord_squared <= 0 || (distance_squared >= squared && !(was_touched && is_behind))) return;
    if (is_behind != behind) {
      has_others = true;
      return;
    }
    const double half_chord = std::sqrt(half_chord_squared), through = height + half_chord;
    const Vec3 normal = (apart - through * outward) / ball.radius;
    const double weights[3] = {w0, w1, w2};
    if (looks_hidden && is_hidden(part, triangle, weights)) return;
    const double share = part.patch == nullptr ? 1 : w0 * shares[0] + w1 * shares[1] + w2 * shares[2];
    const double area = share * triangle.rest_area / (n * n);
    if (!(area > 0)) return;
    const Vec3 volume = area * through * (half_chord / ball.radius) * normal;
    for (std::size_t c = 0; c < 3; ++c) {
      Pressed& pressed = pressed_[std::size_t(slot[c])];
      if (pressed.area == 0) touched_.push_back(slot[c]);
      pressed.area += weights[c] * area, pressed.volume += weights[c] * volume;
    }
    pressed_area_ += area * normal;
  });
  return has_others;
}

void BallContact::find_on_spheres(const StateView& state, const BallMotion& ball, PointContacts& contacts) {
  const double farthest = (ball.radius + largest_radius_) * (ball.radius + largest_radius_),
               at[3] = {ball.centre.x, ball.centre.y, ball.centre.z};
  const auto look_at = [&](std::size_t i) {
    if (model_.held_axes[i] == kAnchored) return;
    const Vec3 apart = state.position[i] - ball.centre;
    const double reach = ball.radius + model_.contact_radius[i], distance_squared = dot(apart, apart);
    if (distance_squared >= reach * reach) return;
    const double distance = std::sqrt(distance_squared);
    // A sphere whose centre coincides with that of the ball is pushed in the direction of the ball's motion.
    const Vec3 normal = distance > 1e-9 * reach ? apart / distance : unit_or_down(ball.velocity, 0);
    const auto sphere = std::int32_t(i);
    const double whole = 1, depth = reach - distance;
    PointContact contact{.axis = normal, .point = first_point_of(ball.hand) + vertex_count_ + sphere, .dent = depth};
    contact.foundation.k = model_.contact_k;
    contact.damping = contact_damping(model_.contact_damping, model_.contact_k, model_.mass[i], depth);
    add(state, ball, contact, {{&sphere, 1}, {&whole, 1}}, state.position[i], contacts);
  };
  for (const auto& [first, last] : bare_)
    for (std::size_t begin = first; begin < last; begin += kLookedAtOnce) {
      const std::size_t end = std::min(begin + kLookedAtOnce, last);
      if (kernels_.nearest_squared(state.position.x.data(), state.position.y.data(), state.position.z.data(), at, begin,
                                   end) < farthest)
        for (std::size_t i = begin; i < end; ++i) look_at(i);
    }
}

/// Adds the contact of a point at `place` [m], of which the detectors have set axis, point, dent, foundation and
/// damping.
void BallContact::add(const StateView& state, const BallMotion& ball, PointContact contact, Carriers carriers,
                      Vec3 place, PointContacts& contacts) const {
  const Vec3 velocity = weighted(carriers, state.velocity);
  const bool moves = ball.step.from_velocity;
  // Over one step, the point is expected to go on with its velocity. However far the hand jumps, the approach leads to
  // the dent, or out of contact, in one step, and the slip does not pass the ball.
  const Approach approach{.place = place - ball.centre,
                          .start = moves ? velocity - ball.velocity : -ball.velocity,
                          .slip_guess = moves ? Vec3{} : velocity,
                          .nearer = contact.dent,
                          .farther = ball.radius};
  contact.hand = std::int32_t(ball.hand);
  press(state, model_.contact_friction, contacts.mobility(carriers), approach, ball.step, contact);
  contacts.add(contact, carriers);
}

Vec3 BallContact::rest_of(const PointContact& contact) const {
  if (cuts_.points().contains(contact.point)) {
    const cutbody::CutPoints::Place at = cuts_.points().place(contact.point);
    const surface::Body& body = cuts_.patch(at)->body;
    return body.surface.rest(at.vertex - body.first_vertex);
  }
  const std::int32_t point = number_of(contact);
  if (point >= vertex_count_) return model_.rest_position[std::size_t(point - vertex_count_)];
  const Part& part = part_of(point);
  return part.surface->rest(point - part.first_point);
}

}  // namespace ctpm::contact
