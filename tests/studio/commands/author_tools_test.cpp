// What an author uses beside the import: places by meaning, scripts that are checked, probes in tables, marks in
// previews, and `watch`.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "studio/render/frame.h"
#include "tests/studio/commands/running_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::run_ctpm;

class AuthorTools : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::copy_file(CTPM_SOURCE_DIR "/scenes/organs/skin.obj", folder_.path() / "skin.obj");
    write("scene.json", scene());
    write("script.json", script("ball"));
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
  }
  /// A patch of skin, with places by meaning and a comment.
  static std::string scene(const std::string& more = "") {
    return "{\"format\": \"ctpm-scene\", \"version\": 1, \"name\": \"patch\", // of skin\n"
           "\"organs\": [{\"name\": \"skin\", \"mesh\": \"skin.obj\", \"fill\": {\"radius_mm\": 6, \"gap_mm\": 6},\n"
           "\"material\": {\"preset\": \"skin\"}, \"anchors\": [{\"lowest_mm\": 4}]}],\n"
           "\"tools\": [{\"name\": \"ball\", \"kind\": \"ball\", \"radius_mm\": 8, \"at_mm\": \"spot out 20\"}],\n"
           "\"probes\": [{\"name\": \"spot\", \"at_mm\": \"surface of skin at 5 -5\"}],\n"
           "\"settle_s\": 0.2" +
           more + "}\n";
  }
  static std::string script(const std::string& tool) {
    return "{\"format\": \"ctpm-script\", \"version\": 1, \"steps\": [\n{\"take\": {\"tool\": \"" + tool +
           "\", \"at_mm\": \"spot out 10\", \"pointing\": \"into spot\"}},\n"
           "{\"press\": {\"distance_mm\": 8, \"direction\": \"into spot\", \"speed_mm_per_s\": 80}}, {\"wait_s\": "
           "0.1}]}\n";
  }
  testing::ProgramOutcome ctpm(const std::vector<std::string>& arguments) {
    return run_ctpm(arguments, folder_.path());
  }
  static void expect_says(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in:\n" << text;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(AuthorTools, CheckNamesTheMistakesOfASceneAndItsScriptsInOneRun) {
  const auto good = ctpm({"check", "scene.json", "--script", "script.json"});
  EXPECT_EQ(good.code, 0) << good.err;
  write("scene.json", scene(", \"contact_friction\": -1"));
  write("script.json", script("bell"));
  write("other.json", "{\"format\": \"ctpm-script\", \"version\": 1,}");
  const auto bad = ctpm({"check", "scene.json", "--script", "script.json", "--script", "other.json"});
  EXPECT_EQ(bad.code, 2);
  expect_says(bad.err, {"scene.json:6:38: error: /contact_friction: got -1",
                        "script.json:2:19: error: /steps/0/take/tool: the scene has no tool \"bell\" (its tools: ball)",
                        "other.json:1:39: error: this comma is one too many"});
  EXPECT_EQ(ctpm({"check", "scene.json", "scene.json", "--script", "script.json"}).code, 2);
}

TEST_F(AuthorTools, AScriptsMistakesComeBeforeItsSceneIsFilled) {
  // A mesh that cannot be filled would be found second.
  write("skin.obj", "v 0 0 0\n");
  std::string wrong = script("ball");
  wrong.replace(wrong.find("into spot"), 9, "into spit");
  write("script.json", wrong);
  const auto outcome = ctpm({"record", "scene.json", "--script", "script.json", "-o", "a.ctpm", "--fast"});
  EXPECT_EQ(outcome.code, 2);
  expect_says(outcome.err, {"script.json:2:", "there is no place \"spit\" (probes: spot"});
  EXPECT_EQ(outcome.err.find("skin.obj"), std::string::npos) << outcome.err;
}

