// Bad input of every kind, from outside: a clear message with its place, exit code 2, and nothing
// half-written.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::run_ctpm;
using testing::TemporaryFolder;

const std::string kShipped = std::string(CTPM_SOURCE_DIR) + "/scenes/";

class BadInput : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
  }

  /// The command must end with exit code 2, say all of `parts` on stderr, print nothing on stdout and leave
  /// the folder.
  void refuse(const std::vector<std::string>& arguments, const std::vector<std::string>& parts) {
    const std::string before = folder_.list();
    const auto outcome = run_ctpm(arguments, folder_.path());
    EXPECT_EQ(outcome.code, 2) << outcome.out << outcome.err;
    EXPECT_EQ(outcome.out, "");
    for (const std::string& part : parts)
      EXPECT_NE(outcome.err.find(part), std::string::npos) << "'" << part << "' is not in: " << outcome.err;
    EXPECT_EQ(folder_.list(), before);
  }

  /// A scene that would be good, with one thing replaced.
  std::string scene_with(const std::string& from, const std::string& to) {
    fs::copy_file(kShipped + "organs/skin.obj", folder_.path() / "skin.obj", fs::copy_options::overwrite_existing);
    std::string text = testing::slurp(kShipped + "skin.json");
    text.replace(text.find("organs/skin.obj"), 15, "skin.obj");
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }

  TemporaryFolder folder_;
};

TEST_F(BadInput, NoCommandAndUnknownCommandsAndOptions) {
  EXPECT_EQ(run_ctpm({}, folder_.path()).code, 2);
  EXPECT_EQ(run_ctpm({"fly"}, folder_.path()).code, 2);
  EXPECT_EQ(run_ctpm({"verify", "--wings"}, folder_.path()).code, 2);
  EXPECT_EQ(run_ctpm({"--help"}, folder_.path()).code, 0);
}

TEST_F(BadInput, AMeshThatDoesNotExist) {
  refuse({"import", "nowhere.obj", "--organ", "liver", "-o", "a.json"}, {"nowhere.obj: error:", "no such file"});
}

TEST_F(BadInput, AMeshThatIsEmptyOrNotAMesh) {
  write("empty.obj", "");
  refuse({"import", "empty.obj", "--organ", "liver", "-o", "a.json"}, {"empty.obj: error:", "empty"});
  write("letter.obj", "Dear Sir or Madam,\n");
  refuse({"import", "letter.obj", "--organ", "liver", "-o", "a.json"}, {"letter.obj: error:"});
  write("letter.stl", "Dear Sir or Madam,\n");
  refuse({"import", "letter.stl", "--organ", "liver", "-o", "a.json"}, {"letter.stl: error:"});
}

TEST_F(BadInput, AMeshThatIsOpenBeyondRepair) {
  // Five of a cube's six sides, 200 mm: the missing side is no small hole.
  write("open.obj",
        "v 0 0 0\nv 200 0 0\nv 200 200 0\nv 0 200 0\nv 0 0 200\nv 200 0 200\nv 200 200 200\nv 0 200 200\n"
        "f 1 4 3\nf 1 3 2\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n");
  refuse({"import", "open.obj", "--organ", "liver", "--unit", "mm", "-o", "a.json"},
         {"open.obj: error:", "hole", "mm"});
}

