#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "core/stepping/step.h"
#include "studio/render/cut_surface.h"
#include "studio/render/open_edges.h"
#include "studio/render/organ_mesh.h"
#include "tests/studio/render_scene.h"

namespace ctpm::render_test {
namespace {

/// A blade along z that goes through the organ in the plane x = `x`, from one side to `end` in y, down to
/// `bottom`.
State cut_along_y(const Model& model, double x, double end, double bottom) {
  State state = rest_state(model);
  cut(model, state, {{x, -0.1, bottom}, {x, -0.1, 0.1}}, {{x, end, bottom}, {x, end, 0.1}});
  return state;
}

double area(const Surface& surface, std::size_t triangles) {
  double sum = 0;
  for (std::size_t i = 0; i < triangles; ++i) {
    const auto& t = surface.triangle[i];
    const Vec3 a = surface.vertex[std::size_t(t[0])], b = surface.vertex[std::size_t(t[1])],
               c = surface.vertex[std::size_t(t[2])];
    sum += 0.5 * norm(cross(b - a, c - a));
  }
  return sum;
}

TEST(CutSurface, WithoutACutIsTheWholeSurface) {
  const auto scene = make_blob_scene();
  CutSurface cut_surface(scene->model, 0, scene->view.surfaces[0]);
  EXPECT_FALSE(cut_surface.update(rest_state(scene->model)));
  EXPECT_EQ(cut_surface.surface().triangle, scene->view.surfaces[0].triangle);
  const State severed = cut_along_y(scene->model, 0, 0.1, 0);
  EXPECT_TRUE(cut_surface.update(severed));
  EXPECT_FALSE(cut_surface.update(severed));
  EXPECT_TRUE(cut_surface.update(rest_state(scene->model)));
  EXPECT_EQ(cut_surface.surface().triangle, scene->view.surfaces[0].triangle);
  EXPECT_EQ(cut_surface.outer_triangle_count(), scene->view.surfaces[0].triangle.size());
}

TEST(CutSurface, SplitTrianglesKeepTheWholeArea) {
  const auto scene = make_blob_scene();
  const double whole = area(scene->view.surfaces[0], scene->view.surfaces[0].triangle.size());
  for (const double bottom : {-0.1, 0.0, 0.01}) {
    CutSurface cut_surface(scene->model, 0, scene->view.surfaces[0]);
    State state = cut_along_y(scene->model, 0.001, 0.02, bottom);
    cut(scene->model, state, {{-0.1, 0, bottom}, {-0.1, 0.01, 0.1}},
        {{0.1, 0, bottom}, {0.1, 0.01, 0.1}});  // a second cut, across
    cut_surface.update(state);
    EXPECT_GT(cut_surface.outer_triangle_count(), scene->view.surfaces[0].triangle.size());
    EXPECT_GT(cut_surface.surface().triangle.size(), cut_surface.outer_triangle_count());
    EXPECT_NEAR(area(cut_surface.surface(), cut_surface.outer_triangle_count()), whole, 1e-9 * whole);
  }
}

/// The largest change of length of any edge of any triangle [m].
double worst_stretch(const CutSurface& cut_surface, const State& state) {
  std::vector<Vec3> moved;
  const Surface& surface = cut_surface.surface();
  deform_surface(surface, state.position, 0, moved);
  double worst = 0;
  for (const auto& t : surface.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t a = std::size_t(t[i]), b = std::size_t(t[(i + 1) % 3]);
      worst = std::max(worst, std::abs(norm(moved[a] - moved[b]) - norm(surface.vertex[a] - surface.vertex[b])));
    }
  return worst;
}

TEST(CutSurface, PiecesOfAFullCutMoveApartWithoutStretchingATriangle) {
  const auto scene = make_blob_scene();
  for (const double lean : {0.0, 0.4, 1.0}) {  // the plane x = lean y
    State state = rest_state(scene->model);
    cut(scene->model, state, {{-0.1 * lean, -0.1, -0.1}, {-0.1 * lean, -0.1, 0.1}},
        {{0.1 * lean, 0.1, -0.1}, {0.1 * lean, 0.1, 0.1}});
    CutSurface cut_surface(scene->model, 0, scene->view.surfaces[0]);
    ASSERT_TRUE(cut_surface.update(state));
    spread(state, scene->model, [&](Vec3 p) { return p.x > lean * p.y ? Vec3{0.05, 0.01, 0} : Vec3{}; });
    EXPECT_LT(worst_stretch(cut_surface, state), 1e-12) << "lean " << lean;  // rounding only
  }
}

TEST(CutSurface, NothingSpansThePiecesWhereASideCutMeetsTheCut) {
  const auto scene = make_blob_scene();
  for (const double x : {0.0, 0.002, 0.0028, 0.0042})
    for (const double y : {-0.01, 0.0, 0.013})
      for (const double bottom : {0.018, 0.0}) {
        State state = rest_state(scene->model);
        cut(scene->model, state, {{x, -0.1, -0.1}, {x, -0.1, 0.1}}, {{x, 0.1, -0.1}, {x, 0.1, 0.1}});
        cut(scene->model, state, {{x - 0.0001, y, bottom}, {x - 0.0001, y, 0.1}},
            {{x + 0.009, y + 0.002, bottom}, {x + 0.009, y + 0.002, 0.1}});
        CutSurface cut_surface(scene->model, 0, scene->view.surfaces[0]);
        ASSERT_TRUE(cut_surface.update(state));
        spread(state, scene->model, [&](Vec3 p) { return p.x > x ? Vec3{0.05, 0.01, 0} : Vec3{}; });
        EXPECT_LT(worst_stretch(cut_surface, state), 1e-12) << "side cut at " << x << ", " << y << " to " << bottom;
      }
}

/// A number for each vertex; those that have the same place and follow the same spheres have the same one: the wall
/// has its own vertices along the lips.
std::vector<std::int32_t> weld(const Surface& surface) {
  using Key = std::pair<std::array<double, 3>, std::vector<double>>;
  std::map<Key, std::int32_t> known;
  std::vector<std::int32_t> welded;
  const SurfaceBinding& b = surface.binding;
  for (std::size_t v = 0; v < surface.vertex.size(); ++v) {
    const Vec3 p = surface.vertex[v];
    Key key{{p.x, p.y, p.z}, {}};
    for (std::int32_t e = b.first[v]; e < b.first[v + 1]; ++e)
      key.second.push_back(b.sphere[std::size_t(e)]), key.second.push_back(b.weight[std::size_t(e)]);
    welded.push_back(known.try_emplace(key, std::int32_t(known.size())).first->second);
  }
  return welded;
}

int open_edges(const Surface& surface) {
  const std::vector<std::int32_t> vertex = weld(surface);
  OpenEdges open;
  for (const auto& t : surface.triangle)
    for (std::size_t i = 0; i < 3; ++i)
      if (vertex[std::size_t(t[i])] != vertex[std::size_t(t[(i + 1) % 3])])
        open.add(vertex[std::size_t(t[i])], vertex[std::size_t(t[(i + 1) % 3])]);
  int count = 0;
  for (const auto& loop : open.take_loops()) count += int(loop.size());
  return count;
}

/// Ways of a blade: each entry is where its edge is, one after the other.
using Way = std::vector<BladeEdge>;

BladeEdge upright(double x, double y, double bottom) { return {{x, y, bottom}, {x, y, 0.1}}; }

struct NamedWays {
  const char* name;
  std::vector<Way> ways;
};

std::vector<NamedWays> cuts_of_all_kinds() {
  Way curved, waving;
  for (int i = 0; i <= 40; ++i) {
    const double a = std::numbers::pi * i / 40;
    curved.push_back(upright(0.03 * std::cos(a), -0.02 + 0.03 * std::sin(a), 0.002));
    waving.push_back(upright(-0.09 + 0.0045 * i, 0.004 * std::sin(8 * a), -0.1));
  }
  const Way across{upright(0.0013, -0.1, -0.1), upright(0.0013, 0.1, -0.1)};
  const Way shallow{upright(0.0013, -0.1, 0.008), upright(0.0013, 0.1, 0.008)};
  const Way partial{upright(-0.0021, -0.1, -0.004), upright(0.0043, 0.012, -0.004)};
  const Way other{upright(-0.1, 0.0034, 0.003), upright(0.02, 0.0047, 0.003)};
  const Way inside{upright(-0.02, 0.0, 0.006), upright(0.02, 0.003, 0.006)};
  const Way flat{{{-0.1, -0.1, 0.011}, {-0.1, 0.1, 0.009}}, {{0.1, -0.1, 0.012}, {0.1, 0.1, 0.008}}};
  return {{"full", {across}},
          {"shallow", {shallow}},
          {"partial", {partial}},
          {"inside", {inside}},
          {"repeated", {partial, partial, across}},
          {"crossing", {partial, other}},
          {"crossing, one full", {across, other}},
          {"curved", {curved}},
          {"waving", {waving}},
          {"a slice off the top", {flat}},
          {"all", {across, other, curved, waving, flat}}};
}

State cut_along(const Model& model, const std::vector<Way>& ways) {
  State state = rest_state(model);
  for (const Way& way : ways)
    for (std::size_t i = 0; i + 1 < way.size(); ++i) cut(model, state, way[i], way[i + 1]);
  return state;
}

/// A lens 8 mm thick, filled with one sheet of spheres.
FilledOrgan lens_of_one_sheet() {
  const Shape lens = [](Vec3 p) {
    return (std::sqrt((p.x * p.x + p.y * p.y) / 0.0025 + p.z * p.z / 1.6e-5) - 1) * 0.004;
  };
  FilledOrgan organ;
  organ.sphere_radius = 0.003, organ.spacing = 0.009, organ.surface = star_surface(lens, 40);
  for (int j = -6; j < 6; ++j)
    for (int i = -6; i < 6; ++i) {
      const Vec3 p = organ.spacing * Vec3{i + 0.5, j + 0.5, 0};
      if (lens(p) > -0.0008) continue;
      organ.centre.push_back(p), organ.cell.push_back({i, j, 0});
      organ.layer.push_back(1), organ.depth.push_back(-lens(p));
    }
  bind_surface(organ);
  return organ;
}

TEST(CutSurface, IsWatertightWhateverTheCut) {
  const auto thick = make_blob_scene(), fine = make_blob_scene(0.002, 60);
  const auto thin = make_scene(lens_of_one_sheet());
  int severed_scenes = 0;
  for (const auto* scene : {thick.get(), fine.get(), thin.get()}) {
    EXPECT_EQ(open_edges(scene->view.surfaces[0]), 0);
    for (const NamedWays& kind : cuts_of_all_kinds()) {
      const State state = cut_along(scene->model, kind.ways);
      CutSurface cut_surface(scene->model, 0, scene->view.surfaces[0]);
      if (!cut_surface.update(state)) continue;
      ++severed_scenes;
      EXPECT_EQ(open_edges(cut_surface.surface()), 0) << kind.name << ", " << scene->model.sphere_count() << " spheres";
    }
  }
  EXPECT_GT(severed_scenes, 26);
}

TEST(CutSurface, WallAndLipsStandWhereTheBladePassed) {
  const auto scene = make_blob_scene();
  for (const double x : {-0.0035, -0.001, 0.0, 0.002, 0.004})
    for (const double lean : {0.0, 0.3}) {
      State state = rest_state(scene->model);
      cut(scene->model, state, {{x - 0.1 * lean, -0.1, -0.1}, {x - 0.1 * lean, -0.1, 0.1}},
          {{x + 0.1 * lean, 0.1, -0.1}, {x + 0.1 * lean, 0.1, 0.1}});
      CutSurface cut_surface(scene->model, 0, scene->view.surfaces[0]);
      ASSERT_TRUE(cut_surface.update(state));
      const Surface& surface = cut_surface.surface();
      std::vector<double> off;
      const double scale = 1 / std::sqrt(1 + lean * lean);
      for (std::size_t v = 0; v < surface.vertex.size(); ++v)
        if (v >= cut_surface.outer_vertex_count() || cut_surface.is_lip()[v])
          off.push_back(std::abs(surface.vertex[v].x - x - lean * surface.vertex[v].y) * scale);
      std::sort(off.begin(), off.end());
      // Spheres are 9 mm apart; where the blade passed is kept to 0.04 mm.
      EXPECT_LT(off[off.size() / 2], 1e-4) << "half of them, at " << x << " leaning " << lean;
      EXPECT_LT(off[off.size() * 95 / 100], 5e-4) << "nearly all, at " << x << " leaning " << lean;
      EXPECT_LT(off.back(), 3e-3) << "all, at " << x << " leaning " << lean;
    }
}

/// Outward normal of the blob at a place on it.
Vec3 blob_normal(Vec3 p) {
  constexpr double h = 1e-6;
  const auto slope = [&](Vec3 d) { return blob(p + h * d) - blob(p - h * d); };
  const Vec3 n{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
  return n / norm(n);
}

TEST(CutSurface, NormalsAndColourContinueOverTheClosedCut) {
  const auto scene = make_blob_scene(0.003, 60);
  const State rest = rest_state(scene->model);
  State state = cut_along_y(scene->model, 0.001, 0.02, -0.005);
  cut(scene->model, state, {{-0.1, 0, 0}, {-0.1, 0.01, 0.1}}, {{0.1, 0, 0}, {0.1, 0.01, 0.1}});
  CutSurface cut_surface(scene->model, 0, scene->view.surfaces[0]);
  ASSERT_TRUE(cut_surface.update(state));
  const Surface &whole = scene->view.surfaces[0], &surface = cut_surface.surface();
  OrganMesh uncut, mesh;
  uncut.set_surface(whole, {}, {}), uncut.update(whole, rest, 0);
  mesh.set_surface(surface, cut_surface.is_lip(), cut_surface.rind()), mesh.update(surface, state, 0);
  const auto normal = [](const OrganMesh& m, std::size_t v) {
    const float* f = &m.vertices()[v * kOrganVertexFloats];
    return Vec3{f[3], f[4], f[5]};
  };
  const auto stain = [](const OrganMesh& m, std::size_t v) { return m.vertices()[v * kOrganVertexFloats + 10]; };
  const auto degrees = [](Vec3 a, Vec3 b) { return std::asin(norm(cross(a, b))) * 180 / std::numbers::pi; };
  double worst_uncut = 0, worst_kept = 0, worst_lip = 0;
  std::map<std::array<double, 3>, std::pair<int, float>> lips;  // place -> how many copies, and their stain
  for (std::size_t v = 0; v < cut_surface.outer_vertex_count(); ++v) {
    if (v < whole.vertex.size()) {
      worst_uncut = std::max(worst_uncut, degrees(normal(uncut, v), blob_normal(whole.vertex[v])));
      worst_kept = std::max(worst_kept, degrees(normal(mesh, v), normal(uncut, v)));
      EXPECT_EQ(stain(mesh, v), stain(uncut, v)) << v;
    }
    if (!cut_surface.is_lip()[v]) continue;
    const Vec3 p = surface.vertex[v];
    worst_lip = std::max(worst_lip, degrees(normal(mesh, v), blob_normal(p)));
    auto& [copies, colour] = lips.try_emplace({p.x, p.y, p.z}, 0, stain(mesh, v)).first->second;
    ++copies;
    EXPECT_EQ(stain(mesh, v), colour) << "the other lip at the same place";
  }
  int paired = 0;
  for (const auto& [place, copies] : lips) paired += copies.first >= 2;
  EXPECT_GT(paired, 60);
  // A lip has triangles on one side only. From triangle to triangle the surface turns by 3 to 6 degrees.
  EXPECT_LT(worst_uncut, 1);
  EXPECT_LT(worst_kept, 3) << "vertices beside the cut";
  EXPECT_LT(worst_lip, 4) << "vertices on its lips";
}

TEST(CutPicture, AClosedCutIsALineAndChangesNothingElse) {
  constexpr int kWidth = 640, kHeight = 360, kLine = 3;  // kLine: half the line's width, with smoothed edges [pixels]
  const auto scene = make_blob_scene(0.003, 60);
  auto made = Renderer::create(kWidth, kHeight, scene->view);
  ASSERT_TRUE(made);
  DrawOptions options;
  options.camera = fit_camera(rest_bounds(scene->view), {0.1, 0.35, -1}, {0, 1, 0});
  const State rest = rest_state(scene->model), severed = cut_along_y(scene->model, 0.001, 0.02, -0.005);
  const Frame whole = (*made)->draw(rest, options), closed = (*made)->draw(severed, options);
  CutSurface cut_surface(scene->model, 0, scene->view.surfaces[0]);
  ASSERT_TRUE(cut_surface.update(severed));
  std::vector<bool> near_lip(kWidth * kHeight);
  for (std::size_t v = 0; v < cut_surface.outer_vertex_count(); ++v) {
    if (!cut_surface.is_lip()[v]) continue;
    const Pixel at = project(options.camera, kWidth, kHeight, cut_surface.surface().vertex[v]);
    for (int y = std::max(0, int(at.y) - 3 * kLine); y < std::min(kHeight, int(at.y) + 3 * kLine); ++y)
      for (int x = std::max(0, int(at.x) - kLine); x < std::min(kWidth, int(at.x) + kLine); ++x)
        near_lip[std::size_t(y * kWidth + x)] = true;
  }
  int darker = 0, worst = 0;
  for (std::size_t i = 0; i < near_lip.size(); ++i) {
    int change = 0;
    for (std::size_t c = 0; c < 3; ++c)
      change = std::max(change, std::abs(whole.rgb[3 * i + c] - closed.rgb[3 * i + c]));
    if (near_lip[i])
      darker += closed.rgb[3 * i] + 12 < whole.rgb[3 * i];
    else
      worst = std::max(worst, change);
  }
  EXPECT_GT(darker, 60) << "the line is seen";
  EXPECT_LE(worst, 4) << "of 255, beside the line";
}

/// Backdrop that cannot be reached from the picture's edge: what one sees through a hole.
int holes(const Frame& picture, const Frame& backdrop) {
  const int w = picture.width, h = picture.height;
  std::vector<int> kind(std::size_t(w * h));  // 1: backdrop, 2: backdrop reached from the edge
  for (std::size_t i = 0; i < kind.size(); ++i) {
    int worst = 0;
    for (std::size_t c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(picture.rgb[3 * i + c] - backdrop.rgb[3 * i + c]));
    kind[i] = worst <= 4;
  }
  std::vector<int> stack;
  const auto reach = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= w || y >= h || kind[std::size_t(y * w + x)] != 1) return;
    kind[std::size_t(y * w + x)] = 2, stack.push_back(y * w + x);
  };
  for (int x = 0; x < w; ++x) reach(x, 0), reach(x, h - 1);
  for (int y = 0; y < h; ++y) reach(0, y), reach(w - 1, y);
  while (!stack.empty()) {
    const int x = stack.back() % w, y = stack.back() / w;
    stack.pop_back();
    reach(x - 1, y), reach(x + 1, y), reach(x, y - 1), reach(x, y + 1);
  }
  return int(std::count(kind.begin(), kind.end(), 1));
}

TEST(CutPicture, OpensShowsItsWallAndNoBackground) {
  const auto scene = make_blob_scene();
  SceneView view = scene->view;
  view.looks = {look_of("liver")};
  view.looks[0].inner = {0.1, 0.7, 0.2};  // green, which is nowhere else
  auto made = Renderer::create(480, 270, view);
  ASSERT_TRUE(made);
  Renderer& renderer = **made;
  const State rest = rest_state(scene->model);
  State state = cut_along_y(scene->model, 0.0, 0.02, -0.005);
  // Open it by up to 8 mm at the top, tapering to its bottom and its end.
  spread(state, scene->model, [](Vec3 p) {
    const double open = std::clamp((p.z + 0.005) / 0.03, 0.0, 1.0) * std::clamp((0.02 - p.y) / 0.04, 0.0, 1.0);
    return Vec3{(p.x > 0 ? 0.004 : -0.004) * open, 0, 0};
  });
  for (const Vec3 direction : {Vec3{0.1, 0.35, -1}, Vec3{0, 0.8, -1}}) {
    DrawOptions options;
    options.camera = fit_camera(rest_bounds(view), direction, {0, 1, 0});
    options.show_ground = false;
    const Frame before = renderer.draw(rest, options), after = renderer.draw(state, options);
    DrawOptions away = options;
    away.camera.target = options.camera.eye + (options.camera.eye - options.camera.target);
    const Frame backdrop = renderer.draw(rest, away);
    const auto green = [](const Frame& f) {
      int count = 0;
      for (std::size_t i = 0; i < f.rgb.size(); i += 3)
        count += f.rgb[i + 1] > f.rgb[i] + 25 && f.rgb[i + 1] > f.rgb[i + 2] + 25;
      return count;
    };
    EXPECT_EQ(green(before), 0);
    EXPECT_GT(green(after), 300);
    EXPECT_EQ(holes(after, backdrop), 0);
  }
}

/// The wall of a full cut in the plane x = 0, seen straight on; the other half is out of sight.
Frame picture_of_wall(const TestScene& scene, const OrganLook& look, const DrawOptions& options) {
  SceneView view = scene.view;
  view.looks = {look};
  auto made = Renderer::create(480, 360, view);
  EXPECT_TRUE(made);
  State state = cut_along_y(scene.model, 0, 0.1, -0.1);
  spread(state, scene.model, [](Vec3 p) { return p.x > 0 ? Vec3{0, 0, -1} : Vec3{}; });
  return (*made)->draw(state, options);
}

TEST(CutPicture, ItsWallIsPalerInTheOutermostLayer) {
  const auto layered = make_blob_scene(0.002, 60), plain = make_blob_scene(0.002, 60);
  ASSERT_GT(layered->model.organs[0].layer_count, 3);
  plain->model.organs[0].layer_count = 1;
  std::fill(plain->model.layer.begin(), plain->model.layer.end(), 1);
  DrawOptions options;
  options.camera = fit_camera(rest_bounds(layered->view), {-1, 0, 0}, {0, 0, 1});
  options.show_ground = false;
  for (const char* organ : {"liver", "kidney", "skin"}) {
    OrganLook look = look_of(organ), other = look;
    look.wetness = other.wetness = 0, other.outer = {0.2, 0.9, 0.9};
    const Frame layers = picture_of_wall(*layered, look, options), one = picture_of_wall(*plain, look, options),
                recoloured = picture_of_wall(*plain, other, options);
    std::array<double, 2> paler{};  // green over red that the layers add: near the surface, deep inside
    std::array<int, 2> pixels{};
    for (double y = -0.045; y < 0.045; y += 0.0005)
      for (double z = -0.03; z < 0.03; z += 0.0005) {
        const double depth = -blob({0, y, z});
        const bool is_near = depth > 0.001 && depth < 0.003;
        const bool is_deep = depth > 0.021;
        if (!is_near && !is_deep) continue;
        const Pixel at = project(options.camera, layers.width, layers.height, {0, y, z});
        const std::size_t i = 3 * (std::size_t(at.y) * std::size_t(layers.width) + std::size_t(at.x));
        const auto green = [i](const Frame& f) { return f.rgb[i + 1] / double(f.rgb[i]); };
        paler[is_deep] += green(layers) - green(one), ++pixels[is_deep];
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_NEAR(one.rgb[i + c], recoloured.rgb[i + c], 1) << organ << ": one layer has the inner colour";
          if (is_deep)
            EXPECT_NEAR(layers.rgb[i + c], one.rgb[i + c], 1) << organ << ": and so has the inside";
          else
            EXPECT_GE(layers.rgb[i + c] + 1, one.rgb[i + c]) << organ << ": no channel is darker";
        }
      }
    ASSERT_GT(std::min(pixels[0], pixels[1]), 500);
    EXPECT_GT(paler[0] / pixels[0], 0.05) << organ;
    EXPECT_LT(std::abs(paler[1] / pixels[1]), 0.002) << organ;
  }
}

