#include "studio/render/organ_painter.h"

namespace ctpm {

Result<Done> OrganPainter::create(const Gl& gl, const SceneView& scene) {
  for (const bool glassy : {false, true})
    for (const bool cutaway : {false, true}) {
      const ShaderSource source = organ_shader(glassy, cutaway);
      auto made = Program::create(gl, "organ", source.vertex, source.fragment);
      if (!made) return made.errors();
      programs_[glassy][cutaway] = *made;
    }
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    organs_.push_back({CutSurface(*scene.model, i, scene.surfaces[i]), {}, {}, 0, false});
    VertexArray& array = organs_.back().array;
    array.create(gl);
    array.attribute(gl, 0, 3, 0, kOrganVertexFloats), array.attribute(gl, 1, 3, 3, kOrganVertexFloats);
    array.attribute(gl, 2, 3, 6, kOrganVertexFloats), array.attribute(gl, 3, 3, 9, kOrganVertexFloats);
  }
  return Done{};
}

void OrganPainter::update(const Gl& gl, const SceneView& scene, const State& state) {
  for (std::size_t i = 0; i < organs_.size(); ++i) {
    Organ& organ = organs_[i];
    const bool changed = organ.cut.update(state);
    const Surface& surface = organ.cut.surface();
    if (changed || !organ.is_set) {
      organ.is_set = true;
      organ.mesh.set_surface(surface, organ.cut.is_lip());
      std::vector<std::uint32_t> index;
      for (const auto& t : surface.triangle)
        for (const std::int32_t v : t) index.push_back(std::uint32_t(v));
      organ.array.set_indices(gl, index);
      organ.outer_indices = 3 * organ.cut.outer_triangle_count();
    }
    organ.mesh.update(surface, state, scene.model->organs[i].first);
    organ.array.set_stream(gl, organ.mesh.vertices());
  }
}

void OrganPainter::add_shadows(GroundShadow& shadow) const {
  for (const Organ& organ : organs_)
    shadow.add(organ.cut.surface(), organ.mesh.positions(), organ.cut.outer_triangle_count());
}

const Program& OrganPainter::program(const DrawOptions& options) const {
  return programs_[options.view == View::both][options.cutaway.is_on()];
}

void OrganPainter::draw(const Gl& gl, const SceneView& scene, const DrawOptions& options) const {
  const Program& program = this->program(options);
  const bool glassy = options.view == View::both;
  program.set("cutaway_point", options.cutaway.point), program.set("cutaway_normal", options.cutaway.normal);
  if (glassy) gl.Enable(GL_BLEND), gl.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl.Enable(GL_CULL_FACE);
  for (std::size_t i = 0; i < organs_.size(); ++i) {
    const Organ& organ = organs_[i];
    const OrganLook& look = scene.looks[i];
    program.set("outer_colour", linear(look.outer)), program.set("inner_colour", linear(look.inner));
    program.set("wetness", look.wetness);
    gl.BindVertexArray(organ.array.id);
    const auto pass = [&](GLenum culled, bool is_wall) {
      const std::size_t first = is_wall ? organ.outer_indices : 0;
      const std::size_t count =
          is_wall ? std::size_t(organ.array.index_count) - organ.outer_indices : organ.outer_indices;
      if (!count) return;
      gl.CullFace(culled), program.set("is_wall", is_wall ? 1 : 0);
      gl.DrawElements(GL_TRIANGLES, GLsizei(count), GL_UNSIGNED_INT,
                      reinterpret_cast<const void*>(first * sizeof(GLuint)));
    };
    // Outer faces first: they hide most of the rest. Inner faces of a whole organ are never seen.
    pass(GL_BACK, false);
    const bool is_cut = std::size_t(organ.array.index_count) > organ.outer_indices;
    if (glassy || !(is_cut || options.cutaway.is_on())) continue;
    pass(GL_BACK, true), pass(GL_FRONT, true), pass(GL_FRONT, false);
  }
  gl.Disable(GL_CULL_FACE), gl.Disable(GL_BLEND);
}

}  // namespace ctpm
