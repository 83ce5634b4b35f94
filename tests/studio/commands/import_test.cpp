// The import as an author meets it, from outside: dirty meshes of every kind become scenes that run, and the
// report says what was found.

#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "importers/label_map.h"
#include "tests/importers/zoo.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::run_ctpm;
using testing::TemporaryFolder;

class ImportProgram : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
  }
  /// Imports a mesh of the folder as `scene.json` with `more` arguments; what the program said.
  testing::ProgramOutcome import(const std::string& mesh, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"import", mesh,         "--organ",  "kidney",
                                       "-o",     "scene.json", "--report", "report.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_ctpm(arguments, folder_.path());
  }
  /// The same with few spheres and no fit, for what depends on neither.
  testing::ProgramOutcome import_quickly(const std::string& mesh, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--stiffness-scale", "1", "--unit", "mm"});
    if (std::find(more.begin(), more.end(), "--spheres") == more.end()) more.insert(more.end(), {"--spheres", "120"});
    return import(mesh, more);
  }
  testing::ProgramOutcome ctpm(const std::vector<std::string>& arguments) {
    return run_ctpm(arguments, folder_.path());
  }
  std::string report() { return testing::slurp(folder_.path() / "report.json"); }

  TemporaryFolder folder_;
};

/// An organ of kidney size, 90 x 60 x 50, in the unit that makes one of its millimetres `millimetre` long.
importers::RawMesh bean(double millimetre = 1, int cuts = 4) {
  return zoo::moved(zoo::sphere(1, cuts), [=](Vec3 p) {
    return millimetre * Vec3{45 * p.x, 30 * p.y + 8 * p.x * p.x, 25 * p.z};
  });
}

void expect_says(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in:\n" << text;
}

TEST_F(ImportProgram, ACoarserSurfaceIsDrawnAroundTheSameSpheres) {
  write("bean.obj", zoo::to_obj_text(bean()));
  const auto fine = import("bean.obj", {"--unit", "mm", "--radius-mm", "4"});
  ASSERT_EQ(fine.code, 0) << fine.err;
  const auto triangles = [&] { return std::stoi(report().substr(report().find("\"surface_triangles\": ") + 21)); };
  EXPECT_GE(triangles(), 5120) << "as fine as the mesh, or finer where a tool must bend it";
  expect_says(fine.out, {"drawn with " + std::to_string(triangles()) + " triangles"});
  const std::string fine_mesh = testing::slurp(folder_.path() / "scene.obj");
  const auto coarse =
      import("bean.obj", {"--unit", "mm", "--radius-mm", "4", "--most-triangles", "800", "--overwrite"});
  ASSERT_EQ(coarse.code, 0) << coarse.err;
  expect_says(report(), {"\"surface_triangles\": 800", "\"code\": \"coarsened\""});
  expect_says(coarse.out, {"drawn with 800 triangles"});
  expect_says(testing::slurp(folder_.path() / "scene.json"), {"\"most_triangles\": 800"});
  // The mesh beside the scene stays whole, so that the scene has the spheres of the mesh.
  EXPECT_EQ(testing::slurp(folder_.path() / "scene.obj"), fine_mesh);
  const auto spheres = [](const std::string& text) { return text.substr(text.find("filling: "), 30); };
  EXPECT_EQ(spheres(fine.out), spheres(coarse.out));
  EXPECT_EQ(run_ctpm({"check", "scene.json"}, folder_.path()).code, 0);
}

TEST_F(ImportProgram, AnOrganOfThePaperIsFittedAndUnderTheTensionOfItsCapsule) {
  write("bean.obj", zoo::to_obj_text(bean()));
  const auto done = import("bean.obj", {"--unit", "mm", "--radius-mm", "4"});
  ASSERT_EQ(done.code, 0) << done.err;
  expect_says(done.out, {"stiffness_scale: ", "fitted so that the paper's ball meets its Table 1",
                         "a layer of 12 mm under a strain of 0.0", "cuts gape"});
  expect_says(report(), {"\"code\": \"tension\""});
  expect_says(testing::slurp(folder_.path() / "scene.json"), {"\"to_depth_mm\": 12", "\"prestrain\": 0.0"});
}

