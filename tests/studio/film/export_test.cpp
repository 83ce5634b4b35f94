// Videos from outside: what they hold, what their sidecar says, and what happens when something goes wrong.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

#include "core/stepping/step.h"
#include "recordings/byte_hash.h"
#include "recordings/session_reader.h"
#include "recordings/session_writer.h"
#include "studio/render/frame.h"
#include "tests/studio/commands/running_program.h"
#include "tests/studio/render/glyph_reader.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::run;
using testing::run_ctpm;
using testing::RunningProgram;
using testing::TemporaryFolder;

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The value behind a key of a sidecar, as it is written.
std::string value_of(const std::string& json, const std::string& key) {
  const auto at = json.find("\"" + key + "\": ");
  if (at == std::string::npos) return "(no " + key + ")";
  const auto begin = at + key.size() + 4;
  return json.substr(begin, json.find_first_of(",\n", begin) - begin);
}

/// The left (0) or right (1) half of a picture.
render::Frame half_of(const render::Frame& whole, int half) {
  const int width = whole.width / 2;
  render::Frame part = render::blank_frame(width, whole.height, 0, 0, 0);
  for (int y = 0; y < whole.height; ++y)
    std::copy_n(whole.rgb.begin() + 3 * (y * whole.width + width * half), 3 * width, part.rgb.begin() + 3 * y * width);
  return part;
}

/// Short sessions of the shipped skin, recorded once for all tests: the ball comes down and presses.
class Export : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    recorded_ = new TemporaryFolder;
    for (const auto& [name, s] : {std::pair{"press.ctpm", "1.2"}, {"short.ctpm", "0.6"}})
      run_ctpm({"record", CTPM_SOURCE_DIR "/scenes/skin.json", "-o", name, "--fast", "--duration-s", s},
               recorded_->path());
  }
  static void TearDownTestSuite() { delete recorded_, recorded_ = nullptr; }
  void SetUp() override { take("press.ctpm"); }
  void take(const char* name) const { fs::copy_file(recorded_->path() / name, folder_.path() / name); }

  /// Exports in a small size; `environment` are settings NAME=VALUE.
  testing::ProgramOutcome export_to(const std::string& output, std::vector<std::string> options = {},
                                    std::vector<std::string> environment = {}) {
    std::vector<std::string> command{"env"};
    command.insert(command.end(), environment.begin(), environment.end());
    for (const char* argument : {CTPM_PROGRAM, "export", "press.ctpm", "--size", "320x180", "-o"})
      command.push_back(argument);
    command.push_back(output);
    command.insert(command.end(), options.begin(), options.end());
    return run(command, folder_.path());
  }

  std::string sidecar(const std::string& video) { return testing::slurp(folder_.path() / (video + ".json")); }
  render::Frame picture(const std::string& folder, int index) {
    char name[32];
    std::snprintf(name, sizeof name, "%06d.png", index);
    const auto read = render::read_png((folder_.path() / folder / name).string());
    EXPECT_TRUE(read) << folder << " " << index;
    return read ? *read : render::Frame{};
  }
  std::string probe(const std::string& video) {
    return run({"ffprobe", "-v", "error", "-count_frames", "-select_streams", "v:0", "-show_entries",
                "stream=codec_name,width,height,r_frame_rate,nb_read_frames", "-of", "csv=p=0", video},
               folder_.path())
        .out;
  }

  TemporaryFolder folder_;
  static inline TemporaryFolder* recorded_ = nullptr;
};

