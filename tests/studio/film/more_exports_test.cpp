// Exports that show more than one session's film: ghosts, strips, pictures of a moment, folders of films, and parts of
// sessions that are damaged elsewhere.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>

#include "recordings/session_reader.h"
#include "studio/render/frame.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::run_ctpm;
using testing::slurp;

const std::string kShipped = std::string(CTPM_SOURCE_DIR) + "/recordings/shipped/";
const std::string kExpert = kShipped + "kidney-cut-expert.ctpm", kClumsy = kShipped + "kidney-cut-clumsy.ctpm";

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

class MoreExports : public ::testing::Test {
 protected:
  testing::ProgramOutcome export_to(const std::string& output, std::vector<std::string> sessions,
                                    const std::vector<std::string>& options) {
    std::vector<std::string> command{"export"};
    command.insert(command.end(), sessions.begin(), sessions.end());
    command.insert(command.end(), {"-o", output, "--size", "480x270"});
    command.insert(command.end(), options.begin(), options.end());
    return run_ctpm(command, folder_.path());
  }
  render::Frame picture(const std::string& name) {
    const auto read = render::read_png((folder_.path() / name).string());
    EXPECT_TRUE(read) << name;
    return read ? *read : render::Frame{};
  }

  const testing::TemporaryFolder folder_;
};

/// Pixels of `now` that are bluer than in `before`, by their share of blue.
int bluer(const render::Frame& now, const render::Frame& before) {
  int count = 0;
  for (std::size_t i = 0; i + 2 < now.rgb.size(); i += 3)
    count += now.rgb[i + 2] - now.rgb[i] > before.rgb[i + 2] - before.rgb[i] + 12;
  return count;
}

TEST_F(MoreExports, AGhostIsSeenThroughWhereTheOtherToolIs) {
  const std::vector<std::string> part{"--from-s", "2", "--to-s", "2.1", "--fps", "10", "--overlay", "none"};
  ASSERT_EQ(export_to("plain/", {kClumsy}, part).code, 0);
  std::vector<std::string> with_ghost = part;
  with_ghost.insert(with_ghost.end(), {"--ghost", kExpert, "--align", "clock"});
  const auto shown = export_to("ghost/", {kClumsy}, with_ghost);
  ASSERT_EQ(shown.code, 0) << shown.err;
  const render::Frame plain = picture("plain/000001.png"), ghost = picture("ghost/000001.png");
  ASSERT_EQ(ghost.width, 480);
  const int blue = bluer(ghost, plain);
  EXPECT_GT(blue, 800) << "a tool and its way";
  EXPECT_LT(blue, 480 * 270 / 5) << "and nothing else";
  // What is behind it is seen through: the picture below the ghost still changes it.
  EXPECT_EQ(bluer(plain, ghost), 0);
  // A ghost where the tool itself is covers it, so that less of the picture changes than its own way off.
  EXPECT_TRUE(holds(slurp(folder_.path() / "ghost/video.json"), "kidney-cut-clumsy"));

  const auto other = export_to("a.mp4", {kClumsy}, {"--ghost", kShipped + "liver-press-expert.ctpm"});
  EXPECT_EQ(other.code, 2);
  EXPECT_TRUE(holds(other.err, "is of another scene")) << other.err;
  EXPECT_EQ(export_to("a.mp4", {kClumsy}, {"--align", "path"}).code, 2);
  EXPECT_FALSE(fs::exists(folder_.path() / "a.mp4"));
}

TEST_F(MoreExports, TheStripShowsWhereInTheSessionThePictureIs) {
  for (const auto& [name, from, to] : {std::tuple{"early/", "1", "1.1"}, {"late/", "4", "4.1"}}) {
    const auto shown = export_to(name, {kExpert}, {"--strip", "--from-s", from, "--to-s", to, "--fps", "10"});
    ASSERT_EQ(shown.code, 0) << shown.err;
  }
  const render::Frame early = picture("early/000001.png"), late = picture("late/000001.png");
  ASSERT_EQ(early.width * 1000 + early.height, 480270) << "the strip takes its room from the picture";
  // The light line through the whole height of the strip.
  const auto now = [](const render::Frame& frame) {
    const auto reader = [&](int x, int y) { return &frame.rgb[std::size_t(y * frame.width + x) * 3]; };
    for (int x = 0; x < frame.width; ++x) {
      bool all = true;
      for (int y = frame.height - 23; y < frame.height; ++y) all &= reader(x, y)[0] > 200 && reader(x, y)[2] > 200;
      if (all) return x;
    }
    return -1;
  };
  auto reader = recordings::SessionReader::open(kExpert);
  ASSERT_TRUE(reader);
  const double whole = double(reader->tick_count()) * 1e-3;
  EXPECT_NEAR(now(early), 1.1 / whole * 479, 2);
  EXPECT_NEAR(now(late), 4.1 / whole * 479, 2);
}

