#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/model/inputs.h"
#include "core/model/model.h"
#include "core/stepping/step.h"
#include "recordings/event.h"

namespace ctpm::session {

/// When a cut ends.
enum class CutEnds {
  with_contact,  ///< when the blade has left the tissue
  unsevered,     ///< when nothing was severed for kPause, as in older sessions: a slow stroke begins again and again
};

/// Finds the events of a simulation that reviewers look for: the moments at which something begins or ends. They follow
/// from the ticks alone, so that a replay finds the same ones.
class EventWatch {
 public:
  using Tell = std::function<void(recordings::Event)>;

  /// `damage_force`: force on a tool that damages [N]; 0: no limit. `tell` receives each event when it is known.
  EventWatch(const Model& model, double damage_force, Tell tell, CutEnds cut_ends = CutEnds::with_contact);

  /// Call it after each tick, in their order.
  void look(std::int64_t tick, const Inputs& inputs, const stepping::StepReport& report);

  /// Call it after the last tick; `end` is the number of ticks.
  void finish(std::int64_t end);

 private:
  /// A state that persists while it is seen again within kPause. Tissue that follows a retreating tool touches it
  /// intermittently.
  struct Spell {
    bool goes_on = false;
    std::int64_t last_tick = 0;
  };
  /// What happens to the tool in one hand.
  struct OfHand {
    std::int32_t tool = -1;  // of the present contact
    Spell contact, too_deep, too_strong;
  };
  static constexpr std::int64_t kPause = 300;  // [ticks]

  static bool begins(Spell& spell, std::int64_t tick, bool is_seen);
  static bool ends(Spell& spell, std::int64_t tick);
  void look_for_contact(std::int64_t tick, std::int32_t tool, const stepping::HandReport& report, OfHand& hand);
  void look_for_cut(std::int64_t tick, const Inputs& inputs, const stepping::StepReport& report);
  void look_for_damage(std::int64_t tick, const stepping::HandReport& report, OfHand& hand);
  std::size_t cutting_hand(const Inputs& inputs) const;
  void look_for_inversion(std::int64_t tick, const stepping::StepReport& report);
  void tell_that_it_came_back();

  Tell tell_;
  CutEnds cut_ends_;
  double depth_limit_ = 0, force_limit_ = 0;  // [m], [N]; 0: no limit
  std::int32_t organ_ = -1;                   // whose depth limit it is
  std::vector<std::uint8_t> is_scalpel_;      // (tool_count)
  std::int32_t blade_ = -1;                   // of the present cut
  std::int32_t most_inverted_ = 0;            // cells in one tick of the present spell
  std::array<OfHand, kMostHands> hands_;
  Spell cut_, inside_out_;
};

/// Whether events of this kind follow from the ticks alone.
bool follows_from_ticks(recordings::EventKind kind);

}  // namespace ctpm::session
