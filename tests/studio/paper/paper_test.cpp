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
void expect_met(const Result<paper::Experiment>& experiment, std::int64_t count) {
  ASSERT_TRUE(experiment) << to_string(experiment.errors().front());
  std::int64_t asked = 0;
  for (const paper::Claim& claim : experiment->claims) {
    if (!paper::must_hold(claim.kind)) continue;
    EXPECT_NE(claim.verdict(), reports::ReportVerdict::missed)
        << claim.organ << " " << claim.structure << " " << claim.viscosity << " " << claim.quantity << ": "
        << claim.error();
    asked += claim.verdict() == reports::ReportVerdict::met ? 1 : 0;
  }
  EXPECT_EQ(asked, count);
}

/// The value of the network in the only claim whose quantity begins so, with this viscosity.
double network_of(const paper::Experiment& experiment, const std::string& quantity, const std::string& viscosity) {
  double value = std::nan("");
  int found = 0;
  for (const paper::Claim& c : experiment.claims)
    if (c.quantity.starts_with(quantity) && c.viscosity == viscosity && c.network) value = *c.network, ++found;
  EXPECT_EQ(found, 1) << quantity;
  return value;
}

/// The number in a table's row whose first columns hold these words.
double number_in(const reports::Table& table, const std::vector<std::string>& words, const std::string& key) {
  for (const auto& row : table.rows) {
    bool is_it = true;
    for (std::size_t i = 0; i < words.size(); ++i) {
      const auto* text = std::get_if<std::string>(&row[i]);
      is_it = is_it && text && *text == words[i];
    }
    if (!is_it) continue;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (table.columns[i].key != key) continue;
      if (const auto* count = std::get_if<std::int64_t>(&row[i])) return double(*count);
      return std::get<double>(row[i]);
    }
  }
  ADD_FAILURE() << "no row " << words.front() << " with " << key;
  return std::nan("");
}

TEST(Paper, TheRigGivesTheClosedFormsAndTheyGive28Of36ForcesAndAllLambdasOfTable1) {
  const Result<paper::Experiment> experiment = paper::run_table_1(kScenes);
  expect_met(experiment, 3 * 6 * 3);
  int forces = 0, lambdas = 0;
  for (const paper::Claim& c : experiment->claims) {
    if (c.kind != paper::ClaimKind::print) continue;
    EXPECT_FALSE(c.network) << "print is compared with the closed form";
    const bool is_met = c.verdict() == reports::ReportVerdict::met;
    (c.quantity.starts_with("lambda") ? lambdas : forces) += is_met ? 1 : 0;
  }
  EXPECT_EQ(lambdas, 18);
  EXPECT_EQ(forces, 28);  // the others are the paper's own scatter
  EXPECT_EQ(paper::count_claims(experiment->claims, paper::ClaimKind::print).missed, 8);
  EXPECT_TRUE(paper::network_holds(experiment->claims)) << "a miss of print is no failure";
}

TEST(Paper, TheRigRelaxesAsEquation10) { expect_met(paper::run_relaxation(kScenes), 3 * 2 * 2); }

TEST(Paper, TheRigCreepsAsEquation10IntoOneOfTheTwoMeasuredRanges) {
  const Result<paper::Experiment> experiment = paper::run_creep(kScenes);
  // Two rows for each load and reading, one more for each load; one of them is not asked for.
  expect_met(experiment, 2 * 2 * 2 + 2 - 1);
  int ranges = 0;
  for (const paper::Claim& c : experiment->claims) {
    if (c.verdict() == reports::ReportVerdict::shown) {
      EXPECT_NE(c.quantity.find("under 0.98 N"), std::string::npos);
      EXPECT_EQ(c.viscosity, "kPa s");
      EXPECT_GT(c.error(), 0.020);
      EXPECT_LT(c.error(), 0.025);
      EXPECT_NE(c.note.find("more than the 1 %"), std::string::npos);
    }
    if (c.kind != paper::ClaimKind::print) continue;
    ++ranges;
    const bool is_large = c.quantity.find("0.98") != std::string::npos;
    EXPECT_EQ(c.verdict(), is_large ? reports::ReportVerdict::met : reports::ReportVerdict::missed);
    EXPECT_NEAR(*c.closed_form, is_large ? 10.36 : 2.22, 0.02);
    EXPECT_NEAR(c.error(), is_large ? 0 : 2.2217 / 3.8 - 1, 1e-4);
  }
  EXPECT_EQ(ranges, 2);
}

