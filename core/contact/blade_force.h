#pragma once

#include <span>

#include "core/contact/blade_motion.h"
#include "core/contact/point_contact.h"
#include "core/cutting/cutting.h"
#include "core/cutting/near_elements.h"
#include "core/model/state_view.h"

namespace ctpm::contact {

/// The law of cutting. The work of the blade's force F along its path s, plus the elastic energy E that severing
/// releases, creates the area A of the cut and overcomes friction:
///   F ds - dE = J_c dA + dW_friction
/// (Atkins & Mai, "Elastic and plastic fracture", 1985; Mahvash & Hayward, "Haptic rendering of cutting: a fracture
/// mechanics approach", Haptics-e 2 (3), 2001; Chanthasopeephan, Desai & Lau, Ann. Biomed. Eng. 31, 2003, for liver).
///
/// Each element ahead of the edge resists over a distance Tool::blade_reach before it is severed. Its force rises
/// linearly from 0, so that the work until severing is J_c times the element's share of the area, less the energy that
/// tension has stored in it. After severing the force is 0. The result is a rise before a cut, a saw-tooth while
/// cutting and a release after it. Tissue on the flanks, behind the edge, rubs with a constant stress. Hand and tissue
/// feel opposite forces.
///
/// The force opposes the blade's motion, so a blade that is also drawn along its edge needs less push (Atkins, Xu &
/// Jeronimidis, J. Mater. Sci. 39, 2004). The hand does more work than this where it drags soft tissue along, whose
/// Kelvin units dissipate it.
class BladeForce {
 public:
  explicit BladeForce(const Model& model);

  /// Whether anything resists a blade.
  bool any() const { return model_.cut_resistance.any(); }

  /// Capacity that the functions below need in one substep, in contacts.
  std::size_t capacity() const { return any() ? 2 * model_.axial.size() : 0; }

  /// Box outside which find() finds nothing.
  cutting::Box around(const Tool& tool, const BladeMotion& motion) const;

  /// Adds the contacts of the blade, at the end of its motion, with the elements that are `near`: unsevered ones ahead
  /// of its edge, and severed ones on its flanks.
  void find(const StateView& state, const cutting::NearElements& near, const Tool& tool, const BladeMotion& motion,
            PointContacts& contacts) const;

  /// Adds the elements that were severed in this tick before they had resisted over the whole reach. Each resists with
  /// its remaining energy, spread over the blade's path in the tick.
  void add_severed(const StateView& state, const Tool& tool, const BladeMotion& motion,
                   std::span<const cutting::Crossing> crossings, PointContacts& contacts) const;

 private:
  struct Element;
  Element element(std::size_t index) const;

  /// Distance ahead of the edge over which an element resists [m].
  double reach(const Tool& tool) const;

  const Model& model_;
  double widest_spacing_ = 0;  ///< of all organs [m]
};

}  // namespace ctpm::contact
