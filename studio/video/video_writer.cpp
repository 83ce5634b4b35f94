#include "studio/video/video_writer.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "studio/video/video_file.h"

namespace ctpm::video {
namespace {

namespace fs = std::filesystem;

/// One video format.
struct Format {
  std::optional<Coding> coding;  ///< none: PNG pictures
  const char* codec;
  const char* container;  ///< for people
  const char* ending;     ///< of the requested path
  const char* written;    ///< its replacement in the written path

  bool is_pictures() const { return !coding; }
};

/// Best first: each is the fallback of the one before.
constexpr std::array<Format, 3> kFormats{{
    {Coding::h264, "H.264", "H.264", ".mp4", ".mp4"},
    {Coding::motion_jpeg, "Motion JPEG", "Motion JPEG in AVI", ".avi", ".avi"},
    {std::nullopt, "PNG", "a folder of PNG pictures", "/", "-frames"},
}};

/// Index of the requested format; 3 if the ending is unknown.
std::size_t format_asked_for(const std::string& path) {
  std::size_t i = 0;
  while (i < kFormats.size() && !path.ends_with(kFormats[i].ending)) ++i;
  return i;
}

/// The picture of frame `index` in a folder, from 1.
fs::path picture_path(const std::string& folder, std::int64_t index) {
  char name[32];
  std::snprintf(name, sizeof name, "%06lld.png", (long long)index);
  return fs::path(folder) / name;
}

/// The `errno` with which creating this file fails; 0: it succeeds. This tells a path that cannot be written from a
/// missing codec.
int cannot_write(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return errno;
  std::fclose(file);
  return 0;
}

/// Checks the reopened video against the written frames.
Errors differences(const VideoFacts& facts, std::int64_t frames, int width, int height) {
  Errors errors;
  if (facts.frames != frames)
    errors.push_back(
        {facts.path,
         std::to_string(frames) + " frames were written, " + std::to_string(facts.frames) + " are in the file",
         "check the free space"});
  if (facts.width != width || facts.height != height)
    errors.push_back(
        {facts.path, "the video has the size " + std::to_string(facts.width) + "x" + std::to_string(facts.height), ""});
  return errors;
}

}  // namespace

struct VideoWriter::Parts {
  std::string stem;  ///< path without ending
  std::string path;  ///< of the finished file or folder
  std::string part;  ///< temporary name
  Format format{};
  std::string note;
  int width = 0, height = 0;
  double fps = 0;
  std::int64_t frames = 0;
  bool is_finished = false;
  std::unique_ptr<VideoFile> file;  ///< none: pictures

  Result<Done> open_first(std::size_t asked_for);
  bool open();
  Result<Done> open_pictures();
  Result<Done> close();
  /// The same of the finished video, which has another name until it is.
  Result<Done> of_video(const Result<Done>& done) const {
    return done ? done : Error{path, done.errors()[0].message, done.errors()[0].hint};
  }
  void discard();
  Result<Done> put(const render::Frame& frame);
  Result<VideoFacts> check_file() const;
  Result<VideoFacts> check_pictures() const;
};

/// Opens the requested format, or the first of the later ones that works.
Result<Done> VideoWriter::Parts::open_first(std::size_t asked_for) {
  for (std::size_t i = asked_for; i < kFormats.size(); ++i) {
    format = kFormats[i];
    if (i > asked_for)
      note = std::string(kFormats[asked_for].codec) + " is not available here: " + format.container +
             " was written instead";
    path = stem + (i == asked_for && format.is_pictures() ? "" : format.written);
    static std::atomic<int> files = 0;  // one process may write several of one name
    part = stem + ".part" + std::to_string(getpid()) + "-" + std::to_string(++files) +
           (format.is_pictures() ? "" : format.ending);
    if (format.is_pictures()) return open_pictures();
    if (const int failed = cannot_write(part); failed != 0)
      return Error{path, std::string("cannot be written: ") + std::strerror(failed), ""};
    if (open()) return Done{};
  }
  return Error{path, "no format can be written", ""};
}

bool VideoWriter::Parts::open() {
  file = VideoFile::create(part, *format.coding, width, height, fps);
  if (file == nullptr) discard();
  return file != nullptr;
}

Result<Done> VideoWriter::Parts::open_pictures() {
  std::error_code failed;
  if (fs::exists(path, failed))
    return Error{path, "exists already; pictures are not mixed with what is there", "remove it or give another name"};
  fs::create_directory(part, failed);
  if (failed) return Error{path, "the folder cannot be made: " + failed.message(), ""};
  return Done{};
}

void VideoWriter::Parts::discard() {
  file.reset();
  std::error_code ignored;
  if (!part.empty()) fs::remove_all(part, ignored);
}

Result<Done> VideoWriter::Parts::put(const render::Frame& frame) {
  if (format.is_pictures()) {
    const Result<Done> written = render::write_png(picture_path(part, frames + 1).string(), frame);
    if (written) return written;
    return Error{picture_path(path, frames + 1).string(), written.errors()[0].message, "check the free space"};
  }
  return of_video(file->add(frame));
}

Result<Done> VideoWriter::Parts::close() { return file ? of_video(file->finish()) : Done{}; }

/// Reopens the closed temporary file, decodes its first frame and counts all.
Result<VideoFacts> VideoWriter::Parts::check_file() const {
  const Result<InVideoFile> found = read_video_file(part);
  if (!found) return Error{path, found.errors()[0].message, found.errors()[0].hint};
  std::error_code failed;
  const auto bytes = std::int64_t(fs::file_size(part, failed));
  return VideoFacts{path, format.codec, note, found->width, found->height, found->fps, found->frames, bytes};
}

/// Opens the first and the last picture and counts those between.
Result<VideoFacts> VideoWriter::Parts::check_pictures() const {
  VideoFacts facts{path, format.codec, note, 0, 0, fps, 0, 0};
  for (const std::int64_t index : {std::int64_t(1), frames}) {
    const Result<render::Frame> picture = render::read_png(picture_path(part, index).string());
    if (!picture) return picture.errors();
    facts.width = picture->width, facts.height = picture->height;
  }
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(part, failed)) {
    ++facts.frames;
    facts.bytes += std::int64_t(entry.file_size(failed));
  }
  return facts;
}

