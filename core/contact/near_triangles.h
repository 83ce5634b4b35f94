#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/contact/cut_surfaces.h"
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
  bool contains(const Reach& other) const;
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

/// The triangles of organs and of their cuts that a ball may touch. They are looked for with a margin, and again only
/// when ball and tissue may have come farther than that (as in the neighbour lists of Verlet, Phys. Rev. 159, 98,
/// 1967). Before the margin is used up, the next look begins and goes on through several rounds, so that no tick bears
/// it whole. Only what cannot be touched is left out: when they were looked for changes no result.
class NearTriangles {
 public:
  struct Found {
    std::int32_t part;
    const surface::NearSurface::Triangle* triangle;
  };

  /// `whole`: the surfaces of organs, with `slots` slots; they and `cuts` must outlive the NearTriangles. `kind`: of
  /// the ball's points in cutbody::CutPoints.
  NearTriangles(const std::vector<BallPart>& whole, std::int32_t slots, CutSurfaces& cuts, std::int32_t kind);

  /// Looks for what may meet `reach` where that is needed, and begins a round of the surfaces with the spheres at
  /// `position` [m], in which those of whole organs and of the cuts already are.
  void find(const Reach& reach, double margin, const Vec3Array& position);

  const std::vector<BallPart>& parts() const { return used_.parts; }   ///< those of whole organs first
  const std::vector<Found>& triangles() const { return used_.found; }  ///< by part, in the order of NearSurface::near()
  std::int32_t slots() const { return used_.slots; }

 private:
  /// A look, which is done once all groups of all parts were visited.
  struct Look {
    bool has_begun = false;
    std::uint32_t version = 0;
    Reach reach{Vec3{}, 0};  ///< with the margin
    Vec3Array position;      ///< in the round in which it began [m]
    double stretch = 1;      ///< a vertex moves at most so many times as far as the farthest sphere
    double drift = 0;        ///< of the farthest sphere, until the last group was visited [m]
    std::vector<BallPart> parts;
    std::vector<Found> found;
    std::int32_t slots = 0;
    std::size_t part = 0, group = 0;  ///< to be visited next

    bool is_done() const { return part == parts.size(); }
    bool holds(const Reach& now, double moved) const;
  };

  void begin(Look& look, const Reach& reach, const Vec3Array& position);
  void go_on(Look& look, const Vec3Array& position, std::size_t most);
  void begin_round(const Look& look);

  CutSurfaces& cuts_;
  const std::int32_t kind_;
  const std::size_t whole_;
  const std::int32_t whole_slots_;
  Look used_, next_;
};

}  // namespace ctpm::contact
