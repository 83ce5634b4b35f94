// Where the surfaces of organs overlap.

#include "core/surface/body_overlaps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

using surface::Body;
using surface::BodyOverlaps;
using surface::Overlap;

constexpr double kSpacing = 0.012, kDepth = 0.002;

/// Two blocks, the upper one `depth` [m] inside the lower one.
Model two_blocks(double depth) {
  Model model;
  const FilledOrgan below = testing::make_block(4, 4, 3);
  for (int i = 0; i < 2; ++i) {
    FilledOrgan organ = i == 0 ? below : testing::make_block(3, 3, 3);
    for (Vec3& centre : organ.centre) centre += i * Vec3{0.002, 0.001, 2 * kSpacing - depth};
    testing::add_faces(organ, 0.003);
    network::OrganSettings settings;
    settings.name = "organ " + std::to_string(i), settings.material = testing::liver_material();
    CTPM_CHECK(bool(network::add_organ(model, organ, settings)), "a test's own organ is valid");
  }
  model.organs_meet = true;
  return model;
}

/// Depths by body and vertex.
using Found = std::map<std::pair<std::size_t, std::int32_t>, double>;

/// As found in a step of `h` [s]; null: however far.
Found find(const Model& model, const State& state, const double* h) {
  std::vector<Body> bodies = surface::bodies_of(model);
  BodyOverlaps overlaps(model, bodies);
  for (Body& body : bodies) body.surface.begin(state.position);
  h == nullptr ? overlaps.begin() : overlaps.begin(state, *h);
  Found found;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::vector<Overlap> list;
    overlaps.find(b, list);
    for (const Overlap& overlap : list) found[{b, overlap.vertex}] = overlap.depth;
  }
  return found;
}

/// As a search through all triangles finds them: where the line inwards first leaves the other block.
Found find_plainly(const Model& model, const State& state) {
  std::vector<Body> bodies = surface::bodies_of(model);
  for (Body& body : bodies) body.surface.begin(state.position);
  Found found;
  for (std::size_t b = 0; b < 2; ++b)
    for (std::int32_t v = 0; v < std::int32_t(bodies[b].surface.vertex_count()); ++v) {
      const auto place = [&](std::int32_t i) { return bodies[b].surface.place(i); };
      const Vec3 from = place(v), inwards = -bodies[b].facets.normal(v, place);
      double nearest = kSpacing;
      bool is_exit = false;
      for (const auto& t : bodies[1 - b].surface.triangles()) {
        const Vec3 a = bodies[1 - b].surface.place(t.corner[0]), p = bodies[1 - b].surface.place(t.corner[1]),
                   q = bodies[1 - b].surface.place(t.corner[2]), normal = cross(p - a, q - a);
        const double distance = dot(a - from, normal) / dot(inwards, normal);
        const Vec3 at = from + distance * inwards;
        const auto is_left = [&](Vec3 x, Vec3 y) { return dot(cross(y - x, at - x), normal) >= 0; };
        if (!(distance > 0 && distance < nearest && is_left(a, p) && is_left(p, q) && is_left(q, a))) continue;
        nearest = distance, is_exit = dot(inwards, normal) > 0;
      }
      if (is_exit) found[{b, v}] = nearest;
    }
  return found;
}

TEST(BodyOverlaps, AreThoseThatASearchThroughAllTrianglesFinds) {
  const Model model = two_blocks(kDepth);
  State state = rest_state(model);
  testing::shake(state, 1e-3, 0);
  const Found found = find(model, state, nullptr), wanted = find_plainly(model, state);
  EXPECT_GT(wanted.size(), 100u);
  ASSERT_EQ(found.size(), wanted.size());
  for (const auto& [vertex, depth] : wanted) {
    ASSERT_TRUE(found.contains(vertex)) << vertex.first << " " << vertex.second;
    EXPECT_NEAR(found.at(vertex), depth, 1e-12);
  }
}

TEST(BodyOverlaps, OfSurfacesThatDidNotTouchAreAsDeepAsTheyCanHaveCome) {
  const Model model = two_blocks(kDepth);
  State state = rest_state(model);
  const double tick = 1e-3;
  const Found all = find(model, state, nullptr);
  EXPECT_TRUE(find(model, state, &tick).empty()) << "nothing moves, and 2 mm are more than a tenth of a spacing";
  const auto first = std::size_t(model.organs[1].first);
  for (std::size_t i = first; i < model.sphere_count(); ++i) state.velocity.z[i] = -2;
  EXPECT_EQ(find(model, state, &tick), all) << "2 mm are its way in a tick";
}

TEST(BodyOverlaps, OfSurfacesThatTouchedAreFoundUpToASpacing) {
  const Model model = two_blocks(kDepth);
  State state = rest_state(model);
  const double tick = 1e-3;
  const Found all = find(model, state, nullptr);
  const std::vector<Body> bodies = surface::bodies_of(model);
  for (const auto& [vertex, depth] : all) {
    const Body& body = bodies[vertex.first];
    const std::int32_t point =
        std::int32_t(model.touchable_count()) + body.first_vertex + body.facets.facet_of(vertex.second);
    if (state.touched.empty() || state.touched.back() < point) state.touched.push_back(point);
  }
  EXPECT_EQ(find(model, state, &tick), all);
}

TEST(BodyOverlaps, TheDeepestIsSaid) {
  const Model model = two_blocks(kDepth);
  const auto deepest = surface::deepest_overlap(model, model.rest_position);
  ASSERT_TRUE(deepest.has_value());
  EXPECT_GT(deepest->depth, 0.999 * kDepth);
  EXPECT_LT(deepest->depth, 3 * kDepth) << "the lines inwards from edges and corners are oblique";
  EXPECT_NE(deepest->organ, deepest->other);
  const Model apart = two_blocks(-1e-3);
  EXPECT_FALSE(surface::deepest_overlap(apart, apart.rest_position).has_value());
}

}  // namespace
}  // namespace ctpm
