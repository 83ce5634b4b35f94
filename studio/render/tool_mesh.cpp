#include "studio/render/tool_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ctpm::render {
namespace {

constexpr int kAround = 40;

class Builder {
 public:
  ToolMesh mesh;

  std::uint32_t vertex(Vec3 p, Vec3 n, ToolPart part) {
    for (const double x : {p.x, p.y, p.z, n.x, n.y, n.z, double(part)}) mesh.vertex.push_back(float(x));
    return std::uint32_t(mesh.vertex.size() / 7 - 1);
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { mesh.index.insert(mesh.index.end(), {a, b, c}); }

  /// A body of revolution around z through the profile (radius, z), bottom to top; the ends are closed by
  /// radius 0. `flat` scales y.
  void turn(const std::vector<std::array<double, 2>>& profile, ToolPart part, double flat = 1) {
    std::vector<std::uint32_t> row, last;
    for (std::size_t i = 0; i < profile.size(); ++i) {
      const auto& before = profile[i ? i - 1 : 0];
      const auto& after = profile[i + 1 < profile.size() ? i + 1 : i];
      const double dr = after[0] - before[0], dz = after[1] - before[1], length = std::hypot(dr, dz);
      row.clear();
      for (int k = 0; k <= kAround; ++k) {
        const double angle = 2 * std::numbers::pi * k / kAround, c = std::cos(angle), s = std::sin(angle);
        const Vec3 n{dz / length * c, dz / length * s / flat, -dr / length};
        row.push_back(vertex({profile[i][0] * c, flat * profile[i][0] * s, profile[i][1]}, n / norm(n), part));
      }
      for (std::size_t k = 0; i && k < std::size_t(kAround); ++k)
        triangle(last[k], last[k + 1], row[k + 1]), triangle(last[k], row[k + 1], row[k]);
      last = row;
    }
  }

  /// One side of the blade: a fan over an outline in the plane y = bulge towards its ridge.
  void blade_side(const std::vector<Vec3>& edge, const std::vector<Vec3>& ridge, double sign) {
    for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
      Vec3 n = cross(edge[i + 1] - edge[i], ridge[i] - edge[i]);
      if (norm(n) == 0) n = cross(edge[i + 1] - edge[i], ridge[i + 1] - edge[i]);
      if (n.y * sign < 0) n = -n;
      n = n / norm(n);
      // Ground hollow: light runs over it, where a flat side would mirror one place of the room.
      const auto hollow = [&](double along, double across) {
        const Vec3 bent = n + Vec3{across, 0, along - 0.5};
        return bent / norm(bent);
      };
      const double from = double(i) / double(edge.size() - 1), to = double(i + 1) / double(edge.size() - 1);
      const double outward = edge[i].x >= ridge[i].x ? 0.45 : -0.45;
      const auto a = vertex(edge[i], hollow(from, outward), ToolPart::steel),
                 b = vertex(edge[i + 1], hollow(to, outward), ToolPart::steel);
      const auto c = vertex(ridge[i + 1], hollow(to, -0.1 * outward), ToolPart::steel),
                 d = vertex(ridge[i], hollow(from, -0.1 * outward), ToolPart::steel);
      triangle(a, b, c), triangle(a, c, d);
    }
  }
};

ToolMesh make_ball(double radius) {
  Builder builder;
  std::vector<std::array<double, 2>> profile;
  constexpr int kRows = 24;
  for (int i = 0; i <= kRows; ++i) {
    const double angle = std::numbers::pi * (double(i) / kRows - 0.5);
    profile.push_back({i == 0 || i == kRows ? 0.0 : radius * std::cos(angle), radius * std::sin(angle)});
  }
  builder.turn(profile, ToolPart::steel);
  // The rod starts inside the ball; its proportions are those of a hand-held probe.
  const double rod = std::max(0.35 * radius, 0.0008), grip = std::max(0.9 * radius, 0.0022),
               length = std::max(10 * radius, 0.03);
  builder.turn({{rod, 0.5 * radius}, {rod, length}, {0, length}}, ToolPart::steel);
  builder.turn({{0, length},
                {0.8 * grip, length},
                {grip, length + 0.003},
                {grip, 3.5 * length},
                {0.7 * grip, 3.5 * length + 0.003},
                {0, 3.5 * length + 0.004}},
               ToolPart::handle);
  return builder.mesh;
}

ToolMesh make_scalpel(double length) {
  Builder builder;
  const double width = 0.28 * length, half = 0.02 * length;
  // The edge is straight; the back curves out from the tip to the full width.
  std::vector<Vec3> edge, back, ridge_left, ridge_right;
  constexpr int kRows = 12;
  for (int i = 0; i <= kRows; ++i) {
    const double z = length * i / kRows, t = double(i) / kRows;
    const double w = width * std::sqrt(std::min(1.0, 2.2 * t));
    edge.push_back({0, 0, z}), back.push_back({-w, 0, z});
    ridge_left.push_back({-0.35 * w, half * std::min(1.0, 4 * t), z}),
        ridge_right.push_back({-0.35 * w, -half * std::min(1.0, 4 * t), z});
  }
  builder.blade_side(edge, ridge_left, 1), builder.blade_side(edge, ridge_right, -1);
  builder.blade_side(back, ridge_left, 1), builder.blade_side(back, ridge_right, -1);
  const std::size_t begin = builder.mesh.vertex.size();
  const double grip = 0.5 * width + 0.0006, top = std::max(3.2 * length, length + 0.08);
  builder.turn({{0, length},
                {0.55 * grip, length},
                {grip, 1.12 * length},
                {grip, 1.5 * length},
                {0.8 * grip, 1.7 * length},
                {0.9 * grip, top},
                {0, top + 0.002}},
               ToolPart::handle, 0.45);
  for (std::size_t i = begin; i < builder.mesh.vertex.size(); i += 7) builder.mesh.vertex[i] -= float(0.5 * width);
  return builder.mesh;
}

}  // namespace

ToolMesh make_tool_mesh(const Tool& tool) {
  return tool.kind == ToolKind::ball ? make_ball(tool.radius) : make_scalpel(tool.blade_length);
}

}  // namespace ctpm::render
