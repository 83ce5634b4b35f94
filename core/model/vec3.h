#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace ctpm {

/// A point or a vector. Each use says the unit; core uses metres and newtons.
struct Vec3 {
  double x = 0, y = 0, z = 0;

  friend bool operator==(const Vec3&, const Vec3&) = default;
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr Vec3 operator*(Vec3 a, double s) { return s * a; }
constexpr Vec3 operator/(Vec3 a, double s) { return {a.x / s, a.y / s, a.z / s}; }
constexpr Vec3& operator+=(Vec3& a, Vec3 b) { return a = a + b; }
constexpr Vec3& operator-=(Vec3& a, Vec3 b) { return a = a - b; }
constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }
inline bool is_finite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// A rotation as a unit quaternion: world_from_tool of a device.
struct Quat {
  double w = 1, x = 0, y = 0, z = 0;

  friend bool operator==(const Quat&, const Quat&) = default;
};

/// `v` turned by `q`; `q` must have unit length.
constexpr Vec3 rotate(Quat q, Vec3 v) {
  const Vec3 axis{q.x, q.y, q.z};
  const Vec3 t = 2.0 * cross(axis, v);
  return v + q.w * t + cross(axis, t);
}

/// Many points, one array per coordinate, so that element loops run over contiguous memory.
struct Vec3Array {
  std::vector<double> x, y, z;  ///< each (count)

  Vec3Array() = default;
  explicit Vec3Array(std::size_t count) : x(count), y(count), z(count) {}

  std::size_t size() const { return x.size(); }
  void resize(std::size_t count) { x.resize(count), y.resize(count), z.resize(count); }
  void push_back(Vec3 p) { x.push_back(p.x), y.push_back(p.y), z.push_back(p.z); }
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, Vec3 p) { x[i] = p.x, y[i] = p.y, z[i] = p.z; }
  void add(std::size_t i, Vec3 p) { x[i] += p.x, y[i] += p.y, z[i] += p.z; }

  friend bool operator==(const Vec3Array&, const Vec3Array&) = default;
};

}  // namespace ctpm
