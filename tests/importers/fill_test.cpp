#include "importers/fill.h"
#include "importers/size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "core/surface/surface.h"
#include "importers/topology.h"
#include "zoo.h"

namespace ctpm {
namespace {

using zoo::find;
using zoo::summary;
using zoo::text_of;

importers::CheckedMesh checked(const importers::RawMesh& raw, double unit = 1, bool all_parts = false) {
  importers::RepairOptions options;
  options.all_parts = all_parts;
  Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, unit, options);
  EXPECT_TRUE(mesh) << text_of(mesh.errors());
  return std::move(*mesh);
}

importers::FillOptions spaced(double spacing) {
  importers::FillOptions options;
  options.sphere_radius = spacing / 3;
  options.gap = spacing - 2 * options.sphere_radius;
  return options;
}

importers::Filling filled(const importers::CheckedMesh& mesh, const importers::FillOptions& options) {
  Result<importers::Filling> filling = importers::fill_organ(mesh, options);
  EXPECT_TRUE(filling) << text_of(filling.errors());
  return std::move(*filling);
}

/// Promises of FilledOrgan that hold for every filling.
void expect_sound(const importers::Filling& filling) {
  const FilledOrgan& organ = filling.organ;
  const std::size_t count = organ.centre.size();
  ASSERT_GT(count, 0u);
  ASSERT_TRUE(organ.cell.size() == count && organ.layer.size() == count && organ.depth.size() == count);
  EXPECT_EQ(filling.report.spheres, std::int64_t(count));
  double volume = 0;
  for (std::size_t n = 0; n < count; ++n) {
    ASSERT_GT(organ.shares.sphere[n], 0);
    volume += organ.shares.sphere[n] * std::pow(organ.spacing, 3);
  }
  EXPECT_NEAR(filling.report.filled_volume, volume, 1e-12);
  const auto key = [&](std::size_t n) { return std::array{organ.cell[n][2], organ.cell[n][1], organ.cell[n][0]}; };
  for (std::size_t n = 1; n < count; ++n) ASSERT_LT(key(n - 1), key(n)) << "sorted by k, j, i, each cell once";
  for (std::size_t n = 0; n < count; ++n) {
    const Vec3 offset{double(organ.cell[n][0] - organ.cell[0][0]), double(organ.cell[n][1] - organ.cell[0][1]),
                      double(organ.cell[n][2] - organ.cell[0][2])};
    ASSERT_LT(norm(organ.centre[n] - organ.centre[0] - organ.spacing * offset), 1e-9 * organ.spacing);
    ASSERT_GT(organ.depth[n], -std::sqrt(3.0) * organ.spacing) << "a corner of a cell that meets the organ";
  }
  // Layers are contiguous, count up inwards, and the report has their sizes.
  std::map<std::int32_t, std::int64_t> sizes;
  std::map<std::int32_t, double> deepest;
  for (std::size_t n = 0; n < count; ++n) {
    ++sizes[organ.layer[n]];
    deepest[organ.layer[n]] = std::max(deepest[organ.layer[n]], organ.depth[n]);
  }
  ASSERT_EQ(sizes.size(), filling.report.spheres_per_layer.size());
  std::int32_t expected = 1;
  for (const auto& [layer, size] : sizes) {
    EXPECT_EQ(layer, expected);
    EXPECT_EQ(size, filling.report.spheres_per_layer[std::size_t(expected - 1)]);
    ++expected;
  }
  for (std::size_t n = 0; n < count; ++n)
    ASSERT_GT(organ.depth[n], organ.layer[n] > 1 ? deepest[organ.layer[n] - 1] : -INFINITY);
  EXPECT_EQ(organ.surface.binding.first.size(), organ.surface.vertex.size() + 1);
}

/// Elements that stand for any tissue, and the number of networks, counted the slow way.
struct Network {
  std::int64_t edges = 0, networks = 0;
};
Network network_of(const FilledOrgan& organ) {
  std::map<std::array<std::int32_t, 3>, std::size_t> at;
  for (std::size_t n = 0; n < organ.cell.size(); ++n) at.emplace(organ.cell[n], n);
  std::vector<std::size_t> root(organ.cell.size());
  for (std::size_t n = 0; n < root.size(); ++n) root[n] = n;
  const auto top = [&](std::size_t n) {
    while (root[n] != n) n = root[n] = root[root[n]];
    return n;
  };
  Network network{0, std::int64_t(root.size())};
  for (const auto& [cell, n] : at)
    for (std::size_t d = 0; d < kLatticeDirections.size(); ++d) {
      if (organ.shares.element[d][n] == 0) continue;
      const auto step = kLatticeDirections[d];
      const std::size_t other = at.at({cell[0] + step[0], cell[1] + step[1], cell[2] + step[2]});
      ++network.edges;
      if (top(n) != top(other)) --network.networks, root[top(n)] = top(other);
    }
  return network;
}

/// Distance of a point from a triangle by the regions of Ericson, Real-Time Collision Detection, 5.1.5.
double distance_to_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return norm(ap);
  if (d3 >= 0 && d4 <= d3) return norm(bp);
  if (d6 >= 0 && d5 <= d6) return norm(cp);
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return norm(ap - d1 / (d1 - d3) * ab);
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return norm(ap - d2 / (d2 - d6) * ac);
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return norm(bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b));
  const double sum = va + vb + vc;
  return norm(ap - vb / sum * ab - vc / sum * ac);
}

