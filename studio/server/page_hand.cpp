#include "studio/server/page_hand.h"

#include <algorithm>

namespace ctpm::server {

void PageHand::move(const HandMove& move, double sent_s) {
  devices::DeviceReport report;
  // Messages that waited on their way arrive together. The page's own clock tells how far apart they were sent; the
  // quickest message so far tells how the two clocks relate.
  const double now = devices::device_clock();
  clock_offset_ = std::min(clock_offset_, now - sent_s);
  report.arrival = std::min(now, sent_s + clock_offset_);
  report.device_time = sent_s, report.on_way = now - report.arrival;
  if (move.buttons != buttons_) {
    report.news = devices::DeviceNews::buttons, report.buttons = buttons_ = move.buttons;
    reports_.push(report);
  }
  report.news = devices::DeviceNews::pose, report.pose = move.pose;
  reports_.push(report);  // full only if no session takes them
}

}  // namespace ctpm::server
