#include "studio/film/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "studio/film/stills.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"

namespace ctpm::film {
namespace {

constexpr int kFiner = 2;  // small pictures are drawn so many times as large: their outlines would be ragged

/// Shrinks a picture by kFiner onto a place of the page.
void put(render::Frame& page, const render::Frame& picture, int left, int top) {
  const auto at = [](const render::Frame& f, int x, int y) {
    return 3 * (std::size_t(y) * std::size_t(f.width) + std::size_t(x));
  };
  for (int y = 0; y < picture.height / kFiner; ++y)
    for (int x = 0; x < picture.width / kFiner; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        int sum = 0;
        for (int i = 0; i < kFiner * kFiner; ++i)
          sum += picture.rgb[at(picture, kFiner * x + i % kFiner, kFiner * y + i / kFiner) + c];
        page.rgb[at(page, left + x, top + y) + c] = std::uint8_t(sum / (kFiner * kFiner));
      }
}

}  // namespace

Result<Done> write_contact_sheet(recordings::SessionReader& session, const std::string& path,
                                 const ExportOptions& options) {
  constexpr int kCount = kSheetColumns * kSheetRows;
  if (const Result<Done> is_new = output::check_new(path, options.overwrite); !is_new) return is_new.errors();
  const double tick = session.start().model.tick;
  const Result<session::TickRange> range = options.range.in_ticks(session.path(), tick, session.tick_count());
  if (!range) return range.errors();
  ExportOptions small = options;
  const int wide = options.size.width / kSheetColumns, high = options.size.height / kSheetRows;
  small.size = {kFiner * wide, kFiner * high};
  StillsRequest request;
  for (int i = 1; i <= kCount; ++i) {
    request.ticks.push_back(range->from + std::llround(double(range->to - range->from) * i / kCount));
    request.since.push_back(request.ticks.back() - (i > 1 ? request.ticks[std::size_t(i) - 2] : range->from));
  }
  const auto caption = [&](std::int64_t at, const std::string& words) {
    return output::fixed(double(at) * tick, 2) + " s" + (words.empty() ? "" : "  " + words);
  };
  const auto stills = draw_stills({&session}, {request}, caption, small);
  if (!stills) return stills.errors();
  render::Frame page = render::blank_frame(options.size.width, options.size.height, 24, 24, 24);
  for (int i = 0; i < kCount; ++i)
    put(page, stills->front()[std::size_t(i)], i % kSheetColumns * wide, i / kSheetColumns * high);
  return render::write_png(path, page);
}

}  // namespace ctpm::film
