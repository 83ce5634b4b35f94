// A scene that an author looks at, settled before it is tried.

#include "studio/server/kept_scene.h"

#include <gtest/gtest.h>

#include "core/stepping/step.h"
#include "studio/session/record_session.h"

namespace ctpm {
namespace {

loading::LoadedScene kidney(double settle) {
  Result<loading::LoadedScene> loaded = loading::load_whole_scene(
      CTPM_SOURCE_DIR "/scenes/kidney.json", {},
      [&](scenes::SceneSpec& scene) { scene.settle = settle, scene.organs[0].fill.radius = 0.006; });
  EXPECT_TRUE(loaded);
  return *std::move(loaded);
}

TEST(KeptScene, BeginsWhereARecordingBeginsAndSettlesOnce) {
  server::KeptScene kept(kidney(0.2));
  const auto start = kept.start([] { return false; });
  ASSERT_TRUE(start);
  const recordings::SessionStart recorded = session::start_session(kept.scene());
  EXPECT_EQ(start->initial_state.position, recorded.initial_state.position);
  EXPECT_EQ(start->initial_state.velocity, recorded.initial_state.velocity);
  State at_once = rest_state(recorded.model);
  stepping::Stepper(recorded.model).settle(at_once, 200);
  EXPECT_EQ(start->initial_state.position, at_once.position) << "looking at it changes nothing";
  EXPECT_EQ(kept.start([] { return false; }), start);
}

TEST(KeptScene, NobodyWaitsForWhatIsNotWanted) {
  constexpr double kForEver = 1e9;  // [s]
  server::KeptScene kept(kidney(kForEver));
  EXPECT_EQ(kept.start([] { return true; }), nullptr);
}

}  // namespace
}  // namespace ctpm
