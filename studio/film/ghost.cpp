#include "studio/film/ghost.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace ctpm::film {

Result<Ghost> ghost_of(recordings::SessionReader& session, const FrameTicks& ticks) {
  constexpr std::int64_t kReadTicks = 10000;  // held in memory at a time
  constexpr double kPointEvery = 0.02;        // of the way [s]
  constexpr render::Colour kBlue{0.35, 0.7, 1};
  Ghost ghost{.session = std::filesystem::path(session.path()).stem().string(), .hand = {}, .way = {}};
  const std::int64_t every = std::max<std::int64_t>(1, std::llround(kPointEvery / session.start().model.tick));
  std::int64_t frame = 0;
  std::int32_t held = -1;
  Hand last;
  for (std::int64_t from = 0; from < session.tick_count(); from += kReadTicks) {
    const auto records = session.ticks(from, std::min(from + kReadTicks, session.tick_count()));
    if (!records) return records.errors();
    for (std::size_t i = 0; i < records->size(); ++i) {
      const std::int64_t tick = from + std::int64_t(i);
      last = (*records)[i].inputs;
      if (last.tool >= 0 && last.tool != held)
        ghost.way.push_back({.shape = render::Mark::Shape::line, .points = {}, .colour = kBlue, .label = ""});
      held = last.tool;
      if (held >= 0 && tick % every == 0) ghost.way.back().points.push_back(last.position);
      for (; frame < ticks.frame_count && ticks.tick(frame) <= tick + 1; ++frame) ghost.hand.push_back(last);
    }
  }
  ghost.hand.resize(std::size_t(ticks.frame_count), last);
  return ghost;
}

}  // namespace ctpm::film
