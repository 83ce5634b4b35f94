#include "studio/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <future>
#include <numbers>
#include <optional>
#include <thread>

#include "core/model/errors.h"
#include "core/parallel/team.h"
#include "studio/render/backdrop.h"
#include "studio/render/edge_smoothing.h"
#include "studio/render/element_values.h"
#include "studio/render/expert_cut.h"
#include "studio/render/footprint.h"
#include "studio/render/gl_context.h"
#include "studio/render/gl_objects.h"
#include "studio/render/marks.h"
#include "studio/render/obstacle_mesh.h"
#include "studio/render/organ_painter.h"
#include "studio/render/shaders.h"
#include "studio/render/tool_mesh.h"

namespace ctpm::render {
namespace {

constexpr double kGroundExtent = 1.45;   // side of the ground that can be shaded, against the scene's size
constexpr double kLineWidth = 0.006;     // of the line of a cut in a section, against the scene's size
constexpr double kExpertWidth = 0.0045;  // of the line of an expert's cut, against the picture's height

Vec3 unit(Vec3 v) { return v / norm(v); }

Mat4 rigid(Quat turn, Vec3 origin) {
  const Vec3 x = rotate(turn, {1, 0, 0}), y = rotate(turn, {0, 1, 0}), z = rotate(turn, {0, 0, 1});
  return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1};
}

}  // namespace

struct Renderer::Parts {
  std::unique_ptr<GlContext> context;
  SceneView scene;
  Frame backdrop, frame;
  std::vector<std::uint8_t> rgba;
  EdgeSmoother edges;
  parallel::Team team{std::clamp(int(std::thread::hardware_concurrency()), 1, 2)};
  PictureTarget target;
  Program tool, sphere, rod;
  OrganPainter organs;
  std::vector<ToolMesh> tool_meshes;
  std::vector<VertexArray> tools;
  struct DrawnObstacle {
    ObstacleMesh mesh;
    VertexArray array;
    std::optional<GroundShadow> shadow;  ///< on its level top
  };
  std::vector<DrawnObstacle> obstacles;
  VertexArray spheres, rods;
  std::vector<float> instances;
  std::vector<ElementValue> elements;
  ExpertMarker marker;
  std::unique_ptr<GroundShadow> shadow;

  // The scene's frame: up, the ground plane, its size.
  Vec3 up, ground_centre, ground_x, ground_y;
  double ground_height = 0, size = 1;

  // Of the picture being drawn.
  Mat4 clip{};
  PixelRect rect;

  const Gl& gl() const { return context->gl(); }
  Result<Done> create_programs();
  void create_arrays();
  void place_ground();
  Mat4 clip_from_world(const Camera& camera) const;
  const Tool* held_tool(const Hand& hand, const DrawOptions& options) const;
  bool sees_ground(const DrawOptions& options) const {
    return options.show_ground && dot(options.camera.eye, up) > ground_height;
  }
  PixelRect footprint(const State& state, const DrawOptions& options) const;
  void set_light(const Program& program, const State& state, const DrawOptions& options);
  void draw_spheres(const State& state, const DrawOptions& options);
  void draw_elements(const State& state, const DrawOptions& options);
  void draw_rods(const State& state, const DrawOptions& options);
  VertexArray array_of(const ToolMesh& mesh) const;
  void draw_tools(const State& state, const DrawOptions& options);
  void draw_tool(const Hand& hand, const State& state, const DrawOptions& options, double ghost);
  void draw_ghost(const State& state, const DrawOptions& options);
  std::vector<Mark> draw_expert(const State& state, const DrawOptions& options);
  void draw_obstacles(const State& state, const DrawOptions& options);
  void cast_shadow(DrawnObstacle& obstacle, const Cutaway& cutaway);
  void draw_behind(const DrawOptions& options);
  void read_frame();
  void composite(int row);
};

