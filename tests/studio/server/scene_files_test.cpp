// Scenes that a client of the protocol renames, removes and brings back.

#include <gtest/gtest.h>

#include <ctime>
#include <fstream>

#include "tests/studio/server/serving.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Serving;
using testing::SocketClient;

class SceneFilesTest : public ::testing::Test {
 protected:
  SceneFilesTest() : folder_(outer_.path() / "folder") {
    fs::create_directories(folder_ / "organs");
    const fs::path scenes = fs::path(CTPM_SOURCE_DIR) / "scenes";
    for (const char* name : {"kidney.json", "liver.json", "organs/kidney.obj", "organs/liver.obj"})
      fs::copy(scenes / name, folder_ / name);
    fs::copy(scenes / "scripts/kidney-cut.json", folder_ / "kidney.script.json");
    write("course.json", R"({"format": "ctpm-course", // its "kidney.json"
      "tasks": [{"name": "a", "scene": "kidney.json"}, {"name": "b", "scene": "./liver.json"}]})");
    fs::create_directories(folder_ / "studies");
    write("studies/sweep.json",
          R"({"format": "ctpm-sweep", "scene": "../kidney.json", "script": "../kidney.script.json"})");
  }

  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  std::string read(const std::string& name) const { return testing::slurp(folder_ / name); }

  /// Refused with these words, and nothing in or around the folder has changed.
  void expect_refused(SocketClient& client, const std::string& call, const json& parameters, const std::string& words) {
    const std::string before = outer_.list();
    const json answer = client.call(call, parameters);
    EXPECT_NE(answer.value("errors", json()).dump().find(words), std::string::npos)
        << call << " " << parameters << ": " << answer;
    EXPECT_EQ(outer_.list(), before) << call << " " << parameters;
  }

  testing::TemporaryFolder outer_;
  const fs::path folder_;
};

json removal_of(SocketClient& client, const std::string& path) {
  const json answer = client.call("scene.removal", {{"path", path}});
  EXPECT_TRUE(answer.contains("result")) << answer;
  return answer.value("result", json());
}

TEST_F(SceneFilesTest, TheNameOfferedForAnImportIsFreeForItsMeshAndItsScriptToo) {
  const Serving serving(folder_);
  SocketClient client(serving);
  const auto offered = [&](const std::string& path) { return client.call("scene.import_name", {{"path", path}}); };
  EXPECT_EQ(offered("new.json")["result"]["path"], "new.json");
  EXPECT_EQ(offered("liver.json")["result"]["path"], "liver-2.json");
  EXPECT_EQ(offered("organs/liver.json")["result"]["path"], "organs/liver-2.json") << "its mesh is there";
  write("new.script.json", "{}");
  write("new-2.obj", "");
  EXPECT_EQ(offered("new.json")["result"]["path"], "new-3.json");
  EXPECT_TRUE(offered("../new.json").contains("errors"));
}

TEST_F(SceneFilesTest, WhatNamesAScenePathNamesItAnewOnceItIsRenamed) {
  const std::string scene = read("kidney.json"), script = read("kidney.script.json");
  const Serving serving(folder_);
  SocketClient client(serving);
  const json renamed = client.call("scene.rename", {{"path", "kidney.json"}, {"to", "left \"kidney\".json"}});
  ASSERT_TRUE(renamed.contains("result")) << renamed;
  EXPECT_EQ(renamed["result"]["moved"], json({"left \"kidney\".json", "left \"kidney\".script.json"}));
  EXPECT_EQ(renamed["result"]["rewritten"], json({"course.json", "studies/sweep.json"}));
  EXPECT_FALSE(fs::exists(folder_ / "kidney.json"));
  EXPECT_EQ(read("left \"kidney\".json"), scene);
  EXPECT_EQ(read("left \"kidney\".script.json"), script);
  EXPECT_EQ(read("course.json"), R"({"format": "ctpm-course", // its "kidney.json"
      "tasks": [{"name": "a", "scene": "left \"kidney\".json"}, {"name": "b", "scene": "./liver.json"}]})");
  EXPECT_EQ(
      read("studies/sweep.json"),
      R"({"format": "ctpm-sweep", "scene": "../left \"kidney\".json", "script": "../left \"kidney\".script.json"})");
  // Its meshes lie beside it as before, and a name back is one, too.
  EXPECT_TRUE(client.call("scene.show", {{"path", "left \"kidney\".json"}, {"stage", 3}}).contains("result"));
  EXPECT_TRUE(
      client.call("scene.rename", {{"path", "left \"kidney\".json"}, {"to", "kidney.json"}}).contains("result"));
  EXPECT_EQ(read("kidney.json"), scene);
}

