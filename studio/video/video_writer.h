#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/model/result.h"
#include "studio/render/frame.h"

namespace ctpm::video {

/// What was written, as found by opening the file again.
struct VideoFacts {
  std::string path;           ///< of the file or folder; another one than asked for if a fallback was taken
  std::string codec;          ///< "H.264", "Motion JPEG" or "PNG"
  std::string note;           ///< why a fallback was taken; empty if none was
  int width = 0, height = 0;  ///< [pixels]
  double fps = 0;             ///< frames per second
  std::int64_t frames = 0;    ///< counted by decoding them all
  std::int64_t bytes = 0;
};

/// What encodes, with its version.
std::string video_library();

/// Writes frames to a video of constant frame rate. The ending of the path decides how: `.mp4` is H.264,
/// `.avi` Motion JPEG, and a `/` at its end a folder of numbered PNG pictures. Where a codec is missing the
/// next of them is taken, and VideoFacts::note says so. The file or folder has a temporary name until it is
/// whole and checked; an unfinished one is removed.
class VideoWriter {
 public:
  /// Errors: another ending, a size that is not positive and even or beyond 8192, a frame rate outside
  /// [1, 240], a folder that cannot be written, a folder of pictures that exists already.
  static Result<std::unique_ptr<VideoWriter>> create(const std::string& path, int width, int height, double fps);
  /// What create() would refuse of its arguments, without making anything.
  static Errors check(const std::string& path, int width, int height, double fps);
  ~VideoWriter();

  /// Where the finished video will be, and why it is not what was asked for (empty: it is).
  const std::string& path() const;
  const std::string& note() const;

  /// Appends a frame. Errors: a frame of another size, after finish().
  Result<Done> add(const render::Frame& frame);

  /// Closes the file, opens it again, compares its size and number of frames, and gives it its name.
  /// Errors: no frame was added, the file does not hold what was written.
  Result<VideoFacts> finish();

 private:
  struct Parts;
  explicit VideoWriter(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace ctpm::video
