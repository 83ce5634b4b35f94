// What the ticks of a session cost is sorted by what the tools did, and is that of the session that `record` makes.

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "studio/session/session_cost.h"
#include "zoo.h"

namespace ctpm {
namespace {

using session::Deed;

Model model_with_tools() {
  Model model;
  model.tools.resize(2);
  model.tools[0].kind = ToolKind::ball, model.tools[1].kind = ToolKind::scalpel;
  model.hands = 2;
  return model;
}

recordings::TickRecord record_of(std::int32_t tool, std::int32_t contacts, double time) {
  recordings::TickRecord record;
  record.inputs.tool = tool, record.contacts = contacts, record.tick_time = time;
  return record;
}

TEST(TickTimes, AreSortedByWhatTheToolsDo) {
  const Model model = model_with_tools();
  session::TickTimes times(model);
  for (int i = 1; i <= 200; ++i) times.add(record_of(0, 3, i));
  times.add(record_of(-1, 0, 7)), times.add(record_of(1, 0, 9));
  times.add(record_of(1, 4, 11));
  recordings::TickRecord both = record_of(0, 3, 13);  // one hand holds, the other cuts
  both.inputs.second.tool = 1, both.second.contacts = 2;
  times.add(both);
  EXPECT_EQ(times.of(Deed::none).ticks, 2);
  EXPECT_EQ(times.of(Deed::none).p50, 7);
  EXPECT_EQ(times.of(Deed::contact).ticks, 200);
  EXPECT_EQ(times.of(Deed::contact).p50, 100);
  EXPECT_EQ(times.of(Deed::contact).p99, 198);
  EXPECT_EQ(times.of(Deed::cut).ticks, 2);
  EXPECT_EQ(times.of(Deed::cut).p99, 13);
}

TEST(TickTimes, WhatOtherProgramsTookIsNotTheTicksOwn) {
  const Model model = model_with_tools();
  session::TickTimes times(model);
  for (int i = 1; i <= 100; ++i) times.add(record_of(0, 3, 1), 0);
  for (int i = 1; i <= 100; ++i) times.add(record_of(0, 3, 5), 3.5);
  EXPECT_EQ(times.of(Deed::contact).p99, 5);
  EXPECT_EQ(times.of(Deed::contact).own_p99, 1.5);
}

TEST(TooLong, IsSureOnceAHundredthOfASessionLikeItWas) {
  session::TimesOfDeeds like{};
  like[std::size_t(Deed::contact)].ticks = 1000, like[std::size_t(Deed::cut)].ticks = 150;
  session::TooLong in_contact(&like, 1), in_a_cut(&like, 1), nothing_like_it(nullptr, 1);
  for (int i = 0; i < 10; ++i) in_contact.add(Deed::contact, 1.1), in_contact.add(Deed::none, 9);
  for (int i = 0; i < 1000; ++i) in_contact.add(Deed::contact, 1), nothing_like_it.add(Deed::cut, 2);
  EXPECT_FALSE(in_contact.is_sure()) << "10 of 1,000 may be, and what no tool touched does not count";
  in_contact.add(Deed::contact, 1.1);
  EXPECT_TRUE(in_contact.is_sure());
  in_a_cut.add(Deed::cut, 2);
  EXPECT_FALSE(in_a_cut.is_sure());
  in_a_cut.add(Deed::cut, 2);
  EXPECT_TRUE(in_a_cut.is_sure());
  EXPECT_FALSE(nothing_like_it.is_sure());
}

TEST(SessionCostOf, ManyThreadsIsOwnOnlyIfAllHadAProcessor) {
  session::SessionCost cost;
  cost.processor_share = 0.4;
  EXPECT_TRUE(cost.is_own()) << "one thread's time is its own, however long it waited";
  cost.threads = 2, cost.processor_share = 1.1;
  EXPECT_FALSE(cost.is_own());
  cost.processor_share = 1.9;
  EXPECT_TRUE(cost.is_own());
}

TEST(TickTimes, OfNothingAreNothing) {
  const Model model = model_with_tools();
  EXPECT_EQ(session::TickTimes(model).of(Deed::cut).ticks, 0);
  EXPECT_EQ(session::TickTimes(model).of(Deed::cut).p99, 0);
}

/// A ball of tissue of 60 mm, pressed and cut as by default, with ticks so long that small fillings hold them anywhere.
class SessionCost : public ::testing::Test {
 protected:
  SessionCost() { folder_.write("ball.obj", zoo::to_obj_text(zoo::sphere(30, 3))); }
  /// Without a scalpel a few dozen long ticks have no cut's surface to wait for.
  loading::LoadedScene load(bool cuts = true) const {
    const std::string scalpel = R"(, {"name": "scalpel", "kind": "scalpel", "blade_length_mm": 40})";
    const std::string file =
        folder_.write("ball.json", R"({"format": "ctpm-scene", "version": 1, "name": "ball", "tick_s": 0.05,
      "organs": [{"name": "ball", "mesh": "ball.obj", "material": {"preset": "liver"},
                  "fill": {"radius_mm": 2.5, "gap_mm": 2.5}, "anchors": [{"lowest_mm": 12}]}],
      "tools": [{"name": "ball", "kind": "ball", "radius_mm": 8})" +
                                       (cuts ? scalpel : "") + "]}");
    Result<loading::LoadedScene> scene = loading::load_whole_scene(file);
    if (!scene) throw std::runtime_error(zoo::text_of(scene.errors()));
    return *std::move(scene);
  }
  static Result<scenes::Script> script(const loading::LoadedScene& scene) {
    return scenes::default_script(scene.scene.spec, scene.organs);
  }