TEST(Paper, SlowUnderAForceCtpmSwingsLessThanMassSpringAndDoesNotTurnRoundLessOften) {
  const Result<paper::Experiment> experiment = paper::run_load(kScenes, false);
  expect_met(experiment, 0);
  const std::vector<reports::Table>& tables = experiment->section.tables;
  ASSERT_EQ(tables.size(), 3u);
  const reports::Table &approached = tables[0], &sudden = tables[1], &checks = tables[2];
  const auto of = [&](const reports::Table& table, const char* model, const char* viscosity, const char* key) {
    return number_in(table, {model, viscosity}, key);
  };
  EXPECT_LT(of(sudden, "CTPM", "kPa s", "overshoot_percent"), 1);
  EXPECT_GT(of(sudden, "mass-spring", "", "overshoot_percent"), 50);
  EXPECT_GT(of(sudden, "CTPM", "kPa s", "reversals"), of(sudden, "mass-spring", "", "reversals"));
  EXPECT_LT(20 * of(sudden, "CTPM", "kPa s", "late_swing_percent"),
            of(sudden, "mass-spring", "", "late_swing_percent"));
  EXPECT_EQ(of(approached, "CTPM", "kPa s", "reversals"), 0);
  // With the viscosity as printed CTPM hardly creeps.
  EXPECT_GT(of(sudden, "CTPM", "Pa s", "overshoot_percent"), 50);
  // Dashpots do the same for mass-spring.
  EXPECT_EQ(of(sudden, "damped mass-spring", "kPa s", "reversals"), 0);
  EXPECT_LT(of(sudden, "damped mass-spring", "kPa s", "overshoot_percent"), 1);

  // Neither half the step nor an integrator without damping changes what is compared.
  const auto check = [&](const char* model, std::size_t row, const char* key) {
    std::vector<double> values;
    for (const auto& cells : checks.rows)
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (checks.columns[i].key == key && std::get<std::string>(cells[0]) == model)
          values.push_back(std::holds_alternative<double>(cells[i]) ? std::get<double>(cells[i])
                                                                    : double(std::get<std::int64_t>(cells[i])));
    return values.at(row);
  };
  EXPECT_EQ(check("mass-spring", 1, "step_ms"), 0.5 * check("mass-spring", 0, "step_ms"));
  for (const std::size_t row : {std::size_t(1), std::size_t(2)}) {  // half the step, leapfrog
    EXPECT_NEAR(check("mass-spring", row, "overshoot_percent"), check("mass-spring", 0, "overshoot_percent"), 0.1);
    EXPECT_NEAR(check("mass-spring", row, "reversals"), check("mass-spring", 0, "reversals"), 2);
  }
  EXPECT_NEAR(check("CTPM, kPa s", 1, "reversals"), check("CTPM, kPa s", 0, "reversals"), 2);
  EXPECT_NEAR(check("CTPM, kPa s", 1, "late_swing_percent"), check("CTPM, kPa s", 0, "late_swing_percent"), 0.1);
}

TEST(Paper, ComparedModelsAreStaticallyAlike) {
  const Result<loading::LoadedScene> scene = paper::load_experiment(kScenes, "paper/block-liver.json");
  ASSERT_TRUE(scene) << to_string(scene.errors().front());
  const auto static_depth = [&](const paper::Variant& variant) {
    const Result<scenes::BuiltScene> built = paper::build_variant(*scene, variant, [](scenes::SceneSpec&) {});
    if (!built) return std::nan("");
    EXPECT_EQ(built->model.solver.integrator, Integrator::sdirk2);
    const auto c = std::size_t(built->probe_sphere[0]);
    const Result<double> depth = paper::at_rest(built->model, "block", [&](const State& state) {
      return built->model.rest_position.z[c] - state.position.z[c];
    });
    return depth ? *depth : std::nan("");
  };
  const double springs = static_depth({"mass-spring", network::Structure::mass_spring, false, ""});
  EXPECT_GT(springs, 0);
  // Springs, springs with dashpots and two-sphere TPMs of twice the moduli are one static network.
  const double damped = static_depth({"", network::Structure::mass_spring, false, "", 1, true}),
               tpm = static_depth({"", network::Structure::tpm, false, "", paper::kTpmStiffness});
  EXPECT_NEAR(damped, springs, 1e-5 * springs);
  EXPECT_NEAR(tpm, springs, 1e-5 * springs);
  EXPECT_GT(static_depth({"", network::Structure::tpm, false, ""}), 1.9 * springs);
  // CTPM differs by its constraint, its softening and the ends of its lines.
  EXPECT_NEAR(static_depth({"", network::Structure::ctpm, false, ""}), springs, 0.03 * springs);
}

