#include "studio/film/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "studio/film/reel.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"

namespace ctpm::film {
namespace {

/// The moments of the sheet.
FrameTicks ticks_of(const session::TickRange& range) {
  constexpr std::int64_t kCount = kSheetColumns * kSheetRows;
  FrameTicks ticks{range, kCount, kCount, {}, [](std::int64_t) { return 1.0; }};
  ticks.tick = [range](std::int64_t frame) {
    return range.from + std::llround(double(range.to - range.from) * double(frame + 1) / kCount);
  };
  return ticks;
}

/// Copies a picture to a place of the page.
void put(render::Frame& page, const render::Frame& picture, int left, int top) {
  for (int y = 0; y < picture.height; ++y)
    std::copy_n(picture.rgb.begin() + std::ptrdiff_t(y) * picture.width * 3, picture.width * 3,
                page.rgb.begin() + (std::ptrdiff_t(top + y) * page.width + left) * 3);
}

}  // namespace

Result<Done> write_contact_sheet(recordings::SessionReader& session, const std::string& path,
                                 const ExportOptions& options) {
  constexpr double kLetters = 1.4;  // times those of a film of that size
  if (const Result<Done> is_new = output::check_new(path, options.overwrite); !is_new) return is_new.errors();
  const double tick = session.start().model.tick;
  const Result<session::TickRange> range = options.range.in_ticks(session.path(), tick, session.tick_count());
  if (!range) return range.errors();
  const render::PictureSize size{options.size.width / kSheetColumns, options.size.height / kSheetRows};
  const FrameTicks ticks = ticks_of(*range);
  Result<Reel> made = make_reel(session, ticks, size, options);
  if (!made) return made.errors();
  std::vector<Reel> reels;
  reels.push_back(std::move(*made));
  Reel& reel = reels[0];
  if (const Result<Done> alike = look_alike(reels, {&session}); !alike) return alike.errors();
  reel.overlay = std::make_unique<render::Overlay>(size.width, size.height, kLetters);
  reel.level = render::OverlayLevel::caption;
  render::Frame page = render::blank_frame(options.size.width, options.size.height, 24, 24, 24);
  for (std::int64_t i = 0; i < ticks.frame_count; ++i) {
    if (options.should_stop && options.should_stop())
      return Error{path, "stopped before the end; no contact sheet was written", ""};
    Result<Shot> shot = reel.shoot(i);
    if (!shot) return shot.errors();
    const std::int64_t now = ticks.tick(i), since = now - (i ? ticks.tick(i - 1) : range->from);
    const std::string words = words_at(reel.moments, now, since - 1);
    shot->overlay.caption = output::fixed(double(now) * tick, 2) + " s" + (words.empty() ? "" : "  " + words);
    std::vector<Shot> shots;
    shots.push_back(std::move(*shot));
    put(page, draw_shots(reels, shots, 0), int(i % kSheetColumns) * size.width, int(i / kSheetColumns) * size.height);
    if (options.progress) options.progress(i + 1, ticks.frame_count);
  }
  return render::write_png(path, page);
}

}  // namespace ctpm::film
