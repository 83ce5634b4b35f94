// Films and pictures that a client of the protocol has written.

#include <gtest/gtest.h>

#include <fstream>

#include "tests/studio/commands/running_program.h"
#include "tests/studio/server/reviewing.h"
#include "tests/studio/server/serving.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::kCut;
using testing::Reviewing;
using testing::Serving;
using testing::SocketClient;

TEST_F(Reviewing, ThePictureOfAMomentIsTheCommands) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const nlohmann::json request = {{"path", kCut},      {"output", "page.png"}, {"at_s", 2},
                                  {"size", "320x180"}, {"cutaway", "y"},       {"caption", "a deep cut"}};
  const nlohmann::json done = client.call("session.export_moment", request);
  ASSERT_TRUE(done.contains("result")) << done;
  EXPECT_EQ(done["result"]["path"], "page.png");
  const testing::ProgramOutcome command =
      testing::run_ctpm({"export", kCut, "-o", "command.png", "--at-s", "2", "--size", "320x180", "--cutaway", "y",
                         "--caption", "a deep cut"},
                        folder_.path());
  ASSERT_EQ(command.code, 0) << command.err;
  EXPECT_EQ(testing::slurp(file("page.png")), testing::slurp(file("command.png")));
  const std::string fetched =
      testing::response_to(serving.port(), serving.head("GET /film/page.png", serving.bearer()));
  EXPECT_EQ(testing::body_of(fetched), testing::slurp(file("page.png")));
  EXPECT_NE(fetched.find("Content-Type: image/png\r\n"), std::string::npos);
  // Bad requests leave nothing behind.
  for (const auto& [key, value, words] : {std::tuple{"output", nlohmann::json("page.png"), "exists"},
                                          {"output", nlohmann::json("page.mp4"), ".png"},
                                          {"at_s", nlohmann::json(1e6), "must be in"},
                                          {"cutaway", nlohmann::json("w"), "cutaway"},
                                          {"size", nlohmann::json("big"), "big"}}) {
    nlohmann::json bad = request;
    bad["output"] = "bad.png", bad[key] = value;
    EXPECT_NE(client.call("session.export_moment", bad)["errors"].dump().find(words), std::string::npos) << bad;
  }
  EXPECT_FALSE(fs::exists(file("bad.png")));
  EXPECT_FALSE(fs::exists(file("page.mp4")));
}

TEST_F(Reviewing, ThePictureOfAPairIsTheCommands) {
  const std::string clumsy = "kidney-cut-clumsy.ctpm";
  fs::copy(fs::path(CTPM_SHIPPED_SESSIONS) / clumsy, file(clumsy));
  const Serving serving(folder_.path());
  SocketClient client(serving);
  for (const std::string how : {"beside", "ghost"}) {
    const nlohmann::json done = client.call("session.export_moment", {{"path", kCut},
                                                                      {"output", how + ".png"},
                                                                      {"at_s", 2.5},
                                                                      {"size", "640x180"},
                                                                      {"align", "cut"},
                                                                      {how, clumsy}});
    ASSERT_TRUE(done.contains("result")) << done;
    EXPECT_EQ(done["result"]["note"], "");
    const testing::ProgramOutcome command =
        testing::run_ctpm({"export", kCut, "-o", how + "-again.png", "--at-s", "2.5", "--size", "640x180", "--align",
                           "cut", "--" + how, clumsy},
                          folder_.path());
    ASSERT_EQ(command.code, 0) << command.err;
    EXPECT_EQ(testing::slurp(file(how + ".png")), testing::slurp(file(how + "-again.png")));
  }
  EXPECT_NE(testing::slurp(file("beside.png")), testing::slurp(file("ghost.png")));
  const nlohmann::json both =
      client.call("session.export_moment",
                  {{"path", kCut}, {"output", "both.png"}, {"at_s", 1}, {"beside", clumsy}, {"ghost", clumsy}});
  EXPECT_NE(both["errors"].dump().find("beside it or a ghost"), std::string::npos) << both;
}

