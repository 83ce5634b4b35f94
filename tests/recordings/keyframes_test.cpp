// How far keyframes are apart.

#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;

/// A State of so many spheres, with a swept surface of so many points.
State state_of(std::size_t spheres, std::size_t swept) {
  State state;
  state.position.resize(spheres), state.velocity.resize(spheres), state.acceleration.resize(spheres);
  state.kelvin_elongation.resize(6 * spheres);
  state.swept.resize(swept);
  return state;
}

TEST(Keyframes, AreAsCloseAsTheSizeOfTheStateAllows) {
  EXPECT_EQ(recordings::ticks_to_next_keyframe(state_of(10, 0)), 250);
  EXPECT_EQ(recordings::ticks_to_next_keyframe(state_of(100000, 0)), 1000);
  const std::int64_t whole = recordings::ticks_to_next_keyframe(state_of(850, 0));
  EXPECT_GT(whole, 250);
  EXPECT_LT(whole, 1000);
  // Keyframes of numbers of which compression leaves three quarters take 6.7 MB a minute.
  EXPECT_NEAR(0.77 * 120 * 850 * 60e3 / double(whole), 6.7e6, 0.5e6);
  EXPECT_EQ(whole % 50, 0);
  EXPECT_GT(recordings::ticks_to_next_keyframe(state_of(850, 20000)), whole);  // after a long cut

  const Folder folder;
  const recordings::SessionStart start = small_start();
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true});
  ASSERT_TRUE(writer);
  live(start, 600, [&](const State& after, const recordings::TickRecord& record) { writer->append(after, record); });
  ASSERT_TRUE(writer->finish());
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  EXPECT_EQ(*reader->keyframe_ticks(), (std::vector<std::int64_t>{0, 250, 500}));
}

}  // namespace
}  // namespace ctpm
