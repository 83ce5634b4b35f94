#pragma once

#include <cstdint>
#include <vector>

#include "core/model/inputs.h"
#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm {

/// Nodes along a blade's edge, at equal distances from the tip to the heel.
inline constexpr std::size_t kEdgeNodes = 33;

/// Cuts as they are touched: the first rows of the swept surface, and the elements that were severed by then.
struct TouchedCuts {
  std::int32_t rows = 0;
  std::vector<std::uint8_t> axial_severed;  ///< 1: severed; empty if none is known to be          (axial_count)
  friend bool operator==(const TouchedCuts&, const TouchedCuts&) = default;
};

/// Everything that the next tick depends on, to the bit. The velocity is also the warm start of the implicit solve.
struct State {
  std::int64_t tick = 0;   ///< ticks done
  Vec3Array position;      ///< [m]                                     (sphere_count)
  Vec3Array velocity;      ///< [m/s]                                   (sphere_count)
  Vec3Array acceleration;  ///< [m/s^2], for the predictor of sdirk2; empty for other integrators (sphere_count)
  std::vector<double> kelvin_elongation;         ///< internal variable of two-sphere TPMs [m]   (internal_count)
  std::vector<std::uint8_t> axial_severed;       ///< 1: severed; empty if the scene has no scalpel (axial_count)
  std::vector<std::uint8_t> constraint_severed;  ///< as above                                   (constraint_count)
  std::vector<std::uint8_t> angle_severed;       ///< as above                                      (angle_count)
  /// Crossing of each severed element, coded by cutting::stored_crossing(); 0: not severed; empty if the scene has no
  /// scalpel (axial_count).
  std::vector<std::uint8_t> axial_crossing;
  /// The front of the cut: where, in the tissue at rest, the nodes of a blade's edge are, from its back over the tip to
  /// the heel [m]; empty if the scene has no scalpel (kEdgeNodes).
  Vec3Array blade_trail;
  std::vector<std::int32_t> edge_organ;  ///< organ that each of them is in or near; -1: none          (kEdgeNodes)
  /// The swept surface: rows of kEdgeNodes places at rest, through which the front went, in the order of time [m].
  Vec3Array swept;
  /// For each node of a row: 1 + the organ in which the front went from the row before to this one, between this node
  /// and the next, through tissue that was whole; 0: it did not                              (as many as `swept`)
  std::vector<std::uint8_t> swept_organ;
  TouchedCuts open_cuts;             ///< those that are touched; empty where nothing can touch cuts
  TouchedCuts opening_cuts;          ///< those that will be; without rows: none
  std::int64_t opening_cuts_at = 0;  ///< tick that begins with them in the place of open_cuts; 0: none does
  /// Points of the tissue that are touched, ascending. With n = Model::touchable_count(), [0, n) are touched by the
  /// first hand's ball, [n, 2 n) by tissue, [(2 + i) n, (3 + i) n) by obstacle i, where there are two hands the next n
  /// by the second one's ball, and those of cuts follow (cutbody) (touched_count)
  std::vector<std::int32_t> touched;
  /// Where on a ball each of them is held, from its centre; elsewhere, how far the grip is stretched [m]
  /// (touched_count)
  Vec3Array grip;
  std::vector<double> kelvin_dent;  ///< Kelvin unit's part of the dent at each of them [m]          (touched_count)
  /// For each part of the tissue that may sleep (elements::parts_of), the ticks for which it has been still, up to
  /// those after which it sleeps; empty where nothing may sleep (part_count).
  std::vector<std::int32_t> still_ticks;
  Inputs last_inputs;  ///< those of the previous tick, where a blade's sweep begins
};

/// The state at rest: rest positions, no motion, nothing severed, no tool.
State rest_state(const Model& model);

}  // namespace ctpm
