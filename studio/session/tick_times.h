#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/model/model.h"
#include "recordings/session.h"

namespace ctpm::session {

/// What the tools of a tick did: touched nothing, touched tissue, or drew a blade through it.
enum class Deed { none, contact, cut };

inline constexpr std::array kDeeds{Deed::none, Deed::contact, Deed::cut};

/// `none`: "no tool in tissue", and so on.
const char* name_of(Deed deed);

/// Computing times of the ticks of one deed: values that were measured, by nearest rank; 0 if there was no such tick.
struct DeedTimes {
  std::int64_t ticks = 0;
  double p50 = 0, p99 = 0;  ///< [s]
  double own_p99 = 0;       ///< the same, less what the machine took of each tick: other programs slow it little [s]
};

using TimesOfDeeds = std::array<DeedTimes, kDeeds.size()>;

/// Tells early that a session's p99 will be too high, by another one of the same script: where more than a hundredth of
/// that one's ticks in contact or in a cut were too long in this one.
class TooLong {
 public:
  /// `like` must outlive it; null: never. `most`: the longest time [s] that is not too long.
  TooLong(const TimesOfDeeds* like, double most) : like_(like), most_(most) {}

  /// `own`: what a tick took, less what the machine took of it [s].
  void add(Deed deed, double own);
  bool is_sure() const { return is_sure_; }

 private:
  const TimesOfDeeds* like_;
  double most_;
  std::array<std::int64_t, kDeeds.size()> count_{};
  bool is_sure_ = false;
};

/// Sorts the computing times of a session's ticks by deed.
class TickTimes {
 public:
  /// `model` must outlive it.
  explicit TickTimes(const Model& model) : model_(model) {}

  /// `lost`: what the machine took of the tick, RunOutcome::lost [s]. Returns what the tick did.
  Deed add(const recordings::TickRecord& record, double lost = 0);
  DeedTimes of(Deed deed) const;

 private:
  Deed deed_of(const recordings::TickRecord& record) const;

  const Model& model_;
  std::array<std::vector<float>, kDeeds.size()> times_, own_;
};

}  // namespace ctpm::session