TEST_F(SceneFilesTest, WhatOthersNeedStaysWhenASceneGoes) {
  fs::copy(folder_ / "kidney.json", folder_ / "kidney-2.json");
  const std::string before = outer_.list(), scene = read("kidney.json");
  const Serving serving(folder_);
  SocketClient client(serving);
  json removal = removal_of(client, "kidney.json");
  EXPECT_EQ(removal["goes"], json({"kidney.json", "kidney.script.json"}));
  EXPECT_EQ(removal["stays"],
            json({{{"path", "organs/kidney.obj"}, {"why", "kidney-2.json uses it"}},
                  {{"path", "course.json"}, {"why", "it names the scene, and will miss it"}},
                  {{"path", "studies/sweep.json"}, {"why", "it names the scene, and will miss it"}}}));
  const json removed = client.call("scene.remove", {{"path", "kidney.json"}, {"files", removal["goes"]}});
  ASSERT_TRUE(removed.contains("result")) << removed;
  EXPECT_FALSE(fs::exists(folder_ / "kidney.json") || fs::exists(folder_ / "kidney.script.json"));
  EXPECT_EQ(read(removed["result"]["folder"].get<std::string>() + "/kidney.json"), scene);
  // Nobody else uses the mesh now; what goes next goes elsewhere.
  removal = removal_of(client, "kidney-2.json");
  EXPECT_EQ(removal["goes"], json({"kidney-2.json", "organs/kidney.obj"}));
  const json second = client.call("scene.remove", {{"path", "kidney-2.json"}, {"files", removal["goes"]}});
  ASSERT_TRUE(second.contains("result")) << second;
  EXPECT_NE(second["result"]["folder"], removed["result"]["folder"]);
  EXPECT_EQ(client.call("folder.list", json::object())["result"]["scenes"].size(), 1u);
  // And all comes back, to the byte and without anything left over.
  for (const json& one : {second, removed})
    EXPECT_TRUE(client.call("scene.restore", {{"removed", one["result"]["removed"]}}).contains("result"));
  fs::remove(folder_ / ".ctpm-removed");
  EXPECT_EQ(outer_.list(), before);
  EXPECT_EQ(read("kidney.json"), scene);
}

TEST_F(SceneFilesTest, OnlyWhatIsListedIsRenamedOrRemoved) {
  write("secret.json", "{}");
  fs::copy(folder_ / "kidney.json", outer_.path() / "outside.json");
  fs::create_symlink(outer_.path() / "outside.json", folder_ / "way-out.json");
  fs::create_symlink("kidney.json", folder_ / "link.json");
  fs::create_directory_symlink("organs", folder_ / "linked");
  fs::copy(folder_ / "kidney.json", folder_ / "organs/inner.json");
  const Serving serving(folder_);
  SocketClient client(serving);
  const json none = json::array();
  for (const auto& [path, words] :
       std::vector<std::pair<const char*, const char*>>{{"../outside.json", "lies outside"},
                                                        {"/etc/passwd", "lies outside"},
                                                        {"way-out.json", "lies outside"},
                                                        {"secret.json", "not among the scenes"},
                                                        {"course.json", "not among the scenes"},
                                                        {"kidney.script.json", "not among the scenes"},
                                                        {"organs/kidney.obj", "not among the scenes"},
                                                        {"organs/../kidney.json", "not among the scenes"},
                                                        {"linked/inner.json", "not among the scenes"},
                                                        {".", "not among the scenes"},
                                                        {"nowhere.json", "does not exist"},
                                                        {"link.json", "is a link"}}) {
    expect_refused(client, "scene.rename", {{"path", path}, {"to", "new.json"}}, words);
    expect_refused(client, "scene.removal", {{"path", path}}, words);
    expect_refused(client, "scene.remove", {{"path", path}, {"files", {path}}}, words);
  }
  for (const json& files :
       {none, json::array({"kidney.json"}), json({"kidney.json", "kidney.script.json", "liver.json"})})
    expect_refused(client, "scene.remove", {{"path", "kidney.json"}, {"files", files}}, "other files than these");
}