  zoo::Folder folder_;
};

TEST_F(SessionCost, IsThatOfASettledSessionThatPressesAndCuts) {
  const loading::LoadedScene scene = load();
  const Result<session::SessionCost> cost = session::measure_session(scene, script, {});
  ASSERT_TRUE(cost) << zoo::text_of(cost.errors());
  std::int64_t ticks = 0;
  for (const Deed deed : session::kDeeds) {
    const session::DeedTimes times = cost->of(deed);
    EXPECT_GT(times.ticks, 10) << session::name_of(deed);
    EXPECT_GT(times.p50, 0) << session::name_of(deed);
    EXPECT_GE(times.p99, times.p50) << session::name_of(deed);
    ticks += times.ticks;
  }
  EXPECT_EQ(ticks, cost->outcome.statistics.ticks);
  EXPECT_GT(cost->outcome.statistics.severed, 0);
  EXPECT_EQ(cost->dearest(), std::max(cost->of(Deed::contact).own_p99, cost->of(Deed::cut).own_p99));
  EXPECT_LE(cost->dearest(), std::max(cost->of(Deed::contact).p99, cost->of(Deed::cut).p99));
}

TEST_F(SessionCost, StopsWhenItIsAskedTo) {
  session::RunOptions running;
  running.should_stop = [] { return true; };
  const Result<session::SessionCost> cost = session::measure_session(load(), script, running);
  ASSERT_FALSE(cost);
  EXPECT_NE(zoo::text_of(cost.errors()).find("stopped"), std::string::npos);
}

TEST_F(SessionCost, RadiiThatHoldTheRateAreThoseOfASessionThatWasMeasured) {
  const loading::LoadedScene scene = load(false);
  session::SessionCost dear;  // as a slower machine would have measured
  dear.times[std::size_t(Deed::contact)] = {100, 2 * scene.built.model.tick, 3 * scene.built.model.tick,
                                            3 * scene.built.model.tick};
  const auto fitting = session::find_fitting_radius(scene, {}, script, dear, {});
  ASSERT_TRUE(fitting) << zoo::text_of(fitting.errors());
  ASSERT_TRUE(*fitting);
  EXPECT_GT((*fitting)->factor, 1);
  EXPECT_LT((*fitting)->spheres, scene.built.model.sphere_count());
  EXPECT_GT((*fitting)->cost.of(Deed::contact).ticks, 0);
  EXPECT_LE((*fitting)->cost.dearest(), scene.built.model.tick);
}

TEST_F(SessionCost, NoRadiusIsNamedThatWasNotSeenToHoldTheRate) {
  loading::LoadedScene scene = load();
  session::SessionCost dear;
  dear.times[std::size_t(Deed::contact)] = {100, 1e9, 1e9, 1e9};  // so dear that no filling of this mesh would do
  const auto fitting = session::find_fitting_radius(scene, {}, script, dear, {});
  ASSERT_TRUE(fitting) << zoo::text_of(fitting.errors());
  EXPECT_FALSE(*fitting);
}

}  // namespace
}  // namespace ctpm
