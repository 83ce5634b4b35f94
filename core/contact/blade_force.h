#pragma once

#include "core/contact/point_contact.h"
#include "core/cutting/cut_front.h"
#include "core/model/state_view.h"

namespace ctpm::contact {

/// The law of cutting. The work of the blade's force F along its path s, plus the elastic energy E that the cut
/// releases, creates the area A of the cut and overcomes friction:
///   F ds - dE = J_c dA + dW_friction
/// (Atkins & Mai, "Elastic and plastic fracture", 1985; Mahvash & Hayward, "Haptic rendering of cutting: a fracture
/// mechanics approach", Haptics-e 2 (3), 2001; Chanthasopeephan, Desai & Lau, Ann. Biomed. Eng. 31, 2003, for liver).
///
/// Each node of the edge pulls at the front of the cut (cutting::CutFront) like a spring, up to the force with which
/// the tissue holds it: J_c times the length of the edge that the node stands for, and the friction of the flanks. Then
/// the front goes on, with that force, and what it sweeps is the area of the cut. The force rises before a cut, is as
/// steady as the tissue while cutting, and falls after it, whatever the lattice.
///
/// The force opposes the blade's motion, so a blade that is also drawn along its edge needs less push (Atkins, Xu &
/// Jeronimidis, J. Mater. Sci. 39, 2004).
class BladeForce {
 public:
  explicit BladeForce(const Model& model) : model_(model) {}

  /// Whether anything resists a blade.
  bool any() const { return model_.cut_resistance.any(); }

  /// Capacity that find() needs: contacts, and entries of their carriers.
  std::size_t capacity() const { return any() ? kEdgeNodes : 0; }
  std::size_t entries() const { return capacity() * cutting::Place::kMost; }

  /// Adds the contacts of the blade in a hand with the front of its cut. `edge`: of the blade at the end of a step of
  /// `h` [s]. `is_predicted`: the spheres of `state` are where they are expected at the end of the step; else where
  /// they are at its start.
  void find(const StateView& state, const Tool& tool, const cutting::CutFront& front, const cutting::BladeEdge& edge,
            double h, bool is_predicted, std::size_t hand, PointContacts& contacts) const;

 private:
  const Model& model_;
};

}  // namespace ctpm::contact