TEST_F(Export, TheSidecarSaysWhatTheVideoShows) {
  const auto exported = export_to("a.mp4", {"--from-s", "0.2", "--to-s", "0.8", "--speed", "0.5"});
  ASSERT_EQ(exported.code, 0) << exported.err;
  EXPECT_TRUE(holds(exported.err, "simulation") && holds(exported.err, "times real time")) << exported.err;
  EXPECT_EQ(probe("a.mp4"), "h264,320,180,30/1,36\n");
  const std::string json = sidecar("a.mp4");
  const auto reader = recordings::SessionReader::open((folder_.path() / "press.ctpm").string());
  ASSERT_TRUE(reader);
  EXPECT_EQ(value_of(json, "session_id"), "\"" + reader->session_id() + "\"");
  EXPECT_EQ(value_of(json, "file_xxh3"),
            "\"" + recordings::hash_text(*recordings::file_hash((folder_.path() / "press.ctpm").string())) + "\"");
  EXPECT_EQ(value_of(json, "verdict"), "\"same\"");
  EXPECT_EQ(value_of(json, "frames"), "36");
  EXPECT_EQ(value_of(json, "codec"), "\"H.264\"");
  EXPECT_EQ(value_of(json, "width") + value_of(json, "height"), "320180");
  EXPECT_EQ(value_of(json, "first_tick") + " " + value_of(json, "last_tick"), "200 800");
  EXPECT_EQ(value_of(json, "speed"), "0.5");
  EXPECT_NE(value_of(json, "drawing").find("llvmpipe"), std::string::npos);
  for (const char* key : {"name", "eye_mm", "program", "elapsed_s", "simulation_s", "rendering_s", "encoding_s",
                          "recorded_by", "pixels_xxh3", "bytes"})
    EXPECT_NE(value_of(json, key).front(), '(') << key;
}

TEST_F(Export, TheVideoShowsTheNumbersOfTheReplay) {
  const auto exported = run_ctpm({"export", "press.ctpm", "-o", "a.mp4", "--from-s", "0.9"}, folder_.path());
  ASSERT_EQ(exported.code, 0) << exported.err;
  const auto decoded =
      run({"ffmpeg", "-v", "error", "-i", "a.mp4", "-vf", "select=eq(n\\,8)", "-frames:v", "1", "frame.png"},
          folder_.path());
  ASSERT_EQ(decoded.code, 0) << decoded.err;
  const auto frame = render::read_png((folder_.path() / "frame.png").string());
  ASSERT_TRUE(frame);
  ASSERT_EQ(run_ctpm({"replay", "press.ctpm", "--csv", "a.csv"}, folder_.path()).code, 0);
  // Frame 8 shows the state after tick 1199: the last line of the table.
  const std::string table = testing::slurp(folder_.path() / "a.csv");
  const std::string last = table.substr(table.rfind('\n', table.size() - 2) + 1);
  const std::string header = table.substr(0, table.find('\n'));
  const auto cell = [&](const std::string& name) {
    const auto column = std::count(header.begin(), header.begin() + std::ptrdiff_t(header.find("," + name) + 1), ',');
    std::istringstream cells(last);
    std::string text;
    for (std::ptrdiff_t i = 0; i <= column; ++i) std::getline(cells, text, ',');
    return std::stod(text);
  };
  const render_test::GlyphReader reader(1280, 720);
  EXPECT_EQ(reader.read_after(*frame, "time"), "1.200 s");
  const double force = cell("force_n");
  EXPECT_GT(force, 0.1) << "the ball presses";
  EXPECT_NEAR(std::atof(reader.read_after(*frame, "force").c_str()), force, 0.0005 + 1e-9);
  EXPECT_NEAR(std::atof(reader.read_after(*frame, "depth").c_str()), cell("depth_mm"), 0.005 + 1e-9);
}

TEST_F(Export, ItsFirstPictureShowsTheForceOfTheTickBeforeIt) {
  // So slow that no tick passes before the first picture.
  for (const std::string speed : {"0.001", "1"})
    ASSERT_EQ(run_ctpm({"export", "press.ctpm", "-o", speed + "/", "--speed", speed, "--from-s", "1.1", "--to-s",
                        speed == "1" ? "1.11" : "1.101", "--fps", speed == "1" ? "240" : "10"},
                       folder_.path())
                  .code,
              0);
  const render_test::GlyphReader reader(1280, 720);
  const double before = std::atof(reader.read_after(picture("0.001", 1), "force").c_str()),
               after = std::atof(reader.read_after(picture("1", 1), "force").c_str());
  EXPECT_GT(before, 0.1) << "the ball presses";
  EXPECT_NEAR(before, after, 0.2 * after);
}