TEST_F(BadInput, WhatMayNotBeReadIsSaidToBeThereAndRefused) {
  fs::permissions(folder_.path(), fs::perms(0755));
  fs::create_directory(folder_.path() / "locked");
  fs::copy_file(kShipped + "organs/kidney.obj", folder_.path() / "mine.obj");
  write("locked/a.json", "{}"), write("s.json", "{}");
  for (const char* name : {"locked", "mine.obj", "s.json"}) fs::permissions(folder_.path() / name, fs::perms::none);
  const std::string denied = ": error: cannot be read: Permission denied";
  for (const auto& [what, name] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"check", "locked/a.json"}, "locked/a.json"},
           {{"check", kShipped + "skin.json", "--script", "s.json"}, "s.json"},
           {{"import", "mine.obj", "-o", "x.json"}, "mine.obj"},
           {{"studio", "locked", "--no-open", "--port", "0"}, "locked"}}) {
    std::vector<std::string> command{"timeout", "20", CTPM_PROGRAM};
    command.insert(command.end(), what.begin(), what.end());
    const auto outcome = testing::run(command, folder_.path(), testing::Whose::nobodys);
    EXPECT_EQ(outcome.code, 2) << name;
    EXPECT_NE(outcome.err.find(name + denied), std::string::npos) << outcome.err;
  }
  fs::permissions(folder_.path() / "locked", fs::perms(0755));
}

TEST_F(BadInput, AnImportToANameThatNoSceneCanHaveOrToFilesThatAreThere) {
  for (const char* name : {"a\nb.json", "a\tb.json", "a\xff.json"})
    refuse({"import", kShipped + "organs/kidney.obj", "-o", name}, {"a scene's name must be UTF-8"});
  for (const char* name : {"b.json", "b.obj", "b.script.json"}) write(name, "precious");
  refuse({"import", kShipped + "organs/kidney.obj", "-o", "b.json"},
         {"b.json: error: exists already", "b.obj: error: exists already", "b.script.json: error: exists already"});
}

TEST_F(BadInput, AnImportWithBadOptionsNamesThemAll) {
  refuse({"import", kShipped + "organs/liver.obj", "--unit", "ell", "--radius-mm", "-1", "--anchor", "lowest", "-o",
          "a.json"},
         {"--unit: error: got 'ell'", "--radius-mm: error: got -1", "--anchor: error: got 'lowest'"});
  refuse({"import", kShipped + "organs/liver.obj", "--organ", "pancreas", "-o", "a.json"},
         {"there is no preset 'pancreas'", "liver, kidney, skin"});
  refuse({"import", kShipped + "organs/liver.obj", "--anchor", "sphere:900,900,900,5", "-o", "a.json"},
         {"holds no sphere"});
}

TEST_F(BadInput, ASceneWithASyntaxError) {
  write("a.json", "{\n  \"format\": ctpm\n}\n");
  refuse({"check", "a.json"}, {"a.json:2:13: error:"});
}

TEST_F(BadInput, ASceneWithAnUnknownKeyAWrongUnitAndAWrongValueNamesThemAll) {
  write("a.json", scene_with("\"fill\": { \"radius_mm\": 7, \"gap_mm\": 7 }",
                             "\"fill\": { \"radius_cm\": 0.7, \"gap_mm\": -7 },\n\"modle\": \"ctpm\""));
  refuse({"check", "a.json"}, {"the key is \"radius_mm\"", "/organs/0/fill/gap_mm: got -7", "did you mean \"model\"?"});
}

TEST_F(BadInput, ASceneWhoseMeshIsMissing) {
  write("a.json", scene_with("skin.obj", "bone.obj"));
  refuse({"record", "a.json", "-o", "a.ctpm"}, {"a.json:", "/organs/0/mesh", "bone.obj"});
}

TEST_F(BadInput, ASceneWhoseMeshLeavesItsFolder) {
  write("a.json", scene_with("skin.obj", "../skin.obj"));
  refuse({"check", "a.json"}, {"leaves the scene's folder"});
}

/// Two organs in lines 2 and 3, and more keys in line 4.
std::string two_organs(const std::string& first, const std::string& second, const std::string& more) {
  return "{\"format\": \"ctpm-scene\", \"version\": 1, \"name\": \"t\", \"organs\": [\n{\"name\": \"a\", " + first +
         "\"material\": {\"preset\": \"skin\"}},\n{\"name\": \"b\", " + second +
         "\"material\": {\"preset\": \"skin\"}}],\n" + more + "}\n";
}
const std::string kRig = R"("rig": {"block": [3, 3, 3]}, )";
const std::string kFarAnchor = R"("anchors": [{"box": {"min_mm": [900, 0, 0], "max_mm": [901, 1, 1]}}], )";
const std::string kAnchorError = "a.json:3:27: error: /organs/1/anchors/0: holds no sphere (its spheres lie from";

