#pragma once

#include "core/contact/point_contact.h"
#include "core/cutting/cut_front.h"
#include "core/model/state_view.h"

namespace ctpm::contact {

/// How thick a blade is so far behind its edge [m]: nothing at the edge, then a bevel with straight sides that is
/// kBevel times as high as the blade is thick, a wedge of 23 degrees (estimate), then Tool::blade_thickness.
double local_thickness(const Tool& scalpel, double behind);
inline constexpr double kBevel = 2.5;

/// The wedge that a blade is. Where it stands in a cut, the two faces of the cut stay apart by the blade's local
/// thickness: at places on its flanks, some behind each node of the edge, a spring pushes the faces apart where they
/// are closer (cutting::Opening). Within half a spacing of the edge and of the point the lattice cannot tell the faces
/// from the whole tissue beyond, and the springs are the softer the nearer they are, as within 2 mm of where they come
/// into the tissue and of where the edge leaves it. What pushes the faces apart are opposite forces on the spheres of
/// both sides; the blade may lie anywhere between the faces.
///
/// The energy of the springs depends on the tissue and on where in it the blade is. The blade feels the change with the
/// latter: faces that open along its way hold it back, and faces that close behind it push it on. So it pays for what
/// it opens, and gets it back where the tissue is elastic. The blade has no stiffness across its flanks.
class BladeWedge {
 public:
  explicit BladeWedge(const Model& model) : model_(model) {}

  /// Capacity that find() needs: contacts, and entries of their carriers.
  std::size_t capacity() const { return model_.cut_resistance.any() ? kEdgeNodes * (kRows + 1) : 0; }
  std::size_t entries() const {
    return model_.cut_resistance.any() ? kEdgeNodes * (kRows * cutting::Opening::kMost + cutting::Place::kMost) : 0;
  }

  /// Adds the contacts of the flanks of the blade in a hand with the cut that they are in. `edge`: of the
  /// blade at the end of a step.
  void find(const StateView& state, const Tool& tool, const cutting::CutFront& front, const cutting::BladeEdge& edge,
            std::size_t hand, PointContacts& contacts) const;

  static constexpr std::size_t kRows = 3;  ///< of places on the flanks, at most

 private:
  struct Flank;
  Vec3 press(const StateView& state, const cutting::CutFront& front, const Flank& flank, std::size_t row,
             PointContacts& contacts) const;

  const Model& model_;
};

}  // namespace ctpm::contact
