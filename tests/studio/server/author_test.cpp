// A scene that a client of the protocol works on.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <set>
#include <string_view>
#include <thread>

#include "importers/text.h"
#include "tests/studio/commands/running_program.h"
#include "tests/studio/output/short_files.h"
#include "tests/studio/server/serving.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::Serving;
using testing::ShortFiles;
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

TEST_F(AuthorTest, WhatLiesAtAnOddPlaceIsWarnedOfAsCheckDoes) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  text_["probes"] = {{{"name", "far"}, {"at_mm", {0, 0, 900}}}};
  const auto shown = client.call("scene.show", {{"path", "kidney.json"}, {"stage", kStage}, {"text", text_.dump(1)}});
  ASSERT_TRUE(shown.contains("result")) << shown.dump();
  const auto& warnings = shown["result"]["warnings"];
  ASSERT_EQ(warnings.size(), 1u) << warnings.dump();
  EXPECT_NE(warnings[0].dump().find("from the nearest tissue"), std::string::npos) << warnings.dump();
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
  for (const auto& error : answer["errors"]) {
    // The same place in the text, under the name of the other file.
    const std::string where = error["where"], place = where.substr(where.find(':'));
    EXPECT_NE(place, where) << answer;
    EXPECT_NE(printed.err.find("other.json" + place + ": error: "), std::string::npos) << printed.err << answer;
    EXPECT_NE(printed.err.find(error["message"].get<std::string>()), std::string::npos) << printed.err;
    EXPECT_NE(printed.err.find(error["hint"].get<std::string>()), std::string::npos) << printed.err << error;
  }
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

TEST_F(AuthorTest, TheShapeErrorOfAFillingIsThatOfPlan) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  std::vector<std::string> told;
  for (const double radius : {4, 2, 9}) {
    text_["organs"][0]["fill"] = {{"radius_mm", radius}, {"gap_mm", radius}};
    const auto shown = client.call("scene.show", {{"path", "kidney.json"}, {"stage", kStage}, {"text", text_.dump()}});
    ASSERT_TRUE(shown.contains("result")) << shown;
    told.push_back(shown["result"]["organs"][0]["shape_error"]);
    std::ofstream(folder_.path() / "kidney.json") << text_.dump();
    const auto plan = testing::run_ctpm({"plan", "kidney.json", "--quick"}, folder_.path());
    EXPECT_NE(plan.out.find("shape of kidney, " + told.back() + "\n"), std::string::npos) << plan.out << told.back();
    const auto json = testing::run_ctpm({"plan", "kidney.json", "--quick", "--json"}, folder_.path());
    const auto figures = nlohmann::json::parse(json.out)["shape_errors"][0];
    EXPECT_EQ(figures["organ"], "kidney");
    EXPECT_GT(figures["largest_mm"].get<double>(), figures["p95_mm"].get<double>());
    EXPECT_NE(told.back().find("95 % within " + importers::mm_text(1e-3 * figures["p95_mm"].get<double>())),
              std::string::npos);
    // What is too thin for its spheres is said in the same words, too.
    const std::string thin = shown["result"]["organs"][0]["thin_parts"];
    EXPECT_EQ(thin.empty(), plan.err.find("spheres lie in tissue thinner than") == std::string::npos) << plan.err;
    EXPECT_NE(plan.err.find(thin), std::string::npos) << thin << plan.err;
    EXPECT_EQ(thin.empty(), radius < 8) << thin;
  }
  EXPECT_NE(told[0], told[1]);
}

/// Calls, and returns what the call told of its progress: done and total.
std::vector<std::pair<double, double>> progress_of(SocketClient& client, const std::string& call,
                                                   const nlohmann::json& parameters) {
  std::vector<std::pair<double, double>> told;
  static int id = 1000;  // one of their own each
  client.send({{"id", ++id}, {"call", call}, {"params", parameters}});
  for (;;) {
    const auto message = client.receive();
    if (!message.is_text) continue;
    const nlohmann::json answer = nlohmann::json::parse(message.bytes);
    if (answer.value("id", 0) != id) continue;
    if (!answer.contains("progress")) {
      EXPECT_TRUE(answer.contains("result")) << answer;
      return told;
    }
    told.emplace_back(answer["progress"]["done"], answer["progress"]["total"]);
  }
}

