// A scene that a client of the protocol works on.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "tests/studio/server/serving.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::Serving;
using testing::SocketClient;
using testing::stopped;
using testing::value_at;

constexpr int kStage = 3;

class AuthorTest : public ::testing::Test {
 protected:
  AuthorTest() {
    fs::create_directories(folder_.path() / "organs");
    for (const char* name : {"kidney", "liver"}) {
      const std::string mesh = std::string("organs/") + name + ".obj";
      fs::copy(fs::path(CTPM_SOURCE_DIR) / "scenes" / mesh, folder_.path() / mesh);
    }
    const fs::path scene = fs::path(CTPM_SOURCE_DIR) / "scenes/kidney.json";
    fs::copy(scene, folder_.path() / "kidney.json");
    std::ifstream in(scene);
    text_ = nlohmann::json::parse(in);
  }

  testing::TemporaryFolder folder_;
  nlohmann::json text_;
};

/// The last message of a kind among those that came.
const std::string* last_of(const std::vector<std::string>& messages, std::uint32_t kind) {
  const std::string* found = nullptr;
  for (const std::string& message : messages)
    if (value_at<std::uint32_t>(message, 0) == kind) found = &message;
  return found;
}

TEST_F(AuthorTest, OnlyScenesAreListedAsScenes) {
  const auto write = [&](const char* name, const std::string& content) {
    std::ofstream(folder_.path() / name) << content;
  };
  write("empty.json", "{}");
  write("nothing.json", "");
  write("settings.json", R"({"name": "of another program", "list": [1, 2]})");
  write("script.json", R"({"format": "ctpm-script", "version": 1, "steps": []})");
  write("kidney.script.json", R"({"format": "ctpm-script", "version": 1, "steps": []})");
  write("broken.json", R"({"format": "ctpm-scene", "version": 1, )");  // its author mends it here
  write("begun.json", R"({"organs": []})");
  const Serving serving(folder_.path());
  SocketClient client(serving);
  std::vector<std::string> listed;
  const nlohmann::json answer = client.call("folder.list", nlohmann::json::object());
  for (const auto& entry : answer["result"]["scenes"]) listed.push_back(entry["path"]);
  EXPECT_EQ(listed, (std::vector<std::string>{"begun.json", "broken.json", "kidney.json"}));
}

TEST_F(AuthorTest, TheTextOfAnAuthorIsShownBeforeItIsSaved) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  text_["organs"][0]["at_mm"] = {100, 0, 0};
  text_["tools"][0]["at_mm"] = {1, 2, 90};
  std::vector<std::string> before, after;
  const auto on_disk = client.call("scene.show", {{"path", "kidney.json"}, {"stage", kStage}}, &before);
  const auto moved =
      client.call("scene.show", {{"path", "kidney.json"}, {"stage", kStage}, {"text", text_.dump()}}, &after);
  ASSERT_TRUE(on_disk.contains("result") && moved.contains("result")) << on_disk << moved;
  const auto& first = on_disk["result"]["view"];
  const auto& second = moved["result"]["view"];
  EXPECT_NEAR(second["least"][0].get<double>() - first["least"][0].get<double>(), 0.1, 1e-9);
  EXPECT_FALSE(first["tools"][0].contains("at"));
  EXPECT_EQ(second["tools"][0]["at"], nlohmann::json({0.001, 0.002, 0.09}));
  EXPECT_EQ(second["tools"][0]["pointing"], nlohmann::json({0, 0, -1}));
  // Its spheres are as many as before, each 100 mm further on.
  const std::string *here = last_of(before, 4), *there = last_of(after, 4);
  ASSERT_TRUE(here && there);
  const std::uint32_t count = value_at<std::uint32_t>(*here, 12);
  EXPECT_EQ(count, moved["result"]["spheres"].get<std::uint32_t>());
  ASSERT_EQ(here->size(), there->size());
  for (std::uint32_t i = 0; i < count; ++i)
    EXPECT_NEAR(value_at<float>(*there, 20 + 12 * i) - value_at<float>(*here, 20 + 12 * i), 0.1, 1e-6);
}

TEST_F(AuthorTest, ErrorsOfATextAreThoseOfCheck) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  text_["organs"][0]["mesh"] = "organs/nowhere.obj";
  const auto answer = client.call("scene.show", {{"path", "kidney.json"}, {"stage", kStage}, {"text", text_.dump(1)}});
  ASSERT_TRUE(answer.contains("errors")) << answer;
  std::ofstream(folder_.path() / "other.json") << text_.dump(1);
  const auto printed = testing::run_ctpm({"check", "other.json"}, folder_.path());
  for (const auto& error : answer["errors"])
    EXPECT_NE(printed.err.find(error["message"].get<std::string>()), std::string::npos) << printed.err;
}

