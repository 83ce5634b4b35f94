// What an author reads when a text is not JSON; comments, and that they are kept.

#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>

#include "scenes/json_text.h"
#include "scenes/json_words.h"
#include "scenes/scene_file.h"
#include "scenes/script.h"

namespace ctpm {
namespace {

std::string error_of(const std::string& text) {
  const Result<scenes::JsonNode> node = scenes::parse_json(text, "t.json");
  return node ? "no error" : to_string(node.errors().front());
}

TEST(JsonWords, EachMistakeIsNamedWhereItStands) {
  EXPECT_EQ(error_of(std::string("SQLite format 3\0\x10", 17)),
            "t.json:1:1: error: this is a recorded session, or another database, and no text");
  EXPECT_EQ(error_of(std::string("MA\xa6\0\1", 5)), "t.json:1:1: error: this is no text");
  const std::pair<const char*, const char*> kMistakes[] = {
      {"", "t.json:1:1: error: the text is empty (it should begin with {)"},
      {"{\"a\": 1,\n}", "t.json:1:8: error: this comma is one too many: nothing follows it but } (remove it)"},
      {"[1, 2, ]", "t.json:1:6: error: this comma is one too many: nothing follows it but ] (remove it)"},
      {"{\"a\": 1\n \"b\": 2}", "t.json:2:2: error: a comma is missing before \""},
      {"[1 2]", "t.json:1:4: error: a comma is missing before 2"},
      {"{a: 1}", "t.json:1:2: error: a key in double quotes must stand here, not a (write \"a\")"},
      {R"({"a": 6,3})",
       "t.json:1:9: error: a key in double quotes must stand here, not 3 (numbers have a point, not a comma)"},
      {"{\u201ca\u201d: 1}",
       "t.json:1:2: error: a key in double quotes must stand here, not \u201ca\u201d (texts stand in straight double "
       "quotes, not in curly ones)"},
      {"{'a': 1}",
       "t.json:1:2: error: a key in double quotes must stand here, not ' (texts stand in double quotes, not "
       "in single ones)"},
      {"{\"a\": 'x'}", "t.json:1:7: error: texts stand in double quotes, not in single ones"},
      {"{\"a\" 1}", "t.json:1:6: error: a : is missing between the key \"a\" and its value"},
      {"{\"a\" = 1}", "t.json:1:6: error: a : is missing between the key \"a\" and its value (write : for =)"},
      {"{\"a\": }", "t.json:1:7: error: the key \"a\" has no value"},
      {"{\"a\": True}", "t.json:1:7: error: got True (write true, in small letters)"},
      {"{\"a\": NaN}", "t.json:1:7: error: NaN is not a number that a file can hold"},
      {"{\"a\": -Infinity}", "t.json:1:7: error: -Infinity is not a number that a file can hold"},
      {"{\"a\": .5}",
       "t.json:1:7: error: .5 is not a number as JSON writes it (numbers are written like 12, -0.5 or 1e-3)"},
      {"{\"a\": +5}",
       "t.json:1:7: error: +5 is not a number as JSON writes it (numbers are written like 12, -0.5 or 1e-3)"},
      {"{\"a\": 05}",
       "t.json:1:7: error: 05 is not a number as JSON writes it (numbers are written like 12, -0.5 or 1e-3)"},
      {"{\"a\": liver}",
       "t.json:1:7: error: got liver, which is neither a number nor a text (texts stand in double "
       "quotes: \"liver\")"},
      {"{\"a\": \"x\ny\"}",
       "t.json:1:7: error: this text has no closing quote in its line (a text cannot go over two lines)"},
      {"{\"a\": \"C:\\organs\"}",
       "t.json:1:11: error: \\o has no meaning in a text (write \\\\ for a backslash, and / in paths)"},
      {"{\n\"a\": [1, 2}\n", "t.json:2:11: error: got }, but the [ of line 2 needs ]"},
      {"{\n\"a\": [1, 2]\n", "t.json:3:1: error: the text ends too early (the { of line 1 has no })"},
      {"{} {}", "t.json:1:4: error: something follows the end of the text (remove it)"},
      {"{\"a\": 1} x", "t.json:1:10: error: something follows the end of the text (remove it)"},
      {"[1, /* no end", "t.json:1:5: error: a value must stand here, not /"},
  };
  for (const auto& [text, message] : kMistakes) EXPECT_EQ(error_of(text), message) << text;
}

TEST(JsonWords, AgreesWithTheParserAboutWhatIsJson) {
  const std::string good = R"({"a": [1, -0.5, 1e-3, {"b": "x\n\u00e9", "c": null}], "d": {}, "e": [], "f": true})";
  EXPECT_FALSE(scenes::find_json_mistake(good));
  std::mt19937 random(3);
  int broken = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string text = good;
    const std::size_t at = random() % text.size();
    switch (random() % 3) {
      case 0:
        text.erase(at, 1);
        break;
      case 1:
        text.insert(at, 1, "{}[],:\"x1-. "[random() % 12]);
        break;
      default:
        std::swap(text[at], text[random() % text.size()]);
    }
    const Result<scenes::JsonNode> node = scenes::parse_json(text, "t.json");
    EXPECT_EQ(bool(node), !scenes::find_json_mistake(text)) << text;
    broken += !node;
  }
  EXPECT_GT(broken, 1000);
}

const std::string kCommented = R"(// A scene of Dr. Müller
{
  "format": "ctpm-scene", "version": 1, /* ü */ "name": "a",
  "organs": [
    // the left one
    {"name": "l", "mesh": "a//b.obj", "fill": {"radius_mm": 4.0, "gap_mm": 4},
     "material": {"preset": "liver", "stiffness_scale": 2.50 /* fitted by hand */}}
  ],
  "tick_s": 9  // too long
}
)";

