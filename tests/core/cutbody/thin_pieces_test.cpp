// Pieces whose spheres do not span space keep their shape: a slice of one layer, a rod of two spheres, a crumb of one.

#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "core/surface/rigid_motion.h"
#include "core/surface/surface.h"
#include "tests/core/cut_blocks.h"

namespace ctpm {
namespace {

constexpr double kBelow = -0.01, kAbove = 0.05;  // heights of an edge outside the block [m]

using Way = std::function<cutting::Front(double)>;

double along(double share) { return -0.06 + 0.12 * share; }
/// Upright planes across x and y, and a level one.
Way at_x(double x) {
  return [=](double t) { return testing::straight_front({x, along(t), kBelow}, {x, along(t), kAbove}); };
}
Way at_y(double y) {
  return [=](double t) { return testing::straight_front({along(t), y, kBelow}, {along(t), y, kAbove}); };
}
Way at_z(double z) {
  return [=](double t) { return testing::straight_front({-0.06, along(t), z}, {0.06, along(t), z}); };
}

/// Two slits leave a strip in which no sphere is, and which goes on into the tissue at both ends. It hangs between
/// these ends while the tissue beside it is lifted.
TEST(ThinPieces, AStripWithoutSpheresHangsEvenlyBetweenItsEnds) {
  const Model model = testing::block_to_cut(6, 14, 4, 0.01);
  State state = rest_state(model);
  constexpr double kEnd = 0.045;
  for (const double x : {0.0015, 0.0045})
    testing::cut_along(
        model,
        [=](double t) {
          const double y = kEnd * (2 * t - 1);
          return testing::straight_front({x, y, kBelow}, {x, y, kAbove});
        },
        state);
  constexpr double kStretch = 2;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    Vec3 p = model.rest_position[i];
    p.y *= kStretch;
    if (std::abs(model.rest_position[i].y) < 0.02) p.z += 0.05;
    state.position.set(i, p);
  }
  const testing::DrawnCut drawn(model, state);
  EXPECT_EQ(drawn.pieces, 1);
  const auto in_strip = [&](std::int32_t v) {
    const Vec3 p = drawn.surface.vertex[std::size_t(v)];
    return p.x > 0.0016 && p.x < 0.0044 && std::abs(p.y) < 0.012;
  };
  double most = 0;
  int edges = 0;
  for (const auto& t : drawn.surface.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = t[i], b = t[(i + 1) % 3];
      if (!in_strip(a) || !in_strip(b)) continue;
      const double rest = norm(drawn.surface.vertex[std::size_t(a)] - drawn.surface.vertex[std::size_t(b)]);
      if (rest < 0.5e-3) continue;
      EXPECT_LT(std::abs(drawn.vertex[std::size_t(a)].z - drawn.surface.vertex[std::size_t(a)].z), 0.01);
      most = std::max(most, norm(drawn.vertex[std::size_t(a)] - drawn.vertex[std::size_t(b)]) / rest), ++edges;
    }
  EXPECT_GT(edges, 20);
  EXPECT_LT(most, 2 * kStretch);
}

/// A rotation about an oblique axis and a shift.
Vec3 move(Vec3 p) {
  constexpr double kAngle = 0.9;
  const Vec3 axis = Vec3{1, 2, -0.5} / norm({1, 2, -0.5}), from{0.006, 0.006, 0.03};
  const Vec3 d = p - from;
  return from + Vec3{0.05, -0.02, 0.08} + std::cos(kAngle) * d + std::sin(kAngle) * cross(axis, d) +
         (1 - std::cos(kAngle)) * dot(axis, d) * axis;
}

/// A cut block of which the spheres in a box have moved as one.
struct MovedPiece {
  MovedPiece(const std::vector<Way>& ways, Box box) : model(testing::block_to_cut(8, 8, 4, 0.01)) {
    State state = rest_state(model);
    for (const Way& way : ways) testing::cut_along(model, way, state);
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      if (box.meets(Box(model.rest_position[i]))) state.position.set(i, move(model.rest_position[i])), ++spheres;
    const testing::DrawnCut drawn(model, state);
    pieces = drawn.pieces;
    // Vertices strictly inside the box are no walls' and belong to the piece alone.
    constexpr double kInside = 0.4e-3;
    const Box inner(box.low + Vec3{kInside, kInside, kInside}, box.high - Vec3{kInside, kInside, kInside});
    for (std::size_t v = 0; v < drawn.vertex.size(); ++v)
      if (inner.meets(Box(drawn.surface.vertex[v])))
        rest.push_back(drawn.surface.vertex[v]), now.push_back(drawn.vertex[v]);
  }