TEST_F(BadInput, AMissingMeshARangeErrorAndAnAnchorAreReportedTogether) {
  write("a.json", two_organs(R"("mesh": "no.obj", )", kFarAnchor + kRig, R"("tick_s": 5)"));
  refuse({"check", "a.json"}, {"a.json:2:23: error: /organs/0/mesh: there is no file \"no.obj\"", kAnchorError,
                               "a.json:4:11: error: /tick_s: got 5, must be in"});
}

TEST_F(BadInput, AMeshThatIsNoneIsRefusedWhereTheSceneNamesIt) {
  write("letter.obj", "Dear Sir or Madam,\n");
  write("a.json", two_organs(R"("mesh": "letter.obj", )", kFarAnchor + kRig, R"("tick_s": 0.001)"));
  refuse({"check", "a.json"}, {"a.json:2:23: error: /organs/0/mesh: letter.obj: ", kAnchorError});
}

TEST_F(BadInput, AnUnstableIntegratorIsRefusedWhereItStands) {
  write("a.json", two_organs(kRig, kRig, R"("solver": {"integrator": "leapfrog"}, "contact_friction": -1)"));
  refuse({"check", "a.json"},
         {"a.json:4:26: error: /solver/integrator: leapfrog", "a.json:4:59: error: /contact_friction"});
}

TEST_F(BadInput, ASceneAndItsScriptAreRefusedTogether) {
  write("a.json",
        two_organs(kRig, kFarAnchor + kRig, R"("tools": [{"name": "ball", "kind": "ball", "radius_mm": 5}])"));
  write("s.json",
        "{\"format\": \"ctpm-script\", \"version\": 1, \"steps\": [\n{\"take\": {\"tool\": \"saw\", \"at_mm\": "
        "[0, 0, 0]}}]}");
  const std::string saw = "s.json:2:19: error: /steps/0/take/tool: the scene has no tool \"saw\" (its tools: ball)";
  refuse({"check", "a.json", "--script", "s.json"}, {kAnchorError, saw});
  // Recording says what a script gets wrong before it fills, and with it what the scene's text does.
  refuse({"record", "a.json", "--script", "s.json", "-o", "a.ctpm"}, {saw});
  write("b.json", two_organs(kRig, kRig,
                             R"("contact_friction": -1, "tools": [{"name": "ball", "kind": "ball", "radius_mm": 5}])"));
  refuse({"record", "b.json", "--script", "s.json", "-o", "a.ctpm"}, {saw, "/contact_friction: got -1"});
}

TEST_F(BadInput, AScriptWithAnUnknownTool) {
  write("s.json",
        "{\"format\": \"ctpm-script\", \"version\": 1, \"steps\": [{\"take\": {\"tool\": \"saw\", \"at_mm\": "
        "[0, 0, 0]}}]}");
  refuse({"record", kShipped + "skin.json", "--script", "s.json", "-o", "a.ctpm"},
         {"s.json:1:", "\"saw\"", "ball, scalpel"});
}

TEST_F(BadInput, ASessionThatDoesNotExistOrIsNone) {
  refuse({"verify", "nowhere.ctpm"}, {"nowhere.ctpm: error:"});
  write("letter.ctpm", "Dear Sir or Madam,\n");
  for (const char* command : {"verify", "info", "replay"}) refuse({command, "letter.ctpm"}, {"letter.ctpm: error:"});
  refuse({"export", "letter.ctpm", "-o", "a.mp4"}, {"letter.ctpm: error:"});
  refuse({"recover", "letter.ctpm", "-o", "b.ctpm"}, {"letter.ctpm"});
}

