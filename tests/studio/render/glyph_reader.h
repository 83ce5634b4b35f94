#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "studio/render/overlay.h"

namespace ctpm::render_test {

/// Reads what the overlay wrote out of a picture, by matching each place with pictures of all characters. It
/// knows what a character looks like, and how far from the left labels begin.
class GlyphReader {
 public:
  /// For pictures of this size.
  GlyphReader(int width, int height) {
    for (const char c : std::string("0123456789.-+ abcdefghijklmnopqrstuvwxyzNCTPM")) {
      render::OverlayData data;
      data.session = std::string(" ") + c + " ";
      render::Overlay overlay(width, height);
      render::Frame frame = render::blank_frame(width, height, 60, 60, 60);
      overlay.draw(frame, data);
      for (const render::PlacedText& text : overlay.layout(data)) {
        if (text.text == "time" || text.text == "session") labels_at_.insert(text.box.x);
        if (text.text != data.session) continue;
        const int space = space_width(width, height);
        glyphs_[c] = patch(frame, text.box.x + space, text.box.y, text.box.width - 2 * space, text.box.height);
      }
    }
  }

  /// The text behind `label`, read to the right as far as characters are found; empty if the label is not in
  /// the picture.
  std::string read_after(const render::Frame& frame, const std::string& label) const {
    Patch word{0, glyphs_.at('t').height, {}};
    for (const char c : label) word.width += glyphs_.at(c).width;
    word.light.resize(std::size_t(word.width * word.height));
    int x = 0;
    for (const char c : label) paste(glyphs_.at(c), word, x), x += glyphs_.at(c).width;
    double best = kMatch;
    int at_x = -1, at_y = -1;
    // In a wide picture all facts are in the upper half, and the plot below has a label of its own.
    const int end = frame.width < 1.4 * frame.height ? frame.height : frame.height / 2;
    for (int y = 0; y + word.height < end; ++y)
      for (const int left : labels_at_)
        if (const double match = similarity(frame, left, y, word); match > best) best = match, at_x = left, at_y = y;
    return at_x < 0 ? "" : read_line(frame, at_x + word.width, at_y);
  }

 private:
  static constexpr double kMatch = 0.86;  ///< correlation; compression blurs the strokes

  struct Patch {
    int width = 0, height = 0;
    std::vector<float> light;  ///< (height x width)
  };

  static int space_width(int width, int height) {
    render::OverlayData data;
    data.session = std::string(1, ' ');
    for (const render::PlacedText& text : render::Overlay(width, height).layout(data))
      if (text.text == data.session) return text.box.width;
    return 0;
  }
  /// Of the brightest of red and green: inks are white, grey, amber, green or red.
  static float light(const render::Frame& frame, int x, int y) {
    const std::uint8_t* pixel = &frame.rgb[(std::size_t(y) * std::size_t(frame.width) + std::size_t(x)) * 3];
    return std::max(pixel[0], pixel[1]);
  }
  static Patch patch(const render::Frame& frame, int x, int y, int width, int height) {
    Patch patch{width, height, {}};
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c) patch.light.push_back(light(frame, x + c, y + r));
    return patch;
  }
  static void paste(const Patch& glyph, Patch& word, int x) {
    for (int r = 0; r < glyph.height; ++r)
      for (int c = 0; c < glyph.width; ++c)
        word.light[std::size_t(r * word.width + x + c)] = glyph.light[std::size_t(r * glyph.width + c)];
  }
  /// Normalised correlation, in [-1, 1]; of two even patches: 1.
  static double similarity(const render::Frame& frame, int x, int y, const Patch& p) {
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    const double n = double(p.light.size());
    for (int r = 0; r < p.height; ++r)
      for (int c = 0; c < p.width; ++c) {
        const double u = light(frame, x + c, y + r), v = p.light[std::size_t(r * p.width + c)];
        a += u, b += v, aa += u * u, bb += v * v, ab += u * v;
      }
    const double spread_a = aa - a * a / n, spread_b = bb - b * b / n;
    constexpr double kEven = 400;  // [grey^2] a pixel: no stroke is so faint
    if (spread_a < kEven * n || spread_b < kEven * n) return spread_a < kEven * n && spread_b < kEven * n;
    return (ab - a * b / n) / std::sqrt(spread_a * spread_b);
  }

  bool is_blank(const render::Frame& frame, int x, int y) const {
    float least = 255, most = 0;
    for (int r = y; r < y + glyphs_.at(' ').height; ++r)
      least = std::min(least, light(frame, x, r)), most = std::max(most, light(frame, x, r));
    return most - least < 45;
  }

  std::string read_line(const render::Frame& frame, int x, int y) const {
    const int space = glyphs_.at(' ').width;
    std::string text;
    for (int gap = 0; x + 2 * space < frame.width;) {
      if (is_blank(frame, x, y)) {
        if (text.size() && ++gap > 3 * space) break;  // the line is over
        ++x;
        continue;
      }
      char found = 0;
      double best = kMatch;
      int next = 0;
      for (const auto& [c, glyph] : glyphs_)
        for (int left = x - 4; c != ' ' && left < x + 2; ++left)  // strokes begin inside their patch
          if (const double match = similarity(frame, left, y, glyph); match > best)
            best = match, found = c, next = left + glyph.width;
      if (!found) break;
      if (text.size() && gap > space / 2) text += ' ';
      text += found, x = next, gap = 0;
    }
    return text;
  }

  std::map<char, Patch> glyphs_;
  std::set<int> labels_at_;  ///< [pixels] from the left
};

}  // namespace ctpm::render_test