TEST(Fill, CubeHasTheSpheresAndLayersThatGeometrySays) {
  const importers::Filling filling = filled(checked(zoo::box({0.1, 0.1, 0.1})), spaced(0.01));
  expect_sound(filling);
  EXPECT_EQ(filling.report.spheres, 11 * 11 * 11);
  EXPECT_EQ(filling.report.spheres_per_layer, (std::vector<std::int64_t>{602, 386, 218, 98, 26, 1}));
  EXPECT_NEAR(filling.report.filled_volume, 1e-3, 1e-12);
  EXPECT_EQ(filling.report.edges, 3 * 11 * 11 * 10 + 6 * 11 * 10 * 10);
  EXPECT_EQ(summary(filling.report.findings), "");
  for (std::size_t n = 0; n < filling.organ.centre.size(); ++n) {
    const Vec3 p = filling.organ.centre[n];
    EXPECT_NEAR(filling.organ.depth[n], 0.05 - std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1e-12);
  }
  EXPECT_NEAR(filling.report.largest_distance, 0, 1e-12) << "the corners of the cube are spheres";
}

/// Sum over the elements that cross a plane at x, each with the area that a full one stands for.
double crossed_area(const FilledOrgan& organ, double x) {
  double area = 0;
  for (std::size_t n = 0; n < organ.centre.size(); ++n)
    for (std::size_t d = 0; d < kLatticeDirections.size(); ++d) {
      const double step = organ.spacing * kLatticeDirections[d][0], from = organ.centre[n].x;
      const int steps = int(d < kAxisDirectionCount ? 1 : 2);
      if ((from < x) != (from + step < x))
        area +=
            organ.shares.element[d][n] * organ.spacing * organ.spacing / (1 + 2 * std::sqrt(2.0)) / std::sqrt(steps);
    }
  return area;
}

TEST(Fill, ElementsStandForTheSectionWhereverTheLatticeLies) {
  // A bar 40 x 27 mm across, of 10 mm cells that fit it in no direction.
  const importers::CheckedMesh mesh = checked(zoo::box({0.1, 0.04, 0.027}, 10));
  for (const Vec3 shift : {Vec3{0, 0, 0}, Vec3{0, 0.25, -0.4}, Vec3{0, 0.5, 0.13}}) {
    importers::FillOptions options = spaced(0.01);
    options.lattice_shift = shift;
    const importers::Filling filling = filled(mesh, options);
    EXPECT_NEAR(filling.report.filled_volume, mesh.volume, 1e-9 * mesh.volume);
    for (const double x : {-0.023, 0.004, 0.031})
      EXPECT_NEAR(crossed_area(filling.organ, x), 0.04 * 0.027, 1e-3 * 0.04 * 0.027) << shift.y << " " << x;
    Vec3 centre;
    for (std::size_t n = 0; n < filling.organ.centre.size(); ++n)
      centre += filling.organ.shares.sphere[n] * std::pow(0.01, 3) / mesh.volume * filling.organ.centre[n];
    EXPECT_LT(norm(centre), 4e-4) << "the centre of mass is the mesh's, within 4 % of a spacing";
  }
}

