// One small session, pressed and cut, against golden hashes. This file is built twice, with optimised and unoptimised
// core; both programs must give the same bits. The test fails if hashes change without a new physics revision.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ranges>
#include <span>
#include <string>

#include "core/model/physics_revision.h"
#include "tests/golden/golden_rows.h"
#include "tests/golden/session.h"

namespace ctpm {
namespace {

using testing::GoldenRevision;
using testing::GoldenRow;
using testing::kGoldenRevisions;

struct Session {
  const char* name;  ///< name of its row
  network::Structure structure;
  std::optional<Integrator> integrator;
  Inputs (*inputs)(int) = testing::golden_inputs;
};

constexpr Session kSessions[] = {
    {"mass-spring, auto", network::Structure::mass_spring, std::nullopt},
    {"angle-mass-spring, auto", network::Structure::angle_mass_spring, std::nullopt},
    {"tpm, auto", network::Structure::tpm, std::nullopt},
    {"ctpm, auto", network::Structure::ctpm, std::nullopt},
    {"tpm, backward-euler", network::Structure::tpm, Integrator::backward_euler},
    {"angle-mass-spring, backward-euler", network::Structure::angle_mass_spring, Integrator::backward_euler},
    {"ctpm, sdirk2", network::Structure::ctpm, Integrator::sdirk2},
};

/// Of make_full_model().
constexpr Session kFullSessions[] = {
    {"full, auto", network::Structure::ctpm, std::nullopt},
    {"full, sdirk2", network::Structure::ctpm, Integrator::sdirk2},
    {"wedge, auto", network::Structure::ctpm, std::nullopt, testing::wedge_inputs},
    {"wedge, sdirk2", network::Structure::ctpm, Integrator::sdirk2, testing::wedge_inputs},
    {"crumbs, auto", network::Structure::ctpm, std::nullopt, testing::crumbs_inputs},
    {"crumbs, sdirk2", network::Structure::ctpm, Integrator::sdirk2, testing::crumbs_inputs},
};

/// Of make_light_model().
constexpr Session kLightSessions[] = {
    {"light, backward-euler", network::Structure::ctpm, Integrator::backward_euler},
    {"light, sdirk2", network::Structure::ctpm, Integrator::sdirk2},
};

/// Of make_resisting_model() or make_skinned_model().
struct BlockSession {
  const char* name;
  bool is_soft;
  std::optional<Integrator> integrator;
  std::int32_t hands = 1;
  Inputs (*inputs)(int) = testing::golden_inputs;
  double edge = 0.003;  ///< of a surface's triangles [m]