TEST_F(AuthorTest, FillingAndMeasuringTellHowFarTheyAre) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  text_["organs"][0]["fill"] = {{"radius_mm", 1}, {"gap_mm", 1}};  // long enough to be told of
  text_["organs"].push_back(text_["organs"][0]);
  text_["organs"][1]["name"] = "other", text_["organs"][1]["at_mm"] = {100, 0, 0};
  const auto filled =
      progress_of(client, "scene.show", {{"path", "kidney.json"}, {"stage", kStage}, {"text", text_.dump()}});
  ASSERT_GE(filled.size(), 2u);
  for (std::size_t i = 0; i < filled.size(); ++i) {
    EXPECT_LE(filled[i].first, filled[i].second);
    if (i > 0) {
      EXPECT_GE(filled[i].first, filled[i - 1].first) << "a share of all organs never falls";
    }
  }
  EXPECT_GT(filled.back().first, 0);
  const auto measured = progress_of(client, "scene.measure", {{"stage", kStage}});
  ASSERT_GE(measured.size(), 2u);
  for (std::size_t i = 1; i < measured.size(); ++i) {
    EXPECT_GE(measured[i].first, measured[i - 1].first) << "ticks that are done";
    EXPECT_LE(measured[i].second, measured[i - 1].second) << "it may need fewer than at most";
  }
  EXPECT_GT(measured.back().first, measured.front().first);
  EXPECT_LT(measured.back().first, measured.back().second);
}

