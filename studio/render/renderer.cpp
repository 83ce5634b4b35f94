#include "studio/render/renderer.h"

#include <algorithm>
#include <cmath>

#include "studio/render/cut_surface.h"
#include "studio/render/gl_context.h"
#include "studio/render/gl_objects.h"
#include "studio/render/organ_mesh.h"
#include "studio/render/shaders.h"
#include "studio/render/tool_mesh.h"

namespace ctpm {
namespace {

constexpr int kShadowSize = 96;        // of the shadow texture [pixels]; it is blurred anyway
constexpr double kShadowMargin = 1.7;  // ground that can be shaded, against the scene's extent

Vec3 linear(const Colour& c) { return {std::pow(c[0], 2.2), std::pow(c[1], 2.2), std::pow(c[2], 2.2)}; }
Vec3 unit(Vec3 v) { return v / norm(v); }

Mat4 rigid(Quat turn, Vec3 origin) {
  const Vec3 x = rotate(turn, {1, 0, 0}), y = rotate(turn, {0, 1, 0}), z = rotate(turn, {0, 0, 1});
  return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1};
}

struct OrganParts {
  CutSurface cut;
  OrganMesh mesh;
  VertexArray array;
};

}  // namespace

struct Renderer::Parts {
  std::unique_ptr<GlContext> context;
  SceneView scene;
  Frame frame;
  std::vector<std::uint8_t> rgba;
  MultisampleTarget target;
  TextureTarget shadow, contact, wide;
  Program background, organ, tool, sphere, ground, shadow_pass, blur;
  GLuint noise = 0;
  std::vector<OrganParts> organs;
  std::vector<VertexArray> tools;
  VertexArray nothing, spheres;
  std::vector<float> sphere_data;

  // The scene's frame: up, the ground plane, its size.
  Vec3 up, ground_centre, ground_x, ground_y;
  double ground_height = 0, size = 1;

  const Gl& gl() const { return context->gl(); }
  Result<Done> create_programs();
  void create_organs();
  void create_tools();
  void place_ground();
  void update_organs(const State& state);
  void draw_shadow();
  void set_light(const Program& program, const State& state, const DrawOptions& options,
                 const Mat4& clip_from_world);
  void draw_background(const DrawOptions& options, const Mat4& clip_from_world);
  void draw_organs(const State& state, const DrawOptions& options, const Mat4& clip_from_world);
  void draw_spheres(const State& state, const DrawOptions& options, const Mat4& clip_from_world);
  void draw_tool(const State& state, const DrawOptions& options, const Mat4& clip_from_world);
  void read_frame();
  Mat4 clip_from_world(const Camera& camera) const;
  const Tool* held_tool(const State& state, const DrawOptions& options) const;
};

Result<Done> Renderer::Parts::create_programs() {
  Errors errors;
  const auto make = [&](Program& program, const char* name, const ShaderSource& source) {
    auto made = Program::create(gl(), name, source.vertex, source.fragment);
    if (made)
      program = *made;
    else
      errors.insert(errors.end(), made.errors().begin(), made.errors().end());
  };
  make(background, "background", background_shader()), make(organ, "organ", organ_shader());
  make(tool, "tool", tool_shader()), make(sphere, "sphere", sphere_shader()),
      make(ground, "ground", ground_shader());
  make(shadow_pass, "shadow", shadow_shader()), make(blur, "blur", shadow_blur_shader());
  if (!errors.empty()) return errors;
  return Done{};
}

void Renderer::Parts::create_organs() {
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    organs.push_back({CutSurface(*scene.model, i, scene.surfaces[i]), {}, {}});
    VertexArray& array = organs.back().array;
    array.create(gl());
    array.attribute(gl(), 0, 3, 0, kOrganVertexFloats), array.attribute(gl(), 1, 3, 3, kOrganVertexFloats);
    array.attribute(gl(), 2, 3, 6, kOrganVertexFloats), array.attribute(gl(), 3, 1, 9, kOrganVertexFloats);
  }
  nothing.create(gl());
  spheres.create(gl());
  spheres.attribute(gl(), 0, 4, 0, 7, 1), spheres.attribute(gl(), 1, 3, 4, 7, 1);
}

