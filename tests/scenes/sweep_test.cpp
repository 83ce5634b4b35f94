#include "scenes/sweep.h"

#include <gtest/gtest.h>

#include "tests/scenes/schema_check.h"

namespace ctpm::scenes {
namespace {

std::string sweep_with(const std::string& vary, const std::string& more = "") {
  return "{\"format\": \"ctpm-sweep\", \"version\": 1, \"name\": \"s\", \"scene\": \"a.json\", " + more +
         "\"vary\": [" + vary + "]}";
}

std::string error_of(const std::string& text) {
  const Result<SweepText> sweep = read_sweep(text, "s.json");
  return sweep ? "" : to_string(sweep.errors().front());
}

TEST(SweepFile, KeepsValuesAsTheyAreWritten) {
  const Result<SweepText> sweep = read_sweep(
      sweep_with(R"({"key": "/a", "values": [1.50, "b", true, [1, 2, 3e1]]}, {"of": "script", "values": ["x.json"]})"),
      "s.json");
  ASSERT_TRUE(sweep) << to_string(sweep.errors().front());
  const SweepAxis& axis = sweep->spec.vary[0];
  ASSERT_EQ(axis.values.size(), 4u);
  EXPECT_EQ(axis.values[0].json, "1.50");
  EXPECT_EQ(axis.values[0].number, 1.5);
  EXPECT_EQ(axis.values[1].json, "\"b\"");
  EXPECT_EQ(axis.values[1].shown, "b");
  EXPECT_EQ(axis.values[2].json, "true");
  EXPECT_EQ(axis.values[3].json, "[1, 2, 3e1]");
  EXPECT_EQ(axis.values[3].shown, "1 2 3e1");
  EXPECT_EQ(axis.column(), "a");
  EXPECT_EQ(sweep->spec.vary[1].column(), "script");
}

TEST(SweepFile, SaysAllMistakesAtOnceWithTheirPlaces) {
  const Result<SweepText> sweep = read_sweep(
      "{\"format\": \"ctpm-sweep\", \"version\": 1, \"name\": \"s\", \"scene\": \"a.json\",\n"
      " \"samples\": 3,\n"
      " \"vary\": [{\"key\": \"/a\"},\n"
      "  {\"key\": \"b\", \"values\": [1, 1]},\n"
      "  {\"kye\": \"/c\", \"values\": [{}]}]}",
      "s.json");
  ASSERT_FALSE(sweep);
  std::string all;
  for (const Error& error : sweep.errors()) all += to_string(error) + "\n";
  for (const char* part : {"s.json:2:13: error: /samples: belongs to a Latin hypercube",
                           "s.json:3:11: error: /vary/0: ", "neither values nor a range",
                           "s.json:4:11: error: /vary/1/key: got \"b\", must begin with /",
                           "s.json:4:30: error: /vary/1/values/1: got 1, which is there already",
                           "s.json:5:4: ", "\"key\"", "s.json:5:28: error: /vary/2/values/0: "})
    EXPECT_NE(all.find(part), std::string::npos) << part << "\nin\n" << all;
}

TEST(SweepFile, RefusesWhatDoesNotFitTogether) {
  EXPECT_EQ(error_of(sweep_with(R"({"key": "/a", "from": 1, "to": 2, "steps": 3})")), "");
  for (const auto& [vary, more, said] : std::vector<std::array<std::string, 3>>{
           {R"({"key": "/a", "from": 1, "to": 2})", "", "needs steps"},
           {R"({"key": "/a", "from": 1, "steps": 2})", "", "needs from and to"},
           {R"({"key": "/a", "from": 2, "to": 1, "steps": 2})", "", "more than from"},
           {R"({"key": "/a", "from": 0, "to": 1, "steps": 2, "scale": "logarithmic"})", "", "more than 0"},
           {R"({"key": "/a", "from": 0, "to": 1, "values": [1]})", "", "values and a range"},
           {R"({"key": "/a", "from": 0, "to": 1})", R"("method": "list", )", "not a range"},
           {R"({"key": "/a", "values": [1]}, {"key": "/b", "values": [1, 2]})", R"("method": "list", )", "as many"},
           {R"({"key": "/a", "values": [1]}, {"key": "/b/a", "values": [1]})", "", "taken"},
           {R"({"key": "/a", "name": "id", "values": [1]})", "", "taken"},
           {R"({"values": [1]})", "", "path of a file"},
           {R"({"of": "script", "key": "/a", "values": [1]})", "", "no script"},
           {R"({"key": "/a", "from": 0, "to": 1})", R"("method": "latin-hypercube", )", "number of samples"},
           {R"({"key": "/a", "from": 0, "to": 1})", R"("method": "latin-hypercube", "samples": 3, "seeds": [1, 1], )",
            "whole number"},
           {R"({"key": "/a", "from": 0, "to": 1, "steps": 1000000}, {"key": "/b", "values": [1, 2]})", "",
            "at most 1000000"}})
    EXPECT_NE(error_of(sweep_with(vary, more)).find(said), std::string::npos)
        << vary << more << ": " << error_of(sweep_with(vary, more));
}

TEST(ValueSlots, KeepCommentsAndAddWhatIsNotWritten) {
  const std::string text = "{ // one\n  \"a\": {\"b\": 1 /* two */, \"c\": [1, {\"d\": 2}]}, \"e\": {}\n}\n";
  const Result<ValueSlots> slots = ValueSlots::find(text, "f.json", {"/a/c/1/d", "/a/b", "/a/new", "/e/f/g"});
  ASSERT_TRUE(slots) << to_string(slots.errors().front());
  EXPECT_EQ(slots->with({"\"x\"", "7.5", "true", "[1, 2]"}),
            "{ // one\n  \"a\": {\"b\": 7.5 /* two */, \"c\": [1, {\"d\": \"x\"}], \"new\": true}, \"e\": {\"f\": "
            "{\"g\": [1, 2]}}\n}\n");
  EXPECT_EQ(ValueSlots::find(text, "f.json", {})->with({}), text);
}

TEST(ValueSlots, SayWhereTheyCannotBe) {
  const Result<ValueSlots> beyond = ValueSlots::find("{\"a\":\n [1]}", "f.json", {"/a/3/b", "/b", "/a/0/c"});
  ASSERT_FALSE(beyond);
  ASSERT_EQ(beyond.errors().size(), 2u);
  EXPECT_EQ(to_string(beyond.errors()[0]), "f.json:2:2: error: /a: there is no /3/b");
  EXPECT_EQ(to_string(beyond.errors()[1]), "f.json:2:3: error: /a/0: there is no /c");
  const Result<ValueSlots> within = ValueSlots::find("{\"a\": {\"b\": 1}}", "f.json", {"/a/b", "/a"});
  ASSERT_FALSE(within);
  EXPECT_EQ(to_string(within.errors()[0]), "f.json: error: /a/b: lies within another value that varies");
}

}  // namespace
}  // namespace ctpm::scenes
