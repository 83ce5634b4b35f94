#include "studio/render/strip.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "studio/output/number_text.h"

namespace ctpm::render {
namespace {

const cv::Scalar kGround(24, 27, 31), kComing(96, 106, 116), kPassed(110, 190, 255), kLimit(235, 72, 60),
    kNow(240, 243, 246);

cv::Scalar ink(const Colour& colour) { return {255 * colour[0], 255 * colour[1], 255 * colour[2]}; }

}  // namespace

Frame with_strip(const Frame& picture, int height, const Strip& strip) {
  Frame whole = blank_frame(picture.width, picture.height + height, 0, 0, 0);
  std::copy(picture.rgb.begin(), picture.rgb.end(), whole.rgb.begin());
  cv::Mat rgb(height, whole.width, CV_8UC3,
              whole.rgb.data() + std::size_t(picture.height) * std::size_t(whole.width) * 3);
  rgb.setTo(kGround);
  const int margin = std::max(3, height / 8), low = height - margin, high = margin;
  const auto column = [&](double share) { return int(std::lround(share * (whole.width - 1))); };
  const auto row = [&](double force) {
    const double share = strip.top_force > 0 ? std::min(force / strip.top_force, 1.0) : 0;
    return low - int(std::lround(share * (low - high)));
  };
  const int now = column(strip.now);
  for (int x = 0; x < whole.width && !strip.force.empty(); ++x) {
    const double force =
        strip.force[std::min(strip.force.size() - 1, std::size_t(x) * strip.force.size() / std::size_t(whole.width))];
    if (force > 0) cv::line(rgb, {x, low}, {x, row(force)}, x <= now ? kPassed : kComing);
  }
  if (strip.limit > 0 && strip.limit <= strip.top_force)
    for (int x = 0; x < whole.width; x += 8) cv::line(rgb, {x, row(strip.limit)}, {x + 4, row(strip.limit)}, kLimit);
  for (const StripMoment& moment : strip.moments)
    cv::rectangle(rgb, {column(moment.at) - 1, 0}, {column(moment.at) + 1, margin + 1}, ink(moment.colour), cv::FILLED);
  cv::line(rgb, {now, 0}, {now, height - 1}, kNow, std::max(1, height / 30));
  // In the corner that the force leaves free.
  const double scale = height / 110.0;
  const std::string text = output::short_number(strip.top_force, 3) + " N";
  int baseline = 0;
  const int width = cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, scale, 1, &baseline).width;
  cv::putText(rgb, text, {whole.width - width - 2 * margin, high + int(24 * scale)}, cv::FONT_HERSHEY_DUPLEX, scale,
              kNow, 1, cv::LINE_AA);
  return whole;
}

}  // namespace ctpm::render