void Renderer::Parts::create_tools() {
  for (const Tool& kind : scene.model->tools) {
    const ToolMesh mesh = make_tool_mesh(kind);
    VertexArray array;
    array.create(gl());
    array.attribute(gl(), 0, 3, 0, 7), array.attribute(gl(), 1, 3, 3, 7), array.attribute(gl(), 2, 1, 6, 7);
    array.set_stream(gl(), mesh.vertex), array.set_indices(gl(), mesh.index);
    tools.push_back(array);
  }
}

void Renderer::Parts::place_ground() {
  up = up_of(*scene.model);
  const Bounds box = rest_bounds(scene);
  size = std::max(box.diagonal(), 1e-6);
  double lowest = dot(box.centre(), up);
  for (const Surface& surface : scene.surfaces)
    for (const Vec3& p : surface.vertex) lowest = std::min(lowest, dot(p, up));
  // A little below the lowest point, since organs sag.
  ground_height = lowest - 0.015 * size;
  ground_centre = box.centre() + (ground_height - dot(box.centre(), up)) * up;
  const double half = 0.5 * kShadowMargin * size;
  ground_x = half * unit(cross(std::abs(up.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, up));
  ground_y = cross(up, ground_x);
}

void Renderer::Parts::update_organs(const State& state) {
  for (std::size_t i = 0; i < organs.size(); ++i) {
    OrganParts& part = organs[i];
    const bool changed = part.cut.update(state);
    const Surface& surface = part.cut.surface();
    part.mesh.update(surface, state, scene.model->organs[i].first);
    part.array.set_stream(gl(), part.mesh.vertices());
    if (!changed && part.array.index_count) continue;
    std::vector<std::uint32_t> index;
    for (const auto& t : surface.triangle)
      for (const std::int32_t v : t) index.push_back(std::uint32_t(v));
    part.array.set_indices(gl(), index);
  }
}

Mat4 Renderer::Parts::clip_from_world(const Camera& camera) const {
  const double away = norm(camera.eye - ground_centre);
  const double near = std::max(away - 3 * size, 0.02 * size), far = away + 3 * size;
  return product(projection_matrix(camera, double(frame.width) / frame.height, near, far),
                 view_matrix(camera));
}

const Tool* Renderer::Parts::held_tool(const State& state, const DrawOptions& options) const {
  const std::int32_t held = state.last_inputs.tool;
  return options.show_tool && held >= 0 && std::size_t(held) < scene.model->tools.size()
             ? &scene.model->tools[std::size_t(held)]
             : nullptr;
}

void Renderer::Parts::set_light(const Program& program, const State& state, const DrawOptions& options,
                                const Mat4& clip) {
  program.use();
  const Mat4 view = view_matrix(options.camera);
  const Vec3 right{view[0], view[4], view[8]}, back{view[2], view[6], view[10]};
  program.set("clip_from_world", clip);
  gl().Uniform2f(gl().GetUniformLocation(program.id(), "picture_size"), float(frame.width),
                 float(frame.height));
  program.set("eye", options.camera.eye), program.set("up", up);
  program.set("key_light", unit(0.85 * up - 0.55 * right + 0.5 * back));
  program.set("fill_light", unit(0.25 * up + 0.9 * right + 0.35 * back));
  program.set("rim_light", unit(0.45 * up + 0.35 * right - 0.8 * back));
  program.set("ground_height", ground_height), program.set("scene_size", size);
  const Tool* held = held_tool(state, options);
  const Vec3 tip = state.last_inputs.position;
  const bool cuts = held && held->kind == ToolKind::scalpel;
  program.set("tool_tip", tip);
  program.set("tool_heel",
              cuts ? tip + rotate(state.last_inputs.world_from_tool, {0, 0, held->blade_length}) : tip);
  program.set("tool_radius", !held ? 0.0 : cuts ? 0.06 * held->blade_length : held->radius);
}

void Renderer::Parts::draw_shadow() {
  const Gl& g = gl();
  g.Disable(GL_DEPTH_TEST);
  shadow.begin(g);
  g.ClearColor(0, 0, 0, 0), g.Clear(GL_COLOR_BUFFER_BIT);
  g.Enable(GL_BLEND), g.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_COLOR);
  shadow_pass.use();
  shadow_pass.set("ground_centre", ground_centre), shadow_pass.set("ground_x", ground_x),
      shadow_pass.set("ground_y", ground_y);
  shadow_pass.set("up", up), shadow_pass.set("reach", 0.10 * size);
  for (const OrganParts& part : organs) {
    g.BindVertexArray(part.array.id);
    g.DrawElements(GL_TRIANGLES, GLsizei(3 * part.cut.outer_triangle_count()), GL_UNSIGNED_INT, nullptr);
  }
  g.Disable(GL_BLEND);
  // Blur twice: a narrow one for the contact, a wide one for the room's light.
  blur.use(), blur.set("picture", 0);
  g.ActiveTexture(GL_TEXTURE0), g.BindVertexArray(nothing.id);
  const auto pass = [&](const TextureTarget& from, const TextureTarget& to, double dx, double dy) {
    to.begin(g), g.BindTexture(GL_TEXTURE_2D, from.texture);
    g.Uniform2f(g.GetUniformLocation(blur.id(), "stride"), float(dx / kShadowSize), float(dy / kShadowSize));
    g.DrawArrays(GL_TRIANGLES, 0, 3);
  };
  pass(shadow, wide, 0.55, 0), pass(wide, contact, 0, 0.55);
  pass(contact, shadow, 2, 0), pass(shadow, wide, 0, 2);
}