  friend void PrintTo(const BlockSession& session, std::ostream* out) { *out << session.name; }
};

constexpr BlockSession kBlockSessions[] = {
    {"resisting, auto", false, std::nullopt},
    {"resisting, sdirk2", false, Integrator::sdirk2},
    {"soft and resisting, auto", true, std::nullopt},
};

/// Of make_skinned_model().
constexpr BlockSession kSkinnedSessions[] = {
    {"skinned, auto", false, std::nullopt},
    {"skinned, sdirk2", false, Integrator::sdirk2},
    {"soft and skinned, auto", true, std::nullopt},
    {"touched cut, auto", false, std::nullopt, 1, testing::touched_cut_inputs},
    {"touched cut, sdirk2", false, Integrator::sdirk2, 1, testing::touched_cut_inputs},
    {"soft and touched cut, auto", true, std::nullopt, 1, testing::touched_cut_inputs},
    {"touched slice, auto", false, std::nullopt, 1, testing::touched_slice_inputs},
    {"touched slice, sdirk2", false, Integrator::sdirk2, 1, testing::touched_slice_inputs},
    {"soft and touched slice, auto", true, std::nullopt, 1, testing::touched_slice_inputs},
    {"touched tear, auto", false, std::nullopt, 1, testing::touched_tear_inputs},
    {"touched tear, sdirk2", false, Integrator::sdirk2, 1, testing::touched_tear_inputs},
    {"touched bridge, auto", false, std::nullopt, 1, testing::touched_bridge_inputs},
    {"touched bridge, sdirk2", false, Integrator::sdirk2, 1, testing::touched_bridge_inputs},
    {"touched plane, auto", false, std::nullopt, 1, testing::touched_plane_inputs},
    {"touched plane, sdirk2", false, Integrator::sdirk2, 1, testing::touched_plane_inputs},
    {"touched edge, auto", false, std::nullopt, 1, testing::touched_edge_inputs},
    {"touched edge, sdirk2", false, Integrator::sdirk2, 1, testing::touched_edge_inputs},
    {"two hands, auto", false, std::nullopt, 2, testing::two_hands_inputs},
    {"two hands, sdirk2", false, Integrator::sdirk2, 2, testing::two_hands_inputs},
    {"soft and two hands, auto", true, std::nullopt, 2, testing::two_hands_inputs},
    {"fine mesh, auto", false, std::nullopt, 1, testing::golden_inputs, 0.001},
    {"fine mesh, sdirk2", false, Integrator::sdirk2, 1, testing::golden_inputs, 0.001},
};

/// Of make_strip_model().
constexpr Session kStripSessions[] = {
    {"long strip, auto", network::Structure::ctpm, std::nullopt, testing::strip_inputs},
    {"long strip, sdirk2", network::Structure::ctpm, Integrator::sdirk2, testing::strip_inputs},
};

std::string to_text(const std::array<std::uint64_t, 4>& hash) {
  char text[128];
  std::snprintf(text, sizeof text, "{0x%016llx, 0x%016llx, 0x%016llx, 0x%016llx}", (unsigned long long)hash[0],
                (unsigned long long)hash[1], (unsigned long long)hash[2], (unsigned long long)hash[3]);
  return text;
}

/// The row of a session under the first `count` revisions: that of the last of them in which it changed. Null if it has
/// none.
const GoldenRow* find_row(std::size_t count, std::string_view session) {
  const auto is_it = [&](const GoldenRow& row) { return row.session == session; };
  for (const GoldenRevision& revision : std::views::reverse(std::span(kGoldenRevisions).first(count)))
    if (const auto row = std::find_if(revision.rows.begin(), revision.rows.end(), is_it); row != revision.rows.end())
      return &*row;
  return nullptr;
}
const GoldenRow* find_row(std::string_view session) { return find_row(std::size(kGoldenRevisions), session); }

void expect_row(const testing::GoldenRun& run, const GoldenRow& row) {
  EXPECT_TRUE(run.is_good) << row.session;
  EXPECT_GT(run.severed, 0) << row.session;
  EXPECT_GT(run.contacts, 0) << row.session;
  EXPECT_EQ(run.hash, row.hash) << row.session << " gave " << to_text(run.hash)
                                << ": raise kPhysicsRevision, append its rows to golden_rows.h and say in "
                                   "recordings/FORMAT.md what changed and why";
}

/// Sessions of richer models: those whose integrator is named, or those of auto.
void expect_rich_sessions(bool is_named) {
  for (const Session& session : kFullSessions) {
    if (session.integrator.has_value() != is_named) continue;
    const GoldenRow* row = find_row(session.name);
    ASSERT_NE(row, nullptr) << session.name;
    expect_row(testing::run_golden(testing::make_full_model(6, 5, 5), 400, session.integrator, {}, session.inputs),
               *row);
  }
  for (const Session& session : kLightSessions) {
    if (!is_named) continue;
    const GoldenRow* row = find_row(session.name);
    ASSERT_NE(row, nullptr) << session.name;
    expect_row(testing::run_golden(testing::make_light_model(6, 5, 5), 400, session.integrator), *row);
  }
  for (const BlockSession& session : kBlockSessions) {
    if (session.integrator.has_value() != is_named) continue;
    const GoldenRow* row = find_row(session.name);
    ASSERT_NE(row, nullptr) << session.name;
    const auto run = [&](double resistance) {
      return testing::run_golden(testing::make_resisting_model(6, 5, 5, session.is_soft, resistance), 400,
                                 session.integrator);
    };
    expect_row(run(10), *row);
    EXPECT_NE(run(0).hash, row->hash) << session.name << ": nothing is pressed below the threshold";
  }
}

TEST(Golden, ASmallSessionGivesTheSameBitsInEveryBuild) {
  ASSERT_EQ(std::rbegin(kGoldenRevisions)->revision, kPhysicsRevision)
      << "golden_rows.h needs the rows of the present physics revision";
  for (const Session& session : kSessions) {
    const GoldenRow* row = find_row(session.name);
    ASSERT_NE(row, nullptr) << session.name;
    expect_row(testing::run_golden(6, 5, 5, 400, session.structure, session.integrator), *row);
  }
  expect_rich_sessions(false);
}

/// Unoptimised code is so slow here that it does this under the label slow; each of these integrators is in the small
/// sessions, and each model under auto.
TEST(Golden, RichModelsUnderNamedIntegratorsGiveTheSameBitsInEveryBuild) { expect_rich_sessions(true); }

class GoldenTouched : public ::testing::TestWithParam<BlockSession> {};

TEST_P(GoldenTouched, SurfaceGivesTheSameBitsInEveryBuild) {
  const BlockSession& session = GetParam();
  const GoldenRow* row = find_row(session.name);
  ASSERT_NE(row, nullptr);
  expect_row(testing::run_golden(testing::make_skinned_model(6, 5, 5, session.is_soft, session.hands, session.edge),
                                 400, session.integrator, {}, session.inputs),
             *row);
}

TEST(Golden, AStripThatFollowsItsFarEndGivesTheSameBitsInEveryBuild) {
  for (const Session& session : kStripSessions) {
    const GoldenRow* row = find_row(session.name);
    ASSERT_NE(row, nullptr) << session.name;
    expect_row(testing::run_golden(testing::make_strip_model(), 400, session.integrator, {}, session.inputs), *row);
  }
}

/// "skinned_auto" for "skinned, auto".
std::string test_name_of(const ::testing::TestParamInfo<BlockSession>& session) {
  std::string name;
  for (const char c : std::string_view(session.param.name))
    if (c != ',') name += c == ' ' ? '_' : c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Each, GoldenTouched, ::testing::ValuesIn(kSkinnedSessions), test_name_of);

TEST(Golden, EachRevisionHasRowsOfItsOwn) {
  std::int32_t expected = 1;
  for (const GoldenRevision& revision : kGoldenRevisions) {
    EXPECT_EQ(revision.revision, expected++);
    EXPECT_FALSE(revision.rows.empty());
  }
  for (std::size_t i = 1; i < std::size(kGoldenRevisions); ++i) {
    const auto changed = [&](const GoldenRow& row) {
      const GoldenRow* before = find_row(i, row.session);
      return before == nullptr || before->hash != row.hash;
    };
    EXPECT_TRUE(std::any_of(kGoldenRevisions[i].rows.begin(), kGoldenRevisions[i].rows.end(), changed))
        << "revision " << kGoldenRevisions[i].revision << " has the bits of the one before";
  }
}

TEST(Golden, RowsOfOldRevisionsAreNeverEdited) {
  std::uint64_t digest = 0;
  for (const GoldenRevision& revision : kGoldenRevisions) {
    digest = testing::golden_digest(digest, revision.rows);
    EXPECT_EQ(revision.digest, digest) << "revision " << revision.revision << " gives 0x" << std::hex << digest;
  }
  GoldenRow edited = testing::kGoldenRevision1[0];
  edited.hash[3] ^= 1;
  EXPECT_NE(testing::golden_digest(0, {&edited, 1}), testing::golden_digest(0, {testing::kGoldenRevision1, 1}));
}

}  // namespace
}  // namespace ctpm
