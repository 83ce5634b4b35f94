#include "studio/render/frame.h"

#include <png.h>

#include <algorithm>

#include "studio/output/files.h"

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

namespace {

/// What libpng is told about a picture; it frees what libpng keeps.
struct Png {
  png_image image{};

  Png() { image.version = PNG_IMAGE_VERSION; }
  explicit Png(const Frame& frame) : Png() {
    CTPM_CHECK(frame.rgb.size() == std::size_t(frame.width) * std::size_t(frame.height) * 3, "three bytes a pixel");
    image.width = png_uint_32(frame.width), image.height = png_uint_32(frame.height);
    image.format = PNG_FORMAT_RGB, image.flags = PNG_IMAGE_FLAG_FAST;
  }
  ~Png() { png_image_free(&image); }
  Png(const Png&) = delete;
  Png& operator=(const Png&) = delete;
};

}  // namespace

Result<std::vector<std::uint8_t>> to_png(const Frame& frame) {
  if (frame.width <= 0 || frame.height <= 0) return Error{"picture", "has no pixels", ""};
  Png png(frame);
  std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(png.image));
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&png.image, bytes.data(), &size, 0, frame.rgb.data(), 0, nullptr))
    return Error{"picture", std::string("cannot be encoded as PNG: ") + png.image.message, ""};
  bytes.resize(size);
  return bytes;
}

Result<Done> write_png(const std::string& path, const Frame& frame) {
  if (frame.width <= 0 || frame.height <= 0) return Error{path, "the picture has no pixels", ""};
  if (!path.ends_with(".png")) return Error{path, "a picture's name must end in .png", ""};
  const Result<std::vector<std::uint8_t>> png = to_png(frame);
  if (!png) return png.errors();
  return output::write_text_file(path, std::string(png->begin(), png->end()));
}

Result<Frame> read_png(const std::string& path) {
  Png png;
  const auto problem = [&] { return Error{path, std::string("no picture could be read: ") + png.image.message, ""}; };
  if (!png_image_begin_read_from_file(&png.image, path.c_str())) return problem();
  png.image.format = PNG_FORMAT_RGB;
  Frame frame = blank_frame(int(png.image.width), int(png.image.height), 0, 0, 0);
  const png_color on_black{0, 0, 0};
  if (!png_image_finish_read(&png.image, &on_black, frame.rgb.data(), 0, nullptr)) return problem();
  return frame;
}

}  // namespace ctpm::render