TEST_F(MoreExports, InsetsShowTheToolFromNearAndTheTissueOpenedAtIt) {
  for (const char* inset : {"", "near", "section", "near,section"}) {
    std::vector<std::string> options{"--at-s", "2.5", "--overlay", "none", "--camera", "front"};
    if (*inset) options.insert(options.end(), {"--inset", inset});
    const auto shown = export_to(std::string("a") + inset + ".png", {kExpert}, options);
    ASSERT_EQ(shown.code, 0) << shown.err;
  }
  const render::Frame plain = picture("a.png"), near = picture("anear.png"), section = picture("asection.png"),
                      both = picture("anear,section.png");
  // The lower right corner, where the first one is, the place above it for the second, and the rest of the picture.
  const auto differing = [](const render::Frame& a, const render::Frame& b, int left, int top, int right, int bottom) {
    int count = 0;
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        const std::size_t i = std::size_t(y * 480 + x) * 3;
        count += a.rgb[i] != b.rgb[i] || a.rgb[i + 1] != b.rgb[i + 1] || a.rgb[i + 2] != b.rgb[i + 2];
      }
    return count;
  };
  EXPECT_GT(differing(plain, near, 364, 203, 476, 266), 5000);
  EXPECT_GT(differing(near, section, 364, 203, 476, 266), 2000) << "they show different things";
  EXPECT_EQ(differing(plain, near, 0, 0, 340, 270), 0);
  EXPECT_EQ(differing(near, both, 364, 203, 476, 266), 0);
  EXPECT_GT(differing(near, both, 364, 136, 476, 199), 5000);
  const auto wrong = export_to("b.png", {kExpert}, {"--at-s", "1", "--inset", "far"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(holds(wrong.err, "--inset: error: got 'far', must be near or section")) << wrong.err;
}

TEST_F(MoreExports, ACaptionStandsFromTheFirstPictureToTheLastInTheRightHalfOfAPair) {
  const std::string fault = "force above the limit: 3.13 N, limit 2 N";
  const auto films = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> part{"--from-s", "2",     "--to-s",  "2.1", "--fps",    "10",
                                  "--beside", kClumsy, "--align", "cut", "--camera", "0,-300,200:0,0,20"};
    part.insert(part.end(), more.begin(), more.end());
    const auto exported = export_to(name, {kExpert}, part);
    EXPECT_EQ(exported.code, 0) << exported.err;
  };
  films("plain/", {}), films("told/", {"--caption", fault}), films("told.mp4", {"--caption", fault});
  for (const char* file : {"000001.png", "000002.png"}) {
    const render::Frame plain = picture(std::string("plain/") + file), told = picture(std::string("told/") + file);
    ASSERT_EQ(plain.rgb.size(), told.rgb.size());
    int left = 0, right = 0;
    for (std::size_t i = 0; i < told.rgb.size(); ++i)
      (i / 3 % std::size_t(told.width) < std::size_t(told.width) / 2 ? left : right) += plain.rgb[i] != told.rgb[i];
    EXPECT_EQ(left, 0) << file;
    EXPECT_GT(right, 1000) << file;
  }
  const auto words =
      testing::run({"ffmpeg", "-v", "error", "-i", "told.mp4", "-map", "0:s:0", "told.srt"}, folder_.path());
  ASSERT_EQ(words.code, 0) << words.err;
  const std::string subtitles = slurp(folder_.path() / "told.srt");
  const auto count = [&](const std::string& part) {
    int times = 0;
    for (std::size_t at = 0; (at = subtitles.find(part, at)) != std::string::npos; ++at) ++times;
    return times;
  };
  EXPECT_GT(count(" --> "), 0);
  EXPECT_EQ(count("right (kidney-cut-clumsy): " + fault), count(" --> ")) << "in each of them: " << subtitles;

  const auto long_winded = export_to("a.mp4", {kExpert}, {"--caption", std::string(201, 'a')});
  EXPECT_EQ(long_winded.code, 2);
  EXPECT_TRUE(holds(long_winded.err, "--caption: error: has 201 bytes")) << long_winded.err;
  const auto sheet = export_to("a.png", {kExpert}, {"--caption", fault});
  EXPECT_EQ(sheet.code, 2);
  EXPECT_TRUE(holds(sheet.err, "--caption: error: ")) << sheet.err;
}