TEST_F(SceneFilesTest, ANewNameIsOneOfASceneInTheSameFolderThatNothingHas) {
  const Serving serving(folder_);
  SocketClient client(serving);
  write("new.script.json", "{}");
  for (const auto& [to, words] :
       std::vector<std::pair<std::string, const char*>>{{"liver.json", "exists already"},
                                                        {"kidney.json", "exists already"},
                                                        {"new.json", "exists already"},  // its script
                                                        {"../kidney-2.json", "lies outside"},
                                                        {"/tmp/kidney-2.json", "lies outside"},
                                                        {"organs/kidney-2.json", "no name for this scene"},
                                                        {"nowhere/kidney-2.json", "does not exist"},
                                                        {"kidney-2", "must end in .json"},
                                                        {"", "must end in .json"},
                                                        {".json", "no name for a file"},
                                                        {".hidden.json", "no name for a file"},
                                                        {"kidney.notes.json", "no name for this scene"},
                                                        {std::string(300, 'k') + ".json", "no name for a file"}})
    expect_refused(client, "scene.rename", {{"path", "kidney.json"}, {"to", to}}, words);
}

TEST_F(SceneFilesTest, ASceneThatSomebodyWorksWithStays) {
  const Serving serving(folder_);
  SocketClient client(serving), other(serving);
  const json rename = {{"path", "kidney.json"}, {"to", "new.json"}}, removal = {{"path", "kidney.json"}};
  const json remove = {{"path", "kidney.json"}, {"files", {"kidney.json", "kidney.script.json", "organs/kidney.obj"}}};
  const auto expect_all_refused = [&](SocketClient& by, const char* words) {
    expect_refused(by, "scene.rename", rename, words);
    expect_refused(by, "scene.removal", removal, words);
    expect_refused(by, "scene.remove", remove, words);
  };
  ASSERT_TRUE(other.call("scene.show", {{"path", "kidney.json"}, {"stage", 3}}).contains("result"));
  expect_all_refused(client, "open in another page");
  EXPECT_TRUE(other.call("scene.removal", removal).contains("result")) << "who shows it may remove it";
  // Who leaves it, or shows another one, gives it free, but holds what is not saved; so does the end of the page.
  ASSERT_TRUE(other.call("scene.close", {{"stage", 3}}).contains("result"));
  EXPECT_TRUE(client.call("scene.removal", removal).contains("result"));
  ASSERT_TRUE(other.call("scene.show", {{"path", "kidney.json"}, {"stage", 3}}).contains("result"));
  ASSERT_TRUE(other.call("scene.show", {{"path", "liver.json"}, {"stage", 3}}).contains("result"));
  EXPECT_TRUE(client.call("scene.removal", removal).contains("result"));
  ASSERT_TRUE(other.call("scene.hold", {{"paths", {"kidney.json", "gone.json"}}}).contains("result"));
  expect_all_refused(client, "changes in another page that are not saved");
  EXPECT_TRUE(other.call("scene.removal", removal).contains("result")) << "its own";
  expect_refused(other, "scene.hold", {{"paths", {"../kidney.json"}}}, "lies outside");
  expect_all_refused(client, "changes in another page that are not saved");
  ASSERT_TRUE(other.call("scene.hold", {{"paths", json::array()}}).contains("result"));
  EXPECT_TRUE(client.call("scene.removal", removal).contains("result"));
  {
    SocketClient leaving(serving);
    ASSERT_TRUE(leaving.call("scene.show", {{"path", "kidney.json"}, {"stage", 3}}).contains("result"));
    ASSERT_TRUE(leaving.call("scene.hold", {{"paths", {"kidney.json"}}}).contains("result"));
    expect_all_refused(client, "open in another page");
  }
  bool is_free = false;
  for (int i = 0; i < 500 && !is_free; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(20)))
    is_free = client.call("scene.removal", removal).contains("result");
  EXPECT_TRUE(is_free);
  ASSERT_TRUE(client.call("train.begin", {{"scene", "kidney.json"}, {"stage", 2}}).contains("result"));
  expect_all_refused(client, "being trained in");
  expect_all_refused(other, "being trained in");
  ASSERT_TRUE(client.call("train.end", json::object()).contains("result"));
  EXPECT_TRUE(other.call("scene.rename", rename).contains("result"));
}

