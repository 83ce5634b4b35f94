#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/model/vec3.h"

namespace ctpm::cutbody {

/// A number for a place, the same for equal ones.
inline std::size_t hash_of(const Vec3& place) {
  std::uint64_t hash = 0;
  for (const double x : {place.x, place.y, place.z}) {
    const double positive_zero = x + 0.0;
    hash = (std::rotl(hash, 23) ^ std::bit_cast<std::uint64_t>(positive_zero)) * 0x9e3779b97f4a7c15u;
  }
  return hash ^ hash >> 32;
}

struct PlaceHash {
  std::size_t operator()(const Vec3& place) const { return hash_of(place); }
};

}  // namespace ctpm::cutbody