TEST_F(ImportProgram, AllPartsAreInTheSceneAsWell) {
  const importers::RawMesh two = zoo::both(bean(), zoo::moved(bean(), [](Vec3 p) { return p + Vec3{120, 0, 0}; }));
  write("two.obj", zoo::to_obj_text(two));
  const std::vector<std::string> coarse{"--unit", "mm", "--stiffness-scale", "1", "--radius-mm", "8", "--overwrite"};
  const auto import_as = [&](const std::string& parts) {
    std::vector<std::string> arguments = coarse;
    arguments.push_back(parts);
    return import("two.obj", arguments);
  };
  ASSERT_EQ(import_as("--largest-part").code, 0);
  const auto one = run_ctpm({"check", "scene.json"}, folder_.path());
  ASSERT_EQ(import_as("--all-parts").code, 0);
  const auto both = run_ctpm({"check", "scene.json"}, folder_.path());
  const auto spheres = [](const std::string& text) { return std::stoi(text.substr(text.find("good, ") + 6)); };
  EXPECT_EQ(spheres(both.out), 2 * spheres(one.out)) << one.out << both.out;
}

TEST_F(ImportProgram, AHoleWiderThanUsualIsFilledWhenThatIsAskedFor) {
  write("open.obj", zoo::to_obj_text(zoo::without(bean(1, 3), [](Vec3 p) { return p.x > 40; })));
  const auto refused = import_quickly("open.obj");
  EXPECT_EQ(refused.code, 2);
  expect_says(refused.err, {"open beyond repair: a hole", "--largest-hole-mm "});
  EXPECT_FALSE(fs::exists(folder_.path() / "scene.json"));
  const auto filled = import_quickly("open.obj", {"--largest-hole-mm", "60"});
  EXPECT_EQ(filled.code, 0) << filled.err;
  expect_says(filled.out, {"1 hole, the widest", "filled", "next: ctpm record scene.json"});
  EXPECT_EQ(import("open.obj", {"--largest-hole-mm", "-1"}).code, 2);
}

TEST_F(ImportProgram, CrumbsFarAwayDoNotMakeTheOrganUnusuallyLarge) {
  write("crumb.obj", zoo::to_obj_text(zoo::both(bean(1, 3), zoo::sphere(3, 1, {150, 0, 0}))));
  const auto outcome = import("crumb.obj");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_says(report(), {"\"code\": \"unit_guessed\"", "\"code\": \"other_part\""});
  EXPECT_EQ(report().find("unusual_size"), std::string::npos) << outcome.out;
}