Result<Done> Renderer::Parts::create_programs() {
  Errors errors;
  const auto make = [&](Program& program, const char* name, const ShaderSource& source) {
    auto made = Program::create(gl(), name, source.vertex, source.fragment);
    if (made)
      program = *made;
    else
      append(errors, made);
  };
  make(tool, "tool", tool_shader()), make(sphere, "sphere", sphere_shader());
  make(rod, "rod", rod_shader());
  if (!errors.empty()) return errors;
  return organs.create(gl(), scene);
}

void Renderer::Parts::create_arrays() {
  const Gl& g = gl();
  spheres.create(g);
  spheres.attribute(g, 0, 4, 0, 7, 1), spheres.attribute(g, 1, 3, 4, 7, 1);
  rods.create(g);
  rods.attribute(g, 0, 3, 0, 10, 1), rods.attribute(g, 1, 3, 3, 10, 1);
  rods.attribute(g, 2, 1, 6, 10, 1), rods.attribute(g, 3, 3, 7, 10, 1);
  for (const Tool& kind : scene.model->tools) {
    tool_meshes.push_back(make_tool_mesh(kind));
    tools.push_back(array_of(tool_meshes.back()));
  }
  for (const Obstacle& obstacle : scene.model->obstacles) {
    if (is_level_ground(obstacle, up)) continue;
    DrawnObstacle& drawn = obstacles.emplace_back();
    drawn.mesh = make_obstacle_mesh(obstacle, up, ground_centre, kGroundExtent * size);
    drawn.array = array_of(drawn.mesh.mesh);
    if (const auto top = level_top_of(obstacle, up)) drawn.shadow.emplace(top->centre, top->x, top->y, up, 0.10 * size);
  }
}

VertexArray Renderer::Parts::array_of(const ToolMesh& mesh) const {
  const Gl& g = gl();
  VertexArray array;
  array.create(g);
  array.attribute(g, 0, 3, 0, 7), array.attribute(g, 1, 3, 3, 7), array.attribute(g, 2, 1, 6, 7);
  array.set_stream(g, mesh.vertex), array.set_indices(g, mesh.index);
  return array;
}