TEST_F(AuthorTest, ATickOfWhatIsShownIsMeasured) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  EXPECT_TRUE(client.call("scene.measure", {{"stage", kStage}}).contains("errors"));
  client.call("scene.show", {{"path", "kidney.json"}, {"stage", kStage}});
  const auto measured = client.call("scene.measure", {{"stage", kStage}});
  ASSERT_TRUE(measured.contains("result")) << measured;
  EXPECT_GT(measured["result"]["measured_tick_time_s"].get<double>(), 0);
  EXPECT_EQ(measured["result"]["tick_s"], 1e-3);
}

TEST_F(AuthorTest, TheScatterIsThatOfTheCommand) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const auto answer = client.call("scene.scatter", {{"path", "kidney.json"}, {"quick", true}});
  ASSERT_TRUE(answer.contains("result")) << answer;
  testing::run_ctpm({"fidelity", "kidney.json", "-o", "report", "--quick"}, folder_.path());
  std::ifstream in(folder_.path() / "report/results.json");
  std::vector<double> printed, told;
  const nlohmann::json report = nlohmann::json::parse(in);
  for (const auto& figure : report["figures"])
    if (figure["figure"].get<std::string>().starts_with("scatter")) printed.push_back(figure["measured"]);
  for (const char* kind : {"turns", "places"})
    for (const auto& row : answer["result"][kind]) told.push_back(100 * row["scatter"].get<double>());
  ASSERT_EQ(printed.size(), told.size());
  for (std::size_t i = 0; i < printed.size(); ++i) EXPECT_NEAR(printed[i], told[i], 1e-9 * printed[i]);
}

TEST_F(AuthorTest, WhatTakesLongCanBeStoppedAndLeavesNothing) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const auto import =
      stopped(client, "scene.import", {{"mesh", "organs/liver.obj"}, {"scene", "new.json"}, {"radius_m", 0.001}});
  ASSERT_TRUE(import.contains("errors")) << import;
  EXPECT_EQ(import["errors"][0]["message"], "stopped");
  for (const char* name : {"new.json", "new.obj", "new.script.json"}) EXPECT_FALSE(fs::exists(folder_.path() / name));
  text_["organs"][0]["fill"] = {{"radius_mm", 2}, {"gap_mm", 2}};
  const auto scatter = stopped(client, "scene.scatter", {{"path", "kidney.json"}, {"text", text_.dump()}});
  ASSERT_TRUE(scatter.contains("errors")) << scatter;
}

/// The kidney without the triangles of its end, where x is the largest.
std::string holed_kidney() {
  std::ifstream in(fs::path(CTPM_SOURCE_DIR) / "scenes/organs/kidney.obj");
  std::vector<double> x;
  std::string kept, line;
  double most = -1e9, least = 1e9;
  while (std::getline(in, line)) {
    double at = 0;
    if (std::sscanf(line.c_str(), "v %lf", &at) == 1)
      x.push_back(at), most = std::max(most, at), least = std::min(least, at);
    unsigned corner = 0;
    const bool is_of_the_end = line.starts_with("f ") && std::sscanf(line.c_str(), "f %u", &corner) == 1 &&
                               x.at(corner - 1) > most - 0.15 * (most - least);
    if (!is_of_the_end) kept += line + "\n";
  }
  return kept;
}

TEST_F(AuthorTest, AWideHoleIsRefusedByItsNameInTheFolderAndClosedOnRequest) {
  std::ofstream(folder_.path() / "holed.obj") << holed_kidney();
  const Serving serving(folder_.path());
  SocketClient client(serving);
  nlohmann::json import = {{"mesh", "holed.obj"}, {"scene", "closed.json"}, {"radius_m", 0.004}, {"organ", "kidney"}};
  const auto refused = client.call("scene.import", import);
  ASSERT_TRUE(refused.contains("errors")) << refused;
  EXPECT_EQ(refused["errors"][0]["where"], "holed.obj");
  EXPECT_NE(refused["errors"][0]["hint"].get<std::string>().find("largest_hole_mm"), std::string::npos) << refused;
  import["largest_hole_m"] = 0.1;
  const auto closed = client.call("scene.import", import);
  ASSERT_TRUE(closed.contains("result")) << closed;
  EXPECT_TRUE(fs::exists(folder_.path() / "closed.json"));
}

TEST_F(AuthorTest, ATextOutsideOfTheFolderIsRefused) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  text_["organs"][0]["mesh"] = "../secret.obj";
  for (const char* path : {"../kidney.json", "/etc/passwd", "kidney.json"}) {
    const auto answer = client.call("scene.show", {{"path", path}, {"stage", kStage}, {"text", text_.dump()}});
    EXPECT_TRUE(answer.contains("errors")) << path;
  }
}

}  // namespace
}  // namespace ctpm
