#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/cutbody/side_binding.h"
#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"

namespace ctpm::cutbody {

/// The surface of an organ that may be cut: a pure function of the Model at rest and of the swept surface. It is
/// closed, with one component for each piece of tissue, and each of its vertices follows only spheres of its own side
/// of the cut. Where those do not span space it follows the spheres of its piece. A piece without spheres, as a strip
/// thinner than a spacing may be, goes with the piece beside it that it shares most of its walls with. Far from a cut
/// its vertices are those of the organ's own surface.
class CutBody {
 public:
  using Index = CutGrid::Index;
  using Origin = SideBinding::Origin;

  /// `model` must outlive the CutBody. The organ must have a surface.
  CutBody(const Model& model, std::size_t organ);
  ~CutBody();
  CutBody(CutBody&&) noexcept;

  /// Does at once what the first cut needs: a grid over the organ.
  void prepare();

  /// Follows the swept surface of `state`. Returns whether surface() changed.
  bool update(const State& state);

  /// Outer triangles first, then the walls of the cut, which have their own vertices, so that normals break at the edge
  /// of a cut. Until something is cut it is the organ's own surface. Vertices are at rest, where both sides of a cut
  /// coincide.
  const Surface& surface() const { return surface_; }
  std::size_t outer_triangle_count() const { return outer_triangles_; }
  std::size_t outer_vertex_count() const { return outer_vertices_; }
  bool is_cut() const { return is_cut_; }

  /// Of the outer vertices, the nearest places on the organ's own surface; empty until something is cut
  /// (outer_vertex_count).
  const std::vector<Origin>& origin() const { return origin_; }

  /// Pieces of tissue that the cuts leave.
  std::int32_t piece_count() const;
  /// A number of the piece that each vertex of surface() belongs to; -1: one that is far from all cuts, which is a
  /// vertex of one piece only (vertex_count). Vertices of different pieces may coincide.
  std::vector<Index> piece_of_vertex() const;

 private:
  struct Parts;
  class Rebuilding;
  void show_whole();
  void rebuild(const State& state);
  Index nearest_corner(Vec3 rest) const;

  const Model& model_;
  const std::size_t organ_;
  const Surface& whole_;
  std::unique_ptr<Parts> parts_;  ///< made when something is cut
  Surface surface_;
  std::size_t outer_triangles_ = 0, outer_vertices_ = 0;
  bool is_cut_ = false;
  std::vector<Origin> origin_;
  std::vector<Index> side_;  ///< a node of the grid in the tissue that each vertex belongs to; -1: far from all cuts
};

}  // namespace ctpm::cutbody