TEST_F(Export, TheVideoOfACutShowsItsDepthWhetherOrNotTheCutIsShown) {
  const std::string session = std::string(CTPM_SOURCE_DIR) + "/recordings/shipped/kidney-cut-expert.ctpm";
  const render_test::GlyphReader reader(1280, 720);
  const auto depth_at = [&](const std::string& from, const std::string& to) {
    const auto exported = run_ctpm(
        {"export", session, "-o", "at-" + to + "/", "--fps", "10", "--camera", "front", "--from-s", from, "--to-s", to},
        folder_.path());
    EXPECT_EQ(exported.code, 0) << exported.err;
    return reader.read_after(picture("at-" + to, 1), "deepest cut");
  };
  EXPECT_EQ(depth_at("0.4", "0.5"), "0.00 mm") << "the blade is in the hand, nothing is severed";
  const double deepest = std::atof(depth_at("3.5", "3.6").c_str());
  EXPECT_NEAR(deepest, 22.6, 0.5) << "along the blade: its tip goes to 22 mm, the top is at 44.6 mm";
  EXPECT_EQ(std::atof(depth_at("5.2", "5.3").c_str()), deepest) << "put away long ago";
}

TEST_F(Export, ThePixelsAreTheSameAtAnyNumberOfThreads) {
  std::string first;
  for (const char* threads : {"0", "1", "2", "5"}) {
    const auto exported = export_to("a.mp4", {"--from-s", "0.5", "--to-s", "1", "--overwrite"},
                                    {std::string("LP_NUM_THREADS=") + threads});
    ASSERT_EQ(exported.code, 0) << exported.err;
    const std::string pixels = value_of(sidecar("a.mp4"), "pixels_xxh3");
    EXPECT_EQ(pixels.size(), 18u) << pixels;
    if (first.empty()) first = pixels;
    EXPECT_EQ(pixels, first) << threads << " threads";
  }
  ASSERT_EQ(export_to("a.mp4", {"--from-s", "0.5", "--to-s", "1", "--overwrite"}, {"taskset", "-c", "0"}).code, 0);
  EXPECT_EQ(value_of(sidecar("a.mp4"), "pixels_xxh3"), first) << "one core";
  ASSERT_EQ(export_to("a.mp4", {"--from-s", "0.5", "--to-s", "1.1", "--overwrite"}).code, 0);
  EXPECT_NE(value_of(sidecar("a.mp4"), "pixels_xxh3"), first) << "other pixels have another hash";
}

TEST_F(Export, APartShowsThePicturesThatTheWholeShowsThere) {
  ASSERT_EQ(export_to("whole/", {"--camera", "follow"}).code, 0);
  ASSERT_EQ(export_to("part/", {"--from-s", "0.9", "--camera", "follow"}).code, 0);
  for (const int i : {1, 5, 9}) EXPECT_EQ(picture("part", i), picture("whole", 27 + i)) << i;
  EXPECT_NE(picture("part", 1), picture("part", 9));
}

TEST_F(Export, AMissingCodecIsReplacedAndThatIsSaidAloud) {
  const std::string hiding = "LD_PRELOAD=" CTPM_HIDDEN_ENCODERS, no_h264 = "HIDDEN_ENCODERS=libx264 h264";
  const auto avi = export_to("a.mp4", {}, {hiding, no_h264 + "_v4l2m2m"});
  EXPECT_EQ(avi.code, 0) << avi.err;
  EXPECT_TRUE(holds(avi.err, "warning: H.264 is not available here: Motion JPEG in AVI")) << avi.err;
  EXPECT_TRUE(holds(avi.out, "a.avi: 36 frames")) << avi.out;
  EXPECT_EQ(probe("a.avi"), "mjpeg,320,180,30/1,36\n");
  EXPECT_TRUE(holds(sidecar("a.avi"), "H.264 is not available here"));
  const auto pictures = export_to("b.mp4", {}, {hiding, no_h264 + "_v4l2m2m mjpeg"});
  EXPECT_EQ(pictures.code, 0) << pictures.err;
  EXPECT_TRUE(holds(pictures.err, "a folder of PNG pictures was written instead")) << pictures.err;
  EXPECT_EQ(value_of(sidecar("b-frames/video"), "codec"), "\"PNG\"");
  EXPECT_EQ(picture("b-frames", 36).width, 320);
  EXPECT_EQ(folder_.list(), "a.avi a.avi.json b-frames press.ctpm");
}

TEST_F(Export, CtrlCLeavesNothingBehind) {
  for (const char* output : {"a.mp4", "frames/"}) {
    RunningProgram exporting({"export", "press.ctpm", "-o", output, "--speed", "0.002"}, folder_.path());
    ASSERT_TRUE(exporting.wait_until([&] { return holds(folder_.list(), ".part"); })) << "the video has begun";
    exporting.interrupt();
    const auto stopped = exporting.outcome();
    EXPECT_EQ(stopped.code, 2);
    EXPECT_TRUE(holds(stopped.err, "stopped before the end; no video was written")) << stopped.err;
    EXPECT_EQ(folder_.list(), "press.ctpm");
  }
}

