#include "studio/devices/device_pair.h"

#include <algorithm>
#include <utility>

namespace ctpm::devices {

DevicePair::DevicePair(std::unique_ptr<DeviceSource> first, std::unique_ptr<DeviceSource> second, const Model& model)
    : first_(std::move(first)), second_(std::move(second)), model_(model) {}

std::optional<Inputs> DevicePair::next(std::int64_t tick, const stepping::StepReport& last) {
  stepping::StepReport of_second = last;
  static_cast<stepping::HandReport&>(of_second) = last.second;
  const std::optional<Inputs> first = first_->next(tick, last), second = second_->next(tick, of_second);
  if (!first || !second) return std::nullopt;
  Inputs inputs = *first;
  inputs.second = *second;
  part(inputs);
  return inputs;
}

/// Takes a tool out of one hand where the two do not go together.
void DevicePair::part(Inputs& inputs) {
  const std::string conflict(stepping::hands_conflict(model_, inputs.tool, inputs.second.tool));
  if (!conflict.empty()) {
    const bool second_keeps = held_[1] == inputs.second.tool && held_[0] != inputs.tool;
    inputs.hand(second_keeps ? 0 : 1).tool = -1;
    if (conflict != conflict_)
      events_.push_back({.kind = recordings::EventKind::note,
                         .text = conflict + ": the " + (second_keeps ? "first" : "second") + " hand stays empty"});
  }
  conflict_ = conflict;
  held_ = {inputs.tool, inputs.second.tool};
}

double DevicePair::input_age() const { return std::max(first_->input_age(), second_->input_age()); }

std::vector<recordings::Event> DevicePair::take_events() {
  std::vector<recordings::Event> events = first_->take_events();
  for (recordings::Event& event : second_->take_events()) {
    event.hand = 1;
    if (!event.text.empty()) event.text = "second hand: " + event.text;
    events.push_back(std::move(event));
  }
  for (recordings::Event& event : std::exchange(events_, {})) events.push_back(std::move(event));
  return events;
}

std::vector<recordings::NamedValue> DevicePair::statistics() const {
  std::vector<recordings::NamedValue> values = first_->statistics();
  for (const auto& [name, value] : second_->statistics()) values.emplace_back("second_" + name, value);
  return values;
}

std::string DevicePair::fault() const {
  const std::string first = first_->fault(), second = second_->fault();
  return !first.empty() || second.empty() ? first : "second hand: " + second;
}

}  // namespace ctpm::devices