void Renderer::Parts::place_ground() {
  up = up_of(*scene.model);
  const Bounds box = rest_bounds(scene);
  size = std::max(box.diagonal(), 1e-6);
  double lowest = dot(box.centre(), up);
  for (const Surface& surface : scene.model->surfaces)
    for (const Vec3& p : surface.vertex) lowest = std::min(lowest, dot(p, up));
  // A little below the lowest point, since organs sag.
  ground_height = lowest - 0.015 * size;
  for (const Obstacle& obstacle : scene.model->obstacles)
    if (is_level_ground(obstacle, up)) ground_height = dot(obstacle.position, up);
  ground_centre = box.centre() + (ground_height - dot(box.centre(), up)) * up;
  const double half = 0.5 * kGroundExtent * size;
  ground_x = half * unit(cross(std::abs(up.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, up));
  ground_y = cross(up, ground_x);
  shadow = std::make_unique<GroundShadow>(ground_centre, ground_x, ground_y, up, 0.10 * size);
}

Mat4 Renderer::Parts::clip_from_world(const Camera& camera) const {
  const double away = norm(camera.eye - ground_centre);
  const double near = std::max(away - 3 * size, 0.02 * size), far = away + 3 * size;
  return product(projection_matrix(camera, double(frame.width) / frame.height, near, far), view_matrix(camera));
}

const Tool* Renderer::Parts::held_tool(const Hand& hand, const DrawOptions& options) const {
  const std::int32_t held = hand.tool;
  return options.show_tool && held >= 0 && std::size_t(held) < scene.model->tools.size()
             ? &scene.model->tools[std::size_t(held)]
             : nullptr;
}

/// The rectangle to draw; the rest of the picture is backdrop.
PixelRect Renderer::Parts::footprint(const State& state, const DrawOptions& options) const {
  Footprint print(clip, frame.width, frame.height);
  organs.for_each_position([&](Vec3 p) { print.add(p); });
  if (options.view != View::surface)
    for (const OrganRange& range : scene.model->organs)
      for (std::int32_t i = range.first; i < range.first + range.count; ++i)
        for (const double side : {-1.5, 1.5}) {
          const Vec3 p = state.position[std::size_t(i)];
          for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
            print.add(p + side * range.sphere_radius * axis);
        }
  for (const DrawnObstacle& obstacle : obstacles) {
    const std::vector<float>& v = obstacle.mesh.mesh.vertex;
    for (std::size_t i = 0; i < v.size(); i += 7) print.add({v[i], v[i + 1], v[i + 2]});
  }
  const auto add_tool = [&](const Hand& hand) {
    if (!held_tool(hand, options)) return;
    const std::vector<float>& v = tool_meshes[std::size_t(hand.tool)].vertex;
    for (std::size_t i = 0; i < v.size(); i += 7)
      print.add(hand.position + rotate(hand.world_from_tool, {v[i], v[i + 1], v[i + 2]}));
  };
  for (std::size_t number = 0; number < kMostHands; ++number) add_tool(state.last_inputs.hand(number));
  if (options.ghost) add_tool(*options.ghost);
  return print.pixels();
}

void Renderer::Parts::set_light(const Program& program, const State& state, const DrawOptions& options) {
  program.use();
  const Mat4 view = view_matrix(options.camera);
  const Vec3 right{view[0], view[4], view[8]}, back{view[2], view[6], view[10]};
  program.set("clip_from_world", clip);
  program.set("eye", options.camera.eye), program.set("up", up);
  program.set("key_light", unit(0.85 * up - 0.55 * right + 0.5 * back));
  program.set("fill_light", unit(0.25 * up + 0.9 * right + 0.35 * back));
  program.set("rim_light", unit(0.45 * up + 0.35 * right - 0.8 * back));
  program.set("ground_height", ground_height), program.set("scene_size", size);
  constexpr std::array<std::array<const char*, 3>, kMostHands> kNames{
      {{"tool_tip", "tool_heel", "tool_radius"}, {"second_tip", "second_heel", "second_radius"}}};
  for (std::size_t number = 0; number < kMostHands; ++number) {
    const Hand& hand = state.last_inputs.hand(number);
    const Tool* held = held_tool(hand, options);
    const Vec3 tip = hand.position;
    const bool cuts = held && held->kind == ToolKind::scalpel;
    program.set(kNames[number][0], tip);
    program.set(kNames[number][1], cuts ? tip + rotate(hand.world_from_tool, {0, 0, held->blade_length}) : tip);
    program.set(kNames[number][2], !held ? 0.0 : cuts ? 0.06 * held->blade_length : held->radius);
  }
}

void Renderer::Parts::draw_spheres(const State& state, const DrawOptions& options) {
  const Gl& g = gl();
  instances.clear();
  // Whole, the outermost would stand out of the surface and hide it.
  const double size = options.view == View::both ? 0.5 : 1.0;
  const std::vector<std::uint8_t> at_cut = spheres_at_cuts(*scene.model, state);
  for (const OrganRange& range : scene.model->organs)
    for (std::int32_t i = range.first; i < range.first + range.count; ++i) {
      const auto n = std::size_t(i);
      const Vec3 p = state.position[n],
                 c = !at_cut.empty() && at_cut[n]
                         ? linear(kCutColour)
                         : linear(scene.sphere_colours.empty() ? layer_colour(scene.model->layer[n], range.layer_count)
                                                               : scene.sphere_colours[n]);
      if (options.cutaway.leaves_out(p)) continue;
      for (const double x : {p.x, p.y, p.z, size * range.sphere_radius, c.x, c.y, c.z}) instances.push_back(float(x));
    }
  spheres.set_stream(g, instances);
  set_light(sphere, state, options);
  g.BindVertexArray(spheres.id), g.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(instances.size() / 7));
}

