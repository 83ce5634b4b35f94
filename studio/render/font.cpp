#include "studio/render/font.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "studio/render/plain_text.h"

namespace ctpm::render {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
constexpr int kOversample = 4;  // strokes are drawn this many times larger and averaged down

void blend(cv::Mat& rgb, const cv::Mat& mask, int x, int y, const Ink& ink) {
  for (int r = std::max(0, -y); r < mask.rows && y + r < rgb.rows; ++r)
    for (int c = std::max(0, -x); c < mask.cols && x + c < rgb.cols; ++c) {
      const int cover = mask.at<std::uint8_t>(r, c);
      if (!cover) continue;
      auto& pixel = rgb.at<cv::Vec3b>(y + r, x + c);
      for (int k = 0; k < 3; ++k)
        pixel[k] = std::uint8_t((pixel[k] * (255 - cover) + ink[std::size_t(k)] * cover + 127) / 255);
    }
}

}  // namespace

Font::Font(int height) : height_(height), scale_(kOversample * height / 22.0) {}

int Font::width(const std::string& text) {
  int sum = 0;
  for (const char c : plain_text(text)) sum += glyph(c).advance;
  return sum;
}

std::string Font::shortened(std::string text, int limit) {
  text = plain_text(text);
  if (width(text) <= limit) return text;
  while (!text.empty() && width(text + "...") > limit) text.pop_back();
  return text + "...";
}

std::vector<std::string> Font::in_lines(std::string text, int limit, std::size_t most) {
  std::vector<std::string> lines;
  while (width(text) > limit && lines.size() + 1 < most) {
    std::size_t end = text.rfind(' ');
    while (end != std::string::npos && end > 0 && width(text.substr(0, end)) > limit) end = text.rfind(' ', end - 1);
    if (end == std::string::npos || end == 0) break;
    lines.push_back(text.substr(0, end)), text.erase(0, end + 1);
  }
  lines.push_back(shortened(text, limit));
  return lines;
}

std::string Font::shortened_inside(const std::string& text, int limit) {
  const std::string whole = plain_text(text);
  std::string shown = whole;
  for (std::size_t kept = whole.size(); kept > 0 && width(shown) > limit; --kept)
    shown = whole.substr(0, (kept - 1) / 2) + "..." + whole.substr(whole.size() - kept / 2);
  return shown;
}

void Font::write(cv::Mat& rgb, int x, int y, const std::string& text, const Ink& ink) {
  for (const char c : plain_text(text)) {
    const Glyph& g = glyph(c);
    blend(rgb, g.mask, x - height_ / 4, y - height_ / 4, ink);
    x += g.advance;
  }
}

const Font::Glyph& Font::glyph(char c) {
  const auto found = glyphs_.find(c);
  if (found != glyphs_.end()) return found->second;
  const std::string text(1, c >= 32 && c < 127 ? c : '?');
  const int thickness = std::max(1, int(std::lround(1.15 * kOversample * height_ / 18.0)));
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, kFont, scale_, 1, &baseline);
  const int pad = height_ / 4, advance = int(std::lround(double(size.width) / kOversample));
  cv::Mat large(kOversample * (height_ + height_ / 2 + 2 * pad), kOversample * (advance + 2 * pad), CV_8U,
                cv::Scalar(0));
  cv::putText(large, text, {kOversample * pad, kOversample * (pad + height_)}, kFont, scale_, cv::Scalar(255),
              thickness, cv::LINE_AA);
  Glyph g{{}, advance};
  cv::resize(large, g.mask, {large.cols / kOversample, large.rows / kOversample}, 0, 0, cv::INTER_AREA);
  return glyphs_.emplace(c, g).first->second;
}

}  // namespace ctpm::render
