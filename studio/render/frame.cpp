#include "studio/render/frame.h"

#include <algorithm>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <system_error>

namespace ctpm::render {

Frame blank_frame(int width, int height, std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  Frame frame{width, height, std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height) * 3)};
  for (std::size_t i = 0; i < frame.rgb.size(); i += 3)
    frame.rgb[i] = red, frame.rgb[i + 1] = green, frame.rgb[i + 2] = blue;
  return frame;
}

Frame join_beside(const Frame& left, const Frame& right) {
  CTPM_CHECK(left.height == right.height, "pictures side by side have one height");
  Frame both{left.width + right.width, left.height, {}};
  const std::size_t a = std::size_t(left.width) * 3, b = std::size_t(right.width) * 3;
  for (std::size_t row = 0; row < std::size_t(left.height); ++row) {
    const auto from_left = left.rgb.begin() + std::ptrdiff_t(row * a),
               from_right = right.rgb.begin() + std::ptrdiff_t(row * b);
    both.rgb.insert(both.rgb.end(), from_left, from_left + std::ptrdiff_t(a));
    both.rgb.insert(both.rgb.end(), from_right, from_right + std::ptrdiff_t(b));
    // The line: two pixels at the seam.
    const std::size_t seam = row * (a + b) + a;
    for (std::size_t i = seam - std::min<std::size_t>(a, 3); i < seam + std::min<std::size_t>(b, 3); ++i)
      both.rgb[i] = 24;
  }
  return both;
}

Result<Done> write_png(const std::string& path, const Frame& frame) {
  if (frame.width <= 0 || frame.height <= 0) return Error{path, "the picture has no pixels", ""};
  if (!path.ends_with(".png")) return Error{path, "a picture's name must end in .png", ""};
  const std::string part = path.substr(0, path.size() - 4) + ".part.png";
  std::string reason = "the file cannot be written";
  bool written = false;
  try {
    const cv::Mat rgb(frame.height, frame.width, CV_8UC3, const_cast<std::uint8_t*>(frame.rgb.data()));
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    written = cv::imwrite(part, bgr);
  } catch (const cv::Exception& problem) {
    reason = problem.err;
  }
  std::error_code failed;
  if (written) std::filesystem::rename(part, path, failed);
  if (!written || failed) {
    if (failed) reason = failed.message();
    std::filesystem::remove(part, failed);
    return Error{path, "the picture could not be written: " + reason, "check that the folder exists and is writable"};
  }
  return Done{};
}

Result<Frame> read_picture(const std::string& path) {
  try {
    cv::Mat bgr = cv::imread(path, cv::IMREAD_COLOR);
    if (bgr.empty()) return Error{path, "no picture could be read", ""};
    Frame frame = blank_frame(bgr.cols, bgr.rows, 0, 0, 0);
    cv::Mat rgb(frame.height, frame.width, CV_8UC3, frame.rgb.data());
    cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
    return frame;
  } catch (const cv::Exception& problem) {
    return Error{path, "no picture could be read: " + problem.err, ""};
  }
}

}  // namespace ctpm::render
