#include "studio/render/noise.h"

#include <cstdint>

namespace ctpm::render {
namespace {

/// The noise's value at a knot, from an integer hash.
double knot(int i, int j, int k) {
  std::uint32_t h = std::uint32_t(i & 63) + 71u * std::uint32_t(j & 63) + 5003u * std::uint32_t(k & 63);
  h = (h ^ 61u ^ (h >> 16)) * 9u, h = (h ^ (h >> 4)) * 0x27d4eb2du, h ^= h >> 15;
  return double(h & 0xffffu) / 32767.5 - 1;
}

/// Smooth step from 0 to 1 with continuous first and second derivative.
double ease(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

}  // namespace

double noise_at(Vec3 place) {
  const int i = int(std::floor(place.x)), j = int(std::floor(place.y)), k = int(std::floor(place.z));
  const double u = ease(place.x - i), v = ease(place.y - j), w = ease(place.z - k);
  double sum = 0;
  for (int n = 0; n < 8; ++n)
    sum += (n & 1 ? u : 1 - u) * (n & 2 ? v : 1 - v) * (n & 4 ? w : 1 - w) *
           knot(i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
  return sum;
}

}  // namespace ctpm::render
