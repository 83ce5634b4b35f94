#include "studio/output/option_name.h"

#include <gtest/gtest.h>

namespace ctpm {
namespace {

std::string flag(std::string_view field) { return "--" + std::string(field); }

TEST(OptionName, IsReplacedWhereverAnErrorNamesIt) {
  const Errors errors =
      output::name_options({{output::option_name("fps"),
                             "must be less than " + output::option_name("most") + " of " + output::option_name("fps"),
                             "give " + output::option_name("most")}},
                           flag);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].where, "--fps");
  EXPECT_EQ(errors[0].message, "must be less than --most of --fps");
  EXPECT_EQ(errors[0].hint, "give --most");
}

TEST(OptionName, LeavesOtherTextAlone) {
  const Error error{"{fps}.json", "got '{option:' and 'option:fps}'", "{}"};
  const Errors errors = output::name_options({error}, flag);
  EXPECT_EQ(to_string(errors[0]), to_string(error));
}

TEST(OptionName, DoesNotReplaceWhatTheCallersNameContains) {
  const Errors errors = output::name_options({{output::option_name("a"), "", ""}},
                                             [](std::string_view) { return output::option_name("a"); });
  EXPECT_EQ(errors[0].where, output::option_name("a"));
}

}  // namespace
}  // namespace ctpm
