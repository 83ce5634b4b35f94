#include "studio/render/frame.h"

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <system_error>

namespace ctpm {

Frame blank_frame(int width, int height, std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  Frame frame{width, height, std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height) * 3)};
  for (std::size_t i = 0; i < frame.rgb.size(); i += 3)
    frame.rgb[i] = red, frame.rgb[i + 1] = green, frame.rgb[i + 2] = blue;
  return frame;
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
    return Error{path, "the picture could not be written: " + reason,
                 "check that the folder exists and is writable"};
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

}  // namespace ctpm