TEST(Fill, ElementsHaveTheSecondMomentOfTheSection) {
  // What bends is the second moment of the shares: the hat functions alone would count s^2 / 6 per area too much.
  for (const double height : {0.03, 0.04, 0.1}) {
    const importers::CheckedMesh mesh = checked(zoo::box({0.06, 0.04, height}, 6));
    for (const double shift : {0.0, 0.25, 0.5}) {
      importers::FillOptions options = spaced(0.01);
      options.lattice_shift = {0, 0, shift};
      const FilledOrgan organ = filled(mesh, options).organ;
      double second = 0;
      for (std::size_t n = 0; n < organ.centre.size(); ++n)
        if (organ.centre[n].x < 0 && organ.centre[n].x + 0.01 >= 0)
          second += organ.shares.element[0][n] * 1e-4 * organ.centre[n].z * organ.centre[n].z;
      const double exact = 0.04 * std::pow(height, 3) / 12, hats = 0.04 * height * 1e-4 / 6;
      EXPECT_LT(std::abs(second - exact), 0.5 * hats) << height << " " << shift;
    }
  }
}

TEST(Fill, SlabHasALayerInItsMiddle) {
  const importers::Filling filling = filled(checked(zoo::box({0.1, 0.1, 0.02}, 5)), spaced(0.01));
  expect_sound(filling);
  EXPECT_EQ(filling.report.spheres_per_layer, (std::vector<std::int64_t>{3 * 121 - 81, 81}));
}

TEST(Fill, SphereHasItsVolumeAndDepth) {
  const double radius = 0.05, spacing = 0.005;
  const importers::CheckedMesh mesh = checked(zoo::sphere(radius, 5));
  const importers::Filling filling = filled(mesh, spaced(spacing));
  expect_sound(filling);
  EXPECT_NEAR(filling.report.filled_volume, mesh.volume, 1e-9 * mesh.volume);
  // The flat triangles lie below the true sphere by at most their sagitta, edge^2 / (6 R) at a triangle's
  // middle.
  constexpr double kSagitta = 5e-5;  // [m]
  for (std::size_t n = 0; n < filling.organ.centre.size(); ++n) {
    const double below = radius - norm(filling.organ.centre[n]);
    ASSERT_LE(filling.organ.depth[n], below + 1e-12);
    ASSERT_GE(filling.organ.depth[n], below - kSagitta);
  }
  const Network network = network_of(filling.organ);
  EXPECT_EQ(network.networks, 1);
  EXPECT_EQ(network.edges, filling.report.edges);
}

TEST(Fill, TorusHasItsVolumeAndItsHole) {
  const importers::CheckedMesh mesh = checked(zoo::torus(0.05, 0.02, 96, 48));
  const importers::Filling filling = filled(mesh, spaced(0.004));
  expect_sound(filling);
  const double exact = 2 * std::numbers::pi * std::numbers::pi * 0.05 * 0.02 * 0.02;
  EXPECT_NEAR(filling.report.filled_volume, mesh.volume, 1e-9 * mesh.volume);
  EXPECT_NEAR(filling.report.filled_volume, exact, 0.01 * exact);
  for (std::size_t n = 0; n < filling.organ.centre.size(); ++n) {
    const double to_axis = std::hypot(filling.organ.centre[n].x, filling.organ.centre[n].y);
    if (filling.organ.depth[n] > 0) {
      ASSERT_GT(to_axis, 0.03 - 1e-9);
    }
  }
  EXPECT_EQ(network_of(filling.organ).networks, 1);
}

