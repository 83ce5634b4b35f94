#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/contact/cut_surfaces.h"
#include "core/contact/moved.h"
#include "core/model/box.h"
#include "core/model/model.h"
#include "core/surface/near_surface.h"

namespace ctpm::contact {

/// Where a ball may touch.
struct Reach {
  double distance;  ///< from its centre, of what it touched before; its radius elsewhere [m]
  Box box;          ///< around all of it [m]
  Vec3 centre;
  double farthest;  ///< anything in it is from the centre [m]

  Reach(Vec3 at, double radius) : distance(radius), box(Box(at).grown(radius)), centre(at), farthest(radius) {}
  /// Adds what is there, and returns how far from the centre [m].
  double add(Vec3 place) {
    const double away = norm(place - centre);
    box.add(place), farthest = std::max(farthest, away);
    return away;
  }
  bool meets(const Box& other) const { return box.meets(other) && gap(other, Box(centre)) <= farthest; }
  Reach grown(double by) const;
  Reach moved(Vec3 by) const;
  /// By how much `other` would have to grow to contain it [m].
  double beyond(const Reach& other) const;
  /// By how much it may grow until it meets a box, which does not move [m]; not positive if they meet.
  double clearance(const Box& other) const;
};

/// A surface that a ball may touch. Its vertices have the slots from `first_slot` on, and the points from `first_point`
/// on.
struct BallPart {
  std::int32_t first_slot, first_point;
  surface::NearSurface* surface;
  const surface::Gathering* gathering;  ///< of a patch's vertices, or of all slots of whole organs
  cutbody::CutPatch* patch = nullptr;   ///< null: whole organs

  std::int32_t slots() const { return std::int32_t(surface->vertex_count()); }
  /// The slot at which what presses on a vertex is gathered.
  std::int32_t gathers_at(std::int32_t vertex) const {
    return patch == nullptr ? gathering->at(first_slot + vertex) : first_slot + gathering->at(vertex);
  }
};

/// The triangles of organs and of their cuts that a ball may touch. They are looked for with a margin, group by group,
/// and again only when the ball and the spheres that the group follows may have come farther than that (as in the
/// neighbour lists of Verlet, Phys. Rev. 159, 98, 1967), seen from the ball: what it pushes along stays near. Groups of
/// which the margin is half used up are looked at before that, a few in each round, so that no round bears all of them.
/// Only what cannot be touched is left out: when they were looked for changes no result.
class NearTriangles {
 public:
  struct Found {
    std::int32_t part;
    const surface::NearSurface::Triangle* triangle;
    std::int32_t group;  ///< that it is of
    double apart;        ///< from the ball's centre when it was found [m]
  };

  /// `whole`: the surfaces of organs, with `slots` slots; they and `cuts` must outlive the NearTriangles. `kind`: of
  /// the ball's points in cutbody::CutPoints.
  NearTriangles(const std::vector<BallPart>& whole, std::int32_t slots, CutSurfaces& cuts, std::int32_t kind);

  /// Looks for what may meet `reach` where that is needed, and begins a round of the surfaces with the spheres at
  /// `position` [m], in which those of whole organs and of the cuts already are.
  void find(const Reach& reach, double margin, const Vec3Array& position);

  const std::vector<BallPart>& parts() const { return parts_; }   ///< those of whole organs first
  const std::vector<Found>& triangles() const { return found_; }  ///< by part, in the order of NearSurface::near()
  /// A triangle is at least so far from the ball's centre in this round [m].
  double least_apart(const Found& found) const {
    const Group& group = groups_[std::size_t(found.group)];
    return found.apart - (group.used + (all_path_ - group.all_path) + kRounding);
  }
  std::int32_t slots() const { return slots_; }

 private:
  struct Candidate {
    const surface::NearSurface::Triangle* triangle;
    double apart;  ///< from the ball's centre [m]
  };
  struct Group {
    std::size_t part, number;  ///< in all_, and of its surface
    WatchedSpheres spheres{};  ///< that it follows, as of when `used` was last found
    double allowed = -1;       ///< nothing is missing while no more than this is used [m]
    double used = 0;           ///< of it, until the ball was there and all had come so far: [m]
    Vec3 centre{};
    double grown = 0, all_path = 0;
    std::vector<Candidate> found{};
  };

  void find_groups();
  void follow(const Reach& reach, const Vec3Array& position);
  double follow_spheres(const Vec3Array& position, Vec3 by);
  double find_used(Group& group);
  std::size_t look_at(Group& group, const Reach& reach, double margin);
  void list();

  CutSurfaces& cuts_;
  const std::int32_t kind_;
  const std::size_t whole_;
  const std::int32_t whole_slots_;
  std::optional<std::uint32_t> version_;  ///< of the cuts, that groups_ are of
  bool is_listed_ = false;                ///< what was found, in parts_ and found_
  std::vector<BallPart> all_;             ///< those of whole organs, and all patches of cuts
  std::vector<Group> groups_;             ///< of all parts
  double stretch_ = 1;                    ///< a vertex moves at most so many times as far as the farthest sphere
  Reach reach_{Vec3{}, 0};                ///< in the last round
  Vec3Array position_;                    ///< of the spheres in it [m]
  std::vector<std::uint32_t> round_;      ///< of each of whole organs in it, see surface::NearSurface
  double grown_ = 0;                      ///< sum of how far the reach, seen from the ball, grew in each round [m]
  double all_path_ = 0;                   ///< the same, and of how far the vertices of the farthest sphere moved [m]
  std::vector<BallPart> parts_;           ///< those of whole organs, and patches of which something was found
  std::vector<Found> found_;
  std::int32_t slots_ = 0;
};

}  // namespace ctpm::contact
