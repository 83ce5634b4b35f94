// Files made to deceive or to harm, with right checksums: refused or harmless, in bounded memory and time.

#include "recordings/replay.h"
#include "tests/recordings/field_tree.h"
#include "tests/recordings/forge.h"
#include "tests/recordings/forgeries.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;
using namespace recordings::session_file;

TEST(ForgedFiles, AHundredNeitherHarmNorDeceive) { verify_forgeries(100, 1); }

/// Opens and verifies a session after `change` of one of its parts; the errors or the verdict in text.
std::string said_after(const std::string& part, const std::function<void(FieldTree&)>& change) {
  const Folder folder;
  record_session(folder / "a.ctpm", small_start(), 120);
  {
    Forge forge(folder / "a.ctpm");
    const bool is_changed = forge.change("part", part, [&](Bytes& content) {
      FieldTree tree = read_tree(content);
      change(tree);
      content = write_tree(tree);
    });
    CTPM_CHECK(is_changed, "a part to forge");
  }
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  if (!reader) return text_of(reader.errors());
  const auto verdict = recordings::verify_session(*reader);
  return verdict ? recordings::to_string(*verdict) : text_of(verdict.errors());
}

FieldNode& field(FieldTree& tree, const std::string& name) {
  for (FieldNode& node : tree)
    if (node.name == name) return node;
  CTPM_CHECK(false, "a field of the session");
  return tree.front();
}

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

void expect_said(const std::string& said, const std::string& message) {
  EXPECT_NE(said.find(message), std::string::npos) << message << " is not in: " << said;
}

TEST(ForgedFiles, TheKnownOnesAreRefusedByName) {
  expect_said(said_after("model", [](FieldTree& t) { field(t, "tools").list.clear(); }), "severed");
  expect_said(said_after("model", [](FieldTree& t) { field(t, "solver.tolerance").bits = {bits(1e-300)}; }),
              "solver.tolerance");
  expect_said(said_after("model",
                         [](FieldTree& t) {
                           field(t, "solver.max_iterations").bits = {1000000};
                           field(t, "solver.substeps").bits = {1000};
                         }),
              "solver iterations of a tick");
  expect_said(said_after("model", [](FieldTree& t) { field(t, "mass").bits[2] = bits(5e-324); }), "mass[2]");
  expect_said(
      said_after("model", [](FieldTree& t) { field(field(t, "organs").list[0], "layer_count").bits = {INT32_MAX}; }),
      "layer_count");
  expect_said(said_after("model", [](FieldTree& t) { field(t, "tools").list.resize(100000); }), "tools: 100000");
  expect_said(
      said_after("surfaces", [](FieldTree& t) { field(field(t, "surfaces").list[0], "vertex").bits[5] = bits(1e300); }),
      "vertex");
}

TEST(ForgedFiles, MemoryFollowsFromTheSizeOfTheFile) {
  const Folder folder;
  record_session(folder / "a.ctpm", small_start(), 120);
  {
    Forge forge(folder / "a.ctpm");
    forge.change("part", "look", [](Bytes& content) { content.assign(200 << 20, ' '); });
  }
  const auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_FALSE(reader);
  expect_said(text_of(reader.errors()), "part look");
  // Nested lists share one budget.
  expect_said(said_after("surfaces",
                         [](FieldTree& t) {
                           FieldNode& list = field(t, "surfaces");
                           field(list.list[0], "binding.sphere").declared = 4 << 20;
                           list.list.resize(500, list.list[0]);
                         }),
              "cannot be decoded");
}

TEST(ForgedFiles, ManyMetadataAreReadAtOnce) {
  const std::string said = said_after("metadata", [](FieldTree& t) {
    for (int i = 0; i < 200000; ++i) t.push_back({"key " + std::to_string(i), FieldNode::Type::text, {'x'}, {}, 0});
  });
  expect_said(said, "same");
  const std::string too_many = said_after("metadata", [](FieldTree& t) {
    for (int i = 0; i < 2000000; ++i) t.push_back({"key " + std::to_string(i), FieldNode::Type::text, {'x'}, {}, 0});
  });
  expect_said(too_many, "more memory than the file's size explains");
}

}  // namespace
}  // namespace ctpm