TEST(Fill, DepthIsTheExactDistance) {
  const importers::CheckedMesh mesh = checked(zoo::torus(0.05, 0.02, 24, 12));
  const importers::Filling filling = filled(mesh, spaced(0.006));
  for (std::size_t n = 0; n < filling.organ.centre.size(); ++n) {
    double least = 1;
    for (const importers::Triangle& t : mesh.triangle)
      least = std::min(least, distance_to_triangle(filling.organ.centre[n], mesh.vertex[std::size_t(t[0])],
                                                   mesh.vertex[std::size_t(t[1])], mesh.vertex[std::size_t(t[2])]));
    ASSERT_NEAR(std::abs(filling.organ.depth[n]), least, 1e-12);
  }
}

TEST(Fill, InsideIsWhereTheSolidAngleIsFull) {
  // Winding number by the solid angles of van Oosterom and Strackee; independent of the scan along rows.
  const importers::CheckedMesh mesh = checked(zoo::torus(0.05, 0.02, 24, 12));
  const double spacing = 0.007;
  const importers::Filling filling = filled(mesh, spaced(spacing));
  std::set<std::array<std::int32_t, 3>> inside;
  for (std::size_t n = 0; n < filling.organ.cell.size(); ++n)
    if (filling.organ.depth[n] > 0) inside.insert(filling.organ.cell[n]);
  const auto& some_cell = filling.organ.cell[0];
  const Vec3 some_centre = filling.organ.centre[0];
  for (int i = -1; i < 22; ++i)
    for (int j = -1; j < 22; ++j)
      for (int k = -1; k < 8; ++k) {
        const Vec3 p =
            some_centre + spacing * Vec3{double(i - some_cell[0]), double(j - some_cell[1]), double(k - some_cell[2])};
        double angle = 0;
        for (const importers::Triangle& t : mesh.triangle) {
          const Vec3 a = mesh.vertex[std::size_t(t[0])] - p, b = mesh.vertex[std::size_t(t[1])] - p,
                     c = mesh.vertex[std::size_t(t[2])] - p;
          const double la = norm(a), lb = norm(b), lc = norm(c);
          angle += 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
        }
        ASSERT_EQ(inside.contains({i, j, k}), angle > 2 * std::numbers::pi) << i << " " << j << " " << k;
      }
}

/// A mesh whose coordinates are multiples of 2^-20 m, so that shifts and turns do not round.
importers::RawMesh dyadic() {
  return zoo::moved(zoo::torus(0.05, 0.02, 40, 20), [](Vec3 p) {
    const auto round = [](double x) { return std::ldexp(std::round(std::ldexp(x, 20)), -20); };
    return Vec3{round(p.x + 0.02 * p.y), round(p.y), round(p.z + 0.3 * p.x * p.x)};
  });
}

constexpr double kDyadicSpacing = 1.0 / 256;  // [m]
importers::FillOptions dyadic_options() {
  importers::FillOptions options;
  options.sphere_radius = kDyadicSpacing / 4;
  options.gap = kDyadicSpacing / 2;
  return options;
}

TEST(Fill, ShiftByWholeSpacingsShiftsEveryBit) {
  const Vec3 shift = kDyadicSpacing * Vec3{3, -5, 17};
  const FilledOrgan here = filled(checked(dyadic()), dyadic_options()).organ;
  const FilledOrgan there =
      filled(checked(zoo::moved(dyadic(), [&](Vec3 p) { return p + shift; })), dyadic_options()).organ;
  EXPECT_EQ(here.cell, there.cell);
  EXPECT_EQ(here.depth, there.depth);
  EXPECT_EQ(here.layer, there.layer);
  for (std::size_t n = 0; n < here.centre.size(); ++n) ASSERT_EQ(here.centre[n] + shift, there.centre[n]);
}