TEST_F(Reviewing, AnExportIsTheCommandsAndCanBeCancelled) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const nlohmann::json request = {{"path", kCut}, {"output", "page.avi"}, {"from_s", 2},
                                  {"to_s", 2.2},  {"size", "320x180"},    {"view", "both"}};
  const nlohmann::json done = client.call("session.export", request);
  ASSERT_TRUE(done.contains("result")) << done;
  const testing::ProgramOutcome command = testing::run_ctpm(
      {"export", kCut, "-o", "command.avi", "--from-s", "2", "--to-s", "2.2", "--size", "320x180", "--view", "both"},
      folder_.path());
  ASSERT_EQ(command.code, 0) << command.err;
  EXPECT_EQ(testing::slurp(file("page.avi")), testing::slurp(file("command.avi")));
  EXPECT_NE(client.call("session.export", request)["errors"].dump().find("exists already"), std::string::npos);
  // A name that neither a video nor a sidecar has; an export says of both that they are there before it looks at
  // anything else.
  const auto name = [&](const std::string& path) { return client.call("session.export_name", {{"path", path}}); };
  EXPECT_EQ(name("new.avi")["result"]["path"], "new.avi");
  EXPECT_EQ(name("page.avi")["result"]["path"], "page-2.avi");
  std::ofstream(folder_.path() / "page-2.avi.json") << "{}";
  EXPECT_EQ(name("page.avi")["result"]["path"], "page-3.avi");
  EXPECT_TRUE(name("../page.avi").contains("errors"));
  const nlohmann::json refused =
      client.call("session.export", {{"path", kCut}, {"beside", "nothing.ctpm"}, {"output", "page-2.avi"}})["errors"];
  EXPECT_EQ(refused[0]["where"], "page-2.avi.json") << refused;
  EXPECT_EQ(refused[0]["message"], "exists already") << refused;
  // Its page may fetch it, and nothing else: not what is in the folder, nor what lies where it was.
  const auto fetch = [&](const std::string& path, bool has_token = true) {
    return testing::response_to(serving.port(), serving.head("GET /film/" + path, has_token ? serving.bearer() : ""));
  };
  const std::string fetched = fetch("page.avi");
  EXPECT_EQ(testing::status_of(fetched), 200);
  EXPECT_EQ(testing::body_of(fetched), testing::slurp(file("page.avi")));
  EXPECT_NE(fetched.find("Content-Type: video/x-msvideo\r\n"), std::string::npos);
  EXPECT_EQ(testing::status_of(fetch("page.avi", false)), 403);
  for (const std::string& path : {std::string("command.avi"), std::string("page.avi.json"), kCut})
    EXPECT_EQ(testing::status_of(fetch(path)), 404) << path;
  for (const char* path : {"..%2Fx.avi", "%2Fetc%2Fpasswd", "nothing.avi"})
    EXPECT_EQ(testing::status_of(fetch(path)), 403) << path;
  fs::remove(file("page.avi"));
  fs::copy(file("command.avi"), file("page.avi"));
  EXPECT_EQ(testing::status_of(fetch("page.avi")), 404);

  client.send({{"id", 1000}, {"call", "session.export"}, {"params", {{"path", kCut}, {"output", "long.avi"}}}});
  for (;;) {
    const nlohmann::json message = nlohmann::json::parse(client.receive().bytes);
    if (message["id"] != 1000) continue;
    if (message.contains("progress")) {
      client.send({{"cancel", 1000}});
      continue;
    }
    EXPECT_TRUE(message.contains("errors")) << message;
    break;
  }
  for (const auto& entry : fs::directory_iterator(folder_.path()))
    EXPECT_EQ(entry.path().filename().string().find("long"), std::string::npos) << entry.path();
}

}  // namespace
}  // namespace ctpm
