#pragma once

#include <span>

#include "core/contact/pair_contact.h"
#include "core/cutting/cutting.h"

namespace ctpm {

/// How a blade moves in a tick.
struct BladeMotion {
  BladeEdge from, to;              ///< at the tick's start and end
  Vec3 heading_tip, heading_heel;  ///< where its ends have been going, length 0 to 1
};

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
  std::size_t most() const { return any() ? 2 * model_.axial.size() : 0; }

  /// Where find() looks, at the most.
  Box around(const BladeMotion& motion) const;

  /// Adds what the blade, at the end of its motion, meets in `state`, of the elements that are `near`: those
  /// ahead, and lips on its flanks.
  void find(const State& state, const NearElements& near, const BladeMotion& motion, PairContacts& contacts) const;

  /// Adds the elements that were severed within the tick before they could resist to the end: their remaining
  /// energy over the blade's way in the tick.
  void add_severed(const State& state, const BladeMotion& motion, std::span<const Crossing> crossings,
                   PairContacts& contacts) const;

 private:
  struct Element;
  Element element(std::size_t index) const;

  const Model& model_;
  double reach_;  ///< way ahead of the edge over which an element resists [m]
};

/// Tows `trail` (2) behind the ends of the blade at a distance of at most kTrail, and gives `motion` the
/// heading that follows: hands tremble, and a heading must not.
void tow(Vec3Array& trail, BladeMotion& motion);

}  // namespace ctpm