TEST(Fill, QuarterTurnTurnsTheSpheres) {
  const FilledOrgan plain = filled(checked(dyadic()), dyadic_options()).organ;
  for (int axis = 0; axis < 3; ++axis) {
    const auto turn = [axis](Vec3 p) {
      return axis == 0 ? Vec3{p.x, -p.z, p.y} : axis == 1 ? Vec3{p.z, p.y, -p.x} : Vec3{-p.y, p.x, p.z};
    };
    const FilledOrgan turned = filled(checked(zoo::moved(dyadic(), turn)), dyadic_options()).organ;
    const auto key = [](Vec3 p) { return std::array{p.x + 0.0, p.y + 0.0, p.z + 0.0}; };
    std::map<std::array<double, 3>, double> wanted, got;
    // Spheres inside: beyond the surface, cells near the limit of slivers are sampled along other lines.
    for (std::size_t n = 0; n < plain.centre.size(); ++n)
      if (plain.depth[n] > 0) wanted.emplace(key(turn(plain.centre[n])), plain.depth[n]);
    for (std::size_t n = 0; n < turned.centre.size(); ++n)
      if (turned.depth[n] > 0) got.emplace(key(turned.centre[n]), turned.depth[n]);
    ASSERT_EQ(wanted.size(), got.size());
    for (auto a = wanted.begin(), b = got.begin(); a != wanted.end(); ++a, ++b) {
      ASSERT_EQ(a->first, b->first);
      ASSERT_NEAR(a->second, b->second, 1e-12);
    }
  }
}

TEST(Fill, AnyTurnKeepsTheVolume) {
  const double volume = checked(dyadic()).volume;
  const Quat turn{0.5, 0.5, -0.1, 0.7};
  const double length = std::sqrt(0.25 + 0.25 + 0.01 + 0.49);
  const Quat unit{turn.w / length, turn.x / length, turn.y / length, turn.z / length};
  const auto moved = zoo::moved(dyadic(), [&](Vec3 p) { return rotate(unit, p) + Vec3{0.0123, 0.4, 0.007}; });
  const importers::Filling filling = filled(checked(moved), dyadic_options());
  EXPECT_NEAR(filling.report.filled_volume, volume, 1e-9 * volume);
}

TEST(Fill, FlippingAllFacesChangesNothing) {
  const FilledOrgan plain = filled(checked(dyadic()), dyadic_options()).organ;
  const FilledOrgan flipped = filled(checked(zoo::flipped(dyadic(), 1)), dyadic_options()).organ;
  EXPECT_EQ(plain.cell, flipped.cell);
  EXPECT_EQ(plain.centre, flipped.centre);
  EXPECT_EQ(plain.layer, flipped.layer);
  for (std::size_t n = 0; n < plain.depth.size(); ++n) ASSERT_NEAR(plain.depth[n], flipped.depth[n], 1e-12);
}

TEST(Fill, UnitsOnlyScale) {
  constexpr double kUnit = 1.0 / 1024;  // a power of two scales without rounding
  const FilledOrgan metres = filled(checked(dyadic()), dyadic_options()).organ;
  const importers::RawMesh raw = zoo::moved(dyadic(), [](Vec3 p) { return p / kUnit; });
  const FilledOrgan scaled = filled(checked(raw, kUnit), dyadic_options()).organ;
  EXPECT_EQ(metres.centre, scaled.centre);
  EXPECT_EQ(metres.depth, scaled.depth);
}

TEST(Fill, ThreadsDoNotChangeOneBit) {
  const importers::CheckedMesh mesh = checked(zoo::torus(0.05, 0.02, 96, 48));
  importers::FillOptions options = spaced(0.002);
  options.threads = 1;
  const importers::Filling one = filled(mesh, options);
  for (const int threads : {2, 4}) {
    options.threads = threads;
    const importers::Filling many = filled(mesh, options);
    EXPECT_EQ(one.organ.centre, many.organ.centre);
    EXPECT_EQ(one.organ.cell, many.organ.cell);
    EXPECT_EQ(one.organ.layer, many.organ.layer);
    EXPECT_EQ(one.organ.depth, many.organ.depth);
    EXPECT_EQ(one.organ.surface.binding.first, many.organ.surface.binding.first);
    EXPECT_EQ(one.organ.surface.binding.sphere, many.organ.surface.binding.sphere);
    EXPECT_EQ(one.organ.surface.binding.weight, many.organ.surface.binding.weight);
    EXPECT_EQ(one.report.mean_distance, many.report.mean_distance);
  }
}