TEST(Comments, CountAsSpacesAndKeepPlaces) {
  const Result<scenes::SceneText> scene = scenes::read_scene(kCommented, "t.json");
  ASSERT_FALSE(scene);
  EXPECT_EQ(to_string(scene.errors().front()), "t.json:9:13: error: /tick_s: got 9, must be in [1e-6, 0.1] s");
  const Result<scenes::SceneDraft> draft = scenes::read_draft(kCommented, "t.json");
  ASSERT_TRUE(draft);
  EXPECT_EQ(draft->scene.spec.organs[0].mesh, "a//b.obj") << "no comment in a text";
  EXPECT_EQ(draft->scene.places.error_at("/name", "x").where, "t.json:3:57");
  EXPECT_TRUE(scenes::read_script("{\"format\": \"ctpm-script\", \"version\": 1, // why\n\"steps\": [{\"wait_s\": 1}]}",
                                  "s", {}));
}

TEST(Comments, AreKeptWhereAToolRewritesTheScene) {
  std::string text = kCommented;
  text.replace(text.find("9  //"), 1, "0.001");
  const Result<scenes::SceneText> scene = scenes::read_scene(text, "t.json");
  ASSERT_TRUE(scene);
  scenes::SceneSpec after = scene->spec;
  EXPECT_EQ(scenes::rewrite_scene(text, scene->spec, after), text) << "nothing changed";
  after.organs[0].material.stiffness_scale = 3.25;
  after.organs[0].material.fitted_for = scenes::FittedForSpec{{0.01, 0.02, 0.03}, 0.005, 0.004, 0.012, 1.5};
  after.organs[0].at = {0.001, 0, 0};
  const std::string changed = scenes::rewrite_scene(text, scene->spec, after);
  const Result<scenes::SceneText> again = scenes::read_scene(changed, "t.json");
  ASSERT_TRUE(again) << changed;
  EXPECT_EQ(again->spec, after);
  for (const char* part : {"// A scene of Dr. Müller\n{", "/* ü */", "    // the left one\n", "\"radius_mm\": 4.0",
                           "\"stiffness_scale\": 3.25, /* fitted by hand */ \"fitted_for\": {", "// too long"})
    EXPECT_NE(changed.find(part), std::string::npos) << part << " is not in\n" << changed;
  // A change that only the program's own layout can show.
  after.organs[0].material.preset = "", after.organs[0].material = {};
  after.organs[0].material.preset = "kidney";
  EXPECT_EQ(scenes::read_scene(scenes::rewrite_scene(text, scene->spec, after), "t.json")->spec, after);
}

