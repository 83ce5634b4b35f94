#include <gtest/gtest.h>

#include <unistd.h>

#include <array>
#include <filesystem>

#include "studio/video/video_writer.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;

class Video : public testing::Test {
 protected:
  Video() : folder_(testing::TempDir() + "/video_" + std::to_string(::getpid())) { fs::create_directories(folder_); }
  ~Video() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  int file_count() const { return int(std::distance(fs::directory_iterator(folder_), {})); }

  std::string folder_;
};

/// A bright square that moves over a dark ground.
render::Frame moving_square(int width, int height, int step) {
  render::Frame frame = render::blank_frame(width, height, 20, 30, 40);
  for (int y = 20; y < 60; ++y)
    for (int x = 10 + 4 * step; x < 50 + 4 * step; ++x) frame.rgb[std::size_t(y * width + x) * 3] = 220;
  return frame;
}

TEST_F(Video, IsReopenedAndCounted) {
  auto writer = video::VideoWriter::create(path("a.mp4"), 320, 180, 30);
  ASSERT_TRUE(writer) << to_string(writer.errors()[0]);
  for (int i = 0; i < 45; ++i) ASSERT_TRUE((*writer)->add(moving_square(320, 180, i)));
  EXPECT_FALSE(fs::exists(path("a.mp4"))) << "before it is whole";
  const auto facts = (*writer)->finish();
  ASSERT_TRUE(facts) << to_string(facts.errors()[0]);
  EXPECT_EQ(facts->frames, 45);
  EXPECT_EQ(facts->width, 320);
  EXPECT_EQ(facts->height, 180);
  EXPECT_DOUBLE_EQ(facts->fps, 30);
  EXPECT_EQ(facts->bytes, std::int64_t(fs::file_size(facts->path)));
  EXPECT_TRUE(facts->codec == "H.264" || !facts->note.empty()) << "a fallback is said aloud";
  EXPECT_EQ(file_count(), 1) << "no temporary is left";
  EXPECT_FALSE((*writer)->finish());
  EXPECT_FALSE((*writer)->add(moving_square(320, 180, 0)));
}

TEST_F(Video, OtherEndingsGiveMotionJpegAndPictures) {
  for (const auto& [name, codec, written] :
       {std::array{"a.avi", "Motion JPEG", "a.avi"}, std::array{"frames/", "PNG", "frames"}}) {
    auto writer = video::VideoWriter::create(path(name), 320, 180, 25);
    ASSERT_TRUE(writer) << to_string(writer.errors()[0]);
    for (int i = 0; i < 7; ++i) ASSERT_TRUE((*writer)->add(moving_square(320, 180, i)));
    EXPECT_FALSE(fs::exists(path(written))) << "before it is whole";
    const auto facts = (*writer)->finish();
    ASSERT_TRUE(facts) << to_string(facts.errors()[0]);
    EXPECT_EQ(facts->codec, codec);
    EXPECT_EQ(facts->path, path(written));
    EXPECT_EQ(facts->frames, 7);
    EXPECT_EQ(facts->note, "");
  }
  EXPECT_EQ(file_count(), 2);
  const auto last = render::read_png(path("frames/000007.png"));
  ASSERT_TRUE(last);
  EXPECT_EQ(*last, moving_square(320, 180, 6)) << "PNG keeps every pixel";
  EXPECT_FALSE(video::VideoWriter::create(path("frames/"), 320, 180, 25)) << "pictures are never mixed";
}

TEST_F(Video, WithoutFramesIsAnErrorAndNoFile) {
  auto writer = video::VideoWriter::create(path("a.mp4"), 320, 180, 30);
  ASSERT_TRUE(writer);
  EXPECT_FALSE((*writer)->finish());
  EXPECT_EQ(file_count(), 0);
}

TEST_F(Video, LeftUnfinishedIsRemoved) {
  {
    auto writer = video::VideoWriter::create(path("a.mp4"), 320, 180, 30);
    ASSERT_TRUE(writer);
    ASSERT_TRUE((*writer)->add(moving_square(320, 180, 0)));
    auto pictures = video::VideoWriter::create(path("frames/"), 320, 180, 30);
    ASSERT_TRUE(pictures);
    ASSERT_TRUE((*pictures)->add(moving_square(320, 180, 0)));
    EXPECT_EQ(file_count(), 2);
  }
  EXPECT_EQ(file_count(), 0);
}

TEST_F(Video, FrameOfAnotherSizeIsRefused) {
  auto writer = video::VideoWriter::create(path("a.mp4"), 320, 180, 30);
  ASSERT_TRUE(writer);
  const auto added = (*writer)->add(render::blank_frame(322, 180, 0, 0, 0));
  ASSERT_FALSE(added);
  EXPECT_NE(added.errors()[0].message.find("322x180"), std::string::npos);
}

TEST_F(Video, BadRequestsAreAllNamedAtOnce) {
  const auto bad = video::VideoWriter::create(folder_ + "/missing/a.mov", 321, 0, 0);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.errors().size(), 4u);  // ending, size, rate, folder
  EXPECT_FALSE(video::VideoWriter::create(path("a.mp4"), 0, 0, 30));
  EXPECT_FALSE(video::VideoWriter::create(path("a.mp4"), 320, 181, 30));
  for (const char* taken_nowhere : {"/proc/a.mp4", "/proc/a.avi", "/proc/a/"}) {
    const auto refused = video::VideoWriter::create(taken_nowhere, 320, 180, 30);
    ASSERT_FALSE(refused) << taken_nowhere;
    EXPECT_TRUE(refused.errors()[0].where.starts_with("/proc/a")) << refused.errors()[0].where;
    EXPECT_EQ(refused.errors()[0].where.find("frames"), std::string::npos) << "no missing codec";
  }
  std::filesystem::create_directory(path("b.mp4"));
  const auto folder = video::VideoWriter::create(path("b.mp4"), 320, 180, 30);
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.errors()[0].message, "is a folder");
  std::filesystem::remove(path("b.mp4"));
  EXPECT_EQ(file_count(), 0);
}

}  // namespace
}  // namespace ctpm