/// Two balls on a bar that is far thinner than the spacing and lies between lattice rows.
importers::RawMesh dumb_bell() {
  return zoo::moved(zoo::box({0.12, 0.02, 0.02}, 24), [](Vec3 p) {
    const double squeeze = std::abs(p.x) < 0.03 ? 0.05 : 1;
    return Vec3{p.x, p.y * squeeze, p.z * squeeze};
  });
}

TEST(Fill, IslandsAreDroppedAndToldOrKept) {
  importers::RawMesh raw = dumb_bell();
  for (Vec3& p : raw.vertex)
    if (p.x > 0.03) p.x += 0.02;  // makes the right end the longer one
  const importers::CheckedMesh mesh = checked(raw);
  importers::FillOptions options = spaced(0.01);
  const importers::Filling dropped = filled(mesh, options);
  expect_sound(dropped);
  EXPECT_EQ(network_of(dropped.organ).networks, 1);
  const importers::Finding* island = find(dropped.report.findings, "island");
  ASSERT_NE(island, nullptr) << summary(dropped.report.findings);
  EXPECT_EQ(island->count, 1);
  EXPECT_LT(island->place->x, 0) << "the smaller end is on the left";
  EXPECT_EQ(island->remains, "");
  options.keep_islands = true;
  const importers::Filling kept = filled(mesh, options);
  expect_sound(kept);
  EXPECT_EQ(network_of(kept.organ).networks, 2);
  EXPECT_GT(kept.report.spheres, dropped.report.spheres);
  EXPECT_NE(find(kept.report.findings, "island")->remains, "");
}

TEST(Fill, ThinPartsAreTold) {
  // A cube with a tail thinner than a spacing.
  const importers::RawMesh raw = zoo::moved(zoo::box({0.1, 0.1, 0.1}, 10), [](Vec3 p) {
    const bool is_tip = p.x > 0.049 && std::abs(p.y) < 0.001 && std::abs(p.z) < 0.001;
    return is_tip ? Vec3{p.x + 0.05, p.y, p.z} : p;
  });
  const importers::Filling filling = filled(checked(raw), spaced(0.01));
  const importers::Finding* thin = find(filling.report.findings, "thin");
  ASSERT_NE(thin, nullptr) << summary(filling.report.findings);
  EXPECT_EQ(thin->count, 1);
  EXPECT_LT(norm(*thin->place - Vec3{0.1, 0, 0}), 1e-9);
  EXPECT_NE(thin->remains, "");
}