Errors VideoWriter::check(const std::string& path, int width, int height, double fps) {
  Errors errors;
  std::error_code failed;
  const std::size_t asked_for = format_asked_for(path);
  if (asked_for == kFormats.size())
    errors.push_back({path, "a video's name must end in .mp4 or .avi, or in / for a folder of PNG pictures",
                      "the help of `export` lists the endings of pictures and shapes too"});
  else if (!kFormats[asked_for].is_pictures() && fs::is_directory(path, failed))
    errors.push_back({path, "is a folder", "give another name"});
  const auto is_good = [](int n) { return n > 0 && n <= 8192 && n % 2 == 0; };
  if (!is_good(width) || !is_good(height))
    errors.push_back({path,
                      "got a video size of " + std::to_string(width) + "x" + std::to_string(height) +
                          ", each must be even and in [2, 8192]",
                      ""});
  if (!(fps >= 1 && fps <= 240))
    errors.push_back({path, "got " + std::to_string(fps) + " frames/s, must be in [1, 240]", ""});
  const fs::path parent = fs::path(path.ends_with('/') ? path.substr(0, path.size() - 1) : path).parent_path();
  const fs::path folder = parent.empty() ? fs::path(".") : parent;
  if (!fs::is_directory(folder, failed))
    errors.push_back({path, "the folder " + folder.string() + " does not exist", "create it first"});
  else if (access(folder.c_str(), W_OK) != 0)
    errors.push_back({path, "the folder " + folder.string() + " cannot be written", ""});
  return errors;
}

std::string video_library() { return VideoFile::library(); }

VideoWriter::VideoWriter(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

VideoWriter::~VideoWriter() {
  if (!parts_->is_finished) parts_->discard();
}

Result<std::unique_ptr<VideoWriter>> VideoWriter::create(const std::string& path, int width, int height, double fps) {
  if (Errors errors = check(path, width, height, fps); !errors.empty()) return errors;
  auto parts = std::make_unique<Parts>();
  const std::size_t asked_for = format_asked_for(path);
  parts->stem = path.substr(0, path.size() - std::string_view(kFormats[asked_for].ending).size());
  parts->width = width, parts->height = height, parts->fps = fps;
  if (const Result<Done> opened = parts->open_first(asked_for); !opened) return opened.errors();
  return std::unique_ptr<VideoWriter>(new VideoWriter(std::move(parts)));
}

const std::string& VideoWriter::path() const { return parts_->path; }
const std::string& VideoWriter::note() const { return parts_->note; }

Result<Done> VideoWriter::add(const render::Frame& frame) {
  Parts& p = *parts_;
  if (p.is_finished) return Error{p.path, "the video is finished", ""};
  if (frame.width != p.width || frame.height != p.height)
    return Error{p.path,
                 "got a frame of " + std::to_string(frame.width) + "x" + std::to_string(frame.height) +
                     " for a video of " + std::to_string(p.width) + "x" + std::to_string(p.height),
                 ""};
  if (const Result<Done> done = p.put(frame); !done) return done;
  ++p.frames;
  return Done{};
}

Result<VideoFacts> VideoWriter::finish(const std::vector<Caption>& captions) {
  Parts& p = *parts_;
  if (p.is_finished) return Error{p.path, "the video is finished already", ""};
  p.is_finished = true;
  Result<VideoFacts> facts = Error{p.path, "a video needs at least one frame", ""};
  if (p.frames > 0)
    if (const Result<Done> closed = p.close(); !closed) {
      p.discard();
      return closed.errors();
    }
  if (p.frames > 0 && p.path.ends_with(".mp4"))
    if (const Result<Done> added = add_captions(p.part, captions); !added) {
      p.discard();
      return added.errors();
    }
  if (p.frames > 0) facts = p.format.is_pictures() ? p.check_pictures() : p.check_file();
  if (facts)
    if (Errors errors = differences(*facts, p.frames, p.width, p.height); !errors.empty()) facts = errors;
  std::error_code failed;
  if (facts) fs::rename(p.part, p.path, failed);
  if (facts && failed) facts = Error{p.path, "the video could not be given its name: " + failed.message(), ""};
  if (!facts) p.discard();
  return facts;
}

}  // namespace ctpm::video
