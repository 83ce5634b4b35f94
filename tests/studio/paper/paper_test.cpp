// The experiments of the paper give what must hold, and its report is whole.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "core/stepping/step.h"
#include "scenes/presets.h"
#include "studio/paper/paper.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;

const std::string kScenes = std::string(CTPM_SOURCE_DIR) + "/scenes";

/// All that must hold of an experiment does; the number of such claims is counted, so that none goes missing.
void expect_met(const Result<paper::Experiment>& experiment, std::size_t count) {
  ASSERT_TRUE(experiment) << to_string(experiment.errors().front());
  std::size_t asked = 0;
  for (const paper::Claim& claim : experiment->claims) {
    EXPECT_NE(claim.verdict(), reports::ReportVerdict::missed)
        << claim.organ << " " << claim.structure << " " << claim.viscosity << " " << claim.quantity << ": "
        << claim.error_to_closed_form() << ", paper " << claim.error_to_paper();
    asked += claim.verdict() == reports::ReportVerdict::met ? 1 : 0;
  }
  EXPECT_EQ(asked, count);
}

TEST(Paper, TheRigGivesTable1AndAllEighteenLambdas) {
  const Result<paper::Experiment> experiment = paper::run_table_1(kScenes);
  expect_met(experiment, 3 * 6 * 3);
  int close = 0, lambdas = 0;
  for (const paper::Claim& c : experiment->claims) {
    if (c.quantity.starts_with("lambda")) ++lambdas;
    if (c.quantity.starts_with("force") && std::abs(c.error_to_paper()) <= 0.10) ++close;
  }
  EXPECT_EQ(lambdas, 18);
  EXPECT_EQ(close, 28);  // the others are the paper's own scatter
}

TEST(Paper, TheRigRelaxesAsEquation10) { expect_met(paper::run_relaxation(kScenes), 3 * 2 * 2); }

TEST(Paper, TheRigCreepsAsEquation10AndTheMeasuredRangesAreNamed) {
  const Result<paper::Experiment> experiment = paper::run_creep(kScenes);
  // Two rows for each load and reading, one more for each load; one of them is not asked for.
  expect_met(experiment, 2 * 2 * 2 + 2 - 1);
  for (const paper::Claim& c : experiment->claims) {
    if (c.verdict() == reports::ReportVerdict::shown) {
      EXPECT_NE(c.quantity.find("under 0.98 N"), std::string::npos);
      EXPECT_EQ(c.viscosity, "kPa s");
      EXPECT_GT(c.error_to_closed_form(), 0.020);
      EXPECT_LT(c.error_to_closed_form(), 0.025);
      EXPECT_NE(c.note.find("more than the 1 %"), std::string::npos);
    }
    if (!c.quantity.starts_with("depth after")) continue;
    const bool is_large = c.quantity.find("0.98") != std::string::npos;
    EXPECT_NEAR(*c.network, is_large ? 10.36 : 2.22, 0.02);
    EXPECT_NE(c.note.find(is_large ? "inside" : "outside"), std::string::npos);
  }
}

TEST(Paper, UnderAForceMassSpringSwingsAndCtpmCreeps) { expect_met(paper::run_load(kScenes, false), 4); }

TEST(Paper, AfterACutMassSpringWandersAndCtpmSeparatesAndSettles) { expect_met(paper::run_cut(kScenes, false), 6); }

class EveryModel : public ::testing::TestWithParam<network::Structure> {};

TEST_P(EveryModel, FilledWithRAndHalfAndQuarterConvergesWithOrderOne) {
  Result<loading::LoadedScene> scene = loading::load_whole_scene(kScenes + "/paper/convergence-liver.json");
  ASSERT_TRUE(scene) << to_string(scene.errors().front());
  scene->scene.spec.organs[0].rig->block = Vec3{4, 4, 3};
  const Result<paper::Refinement> refined = paper::refine(*scene, {"", GetParam(), false, ""});
  ASSERT_TRUE(refined) << to_string(refined.errors().front());
  ASSERT_EQ(refined->fillings.size(), 3u);
  EXPECT_EQ(refined->fillings[2].spheres, 64 * refined->fillings[0].spheres);
  EXPECT_EQ(refined->fillings[2].radius, 1);
  EXPECT_GT(refined->fillings[0].sag, 0);
  // A coarse block has an order that is still on its way to one.
  EXPECT_GT(refined->order(), 0.6);
  EXPECT_LT(refined->order(), 1.4);
  RecordProperty("order", std::to_string(refined->order()));
}

INSTANTIATE_TEST_SUITE_P(Paper, EveryModel,
                         ::testing::Values(network::Structure::mass_spring, network::Structure::angle_mass_spring,
                                           network::Structure::tpm, network::Structure::ctpm));

TEST(Paper, ARefinementKnowsItsOrderAndItsLimit) {
  const paper::Refinement first{{{4, 1, 1.8}, {2, 8, 1.9}, {1, 64, 1.95}}};  // 2 - 0.05 r
  EXPECT_NEAR(first.order(), 1, 1e-12);
  EXPECT_NEAR(first.limit(), 2, 1e-12);
  const paper::Refinement second{{{4, 1, 2.16}, {2, 8, 2.04}, {1, 64, 2.01}}};  // 2 + 0.01 r^2
  EXPECT_NEAR(second.order(), 2, 1e-12);
  EXPECT_NEAR(second.limit(), 2, 1e-12);
}