/// The blob with a capsule under tension, held below, and a blade on its way through the top of it: the states at
/// two fifths, seven tenths and the whole of the way, and a quarter of a second later.
struct Stages {
  std::unique_ptr<TestScene> scene;
  std::vector<State> states;
};

Stages cut_in_stages() {
  Stages stages;
  const FilledOrgan organ = fill(blob, star_surface(blob, 60), 0.0025);
  OrganSettings settings;
  settings.name = "liver";
  settings.material = {15e6, 15e6, 20e6, 5e6, 1060, 1, std::numbers::pi * 4e-6, 0.012};
  settings.material.fracture_toughness = 164, settings.material.blade_friction = 2000;
  settings.layers = {{0.005, settings.material}};
  settings.layers[0].material.prestrain = 0.25;
  for (std::size_t i = 0; i < organ.centre.size(); ++i)
    if (organ.centre[i].z < -0.016) settings.anchored.push_back(std::int32_t(i));
  stages.scene = std::make_unique<TestScene>();
  Model& model = stages.scene->model;
  EXPECT_TRUE(add_organ(model, organ, settings));
  model.gravity = {0, 0, -9.81}, model.tools = {{"scalpel", ToolKind::scalpel, 0, 0.05}};
  stages.scene->view.model = &model, stages.scene->view.surfaces = {organ.surface};
  stages.scene->view.looks = {look_of("liver")};
  Stepper stepper(model);
  State state = rest_state(model);
  (void)stepper.settle(state, 200);
  const Vec3 from{0.001, -0.055, 0.006}, to{0.001, 0.025, 0.006};
  constexpr int kTicks = 400, kAfter = 250;
  for (int i = 0; i <= kTicks + kAfter; ++i) {
    Inputs inputs;
    if (i <= kTicks) {
      inputs.tool = 0, inputs.position = from + double(i) / kTicks * (to - from);
      inputs.world_from_tool = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // faces along y
    }
    EXPECT_EQ(stepper.step(state, inputs).status, StepStatus::ok);
    if (i == kTicks * 2 / 5 || i == kTicks * 7 / 10 || i == kTicks || i == kTicks + kAfter)
      stages.states.push_back(state);
  }
  return stages;
}

