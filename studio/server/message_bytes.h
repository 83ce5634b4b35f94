#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/model/vec3.h"

namespace ctpm::server {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

/// The first number of a binary message. PROTOCOL.md gives the rest.
enum MessageKind : std::uint32_t { kTriangles = 1, kFrame = 2, kShapes = 3, kSpheres = 4, kDrawing = 5, kExpert = 6 };

/// Appends plain values to a binary message.
class MessageBytes {
 public:
  template <class T>
  void add(T value) {
    add_all(&value, 1);
  }
  void add(Vec3 v) {
    for (const double x : {v.x, v.y, v.z}) add(float(x));
  }
  template <class T>
  void add_all(const T* values, std::size_t count) {
    text.append(reinterpret_cast<const char*>(values), count * sizeof(T));
  }
  void pad() { text.append((4 - text.size() % 4) % 4, '\0'); }

  std::string text;
};

}  // namespace ctpm::server
