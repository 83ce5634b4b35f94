#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/cutbody/cut_grid.h"
#include "core/cutbody/cut_mesh.h"
#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"

namespace ctpm::cutbody {

/// The surface of an organ that may be cut: a pure function of the Model at rest and of the swept surface. It is
/// closed, with one component for each piece of tissue, and each of its vertices follows only spheres of its own side
/// of the cut. Where those do not span space it follows the spheres of its piece. A piece without spheres, as a strip
/// thinner than a spacing may be, follows the spheres around it as if nothing were cut.
class CutBody {
 public:
  /// `model` must outlive the CutBody. The organ must have a surface.
  CutBody(const Model& model, std::size_t organ);

  /// Follows the swept surface of `state`. Returns whether surface() changed.
  bool update(const State& state);

  /// Outer triangles first, then the walls of the cut, which have their own vertices, so that normals break at the edge
  /// of a cut. Until something is cut it is the organ's own surface. Vertices are at rest, where both sides of a cut
  /// coincide.
  const Surface& surface() const { return surface_; }
  std::size_t outer_triangle_count() const { return outer_triangles_; }
  std::size_t outer_vertex_count() const { return outer_vertices_; }
  bool is_cut() const { return is_cut_; }

  /// Where a vertex lies on the organ's own surface: in the middle of a triangle's corners with these weights.
  struct Origin {
    std::int32_t triangle;  ///< -1: it does not, and belongs to a wall or a lip
    std::array<double, 3> weight;
  };
  /// Of the outer vertices; empty until something is cut (outer_vertex_count).
  const std::vector<Origin>& origin() const { return origin_; }
  /// Pieces of tissue that the cuts leave; 1 until something is cut.
  std::int32_t piece_count() const { return is_cut_ ? count_pieces(*grid_) : 1; }

 private:
  using Index = CutGrid::Index;
  struct Binding {
    std::vector<Index> sphere;
    std::vector<double> weight;
  };
  struct Bound {
    Vec3 rest;  ///< [m]
    Binding binding;
    Origin origin{-1, {}};
  };
  struct Key {
    Index side;
    double x, y, z;
    friend auto operator<=>(const Key&, const Key&) = default;
  };

  void show_whole();
  void rebuild(const State& state);
  bool is_near(CutGrid::NodeBox box, Index node) const;
  void forget_near(CutGrid::NodeBox box);
  std::vector<Index> spheres_near(Index node) const;
  const std::vector<Index>& seen_from(Index node);
  Origin origin_of(Vec3 rest) const;
  Binding follow_whole(const Origin& origin) const;
  bool is_own_side(const Binding& binding, Index side);
  Bound bind(const CutMesh::Vertex& vertex, bool is_outer);
  Binding bind_to_own_side(Vec3 rest, Index side);
  Binding follow(Vec3 rest, const std::vector<Index>& spheres, double reach) const;
  std::vector<Index> spheres_around(Vec3 rest, double reach, Index piece) const;

  const Model& model_;
  const OrganRange& organ_;
  const std::size_t index_;
  std::optional<CutGrid> grid_;  ///< made when something is cut
  Surface whole_, surface_;
  std::size_t outer_triangles_ = 0, outer_vertices_ = 0;
  bool is_cut_ = false;
  std::vector<Origin> origin_;
  std::vector<Index> piece_;                  ///< of each node of the grid; empty until it is asked for after a change
  CutGrid::NodeBox cut_box_;                  ///< around all crossings of the cut
  std::map<Key, Bound> bound_;                ///< bindings of the vertices of the last mesh
  std::map<Index, std::vector<Index>> seen_;  ///< spheres that a node of the grid sees

  // Scratch memory of seen_from().
  std::vector<std::uint32_t> visited_;  ///< number of the call that visited a node
  std::vector<std::pair<Index, Index>> queue_;
  std::uint32_t call_ = 0;
};

}  // namespace ctpm::cutbody
