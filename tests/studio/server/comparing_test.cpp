// Two sessions of which a client of the protocol asks how they differ.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <vector>

#include "core/contact/drawn_surfaces.h"
#include "recordings/replay.h"
#include "recordings/session_reader.h"
#include "studio/compare/compare_files.h"
#include "studio/film/expert_cut_of.h"
#include "studio/render/cut_surface.h"
#include "tests/studio/server/reviewing.h"
#include "tests/studio/server/serving.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::kCut, testing::kPress;
using testing::Serving;
using testing::SocketClient;
using testing::value_at;

class Comparing : public testing::Reviewing {
 protected:
  /// A ball that presses a small block, whose ticks take no time, and waits that long there.
  void record_press(const std::string& session, const std::string& wait_s) {
    std::ofstream(file("block.json")) << R"({"format": "ctpm-scene", "version": 1, "name": "block", "settle_s": 0,
      "organs": [{"name": "block", "rig": {"block": [4, 4, 3]}, "material": {"preset": "liver"},
      "anchors": [{"lowest_mm": 1}]}], "tools": [{"name": "ball", "kind": "ball", "radius_mm": 8}]})";
    std::ofstream(file("press.json")) << R"({"format": "ctpm-script", "version": 1, "steps": [
      {"take": {"tool": "ball", "at_mm": [0, 0, 45]}}, {"press": {"distance_mm": 12, "speed_mm_per_s": 60}},
      {"wait_s": )" << wait_s << R"(}, {"put_away": true}]})";
    const testing::ProgramOutcome recorded =
        testing::run_ctpm({"record", "block.json", "--script", "press.json", "-o", session, "--fast"}, folder_.path());
    ASSERT_EQ(recorded.code, 0) << recorded.err;
  }
};

TEST_F(Comparing, AComparisonSaysHowFarItIsAndCanBeStopped) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  nlohmann::json at;
  const nlohmann::json answer = testing::stopped(client, "session.compare", {{"expert", kCut}, {"trainee", kCut}}, &at);
  EXPECT_NE(answer["errors"].dump().find("stopped"), std::string::npos) << answer;
  const nlohmann::json verdict = testing::stopped(client, "session.verify", {{"path", kPress}});
  EXPECT_NE(verdict["errors"].dump().find("stopped"), std::string::npos) << verdict;
  EXPECT_EQ(at["total"], 2 * recordings::SessionReader::open(file(kCut))->tick_count());
  EXPECT_LT(at["done"], at["total"]);

  std::vector<std::int64_t> told;
  compare::CompareFilesOptions options;
  options.progress = [&](std::int64_t done, std::int64_t) { told.push_back(done); };
  ASSERT_TRUE(compare::compare_files(*compare::open_files(file(kCut), file(kCut)), options));
  EXPECT_GT(told.size(), 1000u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), at["total"]);
}

TEST_F(Comparing, WhatIsKnownIsAnsweredAtOnceUntilAFileChanges) {
  ASSERT_NO_FATAL_FAILURE(record_press("press.ctpm", "20"));
  const Serving serving(folder_.path());
  SocketClient client(serving);
  int id = 50;
  // The answer, and whether anything was done for it.
  const auto compared = [&](const nlohmann::json& parameters) {
    client.send({{"id", ++id}, {"call", "session.compare"}, {"params", parameters}});
    for (bool was_done = false;;) {
      const SocketClient::Message message = client.receive();
      const nlohmann::json answer = message.is_text ? nlohmann::json::parse(message.bytes) : nlohmann::json();
      if (answer.is_null() || answer.value("id", 0) != id) continue;
      if (!answer.contains("progress")) return std::pair(answer["result"], was_done);
      was_done = true;
    }
  };
  const nlohmann::json pair{{"expert", "press.ctpm"}, {"trainee", "press.ctpm"}};
  nlohmann::json only_known = pair;
  only_known["only_known"] = true;
  EXPECT_EQ(compared(only_known), std::pair(nlohmann::json(), false)) << "nobody has compared them";
  const auto first = compared(pair), again = compared(pair);
  EXPECT_EQ(compared(only_known), std::pair(first.first, false));
  EXPECT_TRUE(first.second);
  EXPECT_FALSE(again.second);
  EXPECT_EQ(again.first, first.first);
  // Another limit is another question, whose answer is not that of the first.
  nlohmann::json limited = pair;
  limited["force_limit_n"] = 0.5;
  const auto other = compared(limited);
  EXPECT_TRUE(other.second);
  EXPECT_NE(other.first, first.first);
  // So is a session that was verified: a remark less may be made of it.
  ASSERT_EQ(client.call("session.verify", {{"path", "press.ctpm"}})["result"]["same"], true);
  EXPECT_TRUE(compared(pair).second);
  EXPECT_FALSE(compared(pair).second);
  fs::last_write_time(file("press.ctpm"), fs::last_write_time(file("press.ctpm")) + std::chrono::seconds(1));
  EXPECT_TRUE(compared(only_known).first.is_null());
  EXPECT_TRUE(compared(pair).second);
}

