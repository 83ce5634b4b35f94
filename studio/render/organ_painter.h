#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/contact/drawn_surfaces.h"
#include "core/cutting/rest_map.h"
#include "studio/render/cut_surface.h"
#include "studio/render/depth_field.h"
#include "studio/render/expert_cut.h"
#include "studio/render/gl_objects.h"
#include "studio/render/ground_shadow.h"
#include "studio/render/organ_mesh.h"
#include "studio/render/scene_view.h"
#include "studio/render/section.h"
#include "studio/render/shaders.h"

namespace ctpm::render {

/// An sRGB colour as linear light, with gamma 2 as in the shaders.
inline Vec3 linear(const Colour& c) { return {c[0] * c[0], c[1] * c[1], c[2] * c[2]}; }

/// Draws the organs' surfaces.
class OrganPainter {
 public:
  /// Errors: shaders that do not compile.
  Result<Done> create(const Gl& gl, const SceneView& scene);

  /// Deforms and splits the surfaces according to the state.
  void update(const Gl& gl, const State& state);
  /// Lays the plane of a cutaway through the organs as update() left them. `line_width` [m]: of the lines of cuts.
  void update_sections(const Gl& gl, const SceneView& scene, const State& state, const DrawOptions& options,
                       double line_width);
  void add_shadows(GroundShadow& shadow, const Cutaway& cutaway) const;

  /// The programs that draw() will use. The caller sets the light of each first.
  std::vector<const Program*> programs(const DrawOptions& options) const;
  void draw(const Gl& gl, const SceneView& scene, const DrawOptions& options);

  /// The organs as update() left them; `version`: a number that no other triangles of them have.
  std::vector<DrawnOrgan> drawn(std::uint64_t& version) const;

  /// Visits the positions of all vertices of all organs [m].
  template <class Visit>
  void for_each_position(Visit&& visit) const {
    for (const Organ& organ : organs_)
      for (const Vec3& p : organ.mesh.positions()) visit(p);
  }

 private:
  struct Organ {
    std::size_t number = 0;
    OrganMesh mesh;
    VertexArray array;
    Section section;
    VertexArray section_array;
    DepthField depth;  ///< empty without layers until there is a section
    GLuint depth_texture = 0;
    double relief_width = 0;            ///< of the shades in a section [m]
    std::optional<std::uint64_t> seen;  ///< the changes of its surface that `mesh` has taken over
    double ooze = 0;  ///< how far blood oozes out of a cut: as far as triangles reach where nothing is cut [m]
    std::vector<std::uint8_t> oozes = {};  ///< whether an outer triangle is beside a cut; empty: none is
  };

  /// Index ranges of one organ: triangles that face the eye far from cuts and beside them, walls of cuts, triangles
  /// that face away, which only a cutaway's section counts.
  struct Order {
    std::size_t outside = 0, near_cut = 0, wall = 0, averted = 0;  ///< counts of indices
  };
  const CutSurface& cut_of(const Organ& organ) const { return (*cuts_)[organ.number]; }
  static std::vector<std::uint8_t> find_oozing(const CutSurface& cut, const std::vector<float>& lip);
  Order sort_triangles(const Organ& organ, const DrawOptions& options);

  std::unique_ptr<contact::DrawnSurfaces> drawn_;
  std::unique_ptr<cutting::RestMap> rest_map_;
  std::vector<Organ> organs_;
  std::shared_ptr<std::vector<CutSurface>> cuts_;  ///< one for each organ
  std::vector<std::uint32_t> indices_, near_cut_, averted_;
  const Program& program(OrganPass pass, const DrawOptions& options) const {
    return programs_[std::size_t(pass)][options.cutaway.is_on()];
  }
  static void set_look(const Program& program, const OrganLook& look, const DrawOptions& options);
  static void add_depth(const Gl& gl, Organ& organ, const Surface& surface, const OrganLook& look);
  static void set_layers(const Gl& gl, const Program& program, const Organ& organ, const OrganLook& look);
  void draw_section(const Gl& gl, const Organ& organ, const OrganLook& look, const DrawOptions& options);

  Program programs_[kOrganPasses][2];  ///< [OrganPass][has_cutaway]
  Program count_;
};

}  // namespace ctpm::render