TEST_F(AuthorTools, PlacesByMeaningAreRecordedAndProbesAreColumns) {
  const auto recorded = ctpm({"record", "scene.json", "--script", "script.json", "-o", "a.ctpm", "--fast"});
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  ASSERT_EQ(ctpm({"verify", "a.ctpm"}).code, 0);
  ASSERT_EQ(ctpm({"replay", "a.ctpm", "--csv", "a.csv"}).code, 0);
  std::istringstream table(testing::slurp(folder_.path() / "a.csv"));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(table, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  const auto column = [&](const std::string& name) {
    return std::size_t(std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin());
  };
  const std::size_t z = column("probe_spot_z_mm"), force = column("force_n"), x = column("probe_spot_x_mm");
  ASSERT_LT(z, rows[0].size());
  EXPECT_EQ(z, x + 2);
  const auto number = [&](std::size_t row, std::size_t at) { return std::stod(rows[row].at(at)); };
  EXPECT_NEAR(number(1, x), 5, 12) << "the sphere that is nearest to the place";
  EXPECT_GT(number(rows.size() - 1, force), 0) << "the ball touches the spot";
  EXPECT_LT(number(rows.size() - 1, z), number(1, z) - 0.3) << "and the probe goes down with it";
  // A comparison shows how far the probe goes in each session.
  ASSERT_EQ(ctpm({"compare", "a.ctpm", "a.ctpm", "-o", "report"}).code, 0);
  expect_says(testing::slurp(folder_.path() / "report/report.html"), {"The tissue at the probes", "Probe spot"});
  const std::string results = testing::slurp(folder_.path() / "report/results.json");
  expect_says(results, {"Probe spot", "from its first place [mm]"});
}

TEST_F(AuthorTools, AFitSaysWhetherThePaperHasTheForcesOfATissue) {
  const auto fit_of = [&](const std::string& material) {
    write("block.json", R"({"format": "ctpm-scene", "version": 1, "name": "block", "settle_s": 0, "organs": [
      {"name": "block", "rig": {"block": [5, 5, 4]}, "anchors": [{"lowest_mm": 1}], "material": )" +
                            material + "}]}");
    const auto fitted = ctpm({"fit", "block.json"});
    EXPECT_EQ(fitted.code, 0) << fitted.err;
    return fitted.out;
  };
  const std::string none = "The paper has no forces of this material";
  const std::string liver = fit_of(R"({"preset": "liver"})");
  EXPECT_NE(liver.find("Table 1, CTPM [N]"), std::string::npos) << liver;
  EXPECT_EQ(liver.find(none), std::string::npos) << liver;
  for (const char* material : {R"({"preset": "heart"})", R"({"preset": "liver", "spring_kpa_per_mm": 9})"}) {
    const std::string other = fit_of(material);
    EXPECT_EQ(other.find("Table 1"), std::string::npos) << other;
    EXPECT_NE(other.find(none), std::string::npos) << other;
  }
  const auto refused = ctpm({"fit", "block.json", "--organ", "blok"});
  EXPECT_EQ(refused.code, 2);
  expect_says(refused.err, {"--organ", "has no organ 'blok'", "it has: block"});
}

TEST_F(AuthorTools, APreviewColoursSpheresByWhatTheyAreMadeOf) {
  write("scene.json", [] {
    std::string layered = scene();
    const std::string coarse = "\"radius_mm\": 6, \"gap_mm\": 6";
    layered.replace(layered.find(coarse), coarse.size(), "\"radius_mm\": 3, \"gap_mm\": 3");
    return layered.insert(layered.find("\"anchors\""),
                          "\"layers\": [{\"to_depth_mm\": 9.5, \"material\": {\"preset\": \"fat\"}}], ");
  }());
  const auto colours = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"preview", "scene.json", "-o", "layers.png", "--overwrite"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return ctpm(arguments);
  };
  const auto by_layer = colours({"--view", "spheres"});
  const std::string picture = testing::slurp(folder_.path() / "layers.png");
  EXPECT_EQ(by_layer.out.find("orange"), std::string::npos) << by_layer.out;
  const auto by_material = colours({"--view", "spheres", "--by", "material"});
  EXPECT_EQ(by_material.code, 0) << by_material.err;
  expect_says(by_material.out, {"orange: skin, fat down to 9.5 mm", "blue: skin, skin below"});
  EXPECT_NE(testing::slurp(folder_.path() / "layers.png"), picture);
  EXPECT_EQ(colours({"--by", "material"}).code, 2) << "a surface has its own colours";
}

