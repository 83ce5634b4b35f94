#include "core/contact/contacts.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/model/result.h"

namespace ctpm::contact {

namespace {

/// Contacts of a Model's blades and cut faces, and entries of their carriers.
std::pair<std::size_t, std::size_t> of_cuts(const Model& model, const BladeForce& blade, const BladeWedge& wedge,
                                            const CutFaceContact& cut_faces) {
  if (!model.has_scalpel()) return {0, 0};
  return {blade.capacity() + wedge.capacity() + cut_faces.capacity(),
          blade.entries() + wedge.entries() + 2 * cut_faces.capacity()};
}

void sort_by_point(Touched& touched) {
  if (std::is_sorted(touched.point.begin(), touched.point.end())) return;
  std::vector<std::size_t> order(touched.point.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return touched.point[a] < touched.point[b]; });
  const Touched found = touched;
  for (std::size_t i = 0; i < order.size(); ++i) {
    touched.point[i] = found.point[order[i]], touched.kelvin_dent[i] = found.kelvin_dent[order[i]];
    touched.grip.set(i, found.grip[order[i]]);
  }
}

}  // namespace

Contacts::Contacts(const Model& model, const elements::Kernels& kernels, StageWatch* watch)
    : model_(model),
      bodies_(surface::bodies_of(model)),
      cuts_(model, watch),
      ball_(model, bodies_, cuts_, kernels),
      body_contact_(model, bodies_, cuts_),
      obstacles_(model, bodies_, cuts_),
      blade_(model),
      wedge_(model),
      cut_faces_(model),
      points_(model, pressed_capacity().first + of_cuts(model, blade_, wedge_, cut_faces_).first,
              pressed_capacity().second + of_cuts(model, blade_, wedge_, cut_faces_).second),
      explicit_solve_(model, points_) {
  if (model.has_tool(ToolKind::ball)) own_motion_.emplace(model);
}

Pins Contacts::pins(const HeldTools& tools, const Vec3Array& position, double share, double h) {
  Pins pins;
  for (std::size_t hand = 0; hand < kMostHands; ++hand) {
    if (!tools[hand].is(ToolKind::pin)) continue;
    const std::int32_t sphere = tools[hand].tool->sphere;
    pins[hand] = {sphere, (tools[hand].at(share) - position[std::size_t(sphere)]) / h};
  }
  return pins;
}

void Contacts::find(const StateView& state, const HeldTools& tools, const ContactStep& step, bool from_velocity) {
  points_.clear();
  for (surface::Body& body : bodies_) body.surface.begin(state.position);
  cuts_.begin(state.position);
  const PressStep press{step.h, step.elapsed, step.ahead, from_velocity};
  const auto find_ball = [&](std::size_t hand) {
    const HeldTool& tool = tools[hand];
    if (!tool.is(ToolKind::ball)) return;
    const Vec3 velocity = (tool.to - tool.from) / model_.tick;
    ball_.find(state, {tool.at(step.share), velocity, tool.tool->radius, press, hand}, points_);
    if (points_.tool_count(hand) > 0) own_motion_->follow(state.axial_severed);
  };
  // In ascending order of points.
  find_ball(0);
  body_contact_.find(state, press, points_);
  obstacles_.find(state, press, points_);
  find_ball(1);
  for (std::size_t hand = 0; hand < kMostHands; ++hand) {
    const HeldTool& tool = tools[hand];
    if (!tool.is(ToolKind::scalpel) || !blade_.any()) continue;
    CTPM_CHECK(tool.front != nullptr, "the front of a cut is known before the blade's contacts are detected");
    blade_.find(state, *tool.tool, *tool.front, tool.edge_at(step.share), step.h, from_velocity, hand, points_);
    wedge_.find(state, *tool.tool, *tool.front, tool.edge_at(step.share), hand, points_);
  }
  if (cut_faces_.is_wanted()) cut_faces_.find(state, points_);
}

ExplicitContacts Contacts::detect_in_middle(const StateView& middle, const HeldTools& tools, const ContactStep& step) {
  ExplicitContacts set(*this, step);
  find(middle, tools, step, true);
  return set;
}

void ExplicitContacts::push_apart(const Vec3Array& before, Vec3Array& velocity) {
  tool_force_ = contacts_->explicit_solve_.solve(step_.h, step_.pins, before, velocity, contacts_->points_);
}

ImplicitContacts Contacts::detect(const StateView& state, const HeldTools& tools, const ContactStep& step,
                                  Linearisation about) {
  ImplicitContacts set(*this, step);
  const bool from_velocity = about == Linearisation::velocity;
  find(state, tools, step, from_velocity);
  points_.begin_implicit(step.h, from_velocity ? &state.velocity : nullptr);
  return set;
}