TEST_F(BadInput, AFolderOrAPipeInPlaceOfASession) {
  fs::create_directory(folder_.path() / "folder.ctpm");
  ASSERT_EQ(::mkfifo((folder_.path() / "pipe.ctpm").c_str(), 0600), 0);
  for (const char* none : {"folder.ctpm", "pipe.ctpm"}) {
    for (const char* command : {"verify", "info", "replay"}) refuse({command, none}, {"it is not a regular file"});
    refuse({"recover", none, "-o", "b.ctpm"}, {std::string(none) + ": error: is not a session file: it is not a"});
    refuse({"compare", none, none}, {"it is not a regular file"});
  }
}

TEST_F(BadInput, ASessionThatIsCutShort) {
  ASSERT_EQ(
      run_ctpm({"record", kShipped + "skin.json", "-o", "whole.ctpm", "--fast", "--duration-s", "1"}, folder_.path())
          .code,
      0);
  const std::string whole = testing::slurp(folder_.path() / "whole.ctpm");
  for (const double share : {0.02, 0.3, 0.7}) {
    write("short.ctpm", whole.substr(0, std::size_t(share * double(whole.size()))));
    refuse({"verify", "short.ctpm"}, {"short.ctpm"});
  }
}

TEST_F(BadInput, AnOutputFolderThatDoesNotExist) {
  ASSERT_EQ(
      run_ctpm({"record", kShipped + "skin.json", "-o", "a.ctpm", "--fast", "--duration-s", "0.1"}, folder_.path())
          .code,
      0);
  refuse({"import", kShipped + "organs/liver.obj", "-o", "a.ctpm/such/a.json"}, {"a.ctpm/such", "cannot be made"});
  refuse({"record", kShipped + "skin.json", "-o", "no/such/a.ctpm"}, {"no/such"});
  for (const char* name : {"a.mp4", "a.txt", "a"})
    refuse({"record", kShipped + "skin.json", "-o", name}, {std::string("--output: error: got ") + name, "in .ctpm"});
  refuse({"export", "a.ctpm", "-o", "a.gif"}, {"a.gif: error", ".mp4", "shapes too"});
  refuse({"preview", kShipped + "skin.json", "-o", "no/such/a.png"}, {"no/such"});
  refuse({"export", "a.ctpm", "-o", "no/such/a.mp4"}, {"no/such"});
  refuse({"replay", "a.ctpm", "--csv", "no/such/a.csv"}, {"no/such"});
}

TEST_F(BadInput, AnOutputThatExistsIsNotOverwrittenUnlessAsked) {
  write("a.ctpm", "precious");
  refuse({"record", kShipped + "skin.json", "-o", "a.ctpm", "--fast", "--duration-s", "0.1"}, {"a.ctpm"});
  EXPECT_EQ(testing::slurp(folder_.path() / "a.ctpm"), "precious");
  EXPECT_EQ(run_ctpm({"record", kShipped + "skin.json", "-o", "a.ctpm", "--fast", "--duration-s", "0.1", "--overwrite"},
                     folder_.path())
                .code,
            0);
}

