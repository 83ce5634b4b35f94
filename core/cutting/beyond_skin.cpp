#include "core/cutting/beyond_skin.h"

namespace ctpm::cutting {

Vec3 beyond_skin(const TissueDepth& depth, std::size_t organ, Vec3 from, Vec3 way, double reach) {
  constexpr int kSteps = 8;
  const double length = norm(way);
  if (!(length > 0)) return from;
  Vec3 place = from;
  for (int i = 1; i <= kSteps; ++i) {
    const Vec3 next = from + i * reach / (kSteps * length) * way;
    if (depth.at(organ, next) > 0) break;
    place = next;
  }
  return place;
}

void go_on_outside(const TissueDepth& depth, std::size_t organ, const NewlySwept& newly,
                   const std::array<bool, kEdgeNodes>& is_outside, double reach, Front& front) {
  const auto extend = [&](std::size_t inner, std::size_t outer) {
    if (is_outside[outer]) front[outer] = beyond_skin(depth, organ, front[outer], front[outer] - front[inner], reach);
  };
  for (std::size_t n = 0; n + 1 < kEdgeNodes; ++n) {
    if (newly[n] == 0) continue;
    if (n == 0 || newly[n - 1] == 0) extend(n + 1, n);
    if (newly[n + 1] == 0) extend(n, n + 1);
  }
}

}  // namespace ctpm::cutting
