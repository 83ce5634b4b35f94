// Files for other programs, from outside: a session with a cut is exported by the program, and read by assimp, meshio
// and VTK. Debian has no reader of USD; its text is checked against what a session must hold.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "importers/mesh.h"
#include "recordings/replay.h"
#include "recordings/session_reader.h"
#include "scenes/scene_file.h"
#include "studio/exchange/shapes.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::run;
using testing::run_ctpm;

const std::string kSession = std::string(CTPM_SHIPPED_SESSIONS) + "/kidney-cut-expert.ctpm";

/// The moment at `at_s` as the library sees it.
struct Truth {
  explicit Truth(double at_s) : reader(*recordings::SessionReader::open(kSession)) {
    auto cursor = *recordings::ReplayCursor::create(reader);
    const std::int64_t tick = at_s < 0 ? reader.tick_count() : std::llround(at_s / reader.start().model.tick);
    EXPECT_TRUE(cursor.seek(tick));
    const auto scene = scenes::read_scene(reader.start().scene_text, "scene");
    state = cursor.state();
    organs = exchange::Shaper(model(), scene->spec).shapes(state);
  }
  const Model& model() const { return reader.start().model; }
  double volume() const {
    double sum = 0;
    for (const exchange::OrganShape& organ : organs)
      for (const auto& t : organ.triangle)
        sum += dot(organ.vertex[std::size_t(t[0])],
                   cross(organ.vertex[std::size_t(t[1])], organ.vertex[std::size_t(t[2])])) /
               6;
    return sum;
  }
  double severed() const {
    return double(std::count_if(state.axial_severed.begin(), state.axial_severed.end(), [](auto s) { return s != 0; }));
  }

  recordings::SessionReader reader;
  State state;
  std::vector<exchange::OrganShape> organs;
};

class Exchange : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  testing::ProgramOutcome export_to(const std::string& name, std::vector<std::string> options = {}) {
    std::vector<std::string> arguments{"export", kSession, "-o", name};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_ctpm(arguments, folder_.path());
  }
  /// What another program's reader says of a file, by key; empty where that reader is not installed.
  std::map<std::string, std::vector<std::string>> read_by(const std::string& reader, const std::string& name) {
    const auto said =
        run({"/usr/bin/python3", CTPM_SOURCE_DIR "/tests/studio/exchange/read_shapes.py", reader, path(name)},
            folder_.path());
    std::map<std::string, std::vector<std::string>> facts;
    if (said.code == 77) return facts;
    EXPECT_EQ(said.code, 0) << said.err;
    std::istringstream lines(said.out);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string key;
      words >> key;
      for (std::string word; words >> word;) facts[key].push_back(word);
    }
    return facts;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Exchange, AssimpReadsTheMomentOfAGlb) {
  const auto outcome = export_to("moment.glb");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("1 moment in 1 file; replay same as recorded"), std::string::npos) << outcome.out;
  const Truth truth(-1);
  ASSERT_GT(truth.organs[0].triangle.size(), truth.organs[0].outer_triangles) << "the session ends with a cut";
  const Result<importers::RawMesh> read = importers::read_mesh(path("moment.glb"));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->parts, (std::vector<std::string>{truth.organs[0].name}));
  EXPECT_EQ(read->triangle.size(), truth.organs[0].triangle.size());
  // glTF is y up and in metres.
  constexpr double kFloat = 1e-7;  // [m]
  Vec3 least = truth.organs[0].vertex[0], most = least, low{least.x, least.z, -least.y}, high = low;
  for (const Vec3& p : truth.organs[0].vertex) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  low = high = read->vertex[0];
  for (const Vec3& p : read->vertex) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  EXPECT_LT(norm(low - Vec3{least.x, least.z, -most.y}), kFloat);
  EXPECT_LT(norm(high - Vec3{most.x, most.z, -least.y}), kFloat);
  const auto seen = read_by("vtk", "moment.glb");
  if (!seen.empty()) {
    EXPECT_EQ(std::stoul(seen.at("cells")[0]), truth.organs[0].triangle.size());
  }
}

