// What sessions hold of cuts that are open: written only where there are some, read as it was, and checked.

#include <gtest/gtest.h>

#include <functional>

#include "core/contact/open_cuts.h"
#include "recordings/internal/field_codec.h"
#include "recordings/internal/model_check.h"
#include "recordings/state_hash.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;
using namespace ctpm::recordings::session_file;

/// Three rows of the swept surface, of which two are open and the third will be.
State opening_state(const recordings::SessionStart& start) {
  State state = start.initial_state;
  state.swept.resize(3 * kEdgeNodes), state.swept_organ.assign(3 * kEdgeNodes, 0);
  std::vector<std::uint8_t> severed(start.model.axial.size(), 0);
  severed[1] = 1;
  state.open_cuts = {2, severed}, severed[2] = 1, state.opening_cuts = {3, severed};
  state.opening_cuts_at = state.tick + 7;
  return state;
}

TEST(OpenCutsInFiles, AreWrittenOnlyWhereThereAreSome) {
  const recordings::SessionStart start = small_start();
  State state = start.initial_state;
  Bytes before, after;
  put_fields(before, state);
  const std::uint64_t hash = recordings::state_hash(state);
  state.opening_cuts = {1, {}}, state.opening_cuts_at = 1;
  put_fields(after, state);
  EXPECT_GT(after.size(), before.size());
  EXPECT_NE(recordings::state_hash(state), hash);
  state.opening_cuts = {}, state.opening_cuts_at = 0, after.clear();
  put_fields(after, state);
  EXPECT_EQ(after, before);
}

TEST(OpenCutsInFiles, AreCheckedByName) {
  const recordings::SessionStart start = small_start();
  const State good = opening_state(start);
  EXPECT_EQ(text_of(check_state(start.model, good)), "");
  using Harm = std::function<void(State&)>;
  for (const auto& [name, harm] : std::initializer_list<std::pair<const char*, Harm>>{
           {"open_cuts", [](State& s) { s.open_cuts.rows = 4; }},
           {"open_cuts.rows", [](State& s) { s.open_cuts.rows = -1; }},
           {"open_cuts", [](State& s) { s.open_cuts.rows = 0; }},
           {"open_cuts.axial_severed", [](State& s) { s.open_cuts.axial_severed.pop_back(); }},
           {"open_cuts.axial_severed[0]", [](State& s) { s.open_cuts.axial_severed[0] = 2; }},
           {"opening_cuts", [](State& s) { s.opening_cuts.rows = 4; }},
           {"opening_cuts", [](State& s) { s.opening_cuts.rows = 1; }},
           {"opening_cuts.at", [](State& s) { s.opening_cuts_at = 0; }},
           {"opening_cuts.at", [](State& s) { s.opening_cuts = {}; }},
           {"opening_cuts.at",
            [&](State& s) { s.opening_cuts_at = s.tick + 1 + contact::ticks_until_open(start.model); }}}) {
    State state = good;
    harm(state);
    EXPECT_NE(text_of(check_state(start.model, state)).find(name), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace ctpm
