// What PROTOCOL.md promises of every call, and of pages that ask for more than is good.

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <regex>
#include <set>
#include <thread>

#include "tests/studio/server/serving.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::Serving;
using testing::SocketClient;

std::set<std::string> all_matches(const fs::path& file, const std::string& pattern) {
  const std::string text = testing::slurp(file);
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) found.insert((*it)[1]);
  return found;
}

TEST(Protocol, ListsEveryCallOfTheProgramAndNoOther) {
  const fs::path server = fs::path(CTPM_SOURCE_DIR) / "studio/server";
  const std::set<std::string> written = all_matches(server / "PROTOCOL.md", R"(\n\| `([a-z]+\.[a-z]+)` \|)");
  EXPECT_EQ(written, all_matches(server / "calls.cpp", R"re(\{"([a-z]+\.[a-z]+)", )re"));
  const testing::TemporaryFolder folder;
  const Serving serving(folder.path());
  SocketClient client(serving);
  ASSERT_GT(written.size(), 15u);
  for (const std::string& call : written)
    EXPECT_EQ(client.call(call, nlohmann::json::object()).dump().find("there is no such call"), std::string::npos)
        << call;
}

TEST(Protocol, TheNumberOfACallIsFreeOnceItIsAnswered) {
  const testing::TemporaryFolder folder;
  const Serving serving(folder.path());
  SocketClient client(serving);
  for (int i = 0; i < 2000; ++i) {
    client.send({{"id", 7}, {"call", "scene.presets"}, {"params", nlohmann::json::object()}});
    const nlohmann::json answer = nlohmann::json::parse(client.receive().bytes);
    ASSERT_TRUE(answer.contains("result")) << i << ": " << answer;
  }
}

TEST(Protocol, NoCallReachesAFileOutsideOfTheFolder) {
  const testing::TemporaryFolder outer;
  const fs::path folder = outer.path() / "folder";
  fs::create_directories(folder);
  fs::create_directory_symlink(outer.path(), folder / "way-out");
  const fs::path scenes = fs::path(CTPM_SOURCE_DIR) / "scenes";
  for (const char* name : {"secret.json", "folder/own.json"}) fs::copy(scenes / "kidney.json", outer.path() / name);
  for (const char* name : {"secret.obj", "folder/own.obj"}) fs::copy(scenes / "organs/kidney.obj", outer.path() / name);
  for (const char* name : {"secret.ctpm", "folder/own.ctpm"})
    fs::copy(fs::path(CTPM_SHIPPED_SESSIONS) / "kidney-cut-expert.ctpm", outer.path() / name);
  const Serving serving(folder);
  SocketClient client(serving);
  struct Case {
    const char *call, *key, *ending;
    nlohmann::json others;
  };
  const nlohmann::json none = nlohmann::json::object();
  const std::vector<Case> cases{
      {"session.open", "path", ".ctpm", {{"stage", 0}}},
      {"session.timeline", "path", ".ctpm", {{"points", 10}}},
      {"session.motion", "path", ".ctpm", {{"rate_hz", 10}}},
      {"session.verify", "path", ".ctpm", none},
      {"session.comparable", "expert", ".ctpm", {{"trainee", "own.ctpm"}}},
      {"session.comparable", "trainee", ".ctpm", {{"expert", "own.ctpm"}}},
      {"session.compare", "expert", ".ctpm", {{"trainee", "own.ctpm"}}},
      {"session.compare", "trainee", ".ctpm", {{"expert", "own.ctpm"}}},
      {"session.export", "path", ".ctpm", {{"output", "film.avi"}, {"to_s", 0.1}}},
      {"session.export", "output", ".avi", {{"path", "own.ctpm"}, {"to_s", 0.1}}},
      {"session.export", "beside", ".ctpm", {{"path", "own.ctpm"}, {"output", "film.avi"}, {"to_s", 0.1}}},
      {"session.export", "ghost", ".ctpm", {{"path", "own.ctpm"}, {"output", "film.avi"}, {"to_s", 0.1}}},
      {"session.export_moment", "path", ".ctpm", {{"output", "film.png"}, {"at_s", 0.1}}},
      {"session.export_moment", "output", ".png", {{"path", "own.ctpm"}, {"at_s", 0.1}}},
      {"session.draw", "expert", ".ctpm", {{"stage", 0}}},
      {"notes.read", "path", ".ctpm", none},
      {"notes.write", "path", ".ctpm", {{"revision", "none"}, {"notes", nlohmann::json::array()}}},
      {"scene.import_name", "path", ".json", none},
      {"scene.import", "mesh", ".obj", {{"scene", "new.json"}, {"radius_m", 0.006}}},
      {"scene.import", "scene", ".json", {{"mesh", "own.obj"}, {"radius_m", 0.006}}},
      {"scene.show", "path", ".json", {{"stage", 3}}},
      {"scene.scatter", "path", ".json", {{"quick", true}}},
      {"scene.read", "path", ".json", none},
      {"scene.check", "path", ".json", {{"text", "{}"}}},
      {"scene.write", "path", ".json", {{"text", "{}"}, {"revision", "none"}}},
      {"scene.rename", "path", ".json", {{"to", "new.json"}}},
      {"scene.rename", "to", ".json", {{"path", "own.json"}}},
      {"scene.removal", "path", ".json", none},
      {"scene.remove", "path", ".json", {{"files", {"own.json"}}}},
      {"train.begin", "scene", ".json", {{"stage", 2}}},
      {"train.begin", "output", ".ctpm", {{"scene", "own.json"}, {"stage", 2}}}};
  const std::string before = outer.list();
  for (const Case& one : cases)
    for (const std::string& place : {std::string("../secret"), std::string("a/../../new"),
                                     std::string("way-out/secret"), (outer.path() / "new").string()}) {
      nlohmann::json parameters = one.others;
      parameters[one.key] = place + one.ending;
      const nlohmann::json answer = client.call(one.call, parameters);
      EXPECT_NE(answer.value("errors", nlohmann::json()).dump().find("lies outside the folder"), std::string::npos)
          << one.call << " " << parameters << ": " << answer.dump().substr(0, 300);
    }
  EXPECT_EQ(outer.list(), before);
  EXPECT_EQ(testing::slurp(outer.path() / "secret.json"), testing::slurp(scenes / "kidney.json"));
}

