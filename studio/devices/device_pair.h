#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "studio/devices/device_source.h"

namespace ctpm::devices {

/// Two devices as the source of a session, one for each hand. Each has its own guard, map and coupling, and feels the
/// force on its own tool. Where both ask for tools that two hands cannot hold at once, the hand that held its tool
/// before keeps it, and the other one stays empty; an event says so once.
class DevicePair : public sources::InputSource {
 public:
  /// `model` must outlive the pair, and have two hands.
  DevicePair(std::unique_ptr<DeviceSource> first, std::unique_ptr<DeviceSource> second, const Model& model);

  DeviceSource& of_hand(std::size_t hand) { return hand == 0 ? *first_ : *second_; }

  std::optional<Inputs> next(std::int64_t tick, const stepping::StepReport& last) override;
  double input_age() const override;  ///< of the older sample
  std::vector<recordings::Event> take_events() override;
  std::vector<recordings::NamedValue> statistics() const override;
  std::string fault() const override;

 private:
  void part(Inputs& inputs);

  std::unique_ptr<DeviceSource> first_, second_;
  const Model& model_;
  std::array<std::int32_t, kMostHands> held_{-1, -1};
  std::string conflict_;  ///< of the tick before
  std::vector<recordings::Event> events_;
};

}  // namespace ctpm::devices
