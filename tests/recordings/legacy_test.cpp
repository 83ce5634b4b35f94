// Contents of files from before a format change, and how they are read.

#include "tests/recordings/legacy_files.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;
using recordings::session_file::SentenceEvent;

TEST(LegacyIntegrator, ARetiredOneIsRefusedByName) {
  const Folder folder;
  for (const auto& [number, name] :
       {std::pair{1, std::string("symplectic Euler")}, std::pair{3, std::string("extrapolated Euler")}}) {
    const std::string path = folder / (std::to_string(number) + ".ctpm");
    write_with_integrator(path, number, 0);
    const auto reader = recordings::SessionReader::open(path);
    ASSERT_FALSE(reader);
    EXPECT_TRUE(to_string(reader.errors()[0])
                    .starts_with(path + ": error: was recorded with " + name + ", which this program no longer has"))
        << text_of(reader.errors());
  }
}

TEST(LegacyIntegrator, AutomaticBecomesWhatThisBuildChoosesAndTheReaderSaysSo) {
  const Folder folder;
  write_with_integrator(folder / "a.ctpm", 0, 0);
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader) << text_of(reader.errors());
  const stepping::IntegratorChoice choice = stepping::choose_integrator(small_start().model);
  EXPECT_EQ(reader->start().model.solver.integrator, choice.integrator);
  EXPECT_EQ(reader->start().model.solver.substeps, choice.substeps);
  ASSERT_EQ(reader->remarks().size(), 1u);
  EXPECT_NE(reader->remarks()[0].find(stepping::name_of(choice.integrator)), std::string::npos) << reader->remarks()[0];

  write_with_integrator(folder / "named.ctpm", 2, 0);
  const auto named = recordings::SessionReader::open(folder / "named.ctpm");
  ASSERT_TRUE(named);
  EXPECT_TRUE(named->remarks().empty());
}

TEST(LegacyIntegrator, AFileThatStoresItsRevisionHoldsNoWordAndNoUnknownNumber) {
  const Folder folder;
  for (const int number : {0, -1, 6, 255}) {
    const std::string path = folder / (std::to_string(number) + ".ctpm");
    write_with_integrator(path, number, kPhysicsRevision);
    const auto reader = recordings::SessionReader::open(path);
    ASSERT_FALSE(reader) << number;
    EXPECT_NE(text_of(reader.errors()).find("solver.integrator is of an unknown kind"), std::string::npos);
  }
  write_with_integrator(folder / "below.ctpm", 2, -1);
  EXPECT_FALSE(recordings::SessionReader::open(folder / "below.ctpm")) << "a revision below 0";
}

TEST(LegacyEvents, KeepTheirSentenceAndOnlyPiecesGetAKindOfTheirOwn) {
  const Folder folder;
  const std::vector<SentenceEvent> stored{
      {10, 3, "blade begins to sever; value: elements", {4}}, {12, 3, "a piece comes loose; value: pieces", {2}},
      {13, 3, "a piece comes loose; value: pieces", {}},      {14, 3, "a piece comes loose; value: pieces", {-1e300}},
      {15, 8, "a piece comes loose; value: pieces", {1}},     {16, 99, "of a newer program", {1, 2}},
  };
  write_with_integrator(folder / "a.ctpm", 2, 0, stored);
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader) << text_of(reader.errors());
  const auto events = reader->events();
  ASSERT_TRUE(events) << text_of(events.errors());
  ASSERT_EQ(events->size(), stored.size());
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const recordings::Event& event = (*events)[i];
    EXPECT_EQ(event.kind == recordings::EventKind::piece_came_loose, i == 1) << i;
    if (i != 1) {
      EXPECT_EQ(static_cast<std::int32_t>(event.kind), stored[i].kind);
    }
    EXPECT_EQ(recordings::describe(event, reader->start().model), stored[i].text);
    EXPECT_EQ(event.values, stored[i].values);
  }
  EXPECT_EQ(recordings::pieces_came_loose(*events, 12), 0);
  EXPECT_EQ(recordings::pieces_came_loose(*events, 100), 2);
}

}  // namespace
}  // namespace ctpm