void Renderer::Parts::draw_elements(const State& state, const DrawOptions& options) {
  const double scale = options.full_scale > 0 ? options.full_scale : default_full_scale(options.quantity);
  measure_elements(*scene.model, state, options.quantity, elements);
  double radius = 0;
  for (const OrganRange& range : scene.model->organs) radius = std::max(radius, 0.11 * range.sphere_radius);
  instances.clear();
  for (const ElementValue& e : elements) {
    const Vec3 a = state.position[std::size_t(e.a)], b = state.position[std::size_t(e.b)];
    if (options.cutaway.leaves_out(0.5 * (a + b))) continue;
    const double part = e.value / scale;
    const Vec3 c = linear(quantity_colour(options.quantity, part));
    const double width = radius * (1 + 1.2 * std::min(std::abs(part), 1.0));  // larger values are thicker
    for (const double x : {a.x, a.y, a.z, b.x, b.y, b.z, width, c.x, c.y, c.z}) instances.push_back(float(x));
  }
  draw_rods(state, options);
}

void Renderer::Parts::draw_rods(const State& state, const DrawOptions& options) {
  if (instances.empty()) return;
  rods.set_stream(gl(), instances);
  set_light(rod, state, options);
  gl().BindVertexArray(rods.id), gl().DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(instances.size() / 10));
}

void Renderer::Parts::draw_tools(const State& state, const DrawOptions& options) {
  for (std::size_t number = 0; number < kMostHands; ++number)
    draw_tool(state.last_inputs.hand(number), state, options, 0);
}

void Renderer::Parts::draw_tool(const Hand& hand, const State& state, const DrawOptions& options, double ghost) {
  if (!held_tool(hand, options)) return;
  const VertexArray& array = tools[std::size_t(hand.tool)];
  set_light(tool, state, options);
  tool.set("world_from_tool", rigid(hand.world_from_tool, hand.position)), tool.set("ghost", ghost);
  gl().BindVertexArray(array.id), gl().DrawElements(GL_TRIANGLES, array.index_count, GL_UNSIGNED_INT, nullptr);
}

/// Its nearest surface alone, over all that was drawn: depth first, then colour.
void Renderer::Parts::draw_ghost(const State& state, const DrawOptions& options) {
  if (!options.ghost) return;
  const Gl& g = gl();
  g.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw_tool(*options.ghost, state, options, 1);
  g.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  g.Enable(GL_BLEND), g.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  draw_tool(*options.ghost, state, options, 1);
  g.Disable(GL_BLEND);
}

/// The line, which organs and tools hide. Returns the marks that nothing hides.
std::vector<Mark> Renderer::Parts::draw_expert(const State& state, const DrawOptions& options) {
  if (!options.expert) return {};
  std::uint64_t version = 0;
  const std::vector<DrawnOrgan> drawn = organs.drawn(version);
  ExpertMarks marks = marker.place(*scene.model, options.expert, drawn, version, state);
  const Vec3 eye = options.camera.eye, colour = linear(kExpertColour);
  const double half_view = std::tan(options.camera.fov_deg * std::numbers::pi / 360);
  instances.clear();
  for (const auto& [from, to] : marks.line) {
    if (options.cutaway.leaves_out(0.5 * (from + to))) continue;
    const double radius = kExpertWidth * half_view * norm(0.5 * (from + to) - eye);
    // On the skin and a little nearer, whose triangles are as coarse as it is.
    const auto raised = [&](Vec3 p) { return p + radius * unit(eye - p); };
    const Vec3 a = raised(from), b = raised(to);
    for (const double x : {a.x, a.y, a.z, b.x, b.y, b.z, radius, colour.x, colour.y, colour.z})
      instances.push_back(float(x));
  }
  draw_rods(state, options);
  std::erase_if(marks.strays, [&](Vec3 p) { return options.cutaway.leaves_out(p); });
  if (marks.strays.empty()) return {};
  // With a dark rim, so that they are seen on every tissue.
  constexpr double kRim = 2, kDot = 1.5;
  Mark dots{
      .shape = Mark::Shape::dot, .points = std::move(marks.strays), .colour = kStrayColour, .label = "", .size = kDot};
  Mark rims = dots;
  rims.colour = {0.08, 0.09, 0.11}, rims.size = kRim;
  return {std::move(rims), std::move(dots)};
}