TEST_F(BadInput, ExportOptionsOutOfRange) {
  ASSERT_EQ(
      run_ctpm({"record", kShipped + "skin.json", "-o", "a.ctpm", "--fast", "--duration-s", "0.1"}, folder_.path())
          .code,
      0);
  refuse({"export", "a.ctpm", "-o", "a.mp4", "--size", "big"}, {"--size", "1280x720"});
  refuse({"export", "a.ctpm", "-o", "a.mp4", "--fps", "0"}, {"--fps"});
  refuse({"export", "a.ctpm", "-o", "a.mp4", "--camera", "moon"}, {"no camera 'moon'", "front"});
  refuse({"export", "a.ctpm", "-o", "a.mp4", "--from-s", "9"}, {"--from-s"});
  refuse({"export", "a.ctpm", "-o", "a.mov"}, {"a.mov"});
  refuse({"export", "a.ctpm", "-o", "a.mp4", "--beside", "nowhere.ctpm"}, {"nowhere.ctpm: error:"});
  refuse({"export", "a.ctpm", "-o", "a.mov", "--fps", "999", "--speed", "0", "--to-s", "7", "--view", "inside",
          "--cutaway", "w=1", "--camera", "moon"},
         {"a.mov", "--fps", "--speed", "--to-s", "--view: error: got 'inside'", "--cutaway: error: got 'w=1'",
          "no camera 'moon'"});
  refuse({"export", "a.ctpm", "-o", "a.mp4", "--view", "elements", "--by", "layer"}, {"stretch, tilt or force"});
  refuse({"export", "a.ctpm", "-o", "a.mp4", "--view", "spheres", "--by", "force"}, {"give --view elements"});
  refuse({"preview", kShipped + "skin.json", "-o", "a.png", "--view", "inside", "--cutaway", "y=deep"},
         {"--view", "--cutaway: error: got 'y=deep'"});
  refuse({"preview", kShipped + "skin.json", "-o", "a.png", "--cutaway", "y=9999"},
         {"--cutaway: error: got 'y=9999', the organs lie between -"});
}

TEST_F(BadInput, EveryPlaceIsSaidOnceAndNumbersAsTheyWereGiven) {
  ASSERT_EQ(
      run_ctpm({"record", kShipped + "skin.json", "-o", "a.ctpm", "--fast", "--duration-s", "0.1"}, folder_.path())
          .code,
      0);
  const auto exported = run_ctpm({"export", "a.ctpm", "-o", "nodir/a.mp4"}, folder_.path());
  EXPECT_EQ(exported.err, "nodir/a.mp4: error: the folder nodir does not exist (create it first)\n");
  refuse({"record", kShipped + "skin.json", "-o", "b.ctpm", "--fast", "--duration-s", "0"},
         {"--duration-s: error: must be above 0"});
  refuse({"replay", "a.ctpm", "--from-s", "9"}, {"--from-s: got 9, the session lasts 0.1 s"});
  refuse({"preview", "none.json", "-o", "nodir/a.png", "--size", "10x"},
         {"--size: error:", "nodir", "none.json: error:"});
  refuse({"stability", "--case", "none", "-o", "a.ctpm/out"}, {"--case: error:", "a.ctpm/out: error: cannot be made"});
  fs::create_directory(folder_.path() / "folder");
  refuse({"anonymise", "a.ctpm", "-o", "b.ctpm", "--key", "folder"}, {"folder: error: is a folder"});
}

TEST_F(BadInput, ModuliRadiiSpacingsAndViscositiesThatCannotBeAreAllNamedWithTheirPlaces) {
  const std::string preset = "\"preset\": \"skin\"", fill = "\"radius_mm\": 7, \"gap_mm\": 7";
  write("a.json",
        scene_with(preset, preset + ",\n\"spring_kpa_per_mm\": 0,\n\"kelvin_kpa_per_mm\": -15,\n"
                                    "\"constraint_kpa_per_mm\": 1e300,\n\"viscosity_kpa_s_per_mm\": \"nan\",\n"
                                    "\"calibration_spacing_mm\": 0"));
  refuse({"check", "a.json"},
         {"a.json:13:22: error: /organs/0/material/spring_kpa_per_mm: got 0, must be in",
          "a.json:14:22: error: /organs/0/material/kelvin_kpa_per_mm: got -15, must be in",
          "a.json:15:26: error: /organs/0/material/constraint_kpa_per_mm: got 1e300, must be in",
          "a.json:16:27: error: /organs/0/material/viscosity_kpa_s_per_mm: got the text \"nan\", must be a "
          "number",
          "a.json:17:27: error: /organs/0/material/calibration_spacing_mm: got 0, must be in"});
  write("a.json", scene_with(preset, preset + ", \"viscosity_kpa_s_per_mm\": NaN"));
  refuse({"check", "a.json"}, {"a.json:12:53: error: NaN is not a number that a file can hold"});
  for (const auto& [value, message] : {std::pair<std::string, std::string>{"0", "got 0, must be in [0.01, 100] mm"},
                                       {"-7", "got -7, must be in [0.01, 100] mm"},
                                       {"1e9", "got 1e9, must be in [0.01, 100] mm"},
                                       {"1e999", "too large for a double"}}) {
    write("a.json", scene_with(fill, "\"radius_mm\": " + value + ", \"gap_mm\": 7"));
    refuse({"record", "a.json", "-o", "a.ctpm", "--fast"}, {"a.json:10:", message});
  }
}

