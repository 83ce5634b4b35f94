#include "importers/make_organs/shapes.h"

#include <algorithm>
#include <cmath>

#include "importers/make_organs/solids.h"

namespace ctpm::importers {

namespace {

/// Both lobes before the underside is shaped. The right lobe leans back: its upper face slopes gently down to a thin
/// front edge, and its back stays thick and round. The left lobe descends and narrows towards the patient's left.
double liver_lobes(Vec3 p) {
  const Vec3 right = turn_y(turn_z(turn_x(p - Vec3{-42, 7, 22.5}, -36), 14), -14);
  const double right_lobe = blunt_ellipsoid(right, {0, 0, 0}, {67, 86, 48.5}, 2.2);
  const Vec3 left = turn_y(turn_z(turn_x(p - Vec3{6, 18, 16}, -20), -8), -15);
  const double left_lobe = ellipsoid(left, {0, 0, 0}, {110, 60, 45});
  return join(right_lobe, left_lobe, 50);
}

/// Height of the underside above the table: flat at the rim, concave below the middle.
double liver_underside(Vec3 p) {
  const double x = (p.x + 4) / 70, y = (p.y - 8) / 44;
  return 14.0 * std::exp(-(x * x + y * y));
}

/// Depth [mm] to remove at `p` for the falciform ligament: a shallow furrow over the dome that opens into a notch in
/// the front edge.
double falciform_furrow(Vec3 p) {
  const double beside = (p.x - 24 + 0.12 * p.y) / 9.0;
  const double to_front = std::clamp((5 - p.y) / 45.0, 0.0, 1.0);
  return (2.0 + 16.0 * to_front * to_front) * std::exp(-beside * beside);
}

/// Furrows of the underside: ligamentum teres, gallbladder bed, the porta hepatis between them, and the groove of the
/// vena cava at the back.
double liver_without_furrows(Vec3 p, double body) {
  body = cut_out(body, tapered_capsule(p, {-20, -43, 3}, 8, {-10, -6, 15}, 5), 12);
  body = cut_out(body, tapered_capsule(p, {23, -40, 3}, 5, {14, 12, 14}, 4), 8);
  body = cut_out(body, tapered_capsule(p, {-14, 2, 15}, 6, {16, 8, 15}, 6), 10);
  return cut_out(body, tapered_capsule(p, {6, 84, 2}, 15, {8, 36, 8}, 8), 12);
}

double liver(Vec3 p) {
  const double lobes = liver_lobes(p) + falciform_furrow(p);
  return liver_without_furrows(p, common(lobes, liver_underside(p) - p.z, 20));
}

double kidney(Vec3 p) {
  // A bean: a blunt ellipsoid, thicker at the upper pole (-x), bent towards the hilum at +y.
  const double thickness = 1.0 - 0.0016 * p.x;
  const Vec3 straight{p.x, (p.y - 0.0036 * p.x * p.x) / thickness, p.z / thickness};
  const double bean = blunt_ellipsoid(straight, {0, 0, 0}, {55, 29, 22.2}, 2.4);
  // The hilum: a wide dent with a deep slit between two lips.
  const double dent = ellipsoid(p, {1, 45, 0}, {21, 25, 40});
  const double slit = ellipsoid(p, {1, 24, 0}, {15, 18, 7});
  return cut_out(cut_out(bean, dent, 16), slit, 7);
}

double skin(Vec3 p) {
  // Only the upper face is wavy; the lower one is flat.
  const double wave = 1.2 * std::sin(p.x / 13.0 + 0.4) + 0.8 * std::sin((p.y + 0.5 * p.x) / 10.0);
  const double share = std::clamp((p.z + 14) / 28.0, 0.0, 1.0);
  return rounded_box({p.x, p.y, p.z - wave * share}, {60, 60, 14.2}, 10);
}

}  // namespace

std::vector<OrganShape> organ_shapes() {
  return {{.name = "liver",
           .description = "Human liver, about life size, lying on its underside; x runs from the patient's right (-) "
                          "to the left (+), the thin front edge faces -y.",
           .distance_mm = liver,
           .inside_mm = {-40, 5, 40},
           .reach_mm = 220,
           .edge_mm = 5.9,
           .triangles = {4000, 6000},
           .volume_ml = {1000, 1500},
           .size_mm = {220, 150, 90}},
          {.name = "kidney",
           .description = "Human kidney, about life size, lying flat; x runs from the upper pole (-) to the lower "
                          "(+), the hilum faces +y.",
           .distance_mm = kidney,
           .inside_mm = {0, -5, 0},
           .reach_mm = 90,
           .edge_mm = 3.8,
           .triangles = {2500, 3500},
           .volume_ml = {120, 180},
           .size_mm = {110, 60, 45}},
          {.name = "skin",
           .description = "Piece of skin with the tissue below it, gently waved on top.",
           .distance_mm = skin,
           .inside_mm = {0, 0, 0},
           .reach_mm = 120,
           .edge_mm = 5.6,
           .triangles = {2500, 3500},
           .volume_ml = {350, 450},
           .size_mm = {120, 120, 30}}};
}

}  // namespace ctpm::importers