void Renderer::Parts::draw_obstacles(const State& state, const DrawOptions& options) {
  if (obstacles.empty()) return;
  set_light(tool, state, options);
  tool.set("world_from_tool", rigid({}, {})), tool.set("ghost", 0.0);
  for (DrawnObstacle& obstacle : obstacles) {
    if (obstacle.shadow) cast_shadow(obstacle, options.cutaway);
    gl().BindVertexArray(obstacle.array.id);
    gl().DrawElements(GL_TRIANGLES, obstacle.array.index_count, GL_UNSIGNED_INT, nullptr);
  }
}

/// Darkens the vertices of a level top where organs are above it.
void Renderer::Parts::cast_shadow(DrawnObstacle& obstacle, const Cutaway& cutaway) {
  obstacle.shadow->clear();
  organs.add_shadows(*obstacle.shadow, cutaway);
  obstacle.shadow->find_darkness();
  std::vector<float>& vertex = obstacle.mesh.mesh.vertex;
  for (std::size_t i = 0; i < obstacle.mesh.top_vertices; ++i) {
    float* const v = &vertex[7 * i];
    v[6] = float(ToolPart::cloth) + obstacle.shadow->darkness_at({v[0], v[1], v[2]});
  }
  obstacle.array.set_stream(gl(), vertex);
}

/// The backdrop and the ground's shadow.
void Renderer::Parts::draw_behind(const DrawOptions& options) {
  frame.rgb = backdrop.rgb;
  if (!sees_ground(options)) return;
  shadow->clear();
  organs.add_shadows(*shadow, options.cutaway);
  shadow->draw(frame, clip);
}

/// Reads the drawn pixels and composites them over the background.
void Renderer::Parts::read_frame() {
  if (rect.width == 0 || rect.height == 0) return;
  target.read(gl(), rect, rgba);
  edges.smooth(rgba, rect.width, rect.height, team);
  constexpr int kBands = 8;
  team.for_each(kBands, [&](int band) {
    for (int row = rect.height * band / kBands; row < rect.height * (band + 1) / kBands; ++row) composite(row);
  });
}

/// A row of the drawn pixels over the background.
void Renderer::Parts::composite(int row) {
  const std::uint8_t* from = rgba.data() + std::size_t(row) * std::size_t(rect.width) * 4;
  std::uint8_t* to =
      frame.rgb.data() +
      (std::size_t(frame.height - 1 - rect.y - row) * std::size_t(frame.width) + std::size_t(rect.x)) * 3;
  for (int x = 0; x < rect.width; ++x, from += 4, to += 3) {
    const unsigned rest = 255u - from[3];
    if (rest == 255) continue;
    if (rest == 0) {
      std::memcpy(to, from, 3);
      continue;
    }
    for (int c = 0; c < 3; ++c) to[c] = std::uint8_t(std::min(255u, from[c] + (to[c] * rest + 127) / 255));
  }
}

std::vector<Pixel> Renderer::tool_points(const State& state, const DrawOptions& options) const {
  constexpr double kApart = 16;  // [pixels]
  const Parts& p = *parts_;
  std::vector<Pixel> points, corner;
  for (std::size_t number = 0; number < kMostHands; ++number) {
    const Hand& hand = state.last_inputs.hand(number);
    if (!p.held_tool(hand, options)) continue;
    const ToolMesh& mesh = p.tool_meshes[std::size_t(hand.tool)];
    corner.clear();
    for (std::size_t i = 0; i < mesh.vertex.size(); i += 7) {
      const Vec3 own{mesh.vertex[i], mesh.vertex[i + 1], mesh.vertex[i + 2]};
      corner.push_back(project(options.camera, p.backdrop.width, p.backdrop.height,
                               hand.position + rotate(hand.world_from_tool, own)));
    }
    for (std::size_t i = 0; i < mesh.index.size(); i += 3) {
      const Pixel a = corner[mesh.index[i]], b = corner[mesh.index[i + 1]];
      if (!(a.depth > 0 && b.depth > 0)) continue;
      const int parts = int(std::min(std::hypot(b.x - a.x, b.y - a.y) / kApart, 200.0)) + 1;
      for (int k = 0; k < parts; ++k) {
        const double t = double(k) / parts;
        points.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.depth});
      }
    }
  }
  return points;
}

