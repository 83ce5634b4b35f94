#include "scenes/text_strings.h"

#include <gtest/gtest.h>

namespace ctpm {
namespace {

using Values = std::vector<std::string>;

Values values_of(const std::string& text) {
  Values values;
  for (const scenes::TextString& string : scenes::strings_of(text)) {
    EXPECT_EQ(text[string.at], '"') << text;
    EXPECT_EQ(text[string.at + string.size - 1], '"') << text;
    values.push_back(string.value);
  }
  return values;
}

TEST(TextStrings, AreThoseOfATextAndNotOfItsComments) {
  EXPECT_EQ(values_of(R"({"a": "b\"c", /* "no" */ "d": ["e//f", 1] } // "no")"), (Values{"a", "b\"c", "d", "e//f"}));
  EXPECT_EQ(values_of("\xEF\xBB\xBF/* \xC3\xA4 \"no\" */ {\"\xC3\xB6\": \"\\u00e4\"}"),
            (Values{"\xC3\xB6", "\xC3\xA4"}));
  EXPECT_EQ(values_of(""), Values{});
}

// A scene that its author has to mend names its mesh all the same.
TEST(TextStrings, ATextThatIsNoJsonHasThoseThatCanBeTold) {
  EXPECT_EQ(values_of(R"({"mesh": "a.obj", oops, "organs": ["b.obj")"), (Values{"mesh", "a.obj", "organs", "b.obj"}));
  EXPECT_EQ(values_of("{\"mesh\": \"a.obj\", \"open\n\"other\": \"b.obj\"}"),
            (Values{"mesh", "a.obj", "other", "b.obj"}));
  EXPECT_EQ(values_of("/* does not end {\"mesh\": \"a.obj\"}"), (Values{"mesh", "a.obj"})) << "rather one too many";
  EXPECT_EQ(values_of("{\"bad\\q\": \"a.obj\", \"ends\\"), Values{"a.obj"});
}

TEST(TextStrings, ATextSaysSomeOfThemAnewAndStaysAsItIsElsewhere) {
  const std::string text = "{\"a\": \"x\", /* \xC3\xA4 \"x\" */ \"b\": [\"x\", \"y\"]} // \"x\"";
  std::vector<scenes::TextString> changed;
  for (scenes::TextString string : scenes::strings_of(text))
    if (string.value == "x") string.value = "left \"x\"", changed.push_back(string);
  EXPECT_EQ(scenes::with_strings(text, changed),
            "{\"a\": \"left \\\"x\\\"\", /* \xC3\xA4 \"x\" */ \"b\": [\"left \\\"x\\\"\", \"y\"]} // \"x\"");
  EXPECT_EQ(scenes::with_strings(text, {}), text);
}

}  // namespace
}  // namespace ctpm
