#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/render/frame.h"
#include "studio/video/captions.h"

namespace ctpm::video {

/// Facts about the finished video, measured by reopening the file.
struct VideoFacts {
  std::string path;           ///< of the file or folder; differs from the request after a fallback
  std::string codec;          ///< "H.264", "Motion JPEG" or "PNG"
  std::string note;           ///< why a fallback was used; empty if none was
  int width = 0, height = 0;  ///< [pixels]
  double fps = 0;             ///< frames per second
  std::int64_t frames = 0;    ///< counted by decoding them all
  std::int64_t bytes = 0;
};

/// Names and versions of the encoding libraries.
std::string video_library();

/// Writes frames to a video of constant frame rate. The end of the path selects the format: `.mp4` is H.264, `.avi`
/// Motion JPEG, and `/` a folder of numbered PNG pictures. If a codec is missing, the next of the three is used and
/// VideoFacts::note says so. The file or folder has a temporary name until it is complete and checked; an unfinished
/// one is removed.
class VideoWriter {
 public:
  /// Errors: another ending, a side that is odd or outside [2, 8192], a frame rate outside [1, 240], a folder that
  /// cannot be written, a folder of pictures that exists already.
  static Result<std::unique_ptr<VideoWriter>> create(const std::string& path, int width, int height, double fps);
  /// The errors of create() for these arguments, without creating anything.
  static Errors check(const std::string& path, int width, int height, double fps);
  ~VideoWriter();

  /// Path of the finished video, and why it differs from the request (empty: it does not).
  const std::string& path() const;
  const std::string& note() const;

  /// Appends a frame. Errors: a frame of another size, after finish().
  Result<Done> add(const render::Frame& frame);

  /// Closes the file, gives an MP4 its captions, reopens it, checks its size and number of frames, and renames it.
  /// Errors: no frame was added, the file does not contain what was written.
  Result<VideoFacts> finish(const std::vector<Caption>& captions = {});

 private:
  struct Parts;
  explicit VideoWriter(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace ctpm::video