TEST(Paper, SlowAfterACutDampedModelsStayUndampedMassSpringWandersAndOnlyATenseCapsuleOpensTheCut) {
  const Result<paper::Experiment> experiment = paper::run_cut(kScenes, false);
  expect_met(experiment, 0);
  const std::vector<reports::Table>& tables = experiment->section.tables;
  ASSERT_EQ(tables.size(), 2u);
  const auto spread = [&](const char* model, const char* viscosity, const char* tension, const char* integrator,
                          const char* point, const char* key) {
    return number_in(tables[0], {model, viscosity, tension, integrator, point}, key);
  };
  for (const char* point : {"A", "B", "C", "D"}) {
    // Without numerical damping. Under sdirk2 the swing of the present, stiffer scene is too fast for its steps. It is
    // chaotic: what eight places of it make of another way there is of no more use than a throw of eight dice.
    const double wandering = spread("mass-spring", "", "yes", "leapfrog", point, "way_spread_mm");
    EXPECT_GT(wandering, 0.1) << point;
    for (const char* key : {"spread_mm", "way_spread_mm"}) {
      EXPECT_LT(spread("CTPM", "kPa s", "yes", "sdirk2", point, key), 1e-3) << point;
      EXPECT_LT(spread("CTPM", "kPa s", "no", "sdirk2", point, key), 1e-3) << point;
      EXPECT_LT(spread("damped mass-spring", "kPa s", "yes", "sdirk2", point, key), 1e-3) << point;
    }
    RecordProperty(std::string("spread_") + point, std::to_string(wandering));
    std::printf("%s: mass-spring %.4f mm all the while, %.4f mm of eight places\n", point, wandering,
                spread("mass-spring", "", "yes", "leapfrog", point, "spread_mm"));
  }
  for (const char* side : {"opening between A and C", "opening between B and D"}) {
    EXPECT_LT(network_of(*experiment, std::string(side) + ", no tension", "kPa s"), 0);
    EXPECT_GT(network_of(*experiment, std::string(side) + ", capsule", "kPa s"), 5);
  }
}

TEST(Paper, NothingMovesBeforeAnExperiment) {
  const Result<loading::LoadedScene> scene = paper::load_experiment(kScenes, "incision.json");
  ASSERT_TRUE(scene) << to_string(scene.errors().front());
  const Result<scenes::BuiltScene> built = paper::build_variant(
      *scene, {"mass-spring", network::Structure::mass_spring, false, ""}, [](scenes::SceneSpec&) {});
  ASSERT_TRUE(built) << to_string(built.errors().front());
  const Result<State> state = paper::settled(built->model, "incision");
  ASSERT_TRUE(state) << to_string(state.errors().front());
  double fastest = 0, farthest = 0;
  for (std::size_t i = 0; i < built->model.sphere_count(); ++i)
    fastest = std::max(fastest, norm(state->velocity[i])),
    farthest = std::max(farthest, norm(state->position[i] - built->model.rest_position[i]));
  EXPECT_LE(fastest, 1e-5);
  EXPECT_GT(farthest, 1e-3) << "gravity and the capsule's tension have acted";
}

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

TEST(Paper, AModelThatMovesByRoundingAloneIsAtRest) {
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(kScenes + "/paper/convergence-liver.json");
  ASSERT_TRUE(scene) << to_string(scene.errors().front());
  Model weightless = scene->built.model;
  weightless.gravity = {};
  double rounding = 1e-17;
  const Result<double> way = paper::at_rest(weightless, "block", [&](const State&) { return rounding = -rounding; });
  ASSERT_TRUE(way) << to_string(way.errors().front());
  EXPECT_NEAR(*way, 0, 1e-15);
}

