#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/pin.h"
#include "core/contact/point_contact.h"
#include "core/model/model.h"

namespace ctpm::contact {

/// Solves all point contacts of an explicit step together and implicitly: M dv = h F(v + dv), with the masses of the
/// touched spheres only. Contacts may therefore be much stiffer than the elements.
class ExplicitSolve {
 public:
  /// Reserves memory for as many contacts as `contacts` has room for, if leapfrog steps the Model, so that a tick never
  /// allocates.
  ExplicitSolve(const Model& model, const PointContacts& contacts);

  /// Adds the contacts, found in the middle of a step of `h` [s], to the `velocity` [m/s] that the step reached without
  /// them. Those that would pull are dropped. `before`: velocity [m/s] at the start. Spheres keep their velocity along
  /// held axes, and so do those of `pins`. Returns the force on each hand's tool [N].
  std::array<Vec3, kMostHands> solve(double h, const Pins& pins, const Vec3Array& before, Vec3Array& velocity,
                                     PointContacts& contacts);

 private:
  /// A contact linearised about the velocity without contacts: force on the point [N] minus `along` times its change of
  /// velocity along the axis, and `across` times that across it.
  struct Linear {
    Vec3 force;
    double along, across;  ///< [N s/m]
    Vec3 slip;             ///< relative to the tool, without contacts [m/s]
  };

  void gather(const Pins& pins, const PointContacts& contacts);
  Linear linearise(const PointContact& contact, Carriers at, double h, const Vec3Array& before,
                   const Vec3Array& velocity, Vec3 change, double mobility) const;
  void assemble(double h, const PointContacts& contacts);
  void multiply(double h, const PointContacts& contacts);
  void run_conjugate_gradients(double h, const PointContacts& contacts);
  Vec3 change_at(const PointContact& contact, Carriers at, const std::vector<Vec3>& values) const;
  void spread(const PointContact& contact, Carriers at, Vec3 value, std::vector<Vec3>& values) const;

  const Model& model_;
  std::vector<std::int32_t> index_;    ///< place of a sphere among the touched ones; -1: untouched (sphere_count)
  std::vector<std::int32_t> touched_;  ///< spheres
  std::vector<std::int32_t> place_;    ///< index_ of each entry of the contacts' carriers
  std::vector<Vec3> free_;             ///< 1 along axes that may move, else 0  (touched_count, like all below)
  std::vector<Vec3> diagonal_;         ///< of the matrix [kg]
  std::vector<Vec3> residual_, change_, direction_, product_;
  std::vector<Linear> linear_;  ///< of each contact
};

}  // namespace ctpm::contact
