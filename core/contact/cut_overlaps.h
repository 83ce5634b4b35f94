#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/contact/cut_surfaces.h"
#include "core/model/model.h"
#include "core/surface/bodies.h"
#include "core/surface/body_overlaps.h"

namespace ctpm::contact {

/// Where surfaces that cuts opened overlap other tissue: that of other organs (Model::organs_meet), and other pieces of
/// their own organ (OrganRange::meets_itself). What it means to overlap is as in surface::BodyOverlaps.
class CutOverlaps {
 public:
  /// `bodies` and `cuts` must outlive the CutOverlaps.
  CutOverlaps(const Model& model, std::vector<surface::Body>& bodies, CutSurfaces& cuts);

  /// Whether anything that is cut may meet other tissue.
  bool any() const { return model_.has_meeting_tissue() && cuts_.any(); }

  /// Whether it finds what BodyOverlaps found where patches stand for organs' own surfaces.
  bool replaces() const;

  /// Begins a round, after one of the surfaces.
  void begin();

  /// Adds where vertices of `bodies[body]` are inside patches.
  void find_on_body(std::size_t body, std::vector<surface::Overlap>& overlaps);

  /// A patch, and which of all overlaps are its.
  struct OfPatch {
    cutbody::CutPatch* patch;
    std::size_t first, last;
  };
  /// Finds the overlaps of the patches of an organ, in a fixed order; the result is valid until the next call.
  const std::vector<OfPatch>& find_on_patches(std::size_t organ, std::vector<surface::Overlap>& overlaps);
  /// What it found last.
  const std::vector<OfPatch>& on_patches() const { return found_; }

 private:
  /// A place of tissue: an organ and the piece of it.
  struct Tissue {
    std::int32_t organ, piece;
  };
  /// A triangle that a line may meet.
  struct Candidate {
    const surface::Body* body;
    std::int32_t triangle;
    Vec3 corner[3];
    Box box{Vec3{}};
  };
  /// A run of candidates, and the box around them.
  struct Run {
    std::size_t first, last;
    Box box{Vec3{}};
  };

  /// What the line inwards from a vertex meets first.
  struct Hit {
    Hit(const surface::Body& body, std::int32_t vertex)
        : overlap{body.facets.facet_of(vertex), vertex, std::numeric_limits<double>::infinity(), {}} {}

    surface::Overlap overlap;
    bool is_exit = false;
    const cutbody::CutPatch* patch = nullptr;  ///< that was looked at last
  };

  bool meets(Tissue a, Tissue b) const;
  bool may_meet_anything(std::size_t organ) const;
  double reach(std::size_t organ) const;
  std::int32_t piece_at(const surface::Body& body, std::int32_t vertex) const;
  void clear_candidates() { candidates_.clear(), runs_.clear(); }
  void add_candidate(const surface::Body& body, const surface::NearSurface::Triangle& triangle, const Vec3* corners);
  void add_candidates_near(const Box& box, Tissue tissue);
  void look_from(Vec3 place, Vec3 inwards, double reach, Hit& hit) const;
  static Box box_of(const surface::Body& body);

  const Model& model_;
  std::vector<surface::Body>& bodies_;
  CutSurfaces& cuts_;
  std::uint32_t version_ = 0;
  std::vector<std::vector<std::int32_t>> piece_of_vertex_;  ///< of bodies whose organ is cut (body_count)
  std::vector<Candidate> candidates_;
  std::vector<Run> runs_;
  std::vector<OfPatch> found_;
  std::vector<Hit> hits_;                    ///< of one body
  std::vector<std::int32_t> hit_of_vertex_;  ///< -1: none
};

}  // namespace ctpm::contact