/// How far the outermost spheres across the cut are apart, at most, beyond their distance at rest [m].
double gape(const Model& model, const State& state) {
  double most = 0;
  for (std::size_t e = 0; e < model.axial.size(); ++e) {
    const auto a = std::size_t(model.axial.a[e]), b = std::size_t(model.axial.b[e]);
    if (state.axial_severed[e] && model.layer[a] == 1 && model.layer[b] == 1)
      most = std::max(
          most, norm(state.position[a] - state.position[b]) - norm(model.rest_position[a] - model.rest_position[b]));
  }
  return most;
}

TEST(CutPicture, FourStagesOfACutFromTwoCameras) {
  const Stages stages = cut_in_stages();
  const Model& model = stages.scene->model;
  ASSERT_EQ(stages.states.size(), 4u);
  EXPECT_GT(gape(model, stages.states[3]), 0.002) << "the lips gape";
  const std::filesystem::path folder = "cut_stages";
  std::filesystem::create_directories(folder);
  auto made = Renderer::create(640, 400, stages.scene->view);
  ASSERT_TRUE(made);
  const std::pair<const char*, Vec3> cameras[] = {{"above", {0.25, 0.6, -1}}, {"along", {-0.1, 1, -0.45}}};
  for (const auto& [name, direction] : cameras) {
    DrawOptions options;
    options.camera = fit_camera(rest_bounds(stages.scene->view), direction, {0, 0, 1});
    options.show_tool = false, options.show_ground = false;
    DrawOptions away = options;
    away.camera.target = options.camera.eye + (options.camera.eye - options.camera.target);
    const Frame backdrop = (*made)->draw(stages.states[0], away);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(holes((*made)->draw(stages.states[i], options), backdrop), 0) << name << ", stage " << i + 1;
      DrawOptions shown = options;
      shown.show_tool = shown.show_ground = true;
      const std::string file = "stage_" + std::to_string(i + 1) + "_" + name + ".png";
      EXPECT_TRUE(write_png((folder / file).string(), (*made)->draw(stages.states[i], shown)));
    }
  }
}

}  // namespace
}  // namespace ctpm::render_test