TEST_F(Export, BesideSaysThatASessionHasEnded) {
  take("short.ctpm");
  const auto both = run_ctpm({"export", "press.ctpm", "-o", "both/", "--beside", "short.ctpm", "--from-s", "0.5",
                              "--to-s", "0.8", "--speed", "3", "--align", "clock"},
                             folder_.path());
  ASSERT_EQ(both.code, 0) << both.err;
  const render::Frame half = half_of(picture("both", 3), 1);  // at 0.8 s
  const render_test::GlyphReader reader(640, 720);
  EXPECT_EQ(reader.read_after(half, "ended"), "0.600 s");
  EXPECT_EQ(reader.read_after(half, "time"), "");
  EXPECT_EQ(reader.read_after(half, "trainee"), "short");
  EXPECT_EQ(reader.read_after(half_of(picture("both", 3), 0), "expert"), "press");
}

TEST_F(Export, BesideShowsTwoSessionsInStep) {
  take("short.ctpm");
  const auto both = run_ctpm({"export", "press.ctpm", "-o", "both/", "--beside", "short.ctpm", "--size", "640x180",
                              "--align", "clock", "--overlay", "none"},
                             folder_.path());
  ASSERT_EQ(both.code, 0) << both.err;
  EXPECT_EQ(picture("both", 36).width, 640);
  // The same script on both sides: apart from the names the halves are alike, until one of them is over.
  const auto differing = [&](int index) {
    const render::Frame frame = picture("both", index);
    int count = 0;
    for (int y = 0; y < 180; ++y)
      for (int x = 160; x < 318; ++x) {
        const std::uint8_t* left = &frame.rgb[std::size_t(y * 640 + x) * 3];
        count += left[0] != left[3 * 320];
      }
    return count;
  };
  EXPECT_EQ(differing(15), 0);
  EXPECT_GT(differing(36), 100);
  const std::string json = sidecar("both/video");
  EXPECT_TRUE(holds(json, "\"file\": \"press.ctpm\"") && holds(json, "\"file\": \"short.ctpm\"")) << json;
  EXPECT_TRUE(holds(json, "\"last_tick\": 1200") && holds(json, "\"last_tick\": 600")) << json;
}

TEST_F(Export, BesideKeepsTheSecondsThatItIsAheadByHand) {
  take("short.ctpm");
  const auto export_ahead = [&](const char* seconds, const char* from, const char* to) {
    fs::remove_all(folder_.path() / "both");
    return run_ctpm({"export", "press.ctpm", "-o", "both/", "--beside", "short.ctpm", "--fps", "20", "--align", seconds,
                     "--from-s", from, "--to-s", to},
                    folder_.path());
  };
  const render_test::GlyphReader reader(640, 720);
  const auto says = [&](int half, const char* label) {
    return reader.read_after(half_of(picture("both", 2), half), label);
  };
  for (const auto& [seconds, second] : {std::pair{"0.15", 0.55}, {"-0.25", 0.15}}) {
    const auto both = export_ahead(seconds, "0.3", "0.4");
    ASSERT_EQ(both.code, 0) << both.err;
    for (int half = 0; half < 2; ++half)
      EXPECT_NEAR(std::atof(says(half, "time").c_str()), half == 0 ? 0.4 : second, 1.1e-3) << seconds;
  }
  ASSERT_EQ(export_ahead("-0.25", "0", "0.1").code, 0);
  EXPECT_EQ(says(1, "not begun"), "0.000 s");
  EXPECT_EQ(says(1, "speed") + says(0, "speed"), "-1.00 x") << "what has not begun has no speed";
  const auto apart = export_ahead("0.6", "0.3", "0.4");
  EXPECT_EQ(apart.code, 2);
  EXPECT_TRUE(holds(apart.err, "--align: error: got 0.600 s, and the sessions have no moment in common")) << apart.err;
}