Renderer::Renderer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Renderer::~Renderer() = default;
const SceneView& Renderer::scene() const { return parts_->scene; }

std::string Renderer::opengl() const {
  parts_->context->make_current();
  const auto text = [&](GLenum name) {
    return std::string(reinterpret_cast<const char*>(parts_->gl().GetString(name)));
  };
  return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

Result<std::unique_ptr<Renderer>> Renderer::create(int width, int height, SceneView scene) {
  Errors errors;
  if (width < 16 || width > 8192 || height < 16 || height > 8192)
    errors.push_back({"picture size",
                      "got " + std::to_string(width) + "x" + std::to_string(height) + ", each must be in [16, 8192]",
                      ""});
  if (!scene.model || scene.model->organs.size() != scene.model->surfaces.size())
    errors.push_back({"scene", "a picture needs a model and one surface for each of its organs", ""});
  if (!errors.empty()) return errors;
  for (std::size_t i = scene.looks.size(); i < scene.model->organs.size(); ++i)
    scene.looks.push_back(look_of(scene.model->organs[i].name));

  if (!scene.cuts) {
    scene.cuts = std::make_shared<std::vector<CutSurface>>();
    for (std::size_t i = 0; i < scene.model->surfaces.size(); ++i) scene.cuts->emplace_back(*scene.model, i);
  }
  auto context = GlContext::create();
  if (!context) return context.errors();
  auto parts = std::make_unique<Parts>();
  parts->context = *std::move(context), parts->scene = std::move(scene);
  parts->frame = blank_frame(width, height, 0, 0, 0);
  parts->backdrop = make_backdrop(width, height);
  const Gl& gl = parts->gl();
  if (auto done = parts->create_programs(); !done) return done.errors();
  if (auto done = parts->target.create(gl, width, height); !done) return done.errors();
  parts->place_ground(), parts->create_arrays();
  return std::unique_ptr<Renderer>(new Renderer(std::move(parts)));
}

Frame Renderer::draw(const State& state, const DrawOptions& options) {
  Parts& p = *parts_;
  p.context->make_current();
  const Gl& gl = p.gl();
  p.clip = p.clip_from_world(options.camera);
  p.organs.update(gl, state);
  p.rect = p.footprint(state, options);
  // Another thread draws the background while this one tells the driver what to draw.
  std::future<void> behind = std::async(std::launch::async, [&] { p.draw_behind(options); });
  if (options.cutaway.is_on()) p.target.need_stencil(gl);
  p.target.begin(gl, p.rect);
  gl.Enable(GL_DEPTH_TEST), gl.DepthFunc(GL_LEQUAL);
  if (options.view == View::spheres || options.view == View::both) p.draw_spheres(state, options);
  if (options.view == View::elements) p.draw_elements(state, options);
  p.draw_tools(state, options);
  p.draw_obstacles(state, options);
  if (options.view == View::surface || options.view == View::both) {
    p.organs.update_sections(gl, p.scene, state, options, kLineWidth * p.size);
    for (const Program* program : p.organs.programs(options)) p.set_light(*program, state, options);
    p.organs.draw(gl, p.scene, options);
  }
  const std::vector<Mark> marks = p.draw_expert(state, options);
  p.draw_ghost(state, options);
  gl.Flush();
  behind.get();
  p.read_frame();
  draw_marks(p.frame, options.camera, marks);
  return std::move(p.frame);
}

}  // namespace ctpm::render
