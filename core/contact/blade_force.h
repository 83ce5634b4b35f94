#pragma once

#include <span>

#include "core/contact/blade_motion.h"
#include "core/contact/pair_contact.h"
#include "core/cutting/cutting.h"
#include "core/cutting/near_elements.h"
#include "core/model/state_view.h"

namespace ctpm {

/// The law of cutting: the blade's force times its way, and the elastic energy E that severing sets free,
/// open the cut and rub,
///   F ds - dE = J_c dA + dW_friction
/// (Atkins & Mai, "Elastic and plastic fracture", 1985; Mahvash & Hayward, "Haptic rendering of cutting: a
/// fracture mechanics approach", Haptics-e 2 (3), 2001; Chanthasopeephan, Desai & Lau, Ann. Biomed. Eng. 31,
/// 2003, for liver).
///
/// Each element that lies ahead of the edge resists over the last stretch `reach` before it is severed, with
/// a force that rises linearly from 0, so that the work up to the severing is J_c times the element's share
/// of the area, less what tension has stored in the element; then it is gone. That is the rise before a cut,
/// the saw-tooth while cutting and the release after it. Tissue that has moved onto the flanks, behind the
/// edge, rubs along them with a constant stress. What the hand feels, the tissue feels with the opposite
/// sign.
///
/// The force points against the way, so a blade that is also drawn along its edge needs less push (Atkins, Xu
/// & Jeronimidis, J. Mater. Sci. 39, 2004). The hand does more than this work where it drags soft tissue
/// along, which then loses energy in its Kelvin units.
class BladeForce {
 public:
  explicit BladeForce(const Model& model);

  /// Whether anything resists a blade.
  bool any() const { return model_.cut_resistance.any(); }

  /// Most contacts that the functions below add in one substep.
  std::size_t capacity() const { return any() ? 2 * (model_.edges.size() + model_.tpms.size()) : 0; }

  /// Where find() looks, at the most.
  Box around(const Tool& tool, const BladeMotion& motion) const;

  /// Adds what the blade, at the end of its motion, meets in `state`, of the elements that are `near`: those
  /// ahead of it, and cut faces on its flanks.
  void find(const StateView& state, const NearElements& near, const Tool& tool, const BladeMotion& motion,
            PairContacts& contacts) const;

  /// Adds the elements that were severed within the tick before they could resist to the end: their remaining
  /// energy over the blade's way in the tick.
  void add_severed(const StateView& state, const Tool& tool, const BladeMotion& motion,
                   std::span<const Crossing> crossings, PairContacts& contacts) const;

 private:
  struct Element;
  Element element(std::size_t index) const;

  /// Distance ahead of the edge over which an element resists [m].
  double reach(const Tool& tool) const;

  const Model& model_;
  double widest_spacing_ = 0;  ///< of all organs [m]
};

}  // namespace ctpm
