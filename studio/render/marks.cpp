#include "studio/render/marks.h"

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "studio/output/number_text.h"
#include "studio/render/plain_text.h"

namespace ctpm::render {
namespace {

cv::Scalar colour_of(const Mark& mark) { return {255 * mark.colour[0], 255 * mark.colour[1], 255 * mark.colour[2]}; }

void write_label(cv::Mat& rgb, cv::Point at, const std::string& name, const cv::Scalar& colour, double scale) {
  const std::string text = plain_text(name);
  const cv::Point place = at + cv::Point(int(12 * scale), int(-8 * scale));
  // A dark rim keeps it readable on every organ.
  cv::putText(rgb, text, place, cv::FONT_HERSHEY_DUPLEX, 0.5 * scale, {20, 24, 28}, int(std::ceil(3 * scale)),
              cv::LINE_AA);
  cv::putText(rgb, text, place, cv::FONT_HERSHEY_DUPLEX, 0.5 * scale, colour, 1, cv::LINE_AA);
}

}  // namespace

void draw_marks(Frame& frame, const Camera& camera, const std::vector<Mark>& marks) {
  cv::Mat rgb(frame.height, frame.width, CV_8UC3, frame.rgb.data());
  const double scale = frame.height / 720.0;
  const int stroke = std::max(1, int(std::lround(2 * scale)));
  for (const Mark& mark : marks) {
    std::vector<cv::Point> seen;
    for (const Vec3& point : mark.points) {
      const Pixel pixel = project(camera, frame.width, frame.height, point);
      if (pixel.depth > 0 && std::abs(pixel.x) < 1e5 && std::abs(pixel.y) < 1e5)
        seen.emplace_back(int(std::lround(pixel.x)), int(std::lround(pixel.y)));
    }
    const cv::Scalar colour = colour_of(mark);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (mark.shape == Mark::Shape::dot)
        cv::circle(rgb, seen[i], std::max(1, int(std::lround(mark.size * 2 * scale))), colour, cv::FILLED, cv::LINE_AA);
      if (mark.shape == Mark::Shape::ring) cv::circle(rgb, seen[i], 4 * stroke, colour, stroke, cv::LINE_AA);
      const bool is_end = i + 1 == seen.size();
      if (i == 0 || (mark.shape != Mark::Shape::line && mark.shape != Mark::Shape::arrow)) continue;
      if (is_end && mark.shape == Mark::Shape::arrow)
        cv::arrowedLine(rgb, seen[i - 1], seen[i], colour, stroke, cv::LINE_AA, 0, 0.15);
      else
        cv::line(rgb, seen[i - 1], seen[i], colour, stroke, cv::LINE_AA);
    }
    if (!mark.label.empty() && !seen.empty()) write_label(rgb, seen.back(), mark.label, colour, scale);
  }
}

std::vector<Mark> axes_of(const Bounds& bounds) {
  // 1, 2 or 5 times a power of ten millimetres.
  const double most = bounds.diagonal() / 4;
  double length = std::pow(10, std::floor(std::log10(std::max(most, 1e-6))));
  for (const double factor : {5.0, 2.0})
    if (factor * length <= most) {
      length *= factor;
      break;
    }
  const Vec3 corner = bounds.min;
  const std::string text = " " + output::short_number(1e3 * length, 3) + " mm";
  return {{Mark::Shape::arrow, {corner, corner + Vec3{length, 0, 0}}, {0.95, 0.35, 0.30}, "x" + text},
          {Mark::Shape::arrow, {corner, corner + Vec3{0, length, 0}}, {0.40, 0.85, 0.40}, "y"},
          {Mark::Shape::arrow, {corner, corner + Vec3{0, 0, length}}, {0.45, 0.65, 1.00}, "z"}};
}

}  // namespace ctpm::render