TEST_F(BadInput, APresetThatDoesNotExist) {
  write("a.json", scene_with("\"preset\": \"skin\"", "\"preset\": \"skim\""));
  refuse({"check", "a.json"}, {"a.json:", "/organs/0/material/preset", "\"skim\"", "did you mean \"skin\"?"});
}

TEST_F(BadInput, ALayerThatIsDeeperThanTheOrgan) {
  write("a.json", scene_with("\"anchors\"",
                             "\"layers\": [{\"to_depth_mm\": 400, \"material\": {\"preset\": "
                             "\"kidney\"}}],\n\"anchors\""));
  refuse({"check", "a.json"}, {"a.json:16:34: error: /organs/0/layers/0/to_depth_mm: got 400 mm",
                               "deeper than the organ", "its spheres lie"});
}

TEST_F(BadInput, ARigWithTooFewSpheres) {
  const auto rig_of = [](const std::string& cells) {
    return "{\"format\": \"ctpm-scene\", \"version\": 1, \"name\": \"r\", \"organs\": [{\"name\": \"a\",\n"
           "\"rig\": {\"cells\": [" +
           cells + "]}, \"material\": {\"preset\": \"liver\"}}]}\n";
  };
  write("a.json", rig_of("[0, 0, 0]"));
  refuse({"check", "a.json"}, {"a.json:2:", "/organs/0/rig/cells", "at least two"});
  write("a.json", rig_of("[0, 0, 0], [5, 0, 0]"));
  refuse({"check", "a.json"}, {"a.json:2:18: error: /organs/0/rig/cells: no two of the 2 spheres are neighbours"});
}

TEST_F(BadInput, AnExperimentOfThePaperWhoseRigHasTooFewSpheresOrNoLoad) {
  const fs::path scenes = folder_.path() / "scenes";
  fs::copy(kShipped, scenes, fs::copy_options::recursive);
  const auto replace_in = [&](const std::string& name, const std::string& from, const std::string& to) {
    std::string text = testing::slurp(scenes / name);
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream(scenes / name, std::ios::binary) << text.replace(at, from.size(), to);
  };
  replace_in("paper/rig-skin.json", ", [1, 0, 0], [2, 0, 0]]", "]");
  replace_in("paper/rig-skin.json", ",\n          { \"cell\": [1, 0, 0], \"axes\": \"y\" }", "");
  replace_in("paper/rig-skin.json", "{ \"sphere\": { \"centre_mm\": [42, 0, 0], \"radius_mm\": 1 } },", "");
  replace_in("paper/block-liver.json",
             "\"loads\": [{ \"at_mm\": [0, 0, 72], \"force_n\": [0, 0, -0.13], \"ramp_s\": 0.082 }],", "");
  const auto outcome = run_ctpm({"paper", "--scenes", "scenes", "-o", "out"}, folder_.path());
  EXPECT_EQ(outcome.code, 2);
  for (const char* part : {"/organs/0/rig/cells: got 5 spheres, the rig of Fig. 3 has 7",
                           "block-liver.json:1:1: error: /loads: the experiment needs one"})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " is not in: " << outcome.err;
  EXPECT_FALSE(fs::exists(folder_.path() / "out")) << "what is refused leaves no folder";
}

}  // namespace
}  // namespace ctpm
