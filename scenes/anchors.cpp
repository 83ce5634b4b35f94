#include "scenes/anchors.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "scenes/json_text.h"

namespace ctpm::scenes {
namespace {

/// Centres on the border of a region are in it, whatever the rounding of millimetres to metres did.
constexpr double kBorder = 1e-9;

/// Height against gravity; along z where there is none.
double height(Vec3 p, Vec3 gravity) {
  const double g = norm(gravity);
  return g > 0 ? -dot(p, gravity) / g : p.z;
}

/// Whether a ball, or a point, reaches into an anchor or a zone, of which box, sphere or plane is set.
template <class Region>
bool reaches(const Region& region, Vec3 p, double radius) {
  if (region.sphere) return norm(p - region.sphere->centre) <= region.sphere->radius + radius + kBorder;
  if (region.plane)
    return dot(p - region.plane->point, region.plane->normal) <= (radius + kBorder) * norm(region.plane->normal);
  if (!region.box) return false;
  const Vec3 low = region.box->min, high = region.box->max;
  const Vec3 nearest{std::clamp(p.x, low.x, high.x), std::clamp(p.y, low.y, high.y), std::clamp(p.z, low.z, high.z)};
  return norm(p - nearest) <= radius + kBorder;
}

bool is_in(const AnchorSpec& anchor, Vec3 p, Vec3 gravity, double lowest) {
  if (anchor.lowest) return height(p, gravity) <= lowest + *anchor.lowest + kBorder;
  return reaches(anchor, p, 0);
}

std::string extent_of(const FilledOrgan& organ) {
  Vec3 low = organ.centre.front(), high = low;
  for (const Vec3& p : organ.centre) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  char text[160];
  std::snprintf(text, sizeof text, "its spheres lie from %.1f, %.1f, %.1f to %.1f, %.1f, %.1f mm", low.x * 1e3,
                low.y * 1e3, low.z * 1e3, high.x * 1e3, high.y * 1e3, high.z * 1e3);
  return text;
}

}  // namespace

bool is_in(const ZoneSpec& zone, Vec3 centre, double radius) { return reaches(zone, centre, radius); }

bool is_in(const ZoneSpec& zone, Vec3 from, Vec3 to) {
  if (is_in(zone, from) || is_in(zone, to)) return true;
  const Vec3 way = to - from;
  if (zone.sphere) {
    const double square = dot(way, way);
    const double along = square > 0 ? std::clamp(dot(zone.sphere->centre - from, way) / square, 0.0, 1.0) : 0.0;
    return is_in(zone, from + along * way);
  }
  if (!zone.box) return false;
  // The part of the line between each pair of faces.
  double first = 0, last = 1;
  for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const double low = zone.box->min.*axis - from.*axis, high = zone.box->max.*axis - from.*axis, step = way.*axis;
    if (step == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    first = std::max(first, std::min(low / step, high / step));
    last = std::min(last, std::max(low / step, high / step));
  }
  return first <= last;
}

double lowest_height(const FilledOrgan& organ, Vec3 gravity) {
  // The lattice covers the surface, so its lowest spheres lie below the organ.
  double lowest = INFINITY;
  for (const Vec3& p : organ.surface.vertex.empty() ? organ.centre : organ.surface.vertex)
    lowest = std::min(lowest, height(p, gravity));
  return lowest;
}

Result<std::vector<std::int32_t>> select_anchored(const FilledOrgan& organ, const std::vector<AnchorSpec>& anchors,
                                                  Vec3 gravity, const std::string& where,
                                                  std::vector<std::int32_t>* counts) {
  if (organ.centre.empty()) return Error{where, "the organ has no spheres", ""};
  const double lowest = lowest_height(organ, gravity);
  std::vector<std::int32_t> selected, caught(anchors.size(), 0);
  for (std::size_t i = 0; i < organ.centre.size(); ++i) {
    bool is_anchored = false;
    for (std::size_t a = 0; a < anchors.size(); ++a)
      if (is_in(anchors[a], organ.centre[i], gravity, lowest)) is_anchored = true, ++caught[a];
    if (is_anchored) selected.push_back(std::int32_t(i));
  }
  Errors errors;
  for (std::size_t a = 0; a < anchors.size(); ++a)
    if (caught[a] == 0)
      errors.push_back({where + "/anchors/" + std::to_string(a), "holds no sphere", extent_of(organ)});
  if (!errors.empty()) return errors;
  if (counts != nullptr) *counts = caught;
  return selected;
}

Result<AnchorSpec> parse_anchor(const std::string& text) {
  const Error error{"",
                    "got '" + text +
                        "', must be lowest:HEIGHT, box:X0,Y0,Z0,X1,Y1,Z1, sphere:X,Y,Z,R or plane:X,Y,Z,NX,NY,NZ, "
                        "with all lengths in mm",
                    ""};
  const auto colon = text.find(':');
  if (colon == std::string::npos) return error;
  std::vector<std::string_view> raw;
  std::vector<double> v;
  for (const char *p = text.data() + colon + 1, *end = text.data() + text.size(); p <= end;) {
    double number = 0;
    const auto [next, problem] = std::from_chars(p, end, number);
    if (problem != std::errc() || (next != end && *next != ',') || !(std::abs(number) <= 1e5)) return error;
    v.push_back(number), raw.emplace_back(p, next);
    p = next + 1;
  }
  const std::string kind = text.substr(0, colon);
  AnchorSpec anchor;
  // Converted as scene text is, so that the scene that is written has the same digits.
  const auto mm = [&](std::size_t i) { return decimal_to_double(raw[i], -3); };
  const auto point = [&](std::size_t i) { return Vec3{mm(i), mm(i + 1), mm(i + 2)}; };
  const bool is_box = kind == "box" && v.size() == 6, is_plane = kind == "plane" && v.size() == 6;
  if (is_box && !(v[0] <= v[3] && v[1] <= v[4] && v[2] <= v[5])) return error;
  if (is_plane && norm(Vec3{v[3], v[4], v[5]}) < 1e-9) return error;
  if (kind == "lowest" && v.size() == 1 && v[0] >= 0)
    anchor.lowest = mm(0);
  else if (is_box)
    anchor.box = BoxRegion{point(0), point(3)};
  else if (kind == "sphere" && v.size() == 4 && v[3] > 0)
    anchor.sphere = SphereRegion{point(0), mm(3)};
  else if (is_plane)
    anchor.plane = PlaneRegion{point(0), {v[3], v[4], v[5]}};
  else
    return error;
  return anchor;
}

}  // namespace ctpm::scenes