TEST_F(AuthorTest, AWriteThatFailsInTheMiddleLeavesTheSceneWhole) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const auto read = client.call("scene.read", {{"path", "kidney.json"}})["result"];
  const std::string before = read["text"];
  const std::string longer = before + std::string(200'000, ' ');
  const auto files = [&] {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) names.insert(entry.path().filename());
    return names;
  };
  const auto names = files();
  nlohmann::json failed;
  {
    const ShortFiles limit(100'000);
    failed = client.call("scene.write", {{"path", "kidney.json"}, {"text", longer}, {"revision", read["revision"]}});
  }
  ASSERT_TRUE(failed.contains("errors")) << failed;
  EXPECT_NE(failed["errors"][0]["message"].get<std::string>().find("cannot be written"), std::string::npos) << failed;
  EXPECT_EQ(client.call("scene.read", {{"path", "kidney.json"}})["result"], read);
  EXPECT_EQ(files(), names) << "nothing half written is left beside it";
  EXPECT_TRUE(client.call("scene.write", {{"path", "kidney.json"}, {"text", longer}, {"revision", read["revision"]}})
                  .contains("result"));
  EXPECT_EQ(client.call("scene.read", {{"path", "kidney.json"}})["result"]["text"], longer);
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

TEST_F(AuthorTest, AFitIsThatOfTheCommandAndKeepsTheRestOfTheText) {
  text_["organs"][0]["fill"] = {{"radius_mm", 6}, {"gap_mm", 6}};
  const std::string text = "// mine\n" + text_.dump(2);
  const Serving serving(folder_.path());
  SocketClient client(serving);
  nlohmann::json asked = {{"path", "kidney.json"}, {"text", text}, {"organ", "kidney"}};
  const auto fitted = client.call("scene.fit", asked)["result"];
  std::ofstream(folder_.path() / "kidney.json") << text;
  const auto command = testing::run_ctpm({"fit", "kidney.json", "--organ", "kidney", "--write"}, folder_.path());
  ASSERT_EQ(command.code, 0) << command.err;
  EXPECT_EQ(fitted["text"], testing::slurp(folder_.path() / "kidney.json"));
  const auto scene = nlohmann::json::parse(fitted["text"].get<std::string>(), nullptr, true, true);
  const auto& material = scene["organs"][0]["material"];
  EXPECT_EQ(material["fitted_for"]["sphere_radius_mm"], 6);
  EXPECT_NEAR(material["stiffness_scale"].get<double>(), fitted["stiffness_scale"].get<double>(), 1e-5);
  EXPECT_NE(material["stiffness_scale"], text_["organs"][0]["material"]["stiffness_scale"]);
  ASSERT_EQ(fitted["rows"].size(), 6u);
  EXPECT_NEAR(fitted["rows"][5]["error"].get<double>(), 0, 0.002);
  EXPECT_EQ(fitted["is_of_table"], true);
  asked["organ"] = "liver";
  const auto refused = client.call("scene.fit", asked);
  ASSERT_TRUE(refused.contains("errors")) << refused;
  EXPECT_EQ(refused["errors"][0]["where"], "organ");
  EXPECT_EQ(refused["errors"][0]["hint"], "it has: kidney");
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
  nlohmann::json presses;
  const auto fit = stopped(client, "scene.fit", {{"path", "kidney.json"}, {"text", text_.dump()}}, &presses);
  ASSERT_TRUE(fit.contains("errors")) << fit;
  EXPECT_EQ(fit["errors"][0]["message"], "stopped");
  EXPECT_EQ(presses["total"], 45) << presses;
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

class UploadTest : public AuthorTest {
 protected:
  /// `page`: the one that sends it; empty: a program does.
  void upload(const std::string& name, const std::string& bytes, const std::string& page = "") const {
    const std::string of_page = page.empty() ? "" : "Ctpm-Page: " + page + "\r\n";
    const std::string more = serving_.bearer() + of_page + "Content-Length: " + std::to_string(bytes.size()) + "\r\n";
    const std::string answer =
        testing::response_to(serving_.port(), serving_.head("PUT /upload/" + name, more) + bytes);
    ASSERT_EQ(testing::status_of(answer), 201) << answer;
  }
  bool is_there(const std::string& name) const { return fs::exists(folder_.path() / name); }
  /// Waits until it is gone; whether it goes within seconds.
  bool goes(const std::string& name) const {
    for (int i = 0; i < 500 && is_there(name); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return !is_there(name);
  }
  static nlohmann::json import_of(const std::string& mesh, const std::string& scene) {
    return {{"mesh", mesh}, {"scene", scene}, {"radius_m", 0.006}, {"organ", "kidney"}};
  }

  Serving serving_{folder_.path()};
};

TEST_F(UploadTest, AnImportThatMadeASceneLeavesNoUploadBesideItsMesh) {
  const std::string kidney = testing::slurp(folder_.path() / "organs/kidney.obj");
  SocketClient client(serving_);
  upload("mine.obj", holed_kidney());
  nlohmann::json import = import_of("mine.obj", "made.json");
  EXPECT_TRUE(client.call("scene.import", import).contains("errors"));
  EXPECT_TRUE(is_there("mine.obj")) << "for another try";
  import["largest_hole_m"] = 0.1;
  const auto made = client.call("scene.import", import);
  ASSERT_TRUE(made.contains("result")) << made;
  EXPECT_FALSE(is_there("mine.obj"));
  EXPECT_TRUE(is_there("made.json") && is_there("made.obj"));
  EXPECT_TRUE(client.call("scene.show", {{"path", "made.json"}, {"stage", kStage}}).contains("result"));
  // What somebody else uses, has changed or brought stays.
  upload("used.obj", kidney);
  text_["organs"][0]["mesh"] = "used.obj";
  std::ofstream(folder_.path() / "user.json") << text_.dump();
  EXPECT_TRUE(client.call("scene.import", import_of("used.obj", "made-2.json")).contains("result"));
  EXPECT_TRUE(is_there("used.obj"));
  EXPECT_TRUE(client.call("scene.import", import_of("organs/kidney.obj", "made-3.json")).contains("result"));
  EXPECT_TRUE(is_there("organs/kidney.obj"));
}

TEST_F(UploadTest, NothingStaysOfATryWhosePageIsGone) {
  upload("holed.obj", holed_kidney()), upload("changed.obj", holed_kidney()), upload("other.obj", holed_kidney());
  const nlohmann::json wrong = {{"mesh", "other.obj"}, {"scene", "made.json"}, {"unknown", 1}};
  {
    SocketClient client(serving_);
    for (const char* name : {"holed.obj", "changed.obj"})
      EXPECT_TRUE(client.call("scene.import", import_of(name, "made.json")).contains("errors"));
    EXPECT_TRUE(client.call("scene.import", wrong).contains("errors"));
    EXPECT_TRUE(is_there("holed.obj") && is_there("other.obj"));
    std::ofstream(folder_.path() / "changed.obj") << "by its author";
  }
  EXPECT_TRUE(goes("holed.obj") && goes("other.obj"));
  EXPECT_TRUE(is_there("changed.obj"));
  // One whose import the end of its page stops.
  upload("holed.obj", holed_kidney());
  {
    SocketClient client(serving_);
    nlohmann::json import = import_of("holed.obj", "made.json");
    import["largest_hole_m"] = 0.1, import["radius_m"] = 0.001;
    client.send({{"id", 1}, {"call", "scene.import"}, {"params", import}});
    while (!client.receive().is_text) continue;  // it goes on
  }
  EXPECT_TRUE(goes("holed.obj"));
  EXPECT_FALSE(is_there("made.json"));
}

/// What a page offers that calls itself by that name.
std::string called(const std::string& page) { return std::string(server::kSubprotocol) + ", page." + page; }

TEST_F(UploadTest, AnUploadGoesWithItsPageBeforeAnyImport) {
  SocketClient other(serving_, called("other"));
  {
    SocketClient page(serving_, called("one"));
    upload("mine.obj", "mesh", "one"), upload("changed.obj", "mesh", "one"), upload("program.obj", "mesh");
    upload("others.obj", "mesh", "other");
    EXPECT_TRUE(page.call("scene.presets", nlohmann::json::object()).contains("result"));
    EXPECT_TRUE(is_there("mine.obj"));
    std::ofstream(folder_.path() / "changed.obj") << "by its author";
  }
  EXPECT_TRUE(goes("mine.obj"));
  // One that is whole when its page is gone already.
  upload("late.obj", "mesh", "one");
  EXPECT_TRUE(goes("late.obj"));
  for (const char* name : {"changed.obj", "program.obj", "others.obj"}) EXPECT_TRUE(is_there(name)) << name;
}

TEST_F(UploadTest, ADiskThatTakesNoMoreIsToldAndKeepsNothingOfTheFile) {
  const ShortFiles full(1000);
  const std::string bytes(100000, 'm');
  const std::string answer = testing::response_to(
      serving_.port(), serving_.head("PUT /upload/a.obj",
                                     serving_.bearer() + "Content-Length: " + std::to_string(bytes.size()) + "\r\n") +
                           bytes);
  EXPECT_EQ(testing::status_of(answer), 507) << answer;
  EXPECT_NE(answer.find("nothing of the file was kept: File too large"), std::string::npos) << answer;
  EXPECT_EQ(folder_.list().find("a.obj"), std::string::npos) << folder_.list();
}

TEST_F(UploadTest, TheNextStudioRemovesWhatAKilledOneLeft) {
  const auto put = [&](int port, const std::string& token, const std::string& name, const std::string& announced) {
    return "PUT /upload/" + name + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
           "\r\nAuthorization: Bearer " + token + "\r\nCtpm-Page: one\r\nContent-Length: " + announced + "\r\n\r\nmesh";
  };
  const auto parts = [&] {
    const std::string names = folder_.list();
    return names.find("part.obj.part-") != std::string::npos;
  };
  text_["organs"][0]["mesh"] = "named.obj";
  std::ofstream(folder_.path() / "user.json") << text_.dump();
  {
    testing::RunningProgram program({"studio", "--no-open", "--port", "0"}, folder_.path());
    std::string address;
    ASSERT_TRUE(program.wait_until(
        [&] { return (address = testing::slurp(folder_.path() / ".stdout")).find('\n') != std::string::npos; }));
    const int port = std::stoi(address.substr(address.rfind(':') + 1));
    const std::string token = address.substr(address.find('=') + 1, 64);
    SocketClient page(port, token, called("one"));
    for (const char* name : {"left.obj", "changed.obj", "named.obj"})
      ASSERT_EQ(testing::status_of(testing::response_to(port, put(port, token, name, "4"))), 201);
    const testing::RawClient slow(port);
    slow.send(put(port, token, "part.obj", "400"));
    ASSERT_TRUE(program.wait_until(parts));
    ::kill(program.process(), SIGKILL);
  }
  std::ofstream(folder_.path() / "changed.obj") << "by its author";
  std::ofstream(folder_.path() / "left.obj.part-users") << "another one's";
  ASSERT_TRUE(is_there("left.obj"));
  { const Serving next(folder_.path()); }
  EXPECT_FALSE(is_there("left.obj") || parts());
  for (const char* name : {"changed.obj", "named.obj", "left.obj.part-users", "kidney.json"})
    EXPECT_TRUE(is_there(name)) << name;
  EXPECT_EQ(folder_.list().find("ctpm-uploads"), std::string::npos) << folder_.list();
}

TEST_F(UploadTest, AListFromAStrangerRemovesNoFileOfTheUsers) {
  std::ofstream(folder_.path() / "mine.ctpm") << "a session";
  std::ofstream(folder_.path() / ".ctpm-uploads-stranger", std::ios::binary)
      << std::string_view("mine.ctpm\0\0kidney.json\0\0../kidney.json\0\0", 40);
  { const Serving next(folder_.path()); }
  EXPECT_TRUE(is_there("mine.ctpm") && is_there("kidney.json"));
}

TEST_F(UploadTest, AnotherStudioOfTheFolderLeavesTheUploadsOfOneThatRuns) {
  SocketClient page(serving_, called("one"));
  upload("mine.obj", "mesh", "one");
  { const Serving next(folder_.path()); }
  EXPECT_TRUE(is_there("mine.obj"));
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