TEST_F(Export, BesideBringsTogetherWhatHappens) {
  const std::string shipped = std::string(CTPM_SOURCE_DIR) + "/recordings/shipped/kidney-cut-";
  const auto both = run_ctpm({"export", shipped + "expert.ctpm", "-o", "both/", "--beside", shipped + "clumsy.ctpm",
                              "--align", "cut", "--fps", "20", "--from-s", "0.682", "--to-s", "0.782"},
                             folder_.path());
  ASSERT_EQ(both.code, 0) << both.err;
  const render::Frame last =
      picture("both", int(std::distance(fs::directory_iterator(folder_.path() / "both"), {})) - 1);
  const render_test::GlyphReader reader(640, 720);
  const char* names[] = {"expert.ctpm", "clumsy.ctpm"};
  for (int half = 0; half < 2; ++half) {
    const render::Frame part = half_of(last, half);
    auto session = recordings::SessionReader::open(shipped + names[half]);
    ASSERT_TRUE(session);
    const auto events = session->events();
    const auto cut = std::find_if(events->begin(), events->end(),
                                  [](const auto& event) { return event.kind == recordings::EventKind::cut; });
    EXPECT_NEAR(std::atof(reader.read_after(part, "time").c_str()), double(cut->tick) * 1e-3, 1e-3) << names[half];
    EXPECT_NE(reader.read_after(part, "speed"), "") << "a half that was slowed down says so";
  }
  const auto wrong =
      run_ctpm({"export", "press.ctpm", "-o", "a.mp4", "--beside", "press.ctpm", "--align", "time"}, folder_.path());
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(holds(wrong.err, "--align: error: got 'time', must be path, contact, cut, clock or the seconds"))
      << wrong.err;
  const auto none =
      run_ctpm({"export", "press.ctpm", "-o", "a.mp4", "--beside", "press.ctpm", "--align", "cut"}, folder_.path());
  EXPECT_EQ(none.code, 2);
  EXPECT_TRUE(holds(none.err, "press.ctpm: error: has no cut")) << none.err;
}

TEST_F(Export, CaptionsAreReadBackAsSubtitlesAndChapters) {
  const std::string session = std::string(CTPM_SOURCE_DIR) + "/recordings/shipped/kidney-cut-expert.ctpm";
  const auto exported = run_ctpm(
      {"export", session, "-o", "cut.mp4", "--size", "320x180", "--fps", "20", "--speed", "2"}, folder_.path());
  ASSERT_EQ(exported.code, 0) << exported.err;
  EXPECT_EQ(probe("cut.mp4"), "h264,320,180,20/1,54\n") << "the pictures are as many as before";
  const auto ask = [&](const std::vector<std::string>& what) {
    std::vector<std::string> command{"ffprobe", "-v", "error"};
    command.insert(command.end(), what.begin(), what.end());
    command.insert(command.end(), {"-of", "csv=p=0", "cut.mp4"});
    const auto asked = run(command, folder_.path());
    EXPECT_EQ(asked.code, 0) << asked.err;
    EXPECT_EQ(asked.err, "");
    return asked.out;
  };
  EXPECT_EQ(ask({"-show_entries", "format_tags=title"}), "kidney: kidney-cut-expert\n");
  EXPECT_EQ(ask({"-select_streams", "s", "-show_entries", "stream=codec_name"}), "mov_text\n");
  const std::string chapters = ask({"-show_entries", "chapter=start_time:chapter_tags=title"});
  auto reader = recordings::SessionReader::open(session);
  ASSERT_TRUE(reader);
  const auto events = reader->events();
  const auto cut = std::find_if(events->begin(), events->end(),
                                [](const auto& event) { return event.kind == recordings::EventKind::cut; });
  const double start = std::atof(chapters.c_str() + chapters.rfind('\n', chapters.find("scalpel cuts")) + 1);
  EXPECT_NEAR(start, double(cut->tick) * 1e-3 / 2, 1.0 / 20) << chapters;
  EXPECT_TRUE(holds(chapters, "kidney: kidney-cut-expert")) << chapters;
  const std::string key = "largest force: ", info = run_ctpm({"info", session, "--json"}, folder_.path()).out;
  ASSERT_TRUE(holds(chapters, key)) << chapters;
  EXPECT_NEAR(std::stod(chapters.substr(chapters.find(key) + key.size())), std::stod(value_of(info, "max_force_n")),
              0.006);
  const auto words = run({"ffmpeg", "-v", "error", "-i", "cut.mp4", "-map", "0:s:0", "cut.srt"}, folder_.path());
  ASSERT_EQ(words.code, 0) << words.err;
  const std::string subtitles = testing::slurp(folder_.path() / "cut.srt");
  EXPECT_TRUE(holds(subtitles, "scalpel cuts") && holds(subtitles, "00:00:00,350 --> ")) << subtitles;
}

