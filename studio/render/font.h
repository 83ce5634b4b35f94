#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace ctpm::render {

/// Red, green and blue, 0 to 255.
using Ink = std::array<int, 3>;

/// A stroke font in one size. Texts are drawn as plain_text().
class Font {
 public:
  /// `height`: of capital letters [pixels].
  explicit Font(int height);

  int height() const { return height_; }
  /// Of a text [pixels].
  int width(const std::string& text);

  /// The text, or as much of its beginning as fits into `width`, with an ellipsis.
  std::string shortened(std::string text, int limit);
  /// The text in at most `most` lines of whole words; the last one as shortened().
  std::vector<std::string> in_lines(std::string text, int limit, std::size_t most);
  /// The text, or as much of its beginning and end as fits: names of a pair differ at their end.
  std::string shortened_inside(const std::string& text, int limit);

  void write(cv::Mat& rgb, int x, int y, const std::string& text, const Ink& ink);

 private:
  /// The strokes of one character, ready to be blended.
  struct Glyph {
    cv::Mat mask;
    int advance = 0;  ///< [pixels]
  };
  const Glyph& glyph(char c);

  int height_;
  double scale_;
  std::map<char, Glyph> glyphs_;
};

}  // namespace ctpm::render