TEST_F(Exchange, MeshioReadsTheNetworkOfAVtu) {
  ASSERT_EQ(export_to("network.vtu", {"--at-s", "3"}).code, 0);
  const auto read = read_by("meshio", "network.vtu");
  if (read.empty()) GTEST_SKIP() << "python3-meshio is not installed";
  const Truth truth(3);
  EXPECT_EQ(std::stoul(read.at("points")[0]), truth.model().sphere_count());
  EXPECT_EQ(std::stoul(read.at("cells")[0]), truth.model().axial.size());
  EXPECT_EQ(read.at("cells")[1], "line");
  EXPECT_EQ(std::stod(read.at("severed")[0]), truth.severed());
  const Model& model = truth.model();
  double shortest = INFINITY, longest = 0;
  for (std::size_t e = 0; e < model.axial.size(); ++e) {
    const Vec3 apart =
        model.rest_position[std::size_t(model.axial.b[e])] - model.rest_position[std::size_t(model.axial.a[e])];
    const double share = model.axial.rest_length[e] / norm(apart);
    shortest = std::min(shortest, share), longest = std::max(longest, share);
  }
  EXPECT_LT(shortest + 0.01, longest) << "the session's organ is under tension";
  EXPECT_NEAR(std::stod(read.at("without_force")[0]), shortest, 1e-4);
  EXPECT_NEAR(std::stod(read.at("without_force")[1]), longest, 1e-4);
  double moved = 0;
  for (std::size_t n = 0; n < truth.model().sphere_count(); ++n)
    moved = std::max(moved, norm(truth.state.position[n] - truth.model().rest_position[n]));
  EXPECT_NEAR(std::stod(read.at("moved_mm")[0]), 1e3 * moved, 1e-3);
}

TEST_F(Exchange, VtkReadsTheSurfaceOfAVtpAndTheSeriesOfAPvd) {
  ASSERT_EQ(export_to("surface.vtp", {"--at-s", "3"}).code, 0);
  const auto outcome = export_to("series.pvd", {"--from-s", "2", "--to-s", "3", "--fps", "4"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("5 moments in 11 files"), std::string::npos) << outcome.out;
  const auto read = read_by("vtk", "surface.vtp");
  if (read.empty()) GTEST_SKIP() << "python3-vtk9 is not installed";
  const Truth truth(3);
  const exchange::OrganShape& organ = truth.organs[0];
  EXPECT_EQ(std::stoul(read.at("points")[0]), organ.vertex.size());
  EXPECT_EQ(std::stoul(read.at("cells")[0]), organ.triangle.size());
  EXPECT_EQ(std::stoul(read.at("wall")[0]), organ.triangle.size() - organ.outer_triangles);
  EXPECT_NEAR(std::stod(read.at("time")[0]), 3, 1e-9);
  EXPECT_NEAR(std::stod(read.at("tool")[0]), 1e3 * truth.state.last_inputs.position.x, 1e-3);
  EXPECT_NEAR(std::stod(read.at("volume")[0]) / (1e9 * truth.volume()), 1, 1e-3);
  const auto series = read_by("series", "series.pvd");
  ASSERT_EQ(series.at("member").size(), 30u) << "two files of each of five moments";
  EXPECT_EQ(std::stod(series.at("member")[0]), 2);
  EXPECT_EQ(std::stod(series.at("member")[27]), 3);
}

/// The lists behind `key` in USD's text, in their order.
std::vector<std::string> after(const std::string& text, const std::string& key, char close) {
  std::vector<std::string> found;
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
    const std::size_t begin = at + key.size();
    found.push_back(text.substr(begin, text.find(close, begin) - begin));
  }
  return found;
}

