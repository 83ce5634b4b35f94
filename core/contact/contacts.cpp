#include "core/contact/contacts.h"

#include "core/model/result.h"

namespace ctpm::contact {

Contacts::Contacts(const Model& model, const elements::Kernels& kernels)
    : model_(model),
      ball_(model, kernels),
      blade_(model),
      cut_faces_(model),
      pairs_(model, model.has_scalpel() ? blade_.capacity() + cut_faces_.capacity() : 0) {}

Pin Contacts::pin(const HeldTool& tool, const Vec3Array& position, double share, double h) {
  if (!tool.is(ToolKind::pin)) return {};
  const std::int32_t sphere = tool.tool->sphere;
  return {sphere, (tool.at(share) - position[std::size_t(sphere)]) / h};
}

/// Finds the contacts of the blade and those between cut faces.
void Contacts::find_pairs(const StateView& state, const HeldTool& tool) {
  pairs_.clear();
  if (tool.is(ToolKind::scalpel) && blade_.any()) {
    CTPM_CHECK(tool.near != nullptr, "a blade has swept before its contacts are detected");
    tool.near->follow(state.position);
    blade_.find(state, *tool.near, *tool.tool, tool.blade, pairs_);
    blade_.add_severed(state, *tool.tool, tool.blade, tool.swept, pairs_);
  }
  if (cut_faces_.is_wanted()) cut_faces_.find(state, pairs_);
}

void Contacts::find_ball(const StateView& state, const HeldTool& tool, const ContactStep& step, bool from_velocity) {
  ball_.clear();
  if (tool.is(ToolKind::ball))
    ball_.find(state, tool.at(step.share), tool.tool->radius, (tool.to - tool.from) / model_.tick, step.h,
               from_velocity);
}

ExplicitContacts Contacts::push_apart(const StateView& middle, const HeldTool& tool, const ContactStep& step,
                                      Vec3Array& velocity) {
  ExplicitContacts set(*this, step);
  find_pairs(middle, tool);
  find_ball(middle, tool, step, true);
  const Vec3 on_ball = ball_.push_apart(step.h, step.pin, middle.velocity, velocity);
  set.tool_force_ = on_ball + pairs_.push_apart(step.h, step.pin, middle.velocity, velocity);
  return set;
}

ImplicitContacts Contacts::detect(const StateView& state, const HeldTool& tool, const ContactStep& step,
                                  Linearisation about) {
  ImplicitContacts set(*this, step);
  const bool from_velocity = about == Linearisation::velocity;
  find_pairs(state, tool);
  if (from_velocity) pairs_.start_from(state.velocity);
  find_ball(state, tool, step, from_velocity);
  return set;
}

ContactSet::ContactSet(Contacts& contacts, const ContactStep& step) : contacts_(&contacts), step_(step) {
  CTPM_CHECK(!contacts.is_locked_, "contacts are detected while those of another step are in use");
  contacts.is_locked_ = true;
}

std::int32_t ContactSet::touched() const {
  return step_.pin.is_held() ? 1 : contacts_->ball_.count() + contacts_->pairs_.tool_count();
}

double ContactSet::depth(const Vec3Array& position) const {
  const Pin& pin = step_.pin;
  if (pin.is_held()) return norm(position[pin.index()] - contacts_->model_.rest_position[pin.index()]);
  return contacts_->ball_.depth(position);
}

LinearisedContacts ImplicitContacts::linearise(elements::Coordinates& force, elements::DiagonalBlocks& blocks) & {
  return {*contacts_, step_.h, force, blocks};
}

LinearisedContacts::LinearisedContacts(Contacts& contacts, double h, elements::Coordinates& force,
                                       elements::DiagonalBlocks& blocks)
    : contacts_(contacts), h_(h), force_(force), blocks_(blocks) {
  CTPM_CHECK(!contacts_.is_linearised_, "contacts are linearised while they are in a linear system");
  contacts_.is_linearised_ = true;
  contacts_.ball_.linearise(h_, force_, blocks_);
  contacts_.pairs_.linearise(h_, force_, blocks_);
}

/// Takes contacts out in the opposite order, since a sphere may have several.
void LinearisedContacts::take_back() {
  if (!is_in_system_) return;
  contacts_.pairs_.undo_linearise(force_, blocks_);
  contacts_.ball_.undo_linearise(force_, blocks_);
  is_in_system_ = contacts_.is_linearised_ = false;
}

bool LinearisedContacts::pulls(const elements::Coordinates& v) const {
  return contacts_.ball_.has_pulling(h_, v) || contacts_.pairs_.has_pulling(h_, v);
}

Vec3 LinearisedContacts::tool_force(const elements::Coordinates& v) const {
  return contacts_.ball_.force_on_tool(h_, v) + contacts_.pairs_.force_on_tool(h_, v);
}

void LinearisedContacts::drop_pulling(const elements::Coordinates& v) && {
  take_back();
  contacts_.ball_.drop_pulling(h_, v);
  contacts_.pairs_.drop_pulling(h_, v);
}

}  // namespace ctpm::contact
