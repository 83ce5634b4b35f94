// What events say.

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "recordings/event.h"

namespace ctpm {
namespace {

TEST(Event, ALateTickTellsWithoutWhatItWouldHaveBeenInTime) {
  using recordings::LateCause;
  const auto cause = [](const recordings::TickParts& parts) { return recordings::late_cause(parts, 1e-3); };
  EXPECT_EQ(cause({}), LateCause::unknown) << "sessions that did not measure it";
  EXPECT_EQ(cause({.solver = 1.2e-3, .cut = 0.3e-3, .machine = 0.1e-3}), LateCause::solver);
  EXPECT_EQ(cause({.solver = 0.7e-3, .cut = 0.6e-3, .recorder = 0.1e-3}), LateCause::cut);
  EXPECT_EQ(cause({.solver = 0.7e-3, .input = 0.6e-3}), LateCause::input);
  EXPECT_EQ(cause({.solver = 0.7e-3, .recorder = 0.4e-3, .machine = 0.1e-3}), LateCause::recorder);
  EXPECT_EQ(cause({.solver = 0.7e-3, .cut = 0.2e-3, .machine = 0.2e-3}), LateCause::machine);
  Model model;
  const recordings::Event late{.kind = recordings::EventKind::late_tick,
                               .late = 0.4e-3,
                               .parts = {.solver = 0.7e-3, .cut = 0.6e-3, .recorder = 0.1e-3}};
  EXPECT_EQ(recordings::describe(late, model),
            "tick ended 0.4 ms late, because of the cut: solver 0.7 ms, cut 0.6 ms, recorder 0.1 ms");
  EXPECT_EQ(recordings::describe({.kind = recordings::EventKind::late_tick, .late = 0.4e-3}, model),
            "tick ended 0.4 ms late");
}

TEST(Event, TissueIsInsideOutFromOneEventToTheOther) {
  using recordings::EventKind;
  const std::vector<recordings::Event> events{{.tick = 3, .kind = EventKind::turned_inside_out, .cells = 2},
                                              {.tick = 5, .kind = EventKind::contact_ends},
                                              {.tick = 7, .kind = EventKind::came_back, .cells = 9},
                                              {.tick = 9, .kind = EventKind::turned_inside_out, .cells = 4}};
  for (const auto& [end, cells] : {std::pair{3, 0}, {4, 2}, {7, 2}, {8, 0}, {9, 0}, {10, 4}, {1000, 4}})
    EXPECT_EQ(recordings::cells_inside_out(events, end), cells) << end;
}

}  // namespace
}  // namespace ctpm
