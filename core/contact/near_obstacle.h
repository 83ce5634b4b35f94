#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/contact/cut_surfaces.h"
#include "core/contact/moved.h"
#include "core/model/model.h"
#include "core/surface/bodies.h"
#include "core/surface/obstacle_shape.h"

namespace ctpm::contact {

/// Which vertices of an organ and of its cuts are inside an obstacle. How far each was away is known from when it was
/// looked at, and it is looked at again only when the spheres that it follows may have brought it so far: what is far
/// or at rest costs nothing. Groups of triangles are looked at by their boxes until these may be inside. When something
/// was looked at changes no result.
class NearObstacle {
 public:
  /// A vertex that is inside.
  struct Found {
    std::int32_t part;  ///< in parts()
    std::int32_t vertex;
    std::int32_t order;  ///< in which vertices of the part first occur in its triangles
    surface::Inside inside;
  };
  struct Part {
    surface::Body* body;
    cutbody::CutPatch* patch;                ///< null: the organ's own surface
    std::vector<std::int32_t> first_corner;  ///< where each vertex first occurs in its triangles (vertex_count)
  };

  /// All of them must outlive the NearObstacle.
  NearObstacle(const Model& model, surface::Body& body, const surface::ObstacleShape& shape, CutSurfaces& cuts);

  /// Finds them with the spheres at `position` [m], by part, in a round of bodies and cuts that has begun.
  const std::vector<Found>& find(const Vec3Array& position);

  const std::vector<Part>& parts() const { return parts_; }

 private:
  /// Something that is outside as long as its region's path, or that of all, is shorter than `due`.
  enum class Kind : std::uint8_t { group, patch, vertex };
  struct Item {
    double due;  ///< [m]
    Kind kind;
    std::int32_t region, number;

    bool operator<(const Item& other) const { return due > other.due; }  // the first due is on top of a heap
  };
  /// A group of triangles of a part, and the spheres that it follows.
  struct Region {
    std::int32_t part, group;
    WatchedSpheres spheres{};     ///< as of when it was last brought up to date; within the organ
    double path = 0;              ///< sum of how far the farthest of them moved from one of these to the next [m]
    double step = 0;              ///< last part of it [m]
    std::uint32_t round = 0;      ///< in which it was last brought up to date; 0: it never was
    std::vector<Item> waiting{};  ///< heap
  };

  void find_parts();
  void look_at_all();
  void add_part(surface::Body& body, cutbody::CutPatch* patch);
  void bring_up_to_date(Region& region);
  void take_due(std::size_t region);
  void schedule(std::size_t region);
  void look_at(Item item);
  void look_at_bound(Item item);
  void look_at_vertex(Item item);
  void wait(Item item, double clearance, double stretch);
  void wait_turning(Item item, double clearance, const surface::NearSurface& surface);

  const OrganRange& organ_;
  surface::Body& body_;
  const surface::ObstacleShape& shape_;
  CutSurfaces& cuts_;
  std::optional<std::uint32_t> version_;  ///< of the cuts, that parts_ are of
  Vec3Array position_;                    ///< of the organ's spheres in the last round [m]
  double path_ = 0;                       ///< sum over the rounds of how far the farthest of them moved [m]
  double step_ = 0;                       ///< part of it that the last round added [m]
  std::uint32_t round_ = 0;               ///< number of rounds
  std::vector<Part> parts_;
  std::vector<Region> regions_;
  std::vector<double> due_at_;  ///< of each region: nothing of it is due while path_ is shorter [m]
  std::vector<Item> turning_;   ///< vertices that move as their tissue turns, by path_; heap
  std::vector<Item> always_;    ///< due in every round
  std::vector<Item> due_;       ///< in this one
  std::vector<Found> found_;
};

}  // namespace ctpm::contact