ContactSet::ContactSet(Contacts& contacts, const ContactStep& step) : contacts_(&contacts), step_(step) {
  CTPM_CHECK(!contacts.is_locked_, "contacts are detected while those of another step are in use");
  contacts.is_locked_ = true;
}

std::int32_t ContactSet::touched(std::size_t hand) const {
  return step_.pins[hand].is_held() ? 1 : contacts_->points_.tool_count(hand);
}

double ContactSet::depth(std::size_t hand, const Vec3Array& position) const {
  const Pin& pin = step_.pins[hand];
  if (pin.is_held()) return norm(position[pin.index()] - contacts_->model_.rest_position[pin.index()]);
  const BallContact& ball = contacts_->ball_;
  double depth = 0;
  surface::RigidMotion motion;
  std::int32_t moved = -1;  // piece that `motion` is of
  for (const PointContact& c : contacts_->points_.all()) {
    if (c.point < 0 || !c.is_of_hand(hand)) continue;
    Vec3 rest = ball.rest_of(c);
    const Carriers carriers = contacts_->points_.carriers(c);
    if (const std::int32_t piece = contacts_->own_motion_->free_piece(carriers.sphere.front()); piece >= 0) {
      if (piece != moved) motion = contacts_->own_motion_->of(piece, position);
      moved = piece, rest = motion(rest);
    }
    depth = std::max(depth, ball.dent_of(c) + dot(c.axis, weighted(carriers, position) - rest));
  }
  return depth;
}

/// Contacts of all pressed points, and entries of their carriers.
std::pair<std::size_t, std::size_t> Contacts::pressed_capacity() const {
  const auto ball = ball_.capacity(), bodies = body_contact_.capacity(), obstacles = obstacles_.capacity();
  const auto hands = std::size_t(model_.hands);
  return {hands * ball.first + bodies.first + obstacles.first, hands * ball.second + bodies.second + obstacles.second};
}

void Contacts::reserve(Touched& touched) const {
  const std::size_t count = pressed_capacity().first;
  touched.point.reserve(count), touched.kelvin_dent.reserve(count);
  for (auto* axis : {&touched.grip.x, &touched.grip.y, &touched.grip.z}) axis->reserve(count);
}

void ContactSet::note_touched(const std::array<Vec3, kMostHands>& centre, const Vec3Array& position,
                              Touched& touched) const {
  touched.point.clear(), touched.grip.resize(0), touched.kelvin_dent.clear();
  contacts_->reserve(touched);
  for (const PointContact& c : contacts_->points_.all()) {
    if (c.point < 0) continue;
    const Vec3 carried = weighted(contacts_->points_.carriers(c), position),
               place = c.hand >= 0 ? carried - centre[std::size_t(c.hand)] : carried, from_anchor = place - c.anchor;
    const Vec3 elongation = from_anchor - dot(from_anchor, c.axis) * c.axis;
    const double held = c.grip_k > 0 ? share_of_grip(c, elongation, {}) : 0.0;
    const double dent = std::max(0.0, c.dent - dot(c.axis, place - c.found));
    touched.point.push_back(c.point);
    touched.grip.push_back(c.hand >= 0 ? place - held * elongation : held * elongation);
    touched.kelvin_dent.push_back(c.foundation.kelvin_after(dent, c.kelvin_dent));
  }
  // Points of cuts are found among those of whole surfaces, but numbered after them.
  if (contacts_->cuts_.any()) sort_by_point(touched);
}

LinearisedContacts ImplicitContacts::linearise(elements::Coordinates& force, elements::DiagonalBlocks& blocks) & {
  return {*contacts_, step_.h, force, blocks};
}

LinearisedContacts::LinearisedContacts(Contacts& contacts, double h, elements::Coordinates& force,
                                       elements::DiagonalBlocks& blocks)
    : contacts_(contacts), h_(h), force_(force), blocks_(blocks) {
  CTPM_CHECK(!contacts_.is_linearised_, "contacts are linearised while they are in a linear system");
  contacts_.is_linearised_ = true;
  contacts_.points_.linearise(h_, force_, blocks_);
}

void LinearisedContacts::take_back() {
  if (!is_in_system_) return;
  contacts_.points_.undo_linearise(force_, blocks_);
  is_in_system_ = contacts_.is_linearised_ = false;
}

bool LinearisedContacts::has_wrong(const elements::Coordinates& v) const { return contacts_.points_.has_wrong(h_, v); }

Vec3 LinearisedContacts::tool_force(std::size_t hand, const elements::Coordinates& v) const {
  return contacts_.points_.force_on_tool(hand, h_, v);
}

void LinearisedContacts::mend_wrong(const elements::Coordinates& v) && {
  take_back();
  contacts_.points_.mend_wrong(h_, v);
}

}  // namespace ctpm::contact
