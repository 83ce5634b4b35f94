#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/model/box.h"
#include "core/model/model.h"
#include "core/model/state_view.h"
#include "core/surface/bodies.h"
#include "core/surface/near_patches.h"

namespace ctpm::surface {

/// A vertex of a body that is inside something rigid, or inside other tissue.
struct Overlap {
  std::int32_t facet, vertex;   ///< of the body
  double depth;                 ///< [m]
  Vec3 axis;                    ///< in which the vertex is pushed, unit length
  const Body* other = nullptr;  ///< the other body; null: something rigid
  std::int32_t triangle = -1;   ///< of the other surface, on the axis at the vertex
  double at[3] = {};            ///< barycentric coordinates there [1]
};

/// Where the surfaces of organs overlap each other (Model::organs_meet), and an organ's surface itself
/// (OrganRange::meets_itself). A vertex is inside other tissue if the line from it inwards leaves that tissue before
/// anything else; how far it goes until then is the depth of the overlap. Of its own surface, a vertex meets only parts
/// that were at rest much farther away than the overlap is deep, so that an organ does not meet its own far side.
class BodyOverlaps {
 public:
  /// `bodies` must outlive the BodyOverlaps.
  BodyOverlaps(const Model& model, std::vector<Body>& bodies);

  /// Whether no two bodies can overlap.
  bool empty() const { return patches_.empty(); }

  /// Begins a round, after one of the bodies' surfaces, in which overlaps of up to a spacing are found.
  void begin();

  /// As above for a step of `h` [s]. Surfaces that did not touch each other at its start overlap no deeper than they
  /// may have come since then; only near those that did are overlaps of up to a spacing looked for.
  void begin(const StateView& state, double h);

  /// Vertices that do not count from now on, numbered through all organs (vertex_count, or empty: all count). It must
  /// outlive this.
  void hide(const std::vector<std::uint8_t>& vertices) { hidden_ = &vertices; }

  /// Adds the overlaps of `bodies[body]`.
  void find(std::size_t body, std::vector<Overlap>& overlaps);

 private:
  /// Where the line inwards from a vertex first meets a surface.
  struct Hit {
    std::uint32_t round = 0;  ///< in which it was found; the rest counts in that one only
    double distance;          ///< along the line [m]
    Vec3 inwards;             ///< direction of the line
    const Body* body;
    std::int32_t triangle;
    double at[3];  ///< barycentric coordinates
    bool is_exit;  ///< the line leaves the tissue there
  };

  /// Facets that have vertices in a patch, by their first vertices: those of patch p from first[p] on.
  struct PatchFacets {
    std::vector<std::int32_t> first{0}, facet;
  };

  /// Boxes of the triangles of a surface where they are, patch by patch once they are asked for.
  struct Placed {
    std::vector<std::uint32_t> round;  ///< of each patch, in which its boxes were found
    std::vector<Box> patch, triangle;  ///< [m]
  };

  /// Box of the lines inwards from all vertices of a patch.
  struct Lines {
    std::uint32_t look = 0;  ///< in which it was found
    Box box{Vec3{}};         ///< [m]
  };

  bool is_hidden(const Body& body, std::int32_t vertex) const {
    return hidden_ != nullptr && !hidden_->empty() && (*hidden_)[std::size_t(body.first_vertex + vertex)] != 0;
  }
  bool may_meet(std::size_t body, std::size_t other) const;
  std::size_t body_of(std::int32_t facet) const;
  double way_of(std::size_t body);
  double finer_spacing(std::size_t body, std::size_t other) const;
  void set_reach(std::size_t body, std::size_t other);
  void look(std::size_t body, std::size_t other);
  void look_at_patches(std::size_t body, std::int32_t patch, std::size_t other, std::int32_t other_patch);
  void seek_triangles(std::size_t body, std::int32_t patch, std::size_t other, std::int32_t other_patch);
  bool may_be_near(std::size_t body, std::int32_t patch, std::int32_t vertex);
  const Placed& placed(std::size_t body, std::int32_t patch);
  Hit& hit_of(std::size_t body, std::int32_t vertex);
  void meet(Vec3 from, double reach, Body& other, std::int32_t triangle, Hit& hit) const;
  bool is_far_at_rest(const Body& body, std::int32_t vertex, const Hit& hit) const;

  const Model& model_;
  std::vector<Body>& bodies_;
  std::vector<NearPatches> patches_;  ///< of each body, like the next
  std::vector<PatchFacets> facets_;
  std::vector<Placed> placed_;
  std::vector<Lines> lines_;                          ///< of the patches of one body
  std::vector<Hit> hits_;                             ///< of the vertices of one body
  std::vector<std::int32_t> hit_vertices_;            ///< with a hit, or looked at without one
  std::uint32_t round_ = 0, placing_ = 0, look_ = 0;  ///< of one body, of all, of one body and another
  const std::vector<std::uint8_t>* hidden_ = nullptr;
  bool reaches_far_ = true;                   ///< everywhere
  double h_ = 0;                              ///< length of the step [s]
  const Vec3Array* velocity_ = nullptr;       ///< at its start [m/s]
  std::vector<std::optional<double>> way_;    ///< that each body may have come in it, once asked for [m]
  std::vector<std::int32_t> touched_;         ///< facets that were touched at its start
  std::vector<std::uint8_t> is_touched_;      ///< the same, of all facets, by their first vertices through all organs
  std::vector<std::uint8_t> was_touched_;     ///< whether any facet of a body was
  std::vector<double> reach_;                 ///< of the patches of one body [m]
  std::vector<Box> triangles_;                ///< of one patch that another may be near, at rest [m]
  Box all_triangles_{Vec3{}}, back_{Vec3{}};  ///< around them; by how far they are back from where they are [m]
};

struct DeepestOverlap {
  std::int32_t organ, other;  ///< in Model::organs
  double depth;               ///< [m]
  Vec3 place;                 ///< of the first organ's surface [m]
};

/// The deepest overlap of a Model's bodies with the spheres at `position` [m], up to a spacing.
std::optional<DeepestOverlap> deepest_overlap(const Model& model, const Vec3Array& position);

}  // namespace ctpm::surface
