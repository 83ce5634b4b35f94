#pragma once

#include <cstdint>
#include <vector>

#include "core/contact/contacts.h"
#include "core/elements/elements.h"
#include "core/elements/kernels/kernels.h"
#include "core/model/model.h"
#include "core/model/state.h"
#include "core/parallel/team.h"
#include "core/stepping/motion.h"

namespace ctpm::stepping {

struct Substep;

/// Leaves out of a tick what stands still. A part of the tissue (elements::parts_of) sleeps once none of its spheres
/// has been faster than SolverSettings::sleep_bound for a while: its elements are not computed, its spheres stay where
/// they are, and time stands still in it. It is awake in each step in which a tool acts on it, or a load grows, and
/// while a part that is awake touches it. All of that depends on State and Inputs alone.
class Sleepers {
 public:
  /// Everything must outlive the Sleepers.
  Sleepers(const Model& model, elements::Elements& elements, parallel::Team& team, const elements::Kernels& kernels,
           const contact::Contacts& contacts);

  /// Ticks for which a part must be still before it sleeps, a tenth of a second: our choice, far longer than it takes
  /// stiff tissue that swings to turn round.
  static std::int32_t ticks_before_sleep(const Model& model);

  /// Begins a substep from `from`: decides what sleeps, as far as that is known before contacts are.
  void begin(const State& from, const contact::HeldTools& tools, const Substep& substep);

  /// Wakes the parts on which `contacts` act, and takes from `contacts` those of tissue that sleeps. True: some part
  /// that slept is awake now, and the substep must begin anew.
  bool wakes(contact::ContactSet& contacts);
  /// Whether wakes() was true since begin() or the last resume().
  bool has_woken() const { return has_woken_; }
  void resume() { has_woken_ = false; }

  /// Writes what sleeps to `to`, as it is in `from` and without motion: for a Motion in which contacts are looked for.
  void keep(const State& from, Motion& to) const;
  /// Writes its Kelvin elongations alone, which is enough for a Motion that is committed.
  void keep_kelvin(const State& from, Motion& to) const {
    if (!elements_.slabs().asleep().empty()) to.kelvin_elongation = from.kelvin_elongation;
  }

  /// Ends a substep from `from`: notes in `to` how long its parts have been still, and what touches those that sleep.
  void finish(const State& from, const Substep& substep, Motion& to);

  /// Of the spheres that are awake [kg].
  double awake_mass() const { return awake_mass_; }
  /// Spheres that sleep.
  std::int32_t count() const;

 private:
  /// Ticks for which a part has been still in `from`.
  std::int32_t still_in(const State& from, std::size_t part) const {
    return from.still_ticks.size() == parts_.size() ? from.still_ticks[part] : 0;
  }
  bool is_still(std::size_t part, const Vec3Array& velocity) const;
  void set_asleep();
  std::size_t part_of(std::int32_t sphere) const;
  void disturb(std::int32_t sphere) { is_disturbed_[part_of(sphere)] = is_awake_[part_of(sphere)] = 1; }
  bool wake_touching(const contact::PointContacts& contacts);
  void keep_touched(const State& from, Motion& to);

  const Model& model_;
  elements::Elements& elements_;
  parallel::Team& team_;
  const elements::Kernels& kernels_;
  const std::int32_t ticks_;                  ///< ticks_before_sleep()
  std::vector<parallel::SphereRange> parts_;  ///< empty where nothing may sleep (part_count)
  std::vector<std::size_t> part_of_slab_;     ///< (slab_count, like the next)
  std::vector<std::uint8_t> is_asleep_;       ///< of each slab
  std::vector<std::uint8_t> is_awake_;        ///< of each part, like the next two
  std::vector<std::uint8_t> is_disturbed_;    ///< something acts on it that may go on changing
  std::vector<std::size_t> island_;           ///< the first of the parts that touch each other and are awake
  std::vector<std::uint8_t> has_moving_;      ///< of the first part of an island: one of its parts is not still
  std::vector<std::int32_t> kept_;            ///< touched points that only sleeping tissue carries
  contact::Touched merged_;                   ///< scratch
  std::vector<double> mass_of_part_;          ///< [kg]
  double all_mass_, awake_mass_;              ///< of all spheres, and of those that are awake [kg]
  bool has_woken_ = false;
};

}  // namespace ctpm::stepping