void Renderer::Parts::draw_background(const DrawOptions& options, const Mat4& clip) {
  const Gl& g = gl();
  target.begin(g);
  g.Disable(GL_DEPTH_TEST), g.Clear(GL_DEPTH_BUFFER_BIT);
  background.use();
  g.Uniform2f(g.GetUniformLocation(background.id(), "picture_size"), float(frame.width), float(frame.height));
  g.BindVertexArray(nothing.id), g.DrawArrays(GL_TRIANGLES, 0, 3);
  g.Enable(GL_DEPTH_TEST), g.DepthFunc(GL_LEQUAL);
  if (!options.show_ground || dot(options.camera.eye, up) <= ground_height) return;
  ground.use();
  g.Uniform2f(g.GetUniformLocation(ground.id(), "picture_size"), float(frame.width), float(frame.height));
  ground.set("clip_from_world", clip);
  ground.set("ground_centre", ground_centre), ground.set("ground_x", ground_x),
      ground.set("ground_y", ground_y);
  ground.set("contact", 0), ground.set("wide", 1);
  g.ActiveTexture(GL_TEXTURE0), g.BindTexture(GL_TEXTURE_2D, contact.texture);
  g.ActiveTexture(GL_TEXTURE1), g.BindTexture(GL_TEXTURE_2D, wide.texture);
  g.ActiveTexture(GL_TEXTURE0);
  g.DepthMask(GL_FALSE), g.DrawArrays(GL_TRIANGLE_STRIP, 0, 4), g.DepthMask(GL_TRUE);
}

void Renderer::Parts::draw_organs(const State& state, const DrawOptions& options, const Mat4& clip) {
  const Gl& g = gl();
  const bool glassy = options.view == View::both;
  set_light(organ, state, options, clip);
  g.ActiveTexture(GL_TEXTURE0), g.BindTexture(GL_TEXTURE_3D, noise);
  organ.set("noise", 0), organ.set("is_glassy", glassy ? 1 : 0);
  if (glassy) g.Enable(GL_BLEND), g.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  for (std::size_t i = 0; i < organs.size(); ++i) {
    const OrganLook& look = scene.looks[i];
    organ.set("outer_colour", linear(look.outer)), organ.set("inner_colour", linear(look.inner)),
        organ.set("wetness", look.wetness);
    const VertexArray& array = organs[i].array;
    const GLsizei outer = GLsizei(3 * organs[i].cut.outer_triangle_count());
    g.BindVertexArray(array.id);
    organ.set("is_wall", 0), g.DrawElements(GL_TRIANGLES, outer, GL_UNSIGNED_INT, nullptr);
    organ.set("is_wall", 1);
    if (array.index_count > outer)
      g.DrawElements(GL_TRIANGLES, array.index_count - outer, GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(sizeof(GLuint) * std::size_t(outer)));
  }
  g.Disable(GL_BLEND);
}

