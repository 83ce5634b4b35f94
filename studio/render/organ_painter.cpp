#include "studio/render/organ_painter.h"

#include <algorithm>

#include "studio/render/lips.h"

namespace ctpm::render {
namespace {

constexpr double kReliefWidth = 0.018;  // of the shades in a section, against the organ's size

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
  for (const OrganPass pass : {OrganPass::outside, OrganPass::near_cut, OrganPass::inside, OrganPass::glassy})
    for (const bool cutaway : {false, true}) {
      const ShaderSource source = organ_shader(pass, cutaway);
      auto made = Program::create(gl, "organ", source.vertex, source.fragment);
      if (!made) return made.errors();
      programs_[std::size_t(pass)][cutaway] = *made;
    }
  auto count = Program::create(gl, "count", count_shader().vertex, count_shader().fragment);
  if (!count) return count.errors();
  count_ = *count;
  drawn_ = std::make_unique<contact::DrawnSurfaces>(*scene.model);
  rest_map_ = std::make_unique<cutting::RestMap>(*scene.model);
  cuts_ = scene.cuts;
  for (std::size_t i = 0; i < scene.model->surfaces.size(); ++i) {
    organs_.push_back(
        {i, {}, {}, Section(*scene.model, *rest_map_, i), {}, {}, 0, 0, {}, scene.model->organs[i].spacing / 3});
    Organ& organ = organs_.back();
    for (VertexArray* array : {&organ.array, &organ.section_array}) {
      array->create(gl);
      array->attribute(gl, 0, 3, 0, kOrganVertexFloats), array->attribute(gl, 1, 3, 3, kOrganVertexFloats);
      array->attribute(gl, 2, 3, 6, kOrganVertexFloats), array->attribute(gl, 3, 4, 9, kOrganVertexFloats);
    }
  }
  return Done{};
}

/// The texture that tells how deep a place of an organ is: for its layers, and for the shades of sections. It takes a
/// moment to make, so an organ without a wall or section goes without.
void OrganPainter::add_depth(const Gl& gl, Organ& organ, const Surface& surface, const OrganLook& look) {
  if (organ.depth_texture || surface.triangle.empty()) return;
  organ.relief_width = kReliefWidth * bounds_of(surface.vertex).diagonal();
  double thinnest = organ.relief_width, last = 0;
  for (const LayerLook& layer : look.layers) {
    thinnest = std::min(thinnest, layer.to_depth - last);
    last = layer.to_depth;
  }
  organ.depth = DepthField(surface, last + organ.relief_width, thinnest);
  gl.GenTextures(1, &organ.depth_texture), gl.BindTexture(GL_TEXTURE_3D, organ.depth_texture);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl.TexParameteri(GL_TEXTURE_3D, wrap, GL_CLAMP_TO_EDGE);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TexImage3D(GL_TEXTURE_3D, 0, GL_R32F, organ.depth.count[0], organ.depth.count[1], organ.depth.count[2], 0, GL_RED,
                GL_FLOAT, organ.depth.depth.data());
}

void OrganPainter::update(const Gl& gl, const State& state) {
  for (std::size_t i = 0; i < organs_.size(); ++i) {
    Organ& organ = organs_[i];
    CutSurface& cut = (*cuts_)[i];
    cut.update(state);  // for another Renderer it may be as it should be already
    const Surface& surface = cut.surface();
    if (organ.seen != cut.changes()) {
      const std::vector<float> lip = nearness_to_lips(surface, cut.is_lip(), organ.ooze);
      organ.mesh.set_surface(surface, lip, cut.rind(), cut.at_rest());
      organ.oozes = find_oozing(cut, lip);
    }
    organ.seen = cut.changes();
    organ.mesh.update(*drawn_, i, surface, state);
    organ.array.set_stream(gl, organ.mesh.vertices());
  }
}

void OrganPainter::update_sections(const Gl& gl, const SceneView& scene, const State& state, const DrawOptions& options,
                                   double line_width) {
  if (!options.cutaway.is_on() || options.view == View::both) return;
  for (std::size_t i = 0; i < organs_.size(); ++i) {
    Organ& organ = organs_[i];
    add_depth(gl, organ, scene.model->surfaces[i], scene.looks[i]);
    organ.section.update(state, options.cutaway, cut_of(organ).surface(), cut_of(organ).outer_triangle_count(),
                         organ.mesh.positions(), line_width);
    organ.section_array.set_stream(gl, organ.section.vertices());
    organ.section_array.set_indices(gl, organ.section.indices());
  }
}

void OrganPainter::add_shadows(GroundShadow& shadow, const Cutaway& cutaway) const {
  for (const Organ& organ : organs_)
    shadow.add(cut_of(organ).surface(), organ.mesh.positions(), cut_of(organ).outer_triangle_count(), cutaway);
}

std::vector<DrawnOrgan> OrganPainter::drawn(std::uint64_t& version) const {
  std::vector<DrawnOrgan> drawn;
  version = 0;
  for (const Organ& organ : organs_) {
    const CutSurface& cut = cut_of(organ);
    drawn.push_back({&cut.surface(), cut.outer_triangle_count(), &organ.mesh.positions()});
    version += cut.changes();  // each of which only grows
  }
  return drawn;
}

std::vector<const Program*> OrganPainter::programs(const DrawOptions& options) const {
  if (options.view == View::both) return {&program(OrganPass::glassy, options)};
  std::vector<const Program*> used{&program(OrganPass::outside, options), &program(OrganPass::near_cut, options),
                                   &program(OrganPass::inside, options)};
  if (options.cutaway.is_on()) used.insert(used.end(), {&programs_[std::size_t(OrganPass::inside)][false], &count_});
  return used;
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

std::vector<std::uint8_t> OrganPainter::find_oozing(const CutSurface& cut, const std::vector<float>& lip) {
  std::vector<std::uint8_t> oozes;
  if (cut.is_lip().empty()) return oozes;
  const auto& triangles = cut.surface().triangle;
  oozes.resize(cut.outer_triangle_count());
  for (std::size_t i = 0; i < oozes.size(); ++i)
    oozes[i] = std::ranges::any_of(triangles[i], [&](std::int32_t v) { return lip[std::size_t(v)] > kLeastOoze; });
  return oozes;
}

/// Sorting here is cheaper than letting the software pipeline transform every triangle once for each pass.
OrganPainter::Order OrganPainter::sort_triangles(const Organ& organ, const DrawOptions& options) {
  const Surface& surface = cut_of(organ).surface();
  const std::vector<Vec3>& p = organ.mesh.positions();
  const std::size_t outer = cut_of(organ).outer_triangle_count();
  // Layers of glass keep their order.
  const bool is_glassy = options.view == View::both, needs_averted = options.cutaway.is_on();
  indices_.clear(), near_cut_.clear(), averted_.clear();
  const auto add = [&](std::vector<std::uint32_t>& list, const std::array<std::int32_t, 3>& t) {
    for (const std::int32_t v : t) list.push_back(std::uint32_t(v));
  };
  for (std::size_t i = 0; i < outer; ++i) {
    const auto& t = surface.triangle[i];
    const Vec3 a = p[std::size_t(t[0])], n = cross(p[std::size_t(t[1])] - a, p[std::size_t(t[2])] - a);
    if (dot(n, options.camera.eye - a) >= 0)
      add(is_glassy || organ.oozes.empty() || !organ.oozes[i] ? indices_ : near_cut_, t);
    else if (needs_averted)
      add(averted_, t);
  }
  Order order{indices_.size(), near_cut_.size(), 0, averted_.size()};
  indices_.insert(indices_.end(), near_cut_.begin(), near_cut_.end());
  for (std::size_t i = outer; i < surface.triangle.size(); ++i) add(indices_, surface.triangle[i]);
  order.wall = indices_.size() - order.outside - order.near_cut;
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
    const bool has_section = !glassy && options.cutaway.is_on();
    const Order order = sort_triangles(organ, options);
    organ.array.set_indices(gl, indices_);
    // Triangles that face the eye come first, because they hide most of the rest. Surface and walls are watertight:
    // nobody sees an inner face.
    set_look(outside, scene.looks[i], options);
    if (glassy) {
      // Where the organ is cut away, the inner face of its far side is seen. It comes first: the near side covers it.
      outside.set("blood", scene.looks[i].blood);
      draw_indices(order.outside + order.near_cut + order.wall, order.averted);
      draw_indices(0, order.outside);
      continue;
    }
    draw_indices(0, order.outside);
    if (order.near_cut > 0) {
      const Program& near_cut = program(OrganPass::near_cut, options);
      set_look(near_cut, scene.looks[i], options);
      near_cut.set("blood", scene.looks[i].blood);
      draw_indices(order.outside, order.near_cut);
    }
    if (order.wall > 0) {
      if (!scene.looks[i].layers.empty()) add_depth(gl, organ, scene.model->surfaces[i], scene.looks[i]);
      set_look(inside, scene.looks[i], options);
      set_layers(gl, inside, organ, scene.looks[i]);
      inside.set("blood", scene.looks[i].blood);
      draw_indices(order.outside + order.near_cut, order.wall);
    }
    if (has_section) draw_section(gl, organ, scene.looks[i], options);
  }
  gl.Disable(GL_BLEND);
}

void OrganPainter::set_layers(const Gl& gl, const Program& program, const Organ& organ, const OrganLook& look) {
  const std::size_t count = organ.depth_texture ? std::min(look.layers.size(), kMostLayerLooks) : 0;
  program.set("layer_count", int(count)), program.set("relief_width", 0.0);
  if (!organ.depth_texture) return;
  gl.ActiveTexture(GL_TEXTURE0), gl.BindTexture(GL_TEXTURE_3D, organ.depth_texture);
  program.set("depth_at_rest", 0), program.set("depth_low", organ.depth.low),
      program.set("depth_size", organ.depth.size);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string at = "[" + std::to_string(i) + "]";
    program.set(("layer_end" + at).c_str(), look.layers[i].to_depth);
    program.set(("layer_colour" + at).c_str(), linear(look.layers[i].colour));
  }
}