TEST_F(SceneFilesTest, NothingIsBroughtBackOverAFileOrFromElsewhere) {
  const Serving serving(folder_);
  SocketClient client(serving);
  const json removal = removal_of(client, "liver.json");
  const json removed = client.call("scene.remove", {{"path", "liver.json"}, {"files", removal["goes"]}});
  ASSERT_TRUE(removed.contains("result")) << removed;
  write("liver.json", "somebody else's");
  for (const char* number : {"", "..", "../..", "0", "1/..", "2", "/", "1x"})
    expect_refused(client, "scene.restore", {{"removed", number}}, "nothing was removed under that number");
  expect_refused(client, "scene.restore", {{"removed", "1"}}, "exists already");
  EXPECT_EQ(read("liver.json"), "somebody else's");
  // A folder that somebody put in the place of what was removed, and that leads elsewhere.
  fs::create_directories(outer_.path() / "else/1");
  std::ofstream(outer_.path() / "else/1/planted.json") << "{}";
  fs::rename(folder_ / ".ctpm-removed", outer_.path() / "removed");
  fs::create_directory_symlink(outer_.path() / "else", folder_ / ".ctpm-removed");
  expect_refused(client, "scene.restore", {{"removed", "1"}}, "nothing was removed under that number");
  const json kidney = removal_of(client, "kidney.json");
  expect_refused(client, "scene.remove", {{"path", "kidney.json"}, {"files", kidney["goes"]}},
                 "cannot be made a folder");
}

/// A removal of a scene with all that goes with it.
json remove_all(SocketClient& client, const std::string& path) {
  const json answer = client.call("scene.remove", {{"path", path}, {"files", removal_of(client, path)["goes"]}});
  EXPECT_TRUE(answer.contains("result")) << answer;
  return answer.value("result", json());
}

TEST_F(SceneFilesTest, WhatWasRemovedIsListedUntilItIsBackOrDeletedForGood) {
  fs::copy(folder_ / "kidney.json", folder_ / "kidney-2.json");
  const double before_s = double(std::time(nullptr)) - 2;
  const Serving serving(folder_);
  SocketClient client(serving);
  const json none = json::object();
  EXPECT_EQ(client.call("scene.removed", none)["result"], json::array());
  const std::string first = remove_all(client, "kidney.json")["removed"];  // its mesh stays with kidney-2
  const std::string second = remove_all(client, "kidney-2.json")["removed"];
  // It is told by the folder alone, as after a new start of the program.
  const Serving again(folder_);
  SocketClient other(again);
  json listed = other.call("scene.removed", none)["result"];
  ASSERT_EQ(listed.size(), 2u) << listed;
  if (listed[0]["removed"] == first) std::swap(listed[0], listed[1]);  // in the same moment
  const auto bytes_of = [&](const std::string& name) { return fs::file_size(folder_ / ".ctpm-removed" / name); };
  EXPECT_EQ(listed[1]["path"], "kidney.json");
  EXPECT_EQ(
      listed[1]["files"],
      json({{{"path", "kidney.json"}, {"bytes", bytes_of(first + "/kidney.json")}, {"used_by", ""}},
            {{"path", "kidney.script.json"}, {"bytes", bytes_of(first + "/kidney.script.json")}, {"used_by", ""}}}));
  EXPECT_EQ(listed[0]["path"], "kidney-2.json");
  EXPECT_EQ(listed[0]["files"][1], json({{"path", "organs/kidney.obj"},
                                         {"bytes", bytes_of(second + "/organs/kidney.obj")},
                                         {"used_by", "kidney.json"}}));
  for (const json& one : listed) {
    EXPECT_GT(one["removed_s"].get<double>(), before_s);
    EXPECT_LT(one["removed_s"].get<double>(), double(std::time(nullptr)) + 2);
  }
  // Only what was told goes, and nothing but that.
  for (const json& files :
       {json::array(), json::array({"kidney.json"}), json({"kidney.json", "kidney.script.json", "x"})})
    expect_refused(client, "scene.delete", {{"removed", first}, {"files", files}}, "other files than these");
  const json deleted =
      client.call("scene.delete", {{"removed", first}, {"files", {"kidney.script.json", "kidney.json"}}});
  EXPECT_TRUE(deleted.contains("result")) << deleted;
  EXPECT_FALSE(fs::exists(folder_ / ".ctpm-removed" / first));
  EXPECT_TRUE(client.call("scene.restore", {{"removed", second}}).contains("result"));
  EXPECT_EQ(client.call("scene.removed", none)["result"], json::array());
  EXPECT_TRUE(fs::exists(folder_ / "kidney-2.json") && fs::exists(folder_ / "organs/kidney.obj"));
}

