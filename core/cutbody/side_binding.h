#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/cutbody/cut_grid.h"
#include "core/cutbody/cut_mesh.h"
#include "core/cutbody/joined_spheres.h"
#include "core/cutbody/nearest_spheres.h"
#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"

namespace ctpm::cutbody {

/// The spheres that the vertices of a CutMesh follow: those of the organ's own surface where the cut lets them, else
/// spheres of their own side, else of their piece.
class SideBinding {
 public:
  using Index = CutGrid::Index;

  struct Binding {
    std::vector<Index> sphere;
    std::vector<double> weight;  ///< sum to 1
    /// How far the spheres are from lying in a plane: a measure of their least variance along a line, in spacings
    /// squared.
    double depth = 0;
    /// What turns with the frame of a sphere: how far spheres that do not span space are from where they put a place.
    struct Turned {
      Index sphere;
      Vec3 offset;  ///< [m]
    };
    std::vector<Turned> turned;
  };
  /// The place on the organ's own surface that is nearest to a vertex: in the middle of a triangle's corners with these
  /// weights.
  struct Origin {
    Index triangle = -1;  ///< -1: none is near
    std::array<double, 3> weight{};
  };
  struct Bound {
    Vec3 rest;  ///< [m]
    Binding binding;
    Origin origin;
  };

  /// A SurfaceBinding that grows by vertices bound by one SideBinding.
  class Writer {
   public:
    /// All must outlive the Writer. `to`: of no vertex yet.
    Writer(SideBinding& binding, SurfaceBinding& to) : binding_(binding), to_(to) {}
    /// Adds the next vertex.
    void add(const Binding& binding);

   private:
    SideBinding& binding_;
    SurfaceBinding& to_;
    std::unordered_map<Index, Index> frame_of_;  ///< of the spheres of which it has a frame
  };

  /// Both must outlive the SideBinding.
  SideBinding(const Model& model, const CutGrid& grid);

  /// Follows the grid, of which edges or spheres in a box have changed.
  void update(CutGrid::NodeBox changed);
  /// Forgets all: it is found again when it is asked for.
  void forget() { bound_ = {}, frames_ = {}; }

  /// What a vertex follows, and where it is: on the organ's own surface or on the swept surface of `state`. It is
  /// remembered. A vertex whose side is -1 is far from all cuts.
  const Bound& bind(const CutMesh::Vertex& vertex, bool is_outer, bool is_wall, const State& state);

 private:
  struct Key {
    Index side;
    Vec3 place;
    bool is_outer, is_wall;
    friend bool operator==(const Key&, const Key&) = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };

  struct Entry {
    Bound bound;
    Vec3 put;                  ///< the vertex, or where it is on the swept surface if it is of a wall [m]
    std::vector<Index> nodes;  ///< on what these see it depends
    std::uint32_t round = 0;   ///< of joined_, in which it was so
    bool by_piece = false;     ///< the spheres of its own side hardly span space, or do not
  };
  class Mix;
  using Joined = JoinedSpheres::Joined;

  void find_pieces();
  bool is_known(const CutMesh::Vertex& vertex, bool is_wall, const State& state, const Entry& entry);
  Vec3 near_cut(Vec3 rest, const State& state);
  Origin origin_of(Vec3 rest) const;
  Vec3 place_of(const Origin& origin) const;
  void bind(Index side, bool is_outer, Entry& entry);
  bool is_joined(const Binding& binding);
  Binding follow_whole(const Origin& origin) const;
  Binding follow(Vec3 rest, std::span<const Joined> spheres, double reach) const;
  Binding follow_nearest(Vec3 rest);
  Binding follow_any(Vec3 rest, Index piece) const;
  Binding follow_frames(Vec3 rest, std::span<const Joined> spheres, double reach) const;
  void follow_piece(Vec3 rest, Index piece, Mix& mix) const;
  const TissueFrame& frame_of(Index sphere);
  std::vector<Joined> spheres_around(Vec3 rest, double reach, Index piece) const;

  const Model& model_;
  const OrganRange& organ_;
  const Surface& whole_;
  const CutGrid& grid_;
  JoinedSpheres joined_;
  NearestSpheres nearest_;
  std::unordered_map<Key, Entry, KeyHash> bound_;
  struct Frame {
    TissueFrame frame;
    std::vector<Index> nodes;  ///< on what these see it depends
    std::uint32_t round = 0;   ///< of joined_, in which it was so
  };
  std::unordered_map<Index, Frame> frames_;  ///< around spheres
  std::size_t asked_ = 0;                    ///< entries asked for in this round of joined_
  std::vector<CutGrid::NodeBox> changed_;    ///< in each round
  cutting::SweptBoxes row_boxes_;            ///< see cutting::boxes_of_rows()
  std::vector<Index> piece_;  ///< that each node of the grid follows; empty until it is asked for after a change
};

}  // namespace ctpm::cutbody