TEST_F(Export, AContactSheetShowsMomentsThroughTheSession) {
  ASSERT_EQ(run_ctpm({"export", "press.ctpm", "-o", "sheet.png"}, folder_.path()).code, 0);
  ASSERT_EQ(folder_.list(), "press.ctpm sheet.png");
  const auto page = render::read_png((folder_.path() / "sheet.png").string());
  ASSERT_TRUE(page);
  ASSERT_EQ(page->width * 10000 + page->height, 12800720);
  const auto tile = [&](int number) {
    render::Frame part = render::blank_frame(320, 200, 0, 0, 0);  // without the words below
    for (int y = 0; y < part.height; ++y)
      std::copy_n(page->rgb.begin() + ((number / 4 * 240 + y) * 1280 + number % 4 * 320) * 3, 320 * 3,
                  part.rgb.begin() + y * 320 * 3);
    return part;
  };
  // The ball comes down: every picture differs from the one before.
  for (int number = 1; number < 12; ++number) EXPECT_NE(tile(number), tile(number - 1)) << number;
  const auto again = export_to("sheet.png");
  EXPECT_EQ(again.code, 2);
  EXPECT_TRUE(holds(again.err, "exists already")) << again.err;
  const auto pair = export_to("pair.png", {"--beside", "press.ctpm"});
  EXPECT_EQ(pair.code, 2);
  EXPECT_TRUE(holds(pair.err, "--beside: error: is for videos only")) << pair.err;
  for (const char* other : {"ghost.png", "ghost.glb"}) {
    const auto ghost = export_to(other, {"--ghost", "press.ctpm"});
    EXPECT_EQ(ghost.code, 2) << other;
    EXPECT_TRUE(holds(ghost.err, "--ghost: error: is for videos only")) << ghost.err;
  }
}

