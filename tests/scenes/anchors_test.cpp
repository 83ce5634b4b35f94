#include "scenes/anchors.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenes/build_model.h"
#include "scenes/scene_file.h"

namespace ctpm {
namespace {

constexpr Vec3 kDown{0, 0, -9.81};

/// A block of 5 x 3 x 4 spheres, 12 mm apart: x from -24 to 24, y from -12 to 12, z from 0 to 36 mm.
FilledOrgan block() {
  scenes::OrganSpec organ;
  organ.rig.emplace().block = Vec3{5, 3, 4};
  return scenes::fill_rig(organ);
}

scenes::AnchorSpec anchor_of(const std::string& text) {
  const Result<scenes::AnchorSpec> anchor = scenes::parse_anchor(text);
  if (!anchor) {
    ADD_FAILURE() << to_string(anchor.errors().front());
    return {};
  }
  return *anchor;
}

/// The centres that the anchors hold.
std::vector<Vec3> held(const std::vector<std::string>& anchors, Vec3 gravity = kDown) {
  std::vector<scenes::AnchorSpec> specs;
  for (const std::string& text : anchors) specs.push_back(anchor_of(text));
  const FilledOrgan organ = block();
  const Result<std::vector<std::int32_t>> selected = scenes::select_anchored(organ, specs, gravity, "/organs/0");
  if (!selected) {
    ADD_FAILURE() << to_string(selected.errors().front());
    return {};
  }
  std::vector<Vec3> centres;
  for (const std::int32_t sphere : *selected) centres.push_back(organ.centre[std::size_t(sphere)]);
  return centres;
}

TEST(Anchors, LowestHoldsTheLayersUpToItsHeight) {
  EXPECT_EQ(held({"lowest:0"}).size(), 15u);
  EXPECT_EQ(held({"lowest:11.999"}).size(), 15u);
  EXPECT_EQ(held({"lowest:12"}).size(), 30u);  // a layer on the border is in
  EXPECT_EQ(held({"lowest:36"}).size(), 60u);
}

TEST(Anchors, LowestIsMeasuredAgainstGravity) {
  for (const Vec3 centre : held({"lowest:0"}, {0, 0, 5})) EXPECT_DOUBLE_EQ(centre.z, 0.036);
  const std::vector<Vec3> side = held({"lowest:0"}, {3, 0, 0});
  EXPECT_EQ(side.size(), 12u);
  for (const Vec3 centre : side) EXPECT_DOUBLE_EQ(centre.x, 0.024);
  for (const Vec3 centre : held({"lowest:0"}, {})) EXPECT_DOUBLE_EQ(centre.z, 0);
}

TEST(Anchors, ABoxHoldsWhatIsInItAndOnItsSides) {
  EXPECT_EQ(held({"box:-12,-12,12,12,12,24"}).size(), 3u * 3 * 2);
  EXPECT_EQ(held({"box:-11.99,-12,12,12,12,24"}).size(), 2u * 3 * 2);
  EXPECT_EQ(held({"box:12,0,24,12,0,24"}).size(), 1u);
}

TEST(Anchors, ASphereHoldsWhatIsInItAndOnItsSurface) {
  EXPECT_EQ(held({"sphere:0,0,12,12"}).size(), 7u);
  EXPECT_EQ(held({"sphere:0,0,12,11.99"}).size(), 1u);
}

TEST(Anchors, APlaneHoldsWhatIsBehindItAndOnIt) {
  EXPECT_EQ(held({"plane:12,0,0,-1,0,0"}).size(), 2u * 12);
  EXPECT_EQ(held({"plane:12,0,0,-1000,0,0"}).size(), 2u * 12);  // the normal's length says nothing
  EXPECT_EQ(held({"plane:12.01,0,0,-1,0,0"}).size(), 1u * 12);
}

TEST(Anchors, ASphereInTwoRegionsIsHeldOnceAndCountedInBoth) {
  const FilledOrgan organ = block();
  std::vector<std::int32_t> counts;
  const Result<std::vector<std::int32_t>> selected = scenes::select_anchored(
      organ, {anchor_of("lowest:0"), anchor_of("plane:-24,0,0,1,0,0")}, kDown, "/organs/0", &counts);
  ASSERT_TRUE(selected);
  EXPECT_EQ(counts, (std::vector<std::int32_t>{15, 12}));
  EXPECT_EQ(selected->size(), 15u + 12 - 3);
  for (std::size_t i = 1; i < selected->size(); ++i) EXPECT_LT((*selected)[i - 1], (*selected)[i]);
}

TEST(Anchors, EachThatHoldsNoSphereIsAnErrorWithTheOrgansExtent) {
  const Result<std::vector<std::int32_t>> selected = scenes::select_anchored(
      block(), {anchor_of("sphere:0,0,500,10"), anchor_of("lowest:0"), anchor_of("box:1,1,1,2,2,2")}, kDown,
      "/organs/3");
  ASSERT_FALSE(selected);
  ASSERT_EQ(selected.errors().size(), 2u);
  EXPECT_EQ(to_string(selected.errors()[0]),
            "/organs/3/anchors/0: error: holds no sphere (its spheres lie from -24.0, -12.0, 0.0 to 24.0, "
            "12.0, 36.0 mm)");
  EXPECT_EQ(selected.errors()[1].where, "/organs/3/anchors/2");
}

TEST(Anchors, AnOrganWithoutSpheresIsAnError) {
  const Result<std::vector<std::int32_t>> selected = scenes::select_anchored({}, {}, kDown, "/organs/0");
  ASSERT_FALSE(selected);
  EXPECT_EQ(selected.errors().front().message, "the organ has no spheres");
}

TEST(ParseAnchor, ReadsEveryKindInMillimetres) {
  EXPECT_EQ(anchor_of("lowest:4.1").lowest, 0.0041);
  EXPECT_EQ(anchor_of("box:1,-2,3.5,4,5e1,6").box, (scenes::BoxRegion{{0.001, -0.002, 0.0035}, {0.004, 0.05, 0.006}}));
  EXPECT_EQ(anchor_of("sphere:1,2,3,4").sphere, (scenes::SphereRegion{{0.001, 0.002, 0.003}, 0.004}));
  EXPECT_EQ(anchor_of("plane:1,2,3,0,0,-2").plane, (scenes::PlaneRegion{{0.001, 0.002, 0.003}, {0, 0, -2}}));
}

TEST(ParseAnchor, SetsOneRegionOnly) {
  for (const std::string text : {"lowest:4", "box:0,0,0,1,1,1", "sphere:1,2,3,4", "plane:1,2,3,0,0,1"}) {
    const scenes::AnchorSpec anchor = anchor_of(text);
    EXPECT_EQ(anchor.lowest.has_value() + anchor.box.has_value() + anchor.sphere.has_value() + anchor.plane.has_value(),
              1);
  }
}

TEST(ParseAnchor, RefusesWhatIsNotAnAnchorAndSaysHowOneIsWritten) {
  for (const std::string text : {"",
                                 ":",
                                 "lowest",
                                 "lowest:",
                                 "lowest:-1",
                                 "lowest:1,2",
                                 "lowest:1,",
                                 "lowest:one",
                                 "lowest:nan",
                                 "lowest:inf",
                                 "lowest:1e9",
                                 "lowest: 1",
                                 "lowest:1mm",
                                 "Lowest:1",
                                 "box:1,2,3,4,5",
                                 "box:1,2,3,4,5,6,7",
                                 "box:4,0,0,1,1,1",
                                 "sphere:0,0,0,0",
                                 "sphere:0,0,0,-1",
                                 "sphere:0,0,0",
                                 "plane:0,0,0,0,0,0",
                                 "plane:0,0,0,1",
                                 "floor:3",
                                 "box:1,,3,4,5,6"}) {
    const Result<scenes::AnchorSpec> anchor = scenes::parse_anchor(text);
    ASSERT_FALSE(anchor) << text;
    EXPECT_EQ(anchor.errors().front().message.find("got '" + text + "', must be lowest:HEIGHT, box:"), 0u);
  }
}

TEST(ParseAnchor, WhatItReadsIsWrittenWithTheSameDigits) {
  scenes::SceneSpec scene;
  scene.name = "a";
  scenes::OrganSpec& organ = scene.organs.emplace_back();
  organ.name = "a", organ.mesh = "a.obj", organ.material.preset = "liver";
  organ.anchors = {anchor_of("lowest:4.1"), anchor_of("sphere:0.3,1.1,2.2,3.3")};
  const std::string text = scenes::write_scene(scene);
  EXPECT_NE(text.find("\"lowest_mm\": 4.1}"), std::string::npos) << text;
  EXPECT_NE(text.find("\"centre_mm\": [0.3, 1.1, 2.2], \"radius_mm\": 3.3"), std::string::npos) << text;
}

}  // namespace
}  // namespace ctpm