  /// The largest change of a distance between two vertices [m].
  double change_of_shape() const {
    double most = 0;
    for (std::size_t a = 0; a < rest.size(); a += 3)
      for (std::size_t b = 0; b < a; b += 5)
        most = std::max(most, std::abs(norm(now[a] - now[b]) - norm(rest[a] - rest[b])));
    return most;
  }
  /// The farthest vertex from where the piece's motion takes it [m].
  double off_motion() const {
    double most = 0;
    for (std::size_t v = 0; v < rest.size(); ++v) most = std::max(most, norm(now[v] - move(rest[v])));
    return most;
  }

  Model model;
  int spheres = 0, pieces = 0;
  std::vector<Vec3> rest, now;
};

TEST(ThinPieces, ASliceOfOneLayerMovesAsItIs) {
  // The spheres of the slice lie at x = 6 mm.
  const MovedPiece slice({at_x(0.0023), at_x(0.0093)}, Box(Vec3{0.0023, -1, -1}, Vec3{0.0093, 1, 1}));
  EXPECT_EQ(slice.pieces, 3);
  EXPECT_EQ(slice.spheres, 8 * 4);
  ASSERT_GT(slice.rest.size(), 100u);
  EXPECT_LT(slice.off_motion(), 1e-6);
}

TEST(ThinPieces, ARodAndACrumbKeepTheirShape) {
  const std::vector<Way> column{at_x(0.0013), at_x(0.0123), at_y(0.0011), at_y(0.0117)};
  for (const auto& [z, count] : {std::pair{0.0171, 2}, {0.0301, 1}}) {
    std::vector<Way> ways = column;
    ways.push_back(at_z(z));
    const MovedPiece piece(ways, Box(Vec3{0.0013, 0.0011, z}, Vec3{0.0123, 0.0117, 1}));
    EXPECT_EQ(piece.spheres, count);
    ASSERT_GT(piece.rest.size(), 8u) << count;
    EXPECT_LT(piece.change_of_shape(), 1e-6) << count;
  }
}

TEST(ThinPieces, AStripWithoutSpheresGoesWithOneSideOfIt) {
  // No sphere lies between the two cuts; both sides move apart.
  const Model model = testing::block_to_cut(8, 8, 4, 0.01);
  State state = rest_state(model);
  testing::cut_along(model, at_x(0.0013), state), testing::cut_along(model, at_x(0.0049), state);
  const Vec3 left{-0.02, 0, 0.01}, right{0.05, 0.01, 0};
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    state.position.add(i, model.rest_position[i].x < 0.003 ? left : right);
  const testing::DrawnCut drawn(model, state);
  EXPECT_EQ(drawn.pieces, 3);
  int with_left = 0, with_right = 0, others = 0;
  for (std::size_t v = 0; v < drawn.vertex.size(); ++v) {
    const Vec3 rest = drawn.surface.vertex[v], by = drawn.vertex[v] - rest;
    if (rest.x < 0.0018 || rest.x > 0.0044) continue;
    if (norm(by - left) < 1e-9)
      ++with_left;
    else if (norm(by - right) < 1e-9)
      ++with_right;
    else
      ++others;
  }
  EXPECT_EQ(others, 0);
  EXPECT_GT(with_left + with_right, 50);
  EXPECT_TRUE(with_left == 0 || with_right == 0) << with_left << " " << with_right;
}

TEST(ThinPieces, AFlapOfOneLayerFollowsItsOwnSpheresAndNotFarOnesBesideIt) {
  // The second cut ends above the two lowest rows of spheres, by which the flap still hangs on.
  const Model model = testing::block_to_cut(8, 8, 6, 0.01);
  State state = rest_state(model);
  constexpr double kHinge = 0.018;
  for (const auto& [x, low] : {std::pair{0.0023, kBelow}, {0.0093, kHinge}})
    testing::cut_along(
        model,
        [=](double t) {
          return testing::straight_front({x, along(t), low}, {x, along(t), 0.08});
        },
        state);
  const auto bent = [&](Vec3 p) {
    const double up = p.z - kHinge, off = p.x - 0.006, angle = 1.3;
    return Vec3{0.006 - std::sin(angle) * up + std::cos(angle) * off, p.y,
                kHinge + std::cos(angle) * up + std::sin(angle) * off};
  };
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (const Vec3 p = model.rest_position[i]; p.x > 0.0023 && p.x < 0.0093 && p.z > kHinge)
      state.position.set(i, bent(p));
  const testing::DrawnCut drawn(model, state);
  int count = 0;
  double most = 0;
  for (std::size_t v = 0; v < drawn.vertex.size(); ++v) {
    const Vec3 p = drawn.surface.vertex[v];
    if (p.x < 0.0027 || p.x > 0.0089 || p.z < kHinge + 0.024) continue;
    most = std::max(most, norm(drawn.vertex[v] - bent(p))), ++count;
  }
  EXPECT_GT(count, 50);
  EXPECT_LT(most, 1e-3);
}

TEST(ThinPieces, ASharpFoldOfOneLayerStretchesNoTriangle) {
  // A slice of one layer is folded by half a turn along a line between spheres, so that its halves lie in each other:
  // no rotation fits the spheres beside the line.
  const Model model = testing::block_to_cut(8, 8, 6, 0.01);
  State state = rest_state(model);
  for (const double x : {0.0023, 0.0093})
    testing::cut_along(
        model,
        [=](double t) {
          return testing::straight_front({x, along(t), kBelow}, {x, along(t), 0.1});
        },
        state);
  constexpr double kFold = 0.03, kX = 0.006;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (const Vec3 p = model.rest_position[i]; p.x > 0.0023 && p.x < 0.0093 && p.z > kFold)
      state.position.set(i, {p.x, p.y, 2 * kFold - p.z});
  const testing::DrawnCut drawn(model, state);
  double most = 0;
  int count = 0;
  for (const auto& t : drawn.surface.triangle)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto a = std::size_t(t[c]), b = std::size_t(t[(c + 1) % 3]);
      if (std::abs(drawn.surface.vertex[a].x - kX) > 0.003) continue;
      const double edge = norm(drawn.surface.vertex[b] - drawn.surface.vertex[a]);
      most = std::max(most, norm(drawn.vertex[b] - drawn.vertex[a]) / std::max(edge, 0.6e-3)), ++count;
    }
  EXPECT_GT(count, 300);
  EXPECT_LT(most, 2);
}

