#include "studio/session/event_watch.h"

#include <algorithm>
#include <utility>

namespace ctpm::session {

using recordings::EventKind;

EventWatch::EventWatch(const Model& model, double damage_force, Tell tell, CutEnds cut_ends)
    : tell_(std::move(tell)), cut_ends_(cut_ends), force_limit_(damage_force) {
  for (const Tool& tool : model.tools) is_scalpel_.push_back(tool.kind == ToolKind::scalpel);
  for (std::size_t i = 0; i < model.organs.size(); ++i) {
    const double limit = model.organs[i].damage_depth;
    if (limit > 0 && (depth_limit_ == 0 || limit < depth_limit_)) depth_limit_ = limit, organ_ = std::int32_t(i);
  }
}

bool EventWatch::begins(Spell& spell, std::int64_t tick, bool is_seen) {
  if (!is_seen) return false;
  const bool is_new = !spell.goes_on;
  spell = {true, tick};
  return is_new;
}

bool EventWatch::ends(Spell& spell, std::int64_t tick) {
  if (!spell.goes_on || tick - spell.last_tick < kPause) return false;
  spell.goes_on = false;
  return true;
}

void EventWatch::look(std::int64_t tick, const Inputs& inputs, const stepping::StepReport& report) {
  for (std::size_t i = 0; i < kMostHands; ++i)
    look_for_contact(tick, inputs.hand(i).tool, report.of_hand(i), hands_[i]);
  look_for_cut(tick, inputs, report);
  if (report.came_loose > 0) tell_({.tick = tick, .kind = EventKind::piece_came_loose, .pieces = report.came_loose});
  for (std::size_t i = 0; i < kMostHands; ++i) look_for_damage(tick, report.of_hand(i), hands_[i]);
  look_for_inversion(tick, report);
}

/// The hand that cuts: one at most holds a scalpel.
std::size_t EventWatch::cutting_hand(const Inputs& inputs) const {
  const std::int32_t second = inputs.second.tool;
  return second >= 0 && std::size_t(second) < is_scalpel_.size() && is_scalpel_[std::size_t(second)] ? 1 : 0;
}

void EventWatch::finish(std::int64_t end) {
  if (inside_out_.goes_on && inside_out_.last_tick + 1 < end) tell_that_it_came_back();
}

void EventWatch::look_for_contact(std::int64_t tick, std::int32_t tool, const stepping::HandReport& report,
                                  OfHand& hand) {
  if (begins(hand.contact, tick, report.contacts > 0)) {
    hand.tool = tool;
    tell_({.tick = tick, .kind = EventKind::contact_begins, .tool = tool});
  }
  if (ends(hand.contact, tick))
    tell_({.tick = hand.contact.last_tick, .kind = EventKind::contact_ends, .tool = hand.tool});
}

/// A blade severs an element now and then, the more rarely the coarser the lattice is; in between it cuts all the same.
void EventWatch::look_for_cut(std::int64_t tick, const Inputs& inputs, const stepping::StepReport& report) {
  const std::size_t hand = cutting_hand(inputs);
  const std::int32_t tool = inputs.hand(hand).tool;
  const bool with_contact = cut_ends_ == CutEnds::with_contact;
  if (with_contact && report.severed > 0 && tool != blade_) cut_.goes_on = false;
  if (begins(cut_, tick, report.severed > 0))
    tell_({.tick = tick, .kind = EventKind::cut, .tool = blade_ = tool, .severed = report.severed});
  if (with_contact && cut_.goes_on && tool == blade_ && report.of_hand(hand).contacts > 0) cut_.last_tick = tick;
  ends(cut_, tick);
}

void EventWatch::look_for_damage(std::int64_t tick, const stepping::HandReport& report, OfHand& hand) {
  if (begins(hand.too_deep, tick, depth_limit_ > 0 && report.depth > depth_limit_))
    tell_(
        {.tick = tick, .kind = EventKind::damage, .organ = organ_, .depth = report.depth, .depth_limit = depth_limit_});
  ends(hand.too_deep, tick);
  const double force = norm(report.tool_force);
  if (begins(hand.too_strong, tick, force_limit_ > 0 && force > force_limit_))
    tell_({.tick = tick, .kind = EventKind::damage, .force = force, .force_limit = force_limit_});
  ends(hand.too_strong, tick);
}

void EventWatch::look_for_inversion(std::int64_t tick, const stepping::StepReport& report) {
  if (begins(inside_out_, tick, report.inverted > 0)) {
    tell_({.tick = tick, .kind = EventKind::turned_inside_out, .cells = report.inverted});
    most_inverted_ = 0;
  }
  most_inverted_ = std::max(most_inverted_, report.inverted);
  if (ends(inside_out_, tick)) tell_that_it_came_back();
}

void EventWatch::tell_that_it_came_back() {
  tell_({.tick = inside_out_.last_tick + 1, .kind = EventKind::came_back, .cells = most_inverted_});
}

bool follows_from_ticks(EventKind kind) {
  switch (kind) {
    case EventKind::contact_begins:
    case EventKind::contact_ends:
    case EventKind::cut:
    case EventKind::piece_came_loose:
    case EventKind::damage:
    case EventKind::turned_inside_out:
    case EventKind::came_back:
      return true;
    default:
      return false;
  }
}

}  // namespace ctpm::session