TEST(Protocol, MessagesAreNotCompressed) {
  const testing::TemporaryFolder folder;
  const Serving serving(folder.path());
  const testing::RawClient client(serving.port(), 1);
  client.send(serving.head("GET /socket",
                           "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                           "Sec-WebSocket-Extensions: permessage-deflate; client_max_window_bits\r\n"
                           "Sec-WebSocket-Protocol: " +
                               std::string(server::kSubprotocol) + ", token." + serving.token() + "\r\n"));
  const std::string response = client.receive();
  EXPECT_EQ(testing::status_of(response), 101) << response;
  EXPECT_EQ(response.find("Extensions"), std::string::npos) << response;
}

TEST(Protocol, APageThatTakesNoAnswersIsDisconnectedAndOthersAreNot) {
  const testing::TemporaryFolder folder;
  server::Limits limits;
  limits.most_waiting = 1 << 20;
  const Serving serving(folder.path(), limits);
  SocketClient silent(serving), other(serving);
  silent.keep_little();
  const std::size_t answer = other.call("scene.schema", nlohmann::json::object()).dump().size();
  ASSERT_GT(answer, 10000u);
  // Far more than the kernel keeps of what is not read, and the limit.
  const std::size_t calls = (64u << 20) / answer;
  bool was_disconnected = false;
  for (std::size_t i = 0; i < calls && !was_disconnected; ++i) try {
      silent.send({{"id", i + 1}, {"call", "scene.schema"}, {"params", nlohmann::json::object()}});
      if (i % 100 == 0) {
        EXPECT_TRUE(other.call("folder.list", nlohmann::json::object()).contains("result"));
      }
    } catch (const boost::system::system_error&) {
      was_disconnected = true;
    }
  std::size_t came = 0;
  for (; !was_disconnected && came < calls; ++came) try {
      silent.receive();
    } catch (const boost::system::system_error&) {
      was_disconnected = true;
    }
  EXPECT_TRUE(was_disconnected);
  EXPECT_TRUE(other.call("folder.list", nlohmann::json::object()).contains("result"));
}

TEST(Protocol, AJumpOfThePagesHandIsRefusedAsADevicesIs) {
  const testing::TemporaryFolder folder;
  fs::create_directories(folder.path() / "organs");
  for (const char* name : {"kidney.json", "organs/kidney.obj"})
    fs::copy(fs::path(CTPM_SOURCE_DIR) / "scenes" / name, folder.path() / name);
  const Serving serving(folder.path());
  SocketClient client(serving);
  ASSERT_TRUE(
      client.call("train.begin", {{"scene", "kidney.json"}, {"output", "jump.ctpm"}, {"stage", 2}}).contains("result"));
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 100; ++i) {
    std::this_thread::sleep_until(begin + std::chrono::milliseconds(8 * i));
    const double x = i == 60 ? 0.3 : 0;  // [m], for one message
    client.send(
        {{"hand",
          {{"position", {x, 0, 0.15}}, {"orientation", {1, 0, 0, 0}}, {"buttons", 1}, {"time_s", 100 + 0.008 * i}}}});
  }
  client.send({{"id", 99}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
  while (client.receive().bytes.find("train_ended") == std::string::npos) {
  }
  const nlohmann::json info =
      nlohmann::json::parse(testing::run_ctpm({"info", "jump.ctpm", "--json"}, folder.path()).out);
  EXPECT_EQ(info["values"]["device_samples_refused"], 1) << info["values"];
  const nlohmann::json motion = client.call("session.motion", {{"path", "jump.ctpm"}, {"rate_hz", 1000}})["result"];
  for (const auto& pose : motion["poses"]) EXPECT_NEAR(pose[1].get<double>(), 0, 1e-3);
  EXPECT_EQ(testing::run_ctpm({"verify", "jump.ctpm"}, folder.path()).code, 0);
}

}  // namespace
}  // namespace ctpm
