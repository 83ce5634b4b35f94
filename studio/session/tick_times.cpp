#include "studio/session/tick_times.h"

#include <algorithm>

#include "core/model/nearest_rank.h"

namespace ctpm::session {

const char* name_of(Deed deed) {
  return deed == Deed::cut ? "in a cut" : deed == Deed::contact ? "in contact" : "no tool in tissue";
}

void TooLong::add(Deed deed, double own) {
  if (like_ == nullptr || deed == Deed::none || own <= most_) return;
  const auto at = std::size_t(deed);
  is_sure_ |= 100 * ++count_[at] > (*like_)[at].ticks;
}

Deed TickTimes::deed_of(const recordings::TickRecord& record) const {
  Deed deed = Deed::none;
  for (std::size_t hand = 0; hand < std::size_t(model_.hands); ++hand) {
    const bool cuts = model_.is_scalpel(record.inputs.hand(hand).tool);
    if (record.of_hand(hand).contacts > 0) deed = std::max(deed, cuts ? Deed::cut : Deed::contact);
  }
  return deed;
}

Deed TickTimes::add(const recordings::TickRecord& record, double lost) {
  const Deed deed = deed_of(record);
  times_[std::size_t(deed)].push_back(float(record.tick_time));
  own_[std::size_t(deed)].push_back(float(record.tick_time - lost));
  return deed;
}

DeedTimes TickTimes::of(Deed deed) const {
  const std::vector<float>&times = times_[std::size_t(deed)], &own = own_[std::size_t(deed)];
  return {std::int64_t(times.size()), percentile(times, 0.5), percentile(times, 0.99), percentile(own, 0.99)};
}

}  // namespace ctpm::session