TEST(Paper, SlowWhatTensionDoesToTheUnloadedLiverIsNoSag) {
  Result<loading::LoadedScene> scene = loading::load_whole_scene(kScenes + "/liver.json");
  ASSERT_TRUE(scene) << to_string(scene.errors().front());
  scenes::OrganSpec& organ = scene->scene.spec.organs[0];
  organ.fill.radius = organ.fill.gap = 0.008;
  const auto refined = [&] { return paper::refine(*scene, {"", network::Structure::ctpm, false, ""}); };
  const Result<paper::Refinement> tense = refined();
  organ.material.prestrain = 0.0;
  for (scenes::LayerSpec& layer : organ.layers) layer.material.prestrain = 0.0;
  const Result<paper::Refinement> slack = refined();
  ASSERT_TRUE(tense && slack);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GT(slack->fillings[i].sag, 0);
    EXPECT_NEAR(tense->fillings[i].sag / slack->fillings[i].sag, 1, 0.25) << tense->fillings[i].radius;
  }
  for (std::size_t i = 1; i < 3; ++i) EXPECT_NEAR(tense->fillings[i].held, tense->fillings[0].held, 1e-6);
  EXPECT_GT(tense->order(), 0.5) << "the same solid on the same foot";
}

TEST(Paper, ARefinementKnowsItsOrderAndItsLimit) {
  const paper::Refinement first{{{4, 1, 1.8}, {2, 8, 1.9}, {1, 64, 1.95}}};  // 2 - 0.05 r
  EXPECT_NEAR(first.order(), 1, 1e-12);
  EXPECT_NEAR(first.limit(), 2, 1e-12);
  const paper::Refinement second{{{4, 1, 2.16}, {2, 8, 2.04}, {1, 64, 2.01}}};  // 2 + 0.01 r^2
  EXPECT_NEAR(second.order(), 2, 1e-12);
  EXPECT_NEAR(second.limit(), 2, 1e-12);
}

TEST(Paper, AClaimBeyondItsBoundIsMissed) {
  paper::Claim claim{.experiment = "x", .organ = "x", .closed_form = 1.0, .network = 1.02};
  EXPECT_EQ(claim.verdict(), reports::ReportVerdict::shown);
  claim.bound = 0.01;
  EXPECT_EQ(claim.verdict(), reports::ReportVerdict::missed);
  claim.bound = 0.03;
  EXPECT_EQ(claim.verdict(), reports::ReportVerdict::met);
  claim.network = std::nan("");
  EXPECT_EQ(claim.verdict(), reports::ReportVerdict::missed);
}

TEST(Paper, PrintIsMetByTheClosedFormAndARangeByAValueInside) {
  paper::Claim claim{
      .kind = paper::ClaimKind::print, .experiment = "x", .organ = "x", .paper = 2.0, .closed_form = 2.1};
  claim.network = 2.0;  // has no say
  claim.bound = 0.10;
  EXPECT_NEAR(claim.error(), 0.05, 1e-12);
  EXPECT_EQ(claim.verdict(), reports::ReportVerdict::met);
  claim.paper_low = 1.0, claim.paper_high = 2.1, claim.bound = 0;
  EXPECT_EQ(claim.verdict(), reports::ReportVerdict::met);
  claim.paper_high = 2.0;
  EXPECT_NEAR(claim.error(), 0.05, 1e-12);
  EXPECT_EQ(claim.verdict(), reports::ReportVerdict::missed);
  claim.paper_low = 3.0, claim.paper_high = 4.0;
  EXPECT_NEAR(claim.error(), -0.3, 1e-12);
  EXPECT_EQ(claim.verdict(), reports::ReportVerdict::missed);
}