TEST(Paper, AClaimBeyondItsBoundIsMissed) {
  paper::Claim claim{
      .experiment = "x", .organ = "x", .structure = "x", .quantity = "x", .closed_form = 1.0, .network = 1.02};
  EXPECT_EQ(claim.verdict(), reports::ReportVerdict::shown);
  claim.closed_form_bound = 0.01;
  EXPECT_EQ(claim.verdict(), reports::ReportVerdict::missed);
  claim.closed_form_bound = 0.03;
  EXPECT_EQ(claim.verdict(), reports::ReportVerdict::met);
  claim.network = std::nan("");
  EXPECT_EQ(claim.verdict(), reports::ReportVerdict::missed);
}

TEST(Paper, MotionOfADampedSwingIsFound) {
  reports::Series swing;
  for (int i = 0; i <= 4000; ++i) {
    const double t = 1e-3 * i;
    swing.x.push_back(t), swing.y.push_back(1 - std::exp(-3 * t) * std::cos(2 * 3.14159265358979 * 5 * t));
  }
  const paper::StepResponse motion = paper::step_response_of(swing);
  EXPECT_NEAR(motion.rest, 1, 1e-4);
  EXPECT_NEAR(motion.overshoot, std::exp(-0.3), 0.02);  // at half a period
  EXPECT_NEAR(motion.settling_time, 1.0, 0.1);          // exp(-3 t) = 0.05
  EXPECT_NEAR(motion.reversals, 23, 2);                 // ten a second until exp(-3 t) = 0.001
}

/// Elements of a page that are opened and not closed, or closed wrongly; empty if it is balanced.
std::string unbalanced(const std::string& html) {
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos) return "a tag never ends";
    const std::string tag = html.substr(at + 1, end - at - 1);
    if (tag.starts_with("!") || tag.ends_with("/")) continue;
    const bool closes = tag.starts_with("/");
    const std::string name = tag.substr(closes ? 1 : 0, tag.find_first_of(" \n", 1) - (closes ? 1 : 0));
    if (!closes)
      open.push_back(name);
    else if (open.empty() || open.back() != name)
      return "</" + name + "> closes " + (open.empty() ? "nothing" : open.back());
    else
      open.pop_back();
  }
  return open.empty() ? "" : open.back() + " stays open";
}

paper::PaperResults small_results() {
  paper::PaperResults results;
  reports::Section section;
  section.key = "creep", section.title = "A <title> & \"quotes\"", section.paragraphs = {"1 < 2"};
  section.plots = {{.title = "plot",
                    .x_title = "t [s]",
                    .y_title = "f [N]",
                    .series = {{.name = "a", .x = {0, 1, std::nan("")}, .y = {1, 2, 3}},
                               {.name = "b", .x = {0.5}, .y = {1.5}, .stroke = reports::Stroke::path}},
                    .bands = {{"range", 1, 2, 2}}}};
  section.pictures = {{render::blank_frame(32, 16, 200, 10, 10), "picture"}};
  results.sections = {section};
  results.claims = {{.experiment = "creep",
                     .organ = "liver",
                     .structure = "CTPM",
                     .quantity = "depth, \"large\" [mm]",
                     .closed_form = 2,
                     .network = 2.001,
                     .closed_form_bound = 0.01}};
  return results;
}

std::string slurp(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

TEST(Report, IsOneBalancedPageThatLoadsNothing) {
  const fs::path folder = fs::temp_directory_path() / ("ctpm-paper-" + std::to_string(getpid())) / "deep";
  const Result<Done> written = paper::write_paper_report(folder.string(), small_results());
  ASSERT_TRUE(written) << to_string(written.errors().front());
  const std::string html = slurp(folder / "report.html");
  EXPECT_EQ(unbalanced(html), "");
  EXPECT_EQ(unbalanced("<p><b></p>"), "</p> closes b");
  EXPECT_NE(html.find("A &lt;title&gt; &amp; &quot;quotes&quot;"), std::string::npos);
  EXPECT_NE(html.find("src=\"data:image/png;base64,iVBOR"), std::string::npos);
  EXPECT_EQ(html.find("src=\"http"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_NE(slurp(folder / "results.csv").find("\"depth, \"\"large\"\" [mm]\""), std::string::npos);
  EXPECT_NE(slurp(folder / "results.json").find("\"verdict\": \"met\""), std::string::npos);
  // Nothing but the three files: no temporary ones are left.
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 3);
  fs::remove_all(folder.parent_path());
}

TEST(Report, AFolderThatCannotBeMadeIsAnError) {
  const fs::path file = fs::temp_directory_path() / ("ctpm-paper-file-" + std::to_string(getpid()));
  std::ofstream(file) << "in the way";
  const std::string folder = (file / "report").string();
  const Result<Done> ready = reports::prepare_folder(folder),
                     written = paper::write_paper_report(folder, small_results());
  fs::remove(file);
  ASSERT_FALSE(ready);
  ASSERT_FALSE(written);
  EXPECT_EQ(ready.errors().front().where, folder);
}

}  // namespace
}  // namespace ctpm
