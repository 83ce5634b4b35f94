#include "studio/film/session_strip.h"

#include <algorithm>

namespace ctpm::film {
namespace {

constexpr std::size_t kParts = 2000;  // of a strip, more than a picture has columns for a half

render::Colour colour_of(Moment::Kind kind) {
  switch (kind) {
    case Moment::Kind::damage:
    case Moment::Kind::inside_out:
      return {0.92, 0.28, 0.24};
    case Moment::Kind::cut:
    case Moment::Kind::loose:
      return {1, 0.75, 0.31};
    default:
      return {0.66, 0.70, 0.74};
  }
}

}  // namespace

render::Strip strip_of(recordings::SessionReader& session, const std::vector<Moment>& moments, double limit) {
  constexpr std::int64_t kReadTicks = 1000;  // what is damaged is left out in parts of this size
  render::Strip strip;
  const std::int64_t count = session.tick_count();
  strip.force.assign(std::min<std::size_t>(kParts, std::size_t(std::max<std::int64_t>(count, 1))), 0.0);
  for (std::int64_t from = 0; from < count; from += kReadTicks) {
    const auto records = session.ticks(from, std::min(from + kReadTicks, count));
    if (!records) continue;
    for (std::size_t i = 0; i < records->size(); ++i) {
      const std::size_t part = std::size_t(from + std::int64_t(i)) * strip.force.size() / std::size_t(count);
      for (std::size_t hand = 0; hand < std::size_t(session.start().model.hands); ++hand)
        strip.force[part] = std::max(strip.force[part], norm((*records)[i].of_hand(hand).tool_force));
    }
  }
  strip.top_force = *std::max_element(strip.force.begin(), strip.force.end());
  strip.limit = limit;
  for (const Moment& moment : moments)
    if (moment.kind != Moment::Kind::title && count > 0)
      strip.moments.push_back({double(moment.tick) / double(count), colour_of(moment.kind)});
  return strip;
}

int strip_height(int picture_height) { return std::max(24, picture_height / 12) / 2 * 2; }

}  // namespace ctpm::film
