// How far a frame may turn while its spheres move.

#include "core/surface/rigid_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace ctpm {
namespace {

using surface::TurnBound;

/// Random frames and moves of their spheres, of which each coordinate is within the unit interval about 0.
class Random {
 public:
  Vec3 vector() { return {number_(bits_), number_(bits_), number_(bits_)}; }
  double share() { return 0.5 * (number_(bits_) + 1); }

 private:
  std::mt19937 bits_{1};
  std::uniform_real_distribution<double> number_{-1, 1};
};

/// A frame of `count` spheres within a box of `size` [m], each as heavy as the others.
TissueFrame frame_of(std::size_t count, Vec3 size, Random& random) {
  TissueFrame frame;
  Vec3 mean;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 at = random.vector();
    frame.sphere.push_back(std::int32_t(i)), frame.weight.push_back(1 / double(count));
    frame.arm.push_back({size.x * at.x, size.y * at.y, size.z * at.z});
    mean += frame.arm.back() / double(count);
  }
  for (Vec3& arm : frame.arm) arm -= mean;
  return frame;
}

std::array<double, 9> moment_at(const TissueFrame& frame, const std::vector<Vec3>& position) {
  return surface::moment_of(frame, [&](std::int32_t sphere) { return position[std::size_t(sphere)]; });
}

/// The largest distance by which one of 30 unit vectors is turned elsewhere by `b` than by `a`.
double apart(const surface::Turn& a, const surface::Turn& b, Random& random) {
  double farthest = 0;
  for (int i = 0; i < 30; ++i) {
    const Vec3 v = random.vector();
    if (norm(v) > 0) farthest = std::max(farthest, norm(a(v / norm(v)) - b(v / norm(v))));
  }
  return farthest;
}

/// The largest share of its bound by which frames of a shape were found to turn, and how many had a bound at all.
std::pair<double, int> most_of_bound(std::size_t count, Vec3 size) {
  Random random;
  double most = 0;
  int bounded = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const TissueFrame frame = frame_of(count, size, random);
    // Tissue that has turned and is strained by up to a third of its size.
    std::vector<Vec3> position;
    const Vec3 turned = random.vector();
    for (const Vec3& arm : frame.arm)
      position.push_back(arm + cross(turned, arm) + 0.3 * random.share() * norm(size) * random.vector());
    const auto moment = moment_at(frame, position);
    const TurnBound bound = surface::bound_turn(frame, moment);
    bounded += bound.reach > 0;
    for (int move = 0; move < 20 && bound.reach > 0; ++move) {
      // Spheres that move each on its own, and all about an axis.
      const Vec3 axis = random.vector();
      std::vector<Vec3> moves;
      double most_moved = 0;
      for (const Vec3& p : position) {
        moves.push_back(move % 2 == 0 ? random.vector() : cross(axis, p));
        most_moved = std::max(most_moved, norm(moves.back()));
      }
      const double farthest = bound.reach * (move < 10 ? 1 : random.share());
      std::vector<Vec3> moved = position;
      for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += farthest / most_moved * moves[i];
      const double turn = apart(surface::turn_of(moment), surface::turn_of(moment_at(frame, moved)), random);
      most = std::max(most, turn / (bound.rate * farthest));
    }
  }
  return {most, bounded};
}

TEST(TurnBound, NoFrameTurnsFartherThanItsBound) {
  const auto [body, bodies] = most_of_bound(8, {0.01, 0.01, 0.01});
  const auto [slab, slabs] = most_of_bound(6, {0.01, 0.01, 0.001});
  const auto [plane, planes] = most_of_bound(5, {0.01, 0.01, 0});
  for (const double most : {body, slab, plane}) EXPECT_LE(most, 1);
  // It says something: frames of tissue have one, and it is not far from how they turn.
  for (const int bounded : {bodies, slabs, planes}) EXPECT_GT(bounded, 200);
  for (const double most : {body, slab, plane}) EXPECT_GT(most, 0.05);
}

TEST(TurnBound, AFrameOfOneSphereNeverTurnsAndOneOnALineHasNoBound) {
  const TissueFrame one{{0}, {1}, {Vec3{}}};
  const TurnBound none = surface::bound_turn(one, moment_at(one, {Vec3{1, 2, 3}}));
  EXPECT_EQ(none.rate, 0);
  EXPECT_TRUE(std::isinf(none.reach));
  const TissueFrame line{{0, 1}, {0.5, 0.5}, {Vec3{-0.01, 0, 0}, Vec3{0.01, 0, 0}}};
  EXPECT_EQ(surface::bound_turn(line, moment_at(line, line.arm)).reach, 0);
}

TEST(TurnBound, ABoundIsSharpWhereTissueTurnsAsAWhole) {
  // A cube that turns: its corners move by their distance from the middle times the angle.
  TissueFrame frame;
  for (int corner = 0; corner < 8; ++corner) {
    const double at = 0.01;
    frame.sphere.push_back(corner), frame.weight.push_back(0.125);
    frame.arm.push_back({corner & 1 ? at : -at, corner & 2 ? at : -at, corner & 4 ? at : -at});
  }
  const TurnBound bound = surface::bound_turn(frame, moment_at(frame, frame.arm));
  const double fastest = 1 / norm(frame.arm[0]);  // [1/m]
  EXPECT_GT(bound.rate, fastest);
  EXPECT_LT(bound.rate, 30 * fastest);
  EXPECT_GT(bound.reach, 0.02 * norm(frame.arm[0]));
}

}  // namespace
}  // namespace ctpm