TEST_F(MoreExports, ACameraMakesRoomForPanelsUnlessSomebodyPlacedIt) {
  const auto middle_of = [&](const char* camera, const char* overlay) {
    std::vector<std::string> options{"--at-s", "2.5", "--overlay", overlay};
    if (*camera) options.insert(options.end(), {"--camera", camera});
    const std::string file = std::string("room") + camera + overlay + ".png";
    EXPECT_EQ(export_to(file, {kExpert}, options).code, 0);
    const render::Frame frame = picture(file);
    return std::vector<std::uint8_t>(frame.rgb.begin() + 120 * 480 * 3 + 200 * 3,
                                     frame.rgb.begin() + 120 * 480 * 3 + 300 * 3);
  };
  EXPECT_EQ(middle_of("front", "none"), middle_of("front", "full"));
  EXPECT_NE(middle_of("", "none"), middle_of("", "full"));
}

TEST_F(MoreExports, APictureOfAMomentIsThatOfTheFilm) {
  ASSERT_EQ(export_to("moment.png", {kExpert}, {"--at-s", "2"}).code, 0);
  ASSERT_EQ(export_to("film/", {kExpert}, {"--from-s", "1.9", "--to-s", "2", "--fps", "10"}).code, 0);
  EXPECT_EQ(picture("moment.png"), picture("film/000001.png"));
  const auto late = export_to("late.png", {kExpert}, {"--at-s", "99"});
  EXPECT_EQ(late.code, 2);
  EXPECT_TRUE(holds(late.err, "--at-s: error: got 99, must be in [0, ")) << late.err;
  EXPECT_FALSE(fs::exists(folder_.path() / "late.png"));
}