TEST_F(ImportProgram, ALabelMapIsListedAndALabelChosenByNameOrNumber) {
  if (!importers::reads_label_maps()) GTEST_SKIP() << "this build has no ITK";
  const std::string map = CTPM_SOURCE_DIR "/tests/importers/maps/names.seg.nrrd";
  const auto listed = run_ctpm({"import", map}, folder_.path());
  EXPECT_EQ(listed.code, 0) << listed.err;
  expect_says(listed.out,
              {": 2 labels", "     1      37.8 ml  left_kidney", "     7       2.1 ml  stone", "--label left_kidney"});
  const auto unchosen = import(map, {"--radius-mm", "3"});
  EXPECT_EQ(unchosen.code, 2);
  expect_says(unchosen.err, {"holds 2 labels", "choose one of left_kidney, stone"});
  EXPECT_FALSE(fs::exists(folder_.path() / "scene.json"));
  for (const std::string label : {"left_kidney", "1"}) {
    const auto outcome = import(map, {"--label", label, "--radius-mm", "4", "--stiffness-scale", "1", "--overwrite"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    expect_says(outcome.out, {"unit: mm (as the file says)", ", 37.8 ml"});
    EXPECT_EQ(run_ctpm({"check", "scene.json"}, folder_.path()).code, 0);
  }
  write("bean.obj", zoo::to_obj_text(bean()));
  EXPECT_EQ(import("bean.obj", {"--label", "1", "--overwrite"}).code, 2) << "a mesh has no labels";
  EXPECT_EQ(run_ctpm({"import", "bean.obj"}, folder_.path()).code, 2) << "only a label map needs no scene";
}

TEST_F(ImportProgram, ATetrahedralMeshBecomesASceneByItsBoundary) {
  const auto outcome = import(CTPM_SOURCE_DIR "/tests/importers/maps/text41.msh",
                              {"--part", "core", "--unit", "mm", "--radius-mm", "1"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_says(outcome.out, {", 1.6 ml"});
  EXPECT_EQ(run_ctpm({"check", "scene.json"}, folder_.path()).code, 0);
}

TEST_F(ImportProgram, NoOrganNeedsToBeNamedAndTheFolderIsMade) {
  write("thing.obj", zoo::to_obj_text(bean()));
  const auto outcome = run_ctpm({"import", "thing.obj", "-o", "my new/place/thing.json"}, folder_.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_says(outcome.out, {"taken as soft-tissue", "an estimate", "script: presses", "and cuts",
                            "next: ctpm record 'my new/place/thing.json' --script 'my new/place/thing.script.json'"});
  EXPECT_EQ(run_ctpm({"check", "my new/place/thing.json"}, folder_.path()).err, "");
}

TEST_F(ImportProgram, WhereTheTissueHardlyDampsItsFlapsTheIntegratorDoes) {
  write("bean.obj", zoo::to_obj_text(bean(1, 3)));
  for (const auto& [organ, is_damped] : {std::pair{"soft-tissue", false}, {"kidney", true}}) {
    const auto outcome = run_ctpm({"import", "bean.obj", "--organ", organ, "-o", "scene.json", "--unit", "mm",
                                   "--spheres", "120", "--stiffness-scale", "1", "--overwrite"},
                                  folder_.path());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto plan = run_ctpm({"plan", "scene.json", "--quick"}, folder_.path());
    expect_says(plan.out, {is_damped ? "sdirk2" : "backward-euler"});
    EXPECT_EQ(run_ctpm({"check", "scene.json"}, folder_.path()).err, "");
  }
}

TEST_F(ImportProgram, ARefusedImportLeavesNoFolderBehind) {
  write("open.obj", zoo::to_obj_text(zoo::without(bean(1, 3), [](Vec3 p) { return p.x > 0; })));
  EXPECT_EQ(run_ctpm({"import", "open.obj", "-o", "my/new/scene.json"}, folder_.path()).code, 2);
  EXPECT_FALSE(fs::exists(folder_.path() / "my"));
}

TEST_F(ImportProgram, SeparatePartsAreOrgansWhichStandAreTouchedAndCut) {
  const importers::RawMesh two = zoo::both(bean(1, 3), zoo::moved(bean(0.6, 3), [](Vec3 p) {
                                             return p + Vec3{120, 0, 0};
                                           }));
  write("two.obj", zoo::to_obj_text(two));
  const auto outcome = import_quickly("two.obj", {"--spheres", "200"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string text = report();
  EXPECT_EQ(text.find("\"script_cuts\": false"), std::string::npos);
  EXPECT_EQ(text.find("\"script_force_n\": 0,"), std::string::npos);
  const auto check = run_ctpm({"check", "scene.json"}, folder_.path());
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_EQ(check.err, "");
  const auto record =
      run_ctpm({"record", "scene.json", "--script", "scene.script.json", "-o", "cut.ctpm", "--fast"}, folder_.path());
  EXPECT_EQ(record.code, 0) << record.err;
  EXPECT_EQ(record.out.find(" 0 elements severed"), std::string::npos) << record.out;
}

TEST_F(ImportProgram, AnOrganIsAddedToASceneThatIsThereAndItsCommentsStay) {
  write("bean.obj", zoo::to_obj_text(bean(1, 3)));
  write("spleen.obj", zoo::to_obj_text(bean(0.8, 3)));
  ASSERT_EQ(import_quickly("bean.obj").code, 0);
  std::string commented = testing::slurp(folder_.path() / "scene.json");
  commented.insert(commented.find("\"tick_s\""), "// the author's own\n  ");
  commented.insert(commented.rfind('}'), "/* to the end */\n");
  write("scene.json", commented);
  const auto add = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"import", "spleen.obj", "--into",    "scene.json",
                                       "--unit", "mm",         "--spheres", "120"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return ctpm(arguments);
  };
  // In the same place, which is said; beside; elsewhere and turned.
  const auto within = add({});
  ASSERT_EQ(within.code, 0) << within.err;
  expect_says(within.out, {"% of the organ lies within organ kidney", "lay it beside, or give it another place"});
  write("scene.json", commented);
  const auto added = add({"--beside", "--overwrite"});
  ASSERT_EQ(added.code, 0) << added.err;
  EXPECT_EQ(added.out.find("lies within"), std::string::npos) << added.out;
  const std::string scene = testing::slurp(folder_.path() / "scene.json");
  expect_says(scene, {"\"name\": \"scene\"", "\"name\": \"kidney\"", "\"name\": \"spleen\"", "\"preset\": \"spleen\"",
                      "// the author's own\n", "/* to the end */"});
  const auto check = ctpm({"check", "scene.json"});
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_EQ(check.err, "") << "it stands, and the import's camera sees both";
  // The bean reaches 45 mm along x and stands on z = -25; the spleen, 36 and 20.
  double x = 0, y = 0, z = 0;
  ASSERT_EQ(std::sscanf(scene.c_str() + scene.find("\"at_mm\": ", scene.find("\"spleen\"")),
                        "\"at_mm\": [%lf, %lf, %lf]", &x, &y, &z),
            3);
  EXPECT_TRUE(x - 36 > 45 && x - 36 < 70) << x;
  EXPECT_NEAR(z - 20, -25, 1.5);
  const auto placed = add({"--at-mm", "0", "-150", "0", "--turn-deg", "0", "0", "90"});
  ASSERT_EQ(placed.code, 0) << placed.err;
  expect_says(testing::slurp(folder_.path() / "scene.json"),
              {"\"name\": \"spleen-2\"", "\"at_mm\": [0, -150, 0]", "\"turn_deg\": [0, 0, 90]"});
  EXPECT_EQ(ctpm({"check", "scene.json"}).err, "");
  EXPECT_EQ(add({"--beside", "--at-mm", "0", "0", "0"}).code, 2);
  // It is called what its author says that it is, before what its file is called.
  ASSERT_EQ(add({"--organ", "liver", "--at-mm", "0", "150", "0"}).code, 0);
  expect_says(testing::slurp(folder_.path() / "scene.json"), {"\"name\": \"liver\"", "\"scene-liver.obj\""});
}

TEST_F(ImportProgram, NumbersOfASceneAreThoseThatWereMeant) {
  write("bean.obj", zoo::to_obj_text(bean(1, 3)));
  for (const char* radius : {"4.5", "4.95", "5.15"}) {
    const auto made =
        import("bean.obj", {"--overwrite", "--unit", "mm", "--radius-mm", radius, "--at-mm", "0.1", "0.7", "-0.3"});
    ASSERT_EQ(made.code, 0) << made.err;
    const std::string scene = testing::slurp(folder_.path() / "scene.json");
    expect_says(scene, {std::string("\"radius_mm\": ") + radius + ",", "\"at_mm\": [0.1, 0.7, -0.3]"});
    for (std::size_t point = scene.find('.'); point != std::string::npos; point = scene.find('.', point + 1))
      EXPECT_LT(scene.find_first_not_of("0123456789", point + 1) - point, 8u) << scene.substr(point - 40, 80);
  }
}

TEST_F(ImportProgram, AnOrganGetsLayersFromTheSurfaceInwards) {
  write("bean.obj", zoo::to_obj_text(bean(1, 3)));
  const auto outcome = import_quickly("bean.obj", {"--layer", "skin:6", "--layer", "fat:14", "--spheres", "300"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string scene = testing::slurp(folder_.path() / "scene.json");
  expect_says(scene, {"\"to_depth_mm\": 6", "\"preset\": \"skin\"", "\"to_depth_mm\": 14", "\"preset\": \"fat\""});
  EXPECT_LT(scene.find("\"skin\""), scene.find("\"fat\""));
  EXPECT_EQ(ctpm({"check", "scene.json"}).err, "");
  const auto picture = ctpm({"preview", "scene.json", "--spheres", "--by", "material", "-o", "scene.png"});
  EXPECT_EQ(picture.code, 0) << picture.err;
  expect_says(picture.out,
              {"orange: kidney, skin down to 6 mm", "blue: kidney, fat down to 14 mm", "green: kidney, kidney below"});
  const auto deep = import_quickly("bean.obj", {"--layer", "skin:80", "--overwrite"});
  EXPECT_EQ(deep.code, 2);
  expect_says(deep.err, {"--layer", "--spheres"});
  for (const char* wrong : {"skin", "skin:", "skin:-1", ":5", "skin:x"})
    EXPECT_EQ(import_quickly("bean.obj", {"--layer", wrong, "--overwrite"}).code, 2) << wrong;
  expect_says(import_quickly("bean.obj", {"--layer", "hide:5", "--overwrite"}).err, {"--layer", "no preset 'hide'"});
}

TEST_F(ImportProgram, SeveralLabelsOfAMapAreOrgansOfOneScene) {
  if (!importers::reads_label_maps()) GTEST_SKIP() << "this build has no ITK";
  const std::string map = CTPM_SOURCE_DIR "/tests/importers/maps/names.seg.nrrd";
  const auto outcome = ctpm({"import", map, "--label", "left_kidney", "--label", "7", "--spheres", "300", "-o",
                             "scene.json", "--report", "report.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_says(outcome.out, {"organ left_kidney", ", 37.8 ml", "organ stone", ", 2.1 ml"});
  expect_says(testing::slurp(folder_.path() / "scene.json"), {"\"name\": \"left_kidney\"", "\"preset\": \"kidney\"",
                                                              "\"name\": \"stone\"", "\"preset\": \"soft-tissue\""});
  EXPECT_EQ(ctpm({"check", "scene.json"}).code, 0);
}

TEST_F(ImportProgram, SlowMoreHertzAreFewerSpheres) {
  write("bean.obj", zoo::to_obj_text(bean(1, 3)));
  const auto spheres_for = [&](const std::string& khz) {
    const auto outcome =
        import("bean.obj", {"--unit", "mm", "--stiffness-scale", "1", "--for-khz", khz, "--overwrite"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    // Judged where the script presses and cuts: what does not hold the rate there says so.
    const double p99 = std::stod(report().substr(report().find("\"tick_time_p99_s\": ") + 19));
    EXPECT_GT(p99, 0);
    EXPECT_EQ(p99 > 1e-3 / std::stod(khz), report().find("\"too_slow\"") != std::string::npos) << khz << ": " << p99;
    return std::stoi(report().substr(report().find("\"spheres\": ") + 11));
  };
  const int few = spheres_for("20"), many = spheres_for("1");
  EXPECT_GE(few, 50);
  EXPECT_GT(many, few) << "a tick may take twenty times as long, so that a busy machine does not matter";
  EXPECT_EQ(import("bean.obj", {"--for-khz", "1", "--spheres", "300", "--overwrite"}).code, 2) << "one of them";
}

TEST_F(ImportProgram, WhatIsOddAboutVolumeAndPressIsAFinding) {
  // Tissue that overlaps itself counts once in the spheres and twice in the mesh.
  const importers::RawMesh ball = zoo::sphere(30, 3);
  write("overlap.obj", zoo::to_obj_text(zoo::both(ball, zoo::moved(ball, [](Vec3 p) { return p + Vec3{25, 0, 0}; }))));
  ASSERT_EQ(import_quickly("overlap.obj", {"--all-parts"}).code, 0);
  expect_says(report(), {"\"code\": \"volume\"", "the spheres stand for "});
  // The paper's press of 12 mm into something 30 mm high.
  write("flat.obj", zoo::to_obj_text(zoo::moved(bean(1, 3), [](Vec3 p) { return Vec3{p.x, p.y, 0.6 * p.z}; })));
  const auto flat = import("flat.obj", {"--unit", "mm", "--spheres", "200", "--overwrite"});
  ASSERT_EQ(flat.code, 0) << flat.err;
  expect_says(report(), {"\"code\": \"press_too_deep\""});
  expect_says(flat.out, {"not fitted: a press of 12 mm is deeper than a third of the organ"});
  // A tall egg gives way to the side: only a much stiffer one would resist like the paper's organ.
  write("egg.obj", zoo::to_obj_text(zoo::moved(zoo::sphere(1, 3), [](Vec3 p) {
          return Vec3{25 * p.x, 25 * p.y, 100 * p.z};
        })));
  const auto egg = import("egg.obj", {"--unit", "mm", "--spheres", "200", "--overwrite"});
  ASSERT_EQ(egg.code, 0) << egg.err;
  expect_says(report(), {"\"code\": \"stiffness_scale\"", "outside of 0.1 to 10", "check the organ's unit and size"});
  EXPECT_EQ(testing::slurp(folder_.path() / "scene.json").find("stiffness_scale"), std::string::npos);
}

/// What `ctpm` shows on a terminal.
std::string shown_on_terminal(const std::vector<std::string>& arguments, const fs::path& folder) {
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    std::vector<char*> argv{const_cast<char*>(CTPM_PROGRAM)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    if (::chdir(folder.c_str()) == 0) ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  std::string shown;
  char part[4096];
  for (ssize_t got; (got = ::read(terminal, part, sizeof part)) > 0;) shown.append(part, std::size_t(got));
  ::close(terminal), ::waitpid(child, nullptr, 0);
  return shown;
}

TEST_F(ImportProgram, OnATerminalItSaysFromTheBeginningWhatItDoes) {
  write("bean.obj", zoo::to_obj_text(bean()));
  const std::string shown = shown_on_terminal(
      {"import", "bean.obj", "--organ", "kidney", "--spheres", "400", "-o", "my/scene.json"}, folder_.path());
  constexpr const char* kLine = "\r\033[Kimporting";
  EXPECT_TRUE(shown.starts_with(kLine)) << "before anything else: " << shown;
  EXPECT_LT(shown.find("settling"), shown.find("written: my/scene.json")) << shown;
  double last = 0;
  for (std::size_t at = 0; (at = shown.find(std::string(kLine) + ": ", at)) != std::string::npos; ++at) {
    const double percent = std::stod(shown.substr(at + std::string(kLine).size() + 2, 5));
    EXPECT_GE(percent, last);
    last = percent;
  }
  EXPECT_GE(last, 70);
}

TEST_F(ImportProgram, WhatCannotBeRecordedOrComesApartIsRefusedWithWhatWouldHelp) {
  write("far.obj", zoo::to_obj_text(zoo::both(bean(1, 3), zoo::moved(bean(1, 3), [](Vec3 p) {
                                                return p + Vec3{2500, 1500, 1500};
                                              }))));
  const auto far = import("far.obj", {"--unit", "mm", "--spheres", "200"});
  EXPECT_EQ(far.code, 2);
  expect_says(far.err, {"the organs together are 2.6 x 1.6 x 1.6 m large", "3.2 m^3", "--size-mm"});
  // Two beads on a thread that is too thin for spheres.
  write("beads.obj", zoo::to_obj_text(zoo::moved(zoo::sphere(1, 4), [](Vec3 p) {
          const double thick = std::abs(p.x) < 0.4 ? 0.02 : 20;
          return Vec3{60 * p.x, thick * p.y, thick * p.z};
        })));
  const auto beads = import("beads.obj", {"--unit", "mm", "--spheres", "200"});
  EXPECT_EQ(beads.code, 2);
  expect_says(beads.err, {"falls apart where it is thin", "--spheres"});
  EXPECT_FALSE(fs::exists(folder_.path() / "scene.json"));
}

/// The commands of README's first scene, as they stand there.
std::vector<std::string> first_commands() {
  const std::string readme = testing::slurp(CTPM_SOURCE_DIR "/README.md");
  const std::size_t begin = readme.find("```\n", readme.find("first scene of two organs")) + 4;
  std::vector<std::string> commands;
  std::istringstream lines(readme.substr(begin, readme.find("```", begin) - begin));
  for (std::string line; std::getline(lines, line);) commands.push_back(line.substr(0, line.find("  #")));
  return commands;
}

TEST_F(ImportProgram, TheFiveCommandsOfTheReadmeMakeASceneOfTwoOrgans) {
  const std::vector<std::string> commands = first_commands();
  ASSERT_EQ(commands.size(), 5u);
  write("my-liver.stl", zoo::to_binary_stl(zoo::moved(bean(2, 3), [](Vec3 p) { return p + Vec3{40, 300, 900}; })));
  write("my-kidney.obj", zoo::to_obj_text(bean(0.1, 3)));
  for (const std::string& command : commands) {
    ASSERT_EQ(command.substr(0, 7), "./ctpm ") << command;
    std::vector<std::string> arguments;
    std::istringstream words(command.substr(7));
    for (std::string word; words >> word;) arguments.push_back(word);
    const auto outcome = ctpm(arguments);
    EXPECT_EQ(outcome.code, 0) << command << "\n" << outcome.err;
    EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << command << "\n" << outcome.err;
    EXPECT_EQ(outcome.out.find(" 0 elements severed"), std::string::npos) << outcome.out;
  }
  expect_says(testing::slurp(folder_.path() / "my/liver.json"),
              {"\"preset\": \"liver\"", "\"preset\": \"kidney\"", "\"to_depth_mm\""});
  EXPECT_GT(fs::file_size(folder_.path() / "my/liver.png"), 10000u);
  EXPECT_EQ(ctpm({"verify", "my/first.ctpm"}).code, 0);
}

TEST_F(ImportProgram, TheSizeAndTheNumberOfSpheresAreThoseThatWereAskedFor) {
  write("bean.obj", zoo::to_obj_text(bean(0.013)));
  const auto outcome = import("bean.obj", {"--size-mm", "100", "--spheres", "500"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string text = report();
  const auto number = [&](const std::string& key) {
    return std::stod(text.substr(text.find("\"" + key + "\": ") + key.size() + 4));
  };
  EXPECT_NEAR(number("spheres"), 500, 50);
  const auto box = [&](const std::string& key) {
    double x = 0, y = 0, z = 0;
    std::sscanf(text.c_str() + text.find("\"" + key + "\": ") + key.size() + 4, "[%lf, %lf, %lf]", &x, &y, &z);
    return Vec3{x, y, z};
  };
  EXPECT_NEAR(norm(box("box_most_mm") - box("box_least_mm")), 100, 0.01) << text;
}

TEST_F(ImportProgram, AnAuthorsOwnMaterialLiesBesideTheScene) {
  write("bean.obj", zoo::to_obj_text(bean()));
  write("materials.json", R"({"format": "ctpm-materials", "version": 1,
    "materials": [{"name": "tumour", "preset": "kidney", "stiffness_scale": 2.5}]})");
  const auto outcome = run_ctpm({"import", "bean.obj", "--organ", "tumour", "-o", "scene.json"}, folder_.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_says(testing::slurp(folder_.path() / "scene.json"), {"\"preset\": \"kidney\"", "\"stiffness_scale\": 2.5"});
  const auto unknown = run_ctpm({"import", "bean.obj", "--organ", "tumor", "-o", "other.json"}, folder_.path());
  EXPECT_EQ(unknown.code, 2);
  expect_says(unknown.err, {"known: tumour, liver"});
}

TEST_F(ImportProgram, AnOrganThatFoldsOverIsRefusedWithWhatWouldHelp) {
  // A metre-long rope of fat, held at one end.
  write("rope.obj", zoo::to_obj_text(zoo::box({1000, 40, 40}, 20)));
  const auto outcome = run_ctpm({"import", "rope.obj", "--organ", "fat", "--unit", "mm", "--anchor",
                                 "plane:-450,0,0,1,0,0", "--spheres", "300", "-o", "my/rope.json"},
                                folder_.path());
  EXPECT_EQ(outcome.code, 2);
  expect_says(outcome.err, {"folds over under its own weight", "--anchor", "--size-mm", "--stiffness-scale"});
  EXPECT_FALSE(fs::exists(folder_.path() / "my"));
}

TEST_F(ImportProgram, CheckWarnsOfWhatIsOddAndPlanOfAScriptThatMisses) {
  write("bean.obj", zoo::to_obj_text(bean(1, 3)));
  ASSERT_EQ(import_quickly("bean.obj").code, 0);
  const std::string good = testing::slurp(folder_.path() / "scene.json");
  const auto with = [&](const std::string& key, const std::string& text) {
    std::string odd = good;
    const std::size_t at = odd.find("\"" + key + "\": ");
    odd.insert(at == std::string::npos ? odd.find("\"organs\"") : at, text);
    return odd;
  };
  write("probe.json", with("-", "\"probes\": [{\"name\": \"far\", \"at_mm\": [0, 0, 500]}], "));
  write("load.json", with("-", "\"loads\": [{\"at_mm\": [0, 900, 0], \"force_n\": [0, 0, 1]}], "));
  std::string free = good;
  const std::size_t lowest = free.find("\"lowest_mm\": ", free.find("\"anchors\""));
  free.replace(lowest, free.find('}', lowest) - lowest, "\"lowest_mm\": 999");
  write("held.json", free);
  EXPECT_EQ(run_ctpm({"check", "scene.json"}, folder_.path()).out.find("warning"), std::string::npos);
  for (const auto& [scene, warning] : {std::pair{"probe.json", "from the nearest tissue"},
                                       {"load.json", "the nearest tissue would be pulled"},
                                       {"held.json", "hold every sphere"}}) {
    const auto check = run_ctpm({"check", scene}, folder_.path());
    EXPECT_EQ(check.code, 0) << check.err;
    expect_says(check.err, {warning, std::string(scene) + ":"});
    expect_says(check.out, {std::string(scene) + ": good, ", " elements, 1 warning\n"});
  }
  write("miss.json", R"({"format": "ctpm-script", "version": 1, "steps": [
    {"take": {"tool": "ball", "at_mm": [0, 0, 400]}}, {"wait_s": 0.05}]})");
  const auto plan = run_ctpm({"plan", "scene.json", "--script", "miss.json"}, folder_.path());
  EXPECT_EQ(plan.code, 0) << plan.err;
  expect_says(plan.err, {"miss.json: warning: never touches any tissue"});
  EXPECT_EQ(run_ctpm({"plan", "scene.json", "--script", "scene.script.json"}, folder_.path()).err.find("never"),
            std::string::npos);
}

}  // namespace
}  // namespace ctpm
