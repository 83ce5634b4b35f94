#include "studio/video/video_writer.h"

#include <unistd.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <system_error>

namespace ctpm {
namespace {

namespace fs = std::filesystem;

/// One way to write a video.
struct Format {
  int fourcc;
  int backend;
  const char* codec;
  const char* ending;
};

Format h264() { return {cv::VideoWriter::fourcc('a', 'v', 'c', '1'), cv::CAP_FFMPEG, "H.264", ".mp4"}; }
Format motion_jpeg() {
  return {cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), cv::CAP_OPENCV_MJPEG, "Motion JPEG", ".avi"};
}

Errors check(const std::string& path, int width, int height, double fps) {
  Errors errors;
  if (!path.ends_with(".mp4")) errors.push_back({path, "a video's name must end in .mp4", ""});
  const auto is_good = [](int n) { return n > 0 && n <= 8192 && n % 2 == 0; };
  if (!is_good(width) || !is_good(height))
    errors.push_back({path,
                      "got a video size of " + std::to_string(width) + "x" + std::to_string(height) +
                          ", each must be even and in [2, 8192]",
                      ""});
  if (!(fps >= 1 && fps <= 240))
    errors.push_back({path, "got " + std::to_string(fps) + " frames/s, must be in [1, 240]", ""});
  const fs::path folder = fs::path(path).parent_path().empty() ? fs::path(".") : fs::path(path).parent_path();
  std::error_code failed;
  if (!fs::is_directory(folder, failed))
    errors.push_back({path, "the folder " + folder.string() + " does not exist", "make it first"});
  else if (access(folder.c_str(), W_OK) != 0)
    errors.push_back({path, "the folder " + folder.string() + " cannot be written", ""});
  return errors;
}

}  // namespace

struct VideoWriter::Parts {
  std::string stem;  ///< path without ending
  std::string part;  ///< temporary name
  Format format{};
  std::string note;
  int width = 0, height = 0;
  double fps = 0;
  std::int64_t frames = 0;
  bool is_finished = false;
  cv::VideoWriter writer;
  cv::Mat bgr;

  bool open(const Format& wanted);
  void discard();
  Result<VideoFacts> check_file() const;
};

bool VideoWriter::Parts::open(const Format& wanted) {
  format = wanted;
  part = stem + ".part" + std::to_string(getpid()) + wanted.ending;
  try {
    // Quality is the encoder's own constant-quality default for H.264, and near lossless for Motion JPEG.
    std::vector<int> settings{cv::VIDEOWRITER_PROP_QUALITY, 95};
    if (wanted.backend == cv::CAP_FFMPEG) settings.clear();
    if (writer.open(part, wanted.backend, wanted.fourcc, fps, {width, height}, settings)) return true;
  } catch (const cv::Exception&) {
    // Reported by the caller, once no format is left.
  }
  discard();
  return false;
}

void VideoWriter::Parts::discard() {
  writer.release();
  std::error_code ignored;
  if (!part.empty()) fs::remove(part, ignored);
}

/// Opens the closed temporary file and counts what is in it.
Result<VideoFacts> VideoWriter::Parts::check_file() const {
  VideoFacts facts{stem + format.ending, format.codec, note, 0, 0, 0, 0, 0};
  try {
    cv::VideoCapture reader(part);
    if (!reader.isOpened()) return Error{facts.path, "the video that was written cannot be opened again", ""};
    facts.width = int(reader.get(cv::CAP_PROP_FRAME_WIDTH)),
    facts.height = int(reader.get(cv::CAP_PROP_FRAME_HEIGHT));
    facts.fps = reader.get(cv::CAP_PROP_FPS);
    while (reader.grab()) ++facts.frames;
  } catch (const cv::Exception& problem) {
    return Error{facts.path, "the video that was written cannot be read: " + problem.err, ""};
  }
  std::error_code failed;
  facts.bytes = std::int64_t(fs::file_size(part, failed));
  if (facts.frames != frames)
    return Error{
        facts.path,
        std::to_string(frames) + " frames were written, " + std::to_string(facts.frames) + " are in the file",
        "check the free space"};
  if (facts.width != width || facts.height != height)
    return Error{facts.path,
                 "the video has the size " + std::to_string(facts.width) + "x" + std::to_string(facts.height),
                 ""};
  return facts;
}

VideoWriter::VideoWriter(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

VideoWriter::~VideoWriter() {
  if (!parts_->is_finished) parts_->discard();
}

Result<std::unique_ptr<VideoWriter>> VideoWriter::create(const std::string& path, int width, int height,
                                                         double fps) {
  if (Errors errors = check(path, width, height, fps); !errors.empty()) return errors;
  auto parts = std::make_unique<Parts>();
  parts->stem = path.substr(0, path.size() - 4);
  parts->width = width, parts->height = height, parts->fps = fps;
  if (!parts->open(h264())) {
    if (!parts->open(motion_jpeg()))
      return Error{path, "neither H.264 nor Motion JPEG can be written here",
                   "install OpenCV's videoio with FFmpeg"};
    parts->note = "H.264 is not available here: Motion JPEG in AVI was written instead";
  }
  return std::unique_ptr<VideoWriter>(new VideoWriter(std::move(parts)));
}

Result<Done> VideoWriter::add(const Frame& frame) {
  Parts& p = *parts_;
  const std::string path = p.stem + p.format.ending;
  if (p.is_finished) return Error{path, "the video is finished", ""};
  if (frame.width != p.width || frame.height != p.height)
    return Error{path,
                 "got a frame of " + std::to_string(frame.width) + "x" + std::to_string(frame.height) +
                     " for a video of " + std::to_string(p.width) + "x" + std::to_string(p.height),
                 ""};
  try {
    const cv::Mat rgb(frame.height, frame.width, CV_8UC3, const_cast<std::uint8_t*>(frame.rgb.data()));
    cv::cvtColor(rgb, p.bgr, cv::COLOR_RGB2BGR);
    p.writer.write(p.bgr);
  } catch (const cv::Exception& problem) {
    return Error{path, "a frame could not be written: " + problem.err, ""};
  }
  ++p.frames;
  return Done{};
}

Result<VideoFacts> VideoWriter::finish() {
  Parts& p = *parts_;
  const std::string path = p.stem + p.format.ending;
  if (p.is_finished) return Error{path, "the video is finished already", ""};
  p.is_finished = true;
  p.writer.release();
  Result<VideoFacts> facts = p.frames ? p.check_file() : Error{path, "a video needs at least one frame", ""};
  std::error_code failed;
  if (facts) fs::rename(p.part, path, failed);
  if (facts && failed) facts = Error{path, "the video could not be given its name: " + failed.message(), ""};
  if (!facts) p.discard();
  return facts;
}

}  // namespace ctpm