TEST_F(AuthorTools, APreviewShowsMarksAndTheSettledShape) {
  const auto draw = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {"preview", "scene.json", "-o", name, "--size", "640x360"});
    const auto outcome = ctpm(more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const Result<render::Frame> picture = render::read_png((folder_.path() / name).string());
    return picture ? *picture : render::Frame{};
  };
  const render::Frame plain = draw("plain.png", {}), marked = draw("marked.png", {"--marks"}),
                      ways = draw("ways.png", {"--script", "script.json"}),
                      settled = draw("settled.png", {"--settled"});
  EXPECT_NE(plain, settled);
  const auto count = [&](const render::Frame& picture, int red, int green, int blue) {
    int pixels = 0;
    for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3)
      pixels += std::abs(picture.rgb[i] - red) < 12 && std::abs(picture.rgb[i + 1] - green) < 12 &&
                std::abs(picture.rgb[i + 2] - blue) < 12;
    return pixels;
  };
  // The probe's yellow ring, the tool's arrow, the axes.
  for (const auto& [red, green, blue] : {std::array{255, 217, 64}, {89, 230, 242}, {242, 89, 76}, {102, 217, 102}}) {
    EXPECT_EQ(count(plain, red, green, blue), 0);
    EXPECT_GT(count(marked, red, green, blue), 8);
  }
  EXPECT_NE(ways, marked) << "the script's way is drawn as well";
  // Outlines of forbidden zones.
  EXPECT_EQ(count(marked, 255, 107, 92), 0);
  for (const char* zone : {R"("sphere": {"centre_mm": [0, 0, 0], "radius_mm": 12})",
                           R"("box": {"min_mm": [-12, -12, -12], "max_mm": [12, 12, 12]})",
                           R"("plane": {"point_mm": [0, 0, 0], "normal": [0, 0, 1]})"}) {
    std::string zoned = scene();
    write("scene.json",
          zoned.insert(zoned.find("\"organs\""), std::string(R"("forbidden": [{"name": "vessel", )") + zone + "}], "));
    EXPECT_GT(count(draw("zone.png", {"--marks", "--overwrite"}), 255, 107, 92), 100) << zone;
  }
}

TEST_F(AuthorTools, ALayerThinnerThanTheSpheresAreApartIsToldWithTheRadiusThatResolvesIt) {
  const auto imported = ctpm({"import", CTPM_SOURCE_DIR "/scenes/organs/kidney.obj", "--unit", "mm", "--spheres", "700",
                              "--stiffness-scale", "1", "--layer", "skin:4.5", "--layer", "fat:15.5", "-o",
                              "layered.json", "--report", "report.json"});
  ASSERT_EQ(imported.code, 0) << imported.err;
  expect_says(imported.out,
              {"the layer of skin is 4.5 mm thick, and the spheres are ", "a radius of 1.5 mm resolves it"});
  EXPECT_EQ(imported.out.find("the layer of fat"), std::string::npos) << imported.out;
  expect_says(testing::slurp(folder_.path() / "report.json"), {"\"thin_layer\""});
}

TEST_F(AuthorTools, TheCommandThatAnImportNamesNextWorksAlsoWhereSessionsAre) {
  const auto next_works = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"import", "skin.obj", "--unit", "mm", "--spheres", "60", "--stiffness-scale", "1"});
    const auto imported = ctpm(more);
    const auto at = imported.out.find("next: ctpm ");
    ASSERT_NE(at, std::string::npos) << imported.err;
    std::istringstream words(imported.out.substr(at + std::string("next: ctpm ").size()));
    std::vector<std::string> command{std::istream_iterator<std::string>(words), {}};
    command.insert(command.end(), {"--fast", "--duration-s", "0.1"});
    const auto recorded = ctpm(command);
    EXPECT_EQ(recorded.code, 0) << recorded.err;
  };
  next_works({"-o", "patch.json"});
  next_works({"-o", "patch.json", "--overwrite"});
  next_works({"--into", "patch.json", "--beside"});
}

TEST_F(AuthorTools, WatchLooksAgainWhenAFileIsSaved) {
  testing::RunningProgram watching({"watch", "scene.json", "--script", "script.json", "--preview", "scene.png"},
                                   folder_.path());
  const auto wait_for = [&](const std::string& file, const std::string& text) {
    for (int i = 0; i < 3000 && testing::slurp(folder_.path() / file).find(text) == std::string::npos; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_NE(testing::slurp(folder_.path() / file).find(text), std::string::npos)
        << testing::slurp(folder_.path() / file);
  };
  wait_for(".stderr", "watching scene.json");
  expect_says(testing::slurp(folder_.path() / ".stdout"), {"scene.json: good", "solver:", "scene.png: 1280x720"});
  EXPECT_TRUE(fs::exists(folder_.path() / "scene.png"));
  write("scene.json", scene(", \"lips_meet\": 3"));
  wait_for(".stderr", "/lips_meet: got the number 3");
  write("scene.json", scene());
  write("script.json", script("bell"));
  wait_for(".stderr", "the scene has no tool \"bell\"");
  watching.interrupt();
  EXPECT_EQ(watching.outcome().code, 0);
}

TEST_F(AuthorTools, WatchRefusesWhatIsNotThereToWatch) {
  const auto refused = ctpm({"watch", ".", "--script", "none.json", "--preview", "nodir/scene.png"});
  EXPECT_EQ(refused.code, 2);
  expect_says(refused.err, {".: error: is a folder", "none.json: error: does not exist", "nodir"});
}

}  // namespace
}  // namespace ctpm