TEST(Paper, OnlyMissesOfTheNetworkAreFailuresAndEachKindIsCounted) {
  const auto claim = [](paper::ClaimKind kind, bool holds) {
    return paper::Claim{.kind = kind, .experiment = "x", .figure = "Fig. 1", .organ = "liver", .holds = holds};
  };
  using enum paper::ClaimKind;
  const std::vector<paper::Claim> good{claim(network, true),   claim(network, true),   claim(convergence, true),
                                       claim(print, true),     claim(print, false),    claim(print, false),
                                       claim(behaviour, true), claim(behaviour, false)};
  EXPECT_TRUE(paper::network_holds(good));
  EXPECT_EQ(paper::count_claims(good, network).met, 2);
  EXPECT_EQ(paper::count_claims(good, print).missed, 2);
  EXPECT_EQ(paper::count_claims(good, print, "another").asked(), 0);
  const std::vector<paper::Sentence> sentences = paper::headline(good);
  ASSERT_EQ(sentences.size(), 4u);
  for (const auto& [i, part] : {std::pair(0, "2 of 2"), {1, "1 of 1"}, {2, "1 of 3"}, {3, "1 of 2"}})
    EXPECT_NE(sentences[std::size_t(i)].text.find(part), std::string::npos) << sentences[std::size_t(i)].text;
  EXPECT_EQ(paper::figures_table(good).rows.size(), 2u);
  for (const paper::ClaimKind kind : {network, convergence}) {
    std::vector<paper::Claim> bad = good;
    bad.push_back(claim(kind, false));
    EXPECT_FALSE(paper::network_holds(bad));
  }
}

TEST(Paper, MotionOfADampedSwingIsFound) {
  reports::Series swing;
  for (int i = 0; i <= 4000; ++i) {
    const double t = 1e-3 * i;
    swing.x.push_back(t), swing.y.push_back(1 - std::exp(-3 * t) * std::cos(2 * 3.14159265358979 * 5 * t));
  }
  const paper::StepResponse motion = paper::step_response_of(swing, 1);
  EXPECT_NEAR(motion.overshoot, std::exp(-0.3), 0.02);  // at half a period
  EXPECT_NEAR(motion.settling_time, 1.0, 0.1);          // exp(-3 t) = 0.05
  EXPECT_NEAR(motion.reversals, 23, 2);                 // ten a second until exp(-3 t) = 0.001
  // The first swing that ends after 2 s, from 1.9 s to 2.0 s or 2.0 s to 2.1 s.
  EXPECT_GE(motion.late_swing, std::exp(-6.0) + std::exp(-6.3) - 1e-4);
  EXPECT_LE(motion.late_swing, std::exp(-5.7) + std::exp(-6.0) + 1e-4);
}

TEST(Paper, ACreepHasNoOvershootAndNoSwing) {
  reports::Series creep;
  for (int i = 0; i <= 1000; ++i) creep.x.push_back(1e-3 * i), creep.y.push_back(1 - std::exp(-2e-3 * i));
  const paper::StepResponse motion = paper::step_response_of(creep, 1);
  EXPECT_EQ(motion.overshoot, 0);
  EXPECT_EQ(motion.reversals, 0);
  EXPECT_EQ(motion.late_swing, 0);
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
                     .bound = 0.01},
                    {.kind = paper::ClaimKind::print,
                     .experiment = "creep",
                     .figure = "Fig. <8>",
                     .organ = "liver",
                     .quantity = "depth [mm]",
                     .closed_form = 2,
                     .paper_low = 3,
                     .paper_high = 4,
                     .bound = 0}};
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
  // Page and JSON hold both counts: the network, and print.
  const std::string json = slurp(folder / "results.json");
  for (const char* part : {"\"verdict\": \"met\"", "\"network_holds\": true", "\"figure\": \"Fig. <8>\""})
    EXPECT_NE(json.find(part), std::string::npos) << part;
  const std::size_t network = json.find("\"network\": {"), print = json.find("\"print\": {");
  ASSERT_NE(network, std::string::npos);
  ASSERT_NE(print, std::string::npos);
  EXPECT_NE(json.substr(network, 60).find("\"must_hold\": true"), std::string::npos);
  EXPECT_NE(json.substr(print, 120).find("\"missed\": 1"), std::string::npos);
  EXPECT_NE(html.find("The network meets the closed forms in 1 of 1"), std::string::npos);
  EXPECT_NE(html.find("The closed forms meet 0 of 1 values"), std::string::npos);
  EXPECT_NE(html.find("Fig. &lt;8&gt;: 0 of 1"), std::string::npos);
  // The conclusion comes first, with what must hold and what is only counted, then the picture that proves it.
  const std::size_t conclusion = html.find("Everything that must hold does: 1 comparisons"),
                    must = html.find("Must hold: "), counted = html.find("Only counted: "),
                    plot = html.find("share of its bound"), table = html.find("<table");
  EXPECT_LT(conclusion, must);
  EXPECT_LT(must, counted);
  EXPECT_LT(counted, plot);
  EXPECT_LT(plot, table);
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