void Renderer::Parts::draw_spheres(const State& state, const DrawOptions& options, const Mat4& clip) {
  const Gl& g = gl();
  sphere_data.clear();
  for (const OrganRange& range : scene.model->organs)
    for (std::int32_t i = range.first; i < range.first + range.count; ++i) {
      const Vec3 p = state.position[std::size_t(i)],
                 c = linear(layer_colour(scene.model->layer[std::size_t(i)], range.layer_count));
      for (const double x : {p.x, p.y, p.z, range.sphere_radius, c.x, c.y, c.z})
        sphere_data.push_back(float(x));
    }
  spheres.set_stream(g, sphere_data);
  set_light(sphere, state, options, clip);
  g.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  g.BindVertexArray(spheres.id),
      g.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(sphere_data.size() / 7));
  g.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void Renderer::Parts::draw_tool(const State& state, const DrawOptions& options, const Mat4& clip) {
  if (!held_tool(state, options)) return;
  const VertexArray& array = tools[std::size_t(state.last_inputs.tool)];
  set_light(tool, state, options, clip);
  tool.set("world_from_tool", rigid(state.last_inputs.world_from_tool, state.last_inputs.position));
  gl().BindVertexArray(array.id),
      gl().DrawElements(GL_TRIANGLES, array.index_count, GL_UNSIGNED_INT, nullptr);
}

void Renderer::Parts::read_frame() {
  target.read(gl(), rgba);
  const std::size_t width = std::size_t(frame.width), height = std::size_t(frame.height);
  for (std::size_t row = 0; row < height; ++row) {
    const std::uint8_t* from = rgba.data() + (height - 1 - row) * width * 4;
    std::uint8_t* to = frame.rgb.data() + row * width * 3;
    for (std::size_t x = 0; x < width; ++x)
      to[3 * x] = from[4 * x], to[3 * x + 1] = from[4 * x + 1], to[3 * x + 2] = from[4 * x + 2];
  }
}

Renderer::Renderer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Renderer::~Renderer() = default;
const SceneView& Renderer::scene() const { return parts_->scene; }

Result<std::unique_ptr<Renderer>> Renderer::create(int width, int height, SceneView scene) {
  Errors errors;
  if (width < 16 || width > 8192 || height < 16 || height > 8192)
    errors.push_back(
        {"picture size",
         "got " + std::to_string(width) + "x" + std::to_string(height) + ", each must be in [16, 8192]", ""});
  if (!scene.model || scene.model->organs.size() != scene.surfaces.size())
    errors.push_back({"scene", "a picture needs a model and one surface for each of its organs", ""});
  if (!errors.empty()) return errors;
  for (std::size_t i = scene.looks.size(); i < scene.model->organs.size(); ++i)
    scene.looks.push_back(look_of(scene.model->organs[i].name));

  auto context = GlContext::create();
  if (!context) return context.errors();
  auto parts = std::make_unique<Parts>();
  parts->context = *std::move(context), parts->scene = std::move(scene);
  parts->frame = blank_frame(width, height, 0, 0, 0);
  const Gl& gl = parts->gl();
  if (auto done = parts->create_programs(); !done) return done.errors();
  if (auto done = parts->target.create(gl, width, height); !done) return done.errors();
  for (TextureTarget* texture : {&parts->shadow, &parts->contact, &parts->wide})
    texture->create(gl, kShadowSize);
  parts->noise = create_noise_texture(gl);
  parts->place_ground(), parts->create_organs(), parts->create_tools();
  return std::unique_ptr<Renderer>(new Renderer(std::move(parts)));
}

const Frame& Renderer::draw(const State& state, const DrawOptions& options) {
  Parts& p = *parts_;
  p.context->make_current();
  const Mat4 clip = p.clip_from_world(options.camera);
  p.update_organs(state);
  if (options.show_ground) p.draw_shadow();
  p.draw_background(options, clip);
  if (options.view != View::surface) p.draw_spheres(state, options, clip);
  p.draw_tool(state, options, clip);
  if (options.view != View::spheres) p.draw_organs(state, options, clip);
  p.read_frame();
  return p.frame;
}

}  // namespace ctpm
