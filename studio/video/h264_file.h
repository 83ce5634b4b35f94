#pragma once

#include <memory>
#include <string>

#include "core/model/result.h"
#include "studio/render/frame.h"

namespace ctpm::video {

/// An MP4 file of H.264 that is being written, at a constant frame rate. Colours are coded with the matrix of BT.709,
/// which players expect of high definition.
class H264File {
 public:
  /// None: there is no encoder for H.264 here, or it does not take pictures of this size.
  static std::unique_ptr<H264File> create(const std::string& path, int width, int height, double fps);
  ~H264File();

  /// Name and version of the library that encodes.
  static std::string library();

  /// Appends a frame of the file's size. Errors: it cannot be encoded or written.
  Result<Done> add(const render::Frame& frame);

  /// Writes what is left, and the file's index. Errors: as add().
  Result<Done> finish();

 private:
  struct Parts;
  explicit H264File(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace ctpm::video