TEST_F(SceneFilesTest, NothingElsewhereIsDeletedForGood) {
  const Serving serving(folder_);
  SocketClient client(serving);
  const std::string number = remove_all(client, "liver.json")["removed"];
  for (const char* wrong : {"", "..", "../..", "0", "1/..", "1/organs", "/", "1x"})
    expect_refused(client, "scene.delete", {{"removed", wrong}, {"files", json::array()}},
                   "nothing was removed under that number");
  // A link among the files is neither told nor followed, and its folder stays with it.
  std::ofstream(outer_.path() / "outside.json") << "{}";
  fs::create_symlink(outer_.path() / "outside.json", folder_ / ".ctpm-removed" / number / "link.json");
  fs::create_directory_symlink(outer_.path(), folder_ / ".ctpm-removed" / number / "out");
  fs::create_directory_symlink(folder_ / "organs", folder_ / ".ctpm-removed/77");
  const json listed = client.call("scene.removed", json::object())["result"];
  ASSERT_EQ(listed.size(), 1u) << listed;
  EXPECT_EQ(listed[0]["files"].size(), 2u) << listed;
  const json files = {"liver.json", "organs/liver.obj"};
  expect_refused(client, "scene.delete", {{"removed", "77"}, {"files", {"kidney.obj"}}}, "nothing was removed");
  EXPECT_TRUE(client.call("scene.delete", {{"removed", number}, {"files", files}}).contains("result"));
  EXPECT_TRUE(fs::exists(outer_.path() / "outside.json") && fs::exists(folder_ / "organs/kidney.obj"));
  EXPECT_TRUE(fs::is_symlink(folder_ / ".ctpm-removed" / number / "link.json"));
  EXPECT_EQ(client.call("scene.removed", json::object())["result"], json::array());
}

TEST_F(SceneFilesTest, TheSceneOfEachSessionIsKnown) {
  for (const char* name : {"kidney-cut-expert", "kidney-cut-clumsy", "liver-press-expert"})
    fs::copy(fs::path(CTPM_SHIPPED_SESSIONS) / (std::string(name) + ".ctpm"), folder_ / (std::string(name) + ".ctpm"));
  write("broken.ctpm", "no session");
  const Serving serving(folder_);
  SocketClient client(serving);
  const json answer = client.call("session.scenes", json::object());
  ASSERT_TRUE(answer.contains("result")) << answer;
  const json scenes = answer["result"];
  ASSERT_EQ(scenes.size(), 3u) << scenes;
  EXPECT_EQ(scenes[0]["path"], "kidney-cut-clumsy.ctpm");
  EXPECT_EQ(scenes[0]["scene_key"], scenes[1]["scene_key"]);
  EXPECT_NE(scenes[0]["scene_key"], scenes[2]["scene_key"]);
  EXPECT_EQ(scenes[0]["scene_name"], json::parse(read("kidney.json"))["name"]);
  const json motion = client.call("session.motion", {{"path", "kidney-cut-expert.ctpm"}, {"rate_hz", 10}});
  EXPECT_EQ(scenes[1]["scene_key"], motion["result"]["scene_key"]);
  // A file that becomes another one is read again.
  fs::copy(folder_ / "liver-press-expert.ctpm", folder_ / "kidney-cut-clumsy.ctpm",
           fs::copy_options::overwrite_existing);
  EXPECT_EQ(client.call("session.scenes", json::object())["result"][0]["scene_key"], scenes[2]["scene_key"]);
}

}  // namespace
}  // namespace ctpm
