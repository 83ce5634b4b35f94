// The surface near cuts, as it is touched.

#include "core/cutbody/cut_patches.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <thread>

#include "tests/core/blade_blocks.h"
#include "tests/core/cut_blocks.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

constexpr double kApart = 0.3;  // [m]

/// Two blocks with skins beside each other.
Model two_blocks() {
  Model model = testing::make_skinned_block(8, 8, 4);
  FilledOrgan second = testing::make_block(8, 8, 4);
  for (Vec3& centre : second.centre) centre.x += kApart;
  testing::add_faces(second, 0.003);
  network::OrganSettings settings;
  settings.name = "second", settings.structure = network::Structure::mass_spring;
  settings.material = testing::liver_material(), settings.anchored = {0, 1, 2};
  CTPM_CHECK(bool(network::add_organ(model, second, settings)), "a test's own block is valid");
  model.tools = {testing::scalpel(0.05), testing::ball(0.005)};
  return model;
}

/// Sweeps an upright edge through one of them.
void sweep(State& state, std::size_t organ, double x) {
  cutting::NewlySwept newly;
  newly.fill(std::uint8_t(organ + 1)), newly.back() = 0;
  const auto front = [&](int step) {
    const double at = x + kApart * double(organ), along = -0.06 + 0.003 * step;
    return testing::straight_front({at, along, -0.01}, {at, along, 0.05});
  };
  for (int step = 0; step < 40; ++step) cutting::add_swept(state, front(step), front(step + 1), newly);
}

std::vector<cutbody::CutPatch*> all_patches(cutbody::CutPatches& patches, const State& state) {
  std::vector<cutbody::CutPatch*> all;
  patches.begin(state.position);
  patches.near(Box(Vec3{-1, -1, -1}, Vec3{1, 1, 1}), [&](cutbody::CutPatch& patch) { all.push_back(&patch); });
  return all;
}

void expect_same(const std::vector<cutbody::CutPatch*>& a, const std::vector<cutbody::CutPatch*>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t p = 0; p < a.size(); ++p) {
    ASSERT_EQ(a[p]->body.surface.vertex_count(), b[p]->body.surface.vertex_count());
    EXPECT_EQ(a[p]->block, b[p]->block);
    const auto count = std::int32_t(a[p]->body.surface.vertex_count());
    for (std::int32_t v = 0; v < count; ++v) EXPECT_EQ(a[p]->gathering.at(v), b[p]->gathering.at(v));
    for (std::size_t v = 0; v < a[p]->body.surface.vertex_count(); ++v)
      EXPECT_EQ(a[p]->body.surface.place(std::int32_t(v)), b[p]->body.surface.place(std::int32_t(v)));
  }
}

TEST(CutPatches, StayWhereOnlyAnotherOrganIsCutAndGoOnAsIfTheyHadBeenMadeAnew) {
  const Model model = two_blocks();
  State state = rest_state(model);
  cutbody::CutPatches followed(model, 0), second(model, 1);
  const auto follow = [&] {
    followed.follow(std::make_shared<State>(state)), second.follow(std::make_shared<State>(state));
  };
  follow();
  sweep(state, 0, 0.0013);
  follow();
  ASSERT_TRUE(followed.is_cut());
  EXPECT_FALSE(second.is_cut());
  const std::vector<cutbody::CutPatch*> patches = all_patches(followed, state);
  ASSERT_FALSE(patches.empty());
  constexpr std::int32_t kMark = -7;
  for (cutbody::CutPatch* patch : patches) patch->first_wall = kMark;

  sweep(state, 1, 0.0013);
  follow();
  EXPECT_TRUE(second.is_cut());
  ASSERT_EQ(all_patches(followed, state), patches);
  for (const cutbody::CutPatch* patch : patches) EXPECT_EQ(patch->first_wall, kMark) << "it was made again";

  sweep(state, 0, 0.0253);
  follow();
  cutbody::CutPatches fresh(model, 0);
  fresh.follow(std::make_shared<State>(state));
  expect_same(all_patches(followed, state), all_patches(fresh, state));
}

TEST(CutPatches, AreFoundWhereTheyAreThoughOnlySpheresFarAwayHaveMoved) {
  constexpr double kEnd = 0.066;  // [m]
  const Model model = testing::block_to_cut(4, 20, 4, 0.008);
  State state = testing::long_strip(model, kEnd);
  cutbody::CutPatches patches(model, 0);
  patches.follow(std::make_shared<State>(state));
  for (const double up : {0.0, 0.03, -0.05}) {
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      if (const Vec3 rest = model.rest_position[i]; rest.y > kEnd - 0.016) state.position.set(i, rest + Vec3{0, 0, up});
    double farthest = 0;
    for (cutbody::CutPatch* patch : all_patches(patches, state))
      for (std::size_t v = 0; v < patch->body.surface.vertex_count(); ++v) {
        const Vec3 at = patch->body.surface.place(std::int32_t(v));
        farthest = std::max(farthest, norm(at - patch->body.surface.rest(std::int32_t(v))));
        bool is_found = false;
        patches.near(Box(at), [&](const cutbody::CutPatch& found) { is_found = is_found || &found == patch; });
        ASSERT_TRUE(is_found) << "block " << patch->block << ", vertex " << v;
      }
    EXPECT_GE(farthest, std::abs(up));
  }
}

TEST(CutPatches, AreTheSameWhoeverMakesThem) {
  const Model model = two_blocks();
  State state = rest_state(model);
  for (const double x : {0.0013, 0.0253}) sweep(state, 0, x);
  cutbody::CutPatches alone(model, 0);
  alone.follow(std::make_shared<State>(state));
  const std::vector<cutbody::CutPatch*> expected = all_patches(alone, state);
  for (int round = 0; round < 3; ++round) {
    cutbody::CutPatches shared(model, 0);
    shared.follow(std::make_shared<State>(state));
    std::jthread ahead([&](const std::stop_token& stop) { shared.make_all(stop); });
    expect_same(all_patches(shared, state), expected);
  }
}

}  // namespace
}  // namespace ctpm
