#include "studio/render/organ_painter.h"

#include <algorithm>

namespace ctpm::render {
namespace {

/// Of the outermost layer where it is cut, as light: the lighter of the organ's colours, paler as fibrous
/// tissue is.
Vec3 rind_colour(const OrganLook& look) {
  constexpr double kPale = 0.08;
  const Vec3 outer = linear(look.outer), inner = linear(look.inner);
  const Vec3 lighter{std::max(outer.x, inner.x), std::max(outer.y, inner.y), std::max(outer.z, inner.z)};
  const double brightest = std::max({lighter.x, lighter.y, lighter.z});
  return (1 - kPale) * lighter + kPale * Vec3{brightest, brightest, brightest};
}

}  // namespace

Result<Done> OrganPainter::create(const Gl& gl, const SceneView& scene) {
  for (const OrganPass pass : {OrganPass::outside, OrganPass::inside, OrganPass::glassy})
    for (const bool cutaway : {false, true}) {
      const ShaderSource source = organ_shader(pass, cutaway);
      auto made = Program::create(gl, "organ", source.vertex, source.fragment);
      if (!made) return made.errors();
      programs_[std::size_t(pass)][cutaway] = *made;
    }
  drawn_ = std::make_unique<contact::DrawnSurfaces>(*scene.model);
  for (std::size_t i = 0; i < scene.model->surfaces.size(); ++i) {
    organs_.push_back({CutSurface(*scene.model, i), {}, {}, false});
    VertexArray& array = organs_.back().array;
    array.create(gl);
    array.attribute(gl, 0, 3, 0, kOrganVertexFloats), array.attribute(gl, 1, 3, 3, kOrganVertexFloats);
    array.attribute(gl, 2, 3, 6, kOrganVertexFloats), array.attribute(gl, 3, 4, 9, kOrganVertexFloats);
  }
  return Done{};
}

void OrganPainter::update(const Gl& gl, const State& state) {
  for (std::size_t i = 0; i < organs_.size(); ++i) {
    Organ& organ = organs_[i];
    const bool changed = organ.cut.update(state);
    const Surface& surface = organ.cut.surface();
    if (changed || !organ.is_set)
      organ.mesh.set_surface(surface, organ.cut.is_lip(), organ.cut.rind(), organ.cut.at_rest());
    organ.is_set = true;
    organ.mesh.update(*drawn_, i, surface, state);
    organ.array.set_stream(gl, organ.mesh.vertices());
  }
}

void OrganPainter::add_shadows(GroundShadow& shadow) const {
  for (const Organ& organ : organs_)
    shadow.add(organ.cut.surface(), organ.mesh.positions(), organ.cut.outer_triangle_count());
}

std::vector<const Program*> OrganPainter::programs(const DrawOptions& options) const {
  if (options.view == View::both) return {&program(OrganPass::glassy, options)};
  return {&program(OrganPass::outside, options), &program(OrganPass::inside, options)};
}

void OrganPainter::set_look(const Program& program, const OrganLook& look, const DrawOptions& options) {
  program.use();
  const Vec3 outer = linear(look.outer), inner = linear(look.inner);
  program.set("outer_colour", outer), program.set("inner_colour", inner);
  program.set("rind_colour", rind_colour(look));
  // Mixes towards a dark inside before lighting.
  const auto tint = [](double in, double out) { return 0.55 * in / std::max(out, 0.01); };
  program.set("lip_tint", Vec3{tint(inner.x, outer.x), tint(inner.y, outer.y), tint(inner.z, outer.z)});
  program.set("wetness", look.wetness);
  program.set("cutaway_point", options.cutaway.point), program.set("cutaway_normal", options.cutaway.normal);
}

/// Sorting here is cheaper than letting the software pipeline transform every triangle once for each pass.
OrganPainter::Order OrganPainter::sort_triangles(const Organ& organ, Vec3 eye, bool needs_averted) {
  const Surface& surface = organ.cut.surface();
  const std::vector<Vec3>& p = organ.mesh.positions();
  const std::size_t outer = organ.cut.outer_triangle_count();
  indices_.clear(), averted_.clear();
  const auto add = [&](std::vector<std::uint32_t>& list, const std::array<std::int32_t, 3>& t) {
    for (const std::int32_t v : t) list.push_back(std::uint32_t(v));
  };
  for (std::size_t i = 0; i < outer; ++i) {
    const auto& t = surface.triangle[i];
    const Vec3 a = p[std::size_t(t[0])], n = cross(p[std::size_t(t[1])] - a, p[std::size_t(t[2])] - a);
    if (dot(n, eye - a) >= 0)
      add(indices_, t);
    else if (needs_averted)
      add(averted_, t);
  }
  Order order{indices_.size(), 0, averted_.size()};
  for (std::size_t i = outer; i < surface.triangle.size(); ++i) add(indices_, surface.triangle[i]);
  order.wall = indices_.size() - order.facing;
  indices_.insert(indices_.end(), averted_.begin(), averted_.end());
  return order;
}

void OrganPainter::draw(const Gl& gl, const SceneView& scene, const DrawOptions& options) {
  const bool glassy = options.view == View::both;
  const Program& outside = program(glassy ? OrganPass::glassy : OrganPass::outside, options);
  const Program& inside = program(OrganPass::inside, options);
  const auto draw_indices = [&](std::size_t first, std::size_t count) {
    if (count)
      gl.DrawElements(GL_TRIANGLES, GLsizei(count), GL_UNSIGNED_INT,
                      reinterpret_cast<const void*>(first * sizeof(GLuint)));
  };
  if (glassy) gl.Enable(GL_BLEND), gl.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  for (std::size_t i = 0; i < organs_.size(); ++i) {
    Organ& organ = organs_[i];
    // Surface and walls are watertight: inner faces are visible only through a cutaway.
    const Order order = sort_triangles(organ, options.camera.eye, !glassy && options.cutaway.is_on());
    organ.array.set_indices(gl, indices_);
    // Triangles that face the eye come first, because they hide most of the rest.
    set_look(outside, scene.looks[i], options);
    draw_indices(0, order.facing);
    if (glassy || order.wall + order.averted == 0) continue;
    set_look(inside, scene.looks[i], options);
    inside.set("is_wall", 1);
    draw_indices(order.facing, order.wall);
    inside.set("is_wall", 0);
    draw_indices(order.facing + order.wall, order.averted);
  }
  gl.Disable(GL_BLEND);
}

}  // namespace ctpm::render
