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

/// Sorts the computing times of a session's ticks by deed.
class TickTimes {
 public:
  /// `model` must outlive it.
  explicit TickTimes(const Model& model) : model_(model) {}

  /// `lost`: what the machine took of the tick, RunOutcome::lost [s].
  void add(const recordings::TickRecord& record, double lost = 0);
  DeedTimes of(Deed deed) const;

 private:
  Deed deed_of(const recordings::TickRecord& record) const;

  const Model& model_;
  std::array<std::vector<float>, kDeeds.size()> times_, own_;
};

}  // namespace ctpm::session