/// A frame of spheres at `arms`, each as heavy as the others.
TissueFrame frame_of(const std::vector<Vec3>& arms) {
  TissueFrame frame;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    frame.sphere.push_back(std::int32_t(i));
    frame.weight.push_back(1 / double(arms.size()));
    frame.arm.push_back(arms[i]);
  }
  return frame;
}

TEST(TissueFrame, TurnsWithSpheresInSpaceInAPlaneAndOnALine) {
  const Vec3 o = move({}), offset{0.3, -0.2, 0.5};
  const auto moved = [&](const TissueFrame& frame) {
    return surface::turn_of(frame, [&](std::int32_t s) { return move(frame.arm[std::size_t(s)]); })(offset);
  };
  const Vec3 whole = move(offset) - o;
  const std::vector<Vec3> space{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const std::vector<Vec3> plane{{1, 0, 0}, {-1, 0, 0}, {0, 0.4, 0.4}, {0, -0.4, -0.4}};
  const std::vector<Vec3> line{{0, 1, 0}, {0, -1, 0}};
  EXPECT_LT(norm(moved(frame_of(space)) - whole), 1e-12);
  EXPECT_LT(norm(moved(frame_of(plane)) - whole), 1e-12);
  // About the line itself nothing says how far it turned.
  const Vec3 on_line = moved(frame_of(line)), direction = move({0, 1, 0}) - o;
  EXPECT_NEAR(norm(on_line), norm(offset), 1e-12);
  EXPECT_NEAR(dot(on_line, direction), offset.y, 1e-12);
  const auto moved_to = [&](const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
    return surface::turn_of(frame_of(from), [&](std::int32_t s) { return to[std::size_t(s)]; })(offset);
  };
  const Vec3 half_turn = moved_to(line, {{0, -1, 0}, {0, 1, 0}});
  EXPECT_NEAR(half_turn.y, -offset.y, 1e-12);
  EXPECT_NEAR(norm(half_turn), norm(offset), 1e-12);
  EXPECT_EQ(moved_to({{0, 0, 0}}, {{7, 8, 9}}).z, offset.z);
  // Turned inside out, a flat set is the same set seen from behind, and stays a rotation.
  EXPECT_NEAR(norm(moved_to(plane, {{-1, 0, 0}, {1, 0, 0}, {0, 0.4, 0.4}, {0, -0.4, -0.4}})), norm(offset), 1e-12);
}

}  // namespace
}  // namespace ctpm
