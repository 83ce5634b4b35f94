#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/model/result.h"
#include "studio/render/frame.h"

namespace ctpm::video {

/// H.264 in MP4: colours are coded with the matrix of BT.709, which players expect of high definition. Motion JPEG in
/// AVI: nearly lossless, with the matrix of JPEG (BT.601).
enum class Coding { h264, motion_jpeg };

/// A video file that is being written, at a constant frame rate.
class VideoFile {
 public:
  /// None: here is no encoder and decoder for this coding, or the encoder does not take pictures of this size.
  static std::unique_ptr<VideoFile> create(const std::string& path, Coding coding, int width, int height, double fps);
  ~VideoFile();

  /// Name and version of the library that encodes.
  static std::string library();

  /// Appends a frame of the file's size. Errors: it cannot be encoded or written.
  Result<Done> add(const render::Frame& frame);

  /// Writes what is left, and the file's index. Errors: as add().
  Result<Done> finish();

 private:
  struct Parts;
  explicit VideoFile(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// What a reader finds in a video file.
struct InVideoFile {
  int width = 0, height = 0;
  double fps = 0;
  std::int64_t frames = 0;  ///< as packets, of which the first is decoded
};

/// Errors: the file cannot be opened as a video, or its first frame cannot be decoded.
Result<InVideoFile> read_video_file(const std::string& path);

}  // namespace ctpm::video