TEST_F(Comparing, AComparisonKnowsWhatWasVerifiedUntilTheFileChanges) {
  // Longer than sessions that a comparison replays whole.
  ASSERT_NO_FATAL_FAILURE(record_press("long.ctpm", "31"));
  fs::copy(file("long.ctpm"), file("other.ctpm"));
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const auto doubts = [&] {
    const nlohmann::json answer = client.call("session.compare", {{"expert", "long.ctpm"}, {"trainee", "other.ctpm"}});
    std::vector<std::string> found;
    for (const nlohmann::json& remark : answer["result"]["remarks"])
      if (const std::string text = remark; text.find("was not replayed for this comparison") != std::string::npos)
        found.push_back(text.substr(0, text.find(' ')));
    return found;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(doubts(), (Names{"long.ctpm", "other.ctpm"}));
  ASSERT_EQ(client.call("session.verify", {{"path", "other.ctpm"}})["result"]["same"], true);
  EXPECT_EQ(doubts(), Names{"long.ctpm"});
  ASSERT_EQ(client.call("session.verify", {{"path", "long.ctpm"}})["result"]["same"], true);
  EXPECT_EQ(doubts(), Names{});
  // Written to since: of another time, and of the same one but longer.
  const fs::file_time_type time = fs::last_write_time(file("other.ctpm"));
  fs::last_write_time(file("other.ctpm"), time + std::chrono::seconds(1));
  EXPECT_EQ(doubts(), Names{"other.ctpm"});
  fs::last_write_time(file("other.ctpm"), time);
  EXPECT_EQ(doubts(), Names{});
  std::ofstream(file("other.ctpm"), std::ios::app) << std::string(4096, '\0');
  fs::last_write_time(file("other.ctpm"), time);
  EXPECT_EQ(doubts(), Names{"other.ctpm"});
}

TEST_F(Comparing, AnExpertsCutIsOnTheOrganOfAnotherSessionOfItsScene) {
  const std::string clumsy = "kidney-cut-clumsy.ctpm";
  fs::copy(fs::path(CTPM_SHIPPED_SESSIONS) / clumsy, file(clumsy));
  const Serving serving(folder_.path());
  SocketClient client(serving);
  client.call("session.open", {{"path", clumsy}, {"stage", 0}});
  auto reader = *recordings::SessionReader::open(file(clumsy));
  auto expert = *recordings::SessionReader::open(file(kCut));
  const auto cut = film::expert_cut_of(expert);
  ASSERT_TRUE(cut);
  const std::int64_t tick = reader.tick_count();
  std::uint32_t number = 0;
  // What comes between the call and its replayed frame: of each kind the last message.
  const auto shown = [&](nlohmann::json request) {
    request["stage"] = 0;
    const nlohmann::json answer = client.call("session.draw", request);
    EXPECT_TRUE(answer.contains("result")) << answer;
    client.send({{"show", {{"stage", 0}, {"tick", tick}, {"request", ++number}}}});
    for (std::map<std::uint32_t, std::string> last;;) {
      const SocketClient::Message message = client.receive();
      if (message.is_text) continue;
      last[value_at<std::uint32_t>(message.bytes, 0)] = message.bytes;
      if (value_at<std::uint32_t>(message.bytes, 0) != 2 || SocketClient::is_glimpse(message.bytes)) continue;
      if (value_at<std::uint32_t>(message.bytes, 16) == number) return last;
    }
  };
  EXPECT_FALSE(shown({}).contains(6)) << "nobody asked for it";
  EXPECT_FALSE(shown({{"expert", kPress}}).contains(6)) << "of another scene";
  const auto messages = shown({{"expert", kCut}, {"size", "320x180"}, {"view", "both"}});
  ASSERT_TRUE(messages.contains(6));
  const std::string& marks = messages.at(6);
  EXPECT_EQ(value_at<std::uint32_t>(marks, 8), number);
  // They are those of the function that films call.
  auto cursor = recordings::ReplayCursor::create(reader);
  ASSERT_TRUE(cursor && cursor->seek(tick));
  const Model& model = reader.start().model;
  render::CutSurface surface(model, 0);
  surface.update(cursor->state());
  std::vector<Vec3> vertex;
  contact::DrawnSurfaces(model).place(0, surface.surface(), cursor->state(), vertex);
  const render::DrawnOrgan organ{&surface.surface(), surface.outer_triangle_count(), &vertex};
  render::ExpertMarker marker;
  const render::ExpertMarks same = marker.place(model, *cut, {&organ, 1}, 0, cursor->state());
  ASSERT_GT(same.line.size(), 20u);
  ASSERT_GT(same.strays.size(), 5u);
  ASSERT_EQ(value_at<std::uint32_t>(marks, 12), same.line.size());
  ASSERT_EQ(value_at<std::uint32_t>(marks, 16), same.strays.size());
  ASSERT_EQ(marks.size(), 20 + 24 * same.line.size() + 12 * same.strays.size());
  for (std::size_t i = 0; i < same.line.size(); ++i)
    EXPECT_FLOAT_EQ(value_at<float>(marks, 20 + 24 * i), float(same.line[i][0].x));
  EXPECT_FLOAT_EQ(value_at<float>(marks, marks.size() - 4), float(same.strays.back().z));
  // The program's own drawing has them too.
  EXPECT_NE(messages.at(5).substr(20), shown({{"size", "320x180"}, {"view", "both"}}).at(5).substr(20));
}

TEST_F(Comparing, SessionsOfDifferentScenesAreToldApart) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const auto ask = [&](const std::string& trainee) {
    return client.call("session.comparable", {{"expert", kCut}, {"trainee", trainee}})["result"];
  };
  EXPECT_EQ(ask(kCut), (nlohmann::json{{"comparable", true}, {"text", ""}}));
  const nlohmann::json other = ask(kPress);
  EXPECT_EQ(other["comparable"], false);
  // In the words of a comparison.
  const nlohmann::json refused = client.call("session.compare", {{"expert", kCut}, {"trainee", kPress}});
  const nlohmann::json& error = refused["errors"][0];
  EXPECT_EQ(other["text"], error["where"].get<std::string>() + " " + error["message"].get<std::string>());
  EXPECT_NE(other["text"].get<std::string>().find("liver instead of kidney"), std::string::npos) << other;
  // A training in a scene has the key of the sessions of it.
  fs::create_directories(file("organs"));
  const fs::path scenes = fs::path(CTPM_SOURCE_DIR) / "scenes";
  fs::copy(scenes / "kidney.json", file("kidney.json")),
      fs::copy(scenes / "organs/kidney.obj", file("organs/kidney.obj"));
  const nlohmann::json begun = client.call("train.begin", {{"scene", "kidney.json"}, {"stage", 2}})["result"];
  const auto key_of = [&](const std::string& path) {
    return client.call("session.motion", {{"path", path}, {"rate_hz", 10}})["result"]["scene_key"].get<std::string>();
  };
  EXPECT_EQ(begun["scene_key"], key_of(kCut));
  EXPECT_NE(begun["scene_key"], key_of(kPress));
}

}  // namespace
}  // namespace ctpm