/// The plane is in tissue where the rest of a ray leaves the organ once more than it enters it.
void OrganPainter::draw_section(const Gl& gl, const Organ& organ, const OrganLook& look, const DrawOptions& options) {
  if (organ.section.indices().empty()) return;
  gl.Enable(GL_STENCIL_TEST), gl.Clear(GL_STENCIL_BUFFER_BIT);
  gl.Disable(GL_DEPTH_TEST), gl.DepthMask(GL_FALSE), gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  gl.StencilFunc(GL_ALWAYS, 0, 255);
  gl.StencilOpSeparate(GL_FRONT, GL_KEEP, GL_KEEP, GL_DECR_WRAP);
  gl.StencilOpSeparate(GL_BACK, GL_KEEP, GL_KEEP, GL_INCR_WRAP);
  set_look(count_, look, options);
  gl.BindVertexArray(organ.array.id);
  gl.DrawElements(GL_TRIANGLES, organ.array.index_count, GL_UNSIGNED_INT, nullptr);
  gl.Enable(GL_DEPTH_TEST), gl.DepthMask(GL_TRUE), gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.StencilFunc(GL_NOTEQUAL, 0, 255), gl.StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  const Program& inside = programs_[std::size_t(OrganPass::inside)][false];
  set_look(inside, look, options);
  set_layers(gl, inside, organ, look);
  inside.set("blood", 0.0), inside.set("relief_width", organ.relief_width);
  gl.BindVertexArray(organ.section_array.id);
  gl.DrawElements(GL_TRIANGLES, organ.section_array.index_count, GL_UNSIGNED_INT, nullptr);
  gl.Disable(GL_STENCIL_TEST);
}

}  // namespace ctpm::render