TEST(Comments, AreKeptWhereAnOrganIsAdded) {
  const std::string organ = "{\"name\": \"l\", \"mesh\": \"a.obj\", \"material\": {\"preset\": \"liver\"}}";
  const std::string head = "{\"format\": \"ctpm-scene\", \"version\": 1, \"name\": \"a\",\n", tail = "// end\n}\n";
  for (const std::string& list :
       {"[" + organ + "] /* here */", "[\n  " + organ + " // first\n  // last\n]", "[\n  // only\n  " + organ + "]"}) {
    const std::string text = head + "\"organs\": " + list + ",\n\"tools\": []\n" + tail;
    const Result<scenes::SceneText> scene = scenes::read_scene(text, "t.json");
    ASSERT_TRUE(scene) << text;
    scenes::SceneSpec after = scene->spec;
    after.organs.push_back(after.organs[0]);
    after.organs[1].name = "second", after.organs[1].turn = {0, 0, 90}, after.organs[1].scale = 1.5;
    scenes::ToolSpec ball;
    ball.name = "ball", ball.radius = 0.01;
    after.tools.push_back(ball);
    const std::string changed = scenes::rewrite_scene(text, scene->spec, after);
    const Result<scenes::SceneText> again = scenes::read_scene(changed, "t.json");
    ASSERT_TRUE(again) << changed;
    EXPECT_EQ(again->spec, after);
    EXPECT_NE(changed.find(organ), std::string::npos) << changed;
    for (const char* comment : {"/* here */", "// first", "// last", "// only", "// end"})
      EXPECT_EQ(changed.find(comment) == std::string::npos, text.find(comment) == std::string::npos) << changed;
  }
}

TEST(Comments, PlacesByMeaningStayTextsWhereASceneIsRewritten) {
  const std::string text =
      "{\"format\": \"ctpm-scene\", \"version\": 1, \"name\": \"a\",\n\"organs\": [{\"name\": \"l\", \"mesh\": "
      "\"a.obj\", "
      "\"material\": {\"preset\": \"liver\"}}],\n\"probes\": [{\"name\": \"p\", \"at_mm\": \"top of l\"}]}\n";
  const Surface surface{{{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0.02}}, {{0, 1, 2}}, {}};
  scenes::PlaceFinder finder({{"l", &surface}}, {0, 0, -9.81});
  const Result<scenes::SceneDraft> draft = scenes::read_draft(text, "t.json", &finder);
  ASSERT_TRUE(draft);
  scenes::SceneSpec after = draft->scene.spec;
  after.organs[0].material.stiffness_scale = 2;
  const std::string changed = scenes::rewrite_scene(text, draft->scene.spec, after);
  EXPECT_NE(changed.find("\"at_mm\": \"top of l\""), std::string::npos) << changed;
  EXPECT_EQ(scenes::read_draft(changed, "t.json", &finder)->scene.spec, after) << changed;
}

TEST(Comments, EveryShippedSceneCanBeChangedAndKeepsTheRestOfItsText) {
  for (const std::string name : {"liver", "kidney", "kidney-capsule", "incision", "skin-incision", "two-organs"}) {
    SCOPED_TRACE(name);
    std::ifstream in(CTPM_SOURCE_DIR "/scenes/" + name + ".json");
    std::ostringstream text;
    text << in.rdbuf();
    const Result<scenes::SceneText> scene = scenes::read_scene(text.str(), name);
    ASSERT_TRUE(scene);
    scenes::SceneSpec after = scene->spec;
    after.organs[0].material.density = 1234;
    const std::string changed = scenes::rewrite_scene(text.str(), scene->spec, after);
    EXPECT_EQ(scenes::read_scene(changed, name)->spec, after);
    // One member more, or one number changed: all other lines are those of before.
    std::istringstream lines(text.str());
    int lost = 0;
    for (std::string line; std::getline(lines, line);) lost += changed.find(line) == std::string::npos;
    EXPECT_LE(lost, 1);
  }
}

}  // namespace
}  // namespace ctpm