TEST_F(MoreExports, SeveralSessionsAreFilmsInAFolderWithATable) {
  std::ofstream(folder_.path() / "broken.ctpm") << "no session";
  const std::vector<std::string> quick{"--from-s", "0.5", "--to-s", "0.7", "--fps", "10"};
  const auto shown = export_to("films", {kExpert, "broken.ctpm", kClumsy}, quick);
  EXPECT_EQ(shown.code, 2) << "one of them fails, and the others are there";
  EXPECT_TRUE(fs::exists(folder_.path() / "films/kidney-cut-expert.mp4"));
  EXPECT_TRUE(fs::exists(folder_.path() / "films/kidney-cut-clumsy.mp4"));
  const std::string table = slurp(folder_.path() / "films/results.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4) << table;
  EXPECT_TRUE(holds(table, "kidney-cut-expert.mp4,2,0.2")) << table;
  EXPECT_TRUE(holds(table, ",same,")) << table;
  EXPECT_TRUE(holds(table, "broken.ctpm,,,,,,")) << table;

  const auto again = export_to("films", {kExpert, kClumsy}, quick);
  EXPECT_EQ(again.code, 2);
  EXPECT_TRUE(holds(again.err, "results.csv")) << again.err;
  const auto one_file = export_to("a.mp4", {kExpert, kClumsy}, quick);
  EXPECT_EQ(one_file.code, 2);
  EXPECT_TRUE(holds(one_file.err, "several sessions are given")) << one_file.err;
  const auto twice = export_to("more", {kExpert, kExpert}, quick);
  EXPECT_EQ(twice.code, 2);
  EXPECT_TRUE(holds(twice.err, "would have the same video as")) << twice.err;
  EXPECT_FALSE(fs::exists(folder_.path() / "more"));
}

// A folder for each trainee, as cohort takes them.
TEST_F(MoreExports, SessionsOfOneNameAreToldApartByTheirFolders) {
  std::vector<std::string> sessions;
  for (const char* name : {"ana/first/1.ctpm", "ben/first/1.ctpm", "ben/2.ctpm"}) {
    fs::create_directories((folder_.path() / name).parent_path());
    fs::copy_file(kExpert, folder_.path() / name), sessions.emplace_back(name);
  }
  const auto shown = export_to("films", sessions, {"--from-s", "0.5", "--to-s", "0.6", "--fps", "10"});
  EXPECT_EQ(shown.code, 0) << shown.err;
  for (const char* name : {"ana-first-1.mp4", "ben-first-1.mp4", "2.mp4"})
    EXPECT_TRUE(fs::exists(folder_.path() / "films" / name)) << name << '\n' << shown.out;
}

TEST_F(MoreExports, ItIsSaidThatSessionsBesideEachOtherAreOfTwoScenes) {
  const std::vector<std::string> quick{"--from-s", "0.5", "--to-s", "0.6", "--fps", "10", "--align", "clock"};
  std::vector<std::string> liver = quick, kidney = quick;
  liver.insert(liver.end(), {"--beside", kShipped + "liver-press-expert.ctpm"});
  kidney.insert(kidney.end(), {"--beside", kClumsy});
  const auto two = export_to("two.mp4", {kExpert}, liver), one = export_to("one.mp4", {kExpert}, kidney);
  EXPECT_EQ(two.code, 0) << two.err;
  EXPECT_TRUE(holds(two.err, "warning: is of another scene than")) << two.err;
  EXPECT_FALSE(holds(one.err, "another scene")) << one.err;
}

TEST_F(MoreExports, APartIsShownThoughTheSessionIsDamagedElsewhere) {
  const std::string whole = slurp(kClumsy);
  int refused = 0;
  for (double place = 0.3; place < 0.95 && refused < 2; place += 0.02) {  // keyframes take most of the file
    std::string bytes = whole;
    const auto at = std::size_t(place * double(bytes.size()));
    for (std::size_t i = at; i < at + 64; ++i) bytes[i] = char(bytes[i] ^ 0x55);
    std::ofstream(folder_.path() / "flipped.ctpm", std::ios::binary) << bytes;
    auto reader = recordings::SessionReader::open(folder_.path() / "flipped.ctpm");
    if (!reader || reader->ticks(0, reader->tick_count())) continue;  // no tick is damaged
    ++refused;
    EXPECT_EQ(export_to("whole.mp4", {"flipped.ctpm"}, {"--fps", "2"}).code, 2) << place;
    const auto part = export_to("part/", {"flipped.ctpm"}, {"--from-s", "0", "--to-s", "0.2", "--fps", "10"});
    EXPECT_EQ(part.code, 0) << place << part.err;
    std::error_code ignored;
    fs::remove_all(folder_.path() / "part", ignored);
  }
  EXPECT_GE(refused, 1);
}

TEST_F(MoreExports, AVideoSaysHowItsColoursAreCoded) {
  ASSERT_EQ(export_to("a.mp4", {kExpert}, {"--to-s", "0.2"}).code, 0);
  const auto asked = testing::run(
      {"ffprobe", "-v", "error", "-select_streams", "v", "-show_entries",
       "stream=color_range,color_space,color_transfer,color_primaries", "-of", "default=noprint_wrappers=1", "a.mp4"},
      folder_.path());
  for (const char* said : {"color_range=tv", "color_space=bt709", "color_transfer=bt709", "color_primaries=bt709"})
    EXPECT_TRUE(holds(asked.out, said)) << asked.out;
  // It is true: decoded as it says, the picture has the colours that were drawn.
  ASSERT_EQ(export_to("drawn/", {kExpert}, {"--to-s", "0.2"}).code, 0);
  const auto decode = [&](const std::vector<std::string>& how, const std::string& name) {
    std::vector<std::string> command{"ffmpeg", "-v", "error", "-i", "a.mp4"};
    command.insert(command.end(), how.begin(), how.end());
    command.insert(command.end(), {"-frames:v", "1", "-pix_fmt", "rgb24", "-f", "rawvideo", name});
    EXPECT_EQ(testing::run(command, folder_.path()).code, 0);
    const std::string bytes = testing::slurp(folder_.path() / name);
    return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
  };
  const render::Frame drawn = picture("drawn/000001.png");
  const auto error = [&](const std::vector<std::uint8_t>& rgb) {
    EXPECT_EQ(rgb.size(), drawn.rgb.size());
    double sum = 0, count = 0;  // of the tissue: grey is the same with every matrix
    for (std::size_t i = 0; i < drawn.rgb.size(); i += 3)
      if (drawn.rgb[i] > drawn.rgb[i + 1] + 40)
        for (std::size_t c = i; c < i + 3; ++c, ++count) sum += std::abs(double(drawn.rgb[c]) - double(rgb[c]));
    EXPECT_GT(count, 1000);
    return sum / count;
  };
  const double as_said = error(decode({}, "said.rgb")),
               otherwise = error(decode({"-vf", "scale=in_color_matrix=bt601:out_color_matrix=bt601"}, "other.rgb"));
  EXPECT_LT(as_said, 0.6 * otherwise) << as_said << " " << otherwise;
}

}  // namespace
}  // namespace ctpm