TEST_F(Export, TheOverlayCanBeLeftOutAndBadWordsAreRefused) {
  const render_test::GlyphReader reader(1280, 720);
  const auto shown = [&](const std::string& level) {
    const auto exported =
        run_ctpm({"export", "press.ctpm", "-o", level + "/", "--overlay", level, "--from-s", "1.1", "--to-s", "1.13"},
                 folder_.path());
    EXPECT_EQ(exported.code, 0) << exported.err;
    return picture(level, 1);
  };
  const render::Frame none = shown("none"), small = shown("small"), full = shown("full");
  for (const char* label : {"time", "force", "tick"}) EXPECT_EQ(reader.read_after(none, label), "") << label;
  EXPECT_EQ(reader.read_after(small, "time"), "1.130 s");
  EXPECT_EQ(reader.read_after(small, "tick"), "");
  EXPECT_EQ(reader.read_after(full, "tick"), "1130");
  for (const std::vector<std::string>& bad :
       {std::vector<std::string>{"--slow-at", "cut,all"}, {"--slow-at", "cut", "--beside", "press.ctpm"}}) {
    const auto refused = export_to("a.mp4", bad);
    EXPECT_EQ(refused.code, 2);
    EXPECT_TRUE(holds(refused.err, "--slow-at: error: ")) << refused.err;
  }
  const auto wrong = export_to("a.mp4", {"--overlay", "some"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(holds(wrong.err, "--overlay: error: got 'some', must be none, small or full")) << wrong.err;
}

/// A copy of a session in which one tick's state hash is not what the simulation gives.
void falsify(const std::string& from, const std::string& to, std::int64_t bad_tick) {
  auto reader = recordings::SessionReader::open(from);
  ASSERT_TRUE(reader);
  auto writer = recordings::SessionWriter::create(to, reader->start());
  ASSERT_TRUE(writer);
  auto records = reader->ticks(0, reader->tick_count());
  ASSERT_TRUE(records);
  (*records)[std::size_t(bad_tick)].state_hash ^= 1;
  // Simulated again, since the new file's keyframes must be what its ticks say.
  stepping::Stepper stepper(reader->start().model);
  State state = reader->start().initial_state;
  for (const recordings::TickRecord& record : *records) {
    ASSERT_EQ(stepper.step(state, record.inputs).status, stepping::StepStatus::ok);
    writer->append(state, record);
  }
  ASSERT_TRUE(writer->finish());
}

TEST_F(Export, ASessionThatDiffersIsRefusedOrMarkedOnEveryFrame) {
  falsify((folder_.path() / "press.ctpm").string(), (folder_.path() / "false.ctpm").string(), 700);
  const auto refused = run_ctpm({"export", "false.ctpm", "-o", "a.mp4", "--size", "640x360"}, folder_.path());
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(holds(refused.err, "differs from the recording since 0.700 s; no video was written")) << refused.err;
  EXPECT_EQ(folder_.list(), "false.ctpm press.ctpm");
  const auto before =
      run_ctpm({"export", "false.ctpm", "-o", "a.mp4", "--size", "640x360", "--to-s", "0.5"}, folder_.path());
  EXPECT_EQ(before.code, 0) << "nothing differs before: " << before.err;
  const auto marked =
      run_ctpm({"export", "false.ctpm", "-o", "marked/", "--size", "640x360", "--allow-diverged"}, folder_.path());
  EXPECT_EQ(marked.code, 1) << marked.err;
  EXPECT_TRUE(holds(marked.out, "DIFFERS")) << marked.out;
  EXPECT_EQ(value_of(sidecar("marked/video"), "verdict"), "\"different\"");
  EXPECT_EQ(value_of(sidecar("marked/video"), "first_different_tick"), "700");
  // The banner at the top right is amber on dark in every frame, also before the difference.
  for (int i = 1; i <= 36; ++i) {
    const render::Frame frame = picture("marked", i);
    int amber = 0;
    for (int y = 8; y < 40; ++y)
      for (int x = 320; x < 632; ++x) {
        const std::uint8_t* p = &frame.rgb[std::size_t(y * 640 + x) * 3];
        amber += p[0] > 140 && p[0] > p[2] + 60 && p[1] > p[2] + 30;
      }
    EXPECT_GT(amber, 150) << "frame " << i;
  }
}

TEST_F(Export, ElementsAreColouredByTheirOwnRange) {
  const auto range_of = [&](const std::string& by, const std::vector<std::string>& more = {}) {
    std::vector<std::string> options{"--view", "elements", "--by", by, "--from-s", "1.1", "--to-s", "1.13"};
    options.insert(options.end(), more.begin(), more.end());
    fs::remove_all(folder_.path() / "a");
    EXPECT_EQ(export_to("a/", options).code, 0);
    return value_of(sidecar("a/video"), "last_colour");
  };
  const std::string tilt = range_of("tilt"), stretch = range_of("stretch");
  const double degrees = std::atof(tilt.c_str() + 1), percent = std::atof(stretch.c_str() + 1);
  EXPECT_TRUE(degrees > 0 && degrees < 20) << tilt << ": the skin hardly tilts, 29 degrees would be one colour";
  EXPECT_TRUE(percent > 0 && percent < 20) << stretch;
  EXPECT_EQ(range_of("tilt", {"--full-scale", "12"}), "\"12\"") << "unless it is given";
}

TEST_F(Export, EveryViewShowsSomethingElse) {
  std::vector<render::Frame> seen;
  const std::vector<std::vector<std::string>> looks{
      {},
      {"--view", "spheres"},
      {"--view", "both"},
      {"--view", "elements"},
      {"--view", "elements", "--by", "tilt"},
      {"--view", "elements", "--by", "force"},
      {"--view", "elements", "--by", "force", "--full-scale", "0.3"},
      {"--cutaway", "y"},
      {"--cutaway", "y=5"},
      {"--camera", "fitted"},
      {"--camera", "follow"},
  };
  for (const auto& look : looks) {
    std::vector<std::string> options = look;
    options.insert(options.end(), {"--from-s", "1.1", "--to-s", "1.13"});
    fs::remove_all(folder_.path() / "a");
    const auto exported = export_to("a/", options);
    ASSERT_EQ(exported.code, 0) << exported.err;
    seen.push_back(picture("a", 1));
    for (std::size_t i = 0; i + 1 < seen.size(); ++i) EXPECT_NE(seen[i], seen.back()) << i << " " << seen.size();
  }
}

}  // namespace
}  // namespace ctpm