TEST_F(Exchange, UsdHasAPieceForEachTimeInWhichTheCutStaysTheSame) {
  const auto refused = export_to("session.usda", {"--strip", "--camera", "follow"});
  EXPECT_EQ(refused.code, 2);
  for (const char* option : {"--strip", "--camera"})
    EXPECT_NE(refused.err.find(std::string(option) + ": error: is of pictures, and "), std::string::npos)
        << refused.err;
  const auto outcome = export_to("session.usda", {"--from-s", "1", "--to-s", "4", "--fps", "5"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string text = testing::slurp(path("session.usda"));
  EXPECT_TRUE(text.starts_with("#usda 1.0\n"));
  for (const auto& [open, close] : {std::pair{'{', '}'}, {'[', ']'}, {'(', ')'}})
    EXPECT_EQ(std::count(text.begin(), text.end(), open), std::count(text.begin(), text.end(), close));
  EXPECT_NE(text.find("endTimeCode = 15"), std::string::npos);
  const auto counts = after(text, "faceVertexCounts = [", ']'), indices = after(text, "faceVertexIndices = [", ']');
  const auto samples = after(text, "points.timeSamples = {\n", '}'),
             seen = after(text, "visibility.timeSamples = {\n", '}');
  ASSERT_GT(counts.size(), 2u) << "a cut grows";
  ASSERT_EQ(indices.size(), counts.size());
  ASSERT_EQ(samples.size(), counts.size());
  std::int64_t next = 0;
  for (std::size_t piece = 0; piece < counts.size(); ++piece) {
    const auto numbers = [](const std::string& list) {
      std::vector<std::int64_t> all;
      std::istringstream in(list);
      for (std::string word; in >> word;) all.push_back(std::stoll(word));
      return all;
    };
    const auto corner = numbers(indices[piece]);
    EXPECT_EQ(corner.size(), 3 * numbers(counts[piece]).size());
    const std::int64_t most = *std::max_element(corner.begin(), corner.end());
    std::istringstream lines(samples[piece]);
    const std::int64_t first = next;
    for (std::string line; std::getline(lines, line) && line.find(':') != std::string::npos; ++next) {
      EXPECT_EQ(std::stoll(line), next) << "every moment is in one piece";
      EXPECT_EQ(std::count(line.begin(), line.end(), '('), most + 1) << "as many points as the triangles use";
    }
    EXPECT_EQ(seen[piece].find("0: \"invisible\"") != std::string::npos, first > 0) << "seen at its own time alone";
    EXPECT_NE(seen[piece].find(std::to_string(first) + ": \"inherited\""), std::string::npos);
    if (next < 16) {
      EXPECT_NE(seen[piece].find(std::to_string(next) + ": \"invisible\""), std::string::npos);
    }
  }
  EXPECT_EQ(next, 16);
  EXPECT_NE(text.find("def BasisCurves \"edge\""), std::string::npos) << "the scalpel";
}

TEST_F(Exchange, MistakesAreRefusedAndLeaveNothing) {
  EXPECT_EQ(export_to("late.vtp", {"--at-s", "1000"}).code, 2);
  EXPECT_EQ(export_to("fast.pvd", {"--fps", "0"}).code, 2);
  for (const char* series : {"moment.pvd", "moment.usda"}) EXPECT_EQ(export_to(series, {"--at-s", "1"}).code, 2);
  EXPECT_EQ(export_to("nowhere/a.usda").code, 2);
  EXPECT_EQ(export_to("both.glb", {"--beside", kSession}).code, 2);
  EXPECT_EQ(export_to("video.mp4", {"--at-s", "1"}).code, 2);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  ASSERT_EQ(export_to("a.vtp").code, 0);
  EXPECT_EQ(export_to("a.vtp").code, 2) << "it exists";
  EXPECT_EQ(export_to("a.vtp", {"--overwrite"}).code, 0);
}

}  // namespace
}  // namespace ctpm