TEST(Fill, TheWallOfABagIsToldWithTheSpheresThatWouldDo) {
  const importers::CheckedMesh mesh = checked(zoo::both(zoo::sphere(0.05, 4), zoo::sphere(0.046, 4)));
  const auto found = [&](double spacing) {
    const importers::Filling filling = filled(mesh, spaced(spacing));
    const importers::Finding* thin = find(filling.report.findings, "thin");
    return thin ? thin->found + "; " + thin->remains : "nothing thin, " + std::to_string(filling.report.spheres);
  };
  for (const double spacing : {0.011, 0.022}) {
    const std::string text = found(spacing);
    for (const char* part :
         {"100 % of its vertices", "mostly about 4 mm thick", "spheres of radius 0.67 mm, 2 mm apart", "about 22000"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
  EXPECT_EQ(found(0.0019).substr(0, 12), "nothing thin") << found(0.0019);
}

TEST(Fill, SheetThinnerThanASpacingKeepsItsThicknessAndIsTold) {
  const importers::Filling filling = filled(checked(zoo::box({0.1, 0.1, 0.008}, 5)), spaced(0.01));
  EXPECT_NEAR(filling.report.filled_volume, 8e-5, 1e-12);
  EXPECT_EQ(find(filling.report.findings, "flat"), nullptr);
  EXPECT_NE(find(filling.report.findings, "thin"), nullptr);
  Vec3Array rest;
  for (const Vec3& p : filling.organ.centre) rest.push_back(p);
  std::vector<Vec3> drawn;
  surface::deform_surface(filling.organ.surface, rest, 0, drawn);
  for (std::size_t v = 0; v < drawn.size(); ++v) ASSERT_LT(norm(drawn[v] - filling.organ.surface.vertex[v]), 1e-9);
}

TEST(Fill, WhatCannotBeFilledIsRefused) {
  const importers::CheckedMesh mesh = checked(zoo::sphere(0.05, 3));
  const auto message = [&](const importers::FillOptions& options) {
    const Result<importers::Filling> filling = importers::fill_organ(mesh, options);
    return filling ? std::string("filled") : text_of(filling.errors());
  };
  importers::FillOptions options = spaced(0.005);
  options.sphere_radius = 0;
  EXPECT_NE(message(options).find("radius must be above 0"), std::string::npos);
  options = spaced(0.005);
  options.threads = 0;
  EXPECT_NE(message(options).find("thread"), std::string::npos);
  options = spaced(0.005);
  options.most_spheres = 100;
  EXPECT_NE(message(options).find("at most 100"), std::string::npos);
  options.most_spheres = 4100;
  EXPECT_NE(message(options).find("at most 4100"), std::string::npos);
  EXPECT_NE(message(spaced(1e-7)).find("spheres"), std::string::npos) << "before memory is spent";
}

TEST(Fill, TheExpectedNumberOfSpheresIsThatOfTheFilling) {
  // A full ball, and a sheet far thinner than a spacing, of which the volume alone would tell nothing.
  for (const importers::RawMesh& raw : {zoo::sphere(0.05, 3), zoo::box({0.2, 0.2, 0.0005}, 20)}) {
    const importers::CheckedMesh mesh = checked(raw);
    const double expected = importers::expected_spheres(mesh, 0.005);
    const auto filled = double(importers::fill_organ(mesh, spaced(0.005))->report.spheres);
    EXPECT_GT(expected, 0.4 * filled);
    EXPECT_LT(expected, 1.1 * filled);
  }
}

TEST(Fill, NoSphereFitsIntoAShellOfPaper) {
  // A closed bowl, 0.1 mm thick: a lattice that is symmetric about the box's middle meets nothing of it.
  const importers::RawMesh raw = zoo::moved(zoo::box({0.1, 0.1, 0.0001}, 20), [](Vec3 p) {
    return Vec3{p.x, p.y, p.z + 0.03 * (p.x * p.x + p.y * p.y) / 0.005};
  });
  const Result<importers::Filling> filling = importers::fill_organ(checked(raw), spaced(0.03));
  ASSERT_FALSE(filling) << filling->report.spheres;
  EXPECT_NE(filling.errors()[0].message.find("no sphere fits"), std::string::npos);
}

TEST(Fill, SurfaceFollowsRigidMotionExactly) {
  const FilledOrgan organ = filled(checked(zoo::torus(0.05, 0.02, 48, 24)), spaced(0.005)).organ;
  const double half = std::sqrt(0.5);
  const Quat quarter{half, 0, half, 0};
  const auto move = [&](Vec3 p) { return rotate(quarter, p) + Vec3{0.1, 0.2, 0.3}; };
  Vec3Array rest, positions;
  for (const Vec3& p : organ.centre) rest.push_back(p), positions.push_back(move(p));
  std::vector<Vec3> vertex;
  surface::deform_surface(organ.surface, rest, 0, vertex);
  for (std::size_t v = 0; v < vertex.size(); ++v) ASSERT_LT(norm(vertex[v] - organ.surface.vertex[v]), 1e-9);
  surface::deform_surface(organ.surface, positions, 0, vertex);
  for (std::size_t v = 0; v < vertex.size(); ++v) ASSERT_LT(norm(vertex[v] - move(organ.surface.vertex[v])), 1e-9);
}

}  // namespace
}  // namespace ctpm
