#pragma once

#include <vector>

#include "core/elements/elements.h"
#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::testing {

/// A rigid ball that presses straight down and leaves: its depth is `depth` sin^2(pi t / duration).
struct Press {
  Vec3 touch;           ///< centre of the ball at the start and at the end [m]
  double radius = 0;    ///< [m]
  double depth = 0;     ///< depth at half the duration [m]
  double duration = 0;  ///< [s]

  Vec3 centre(double time) const;
  Vec3 velocity(double time) const;
};

/// Core's equations as y' = f(t, y) for any other integrator. y holds displacement from the start, velocity, and Kelvin
/// elongation. Elements are core's own. Loads and the ball's contact are those of external_loads.h and ball_contact.h
/// at time t, the limit of core's substeps as they get shorter.
class NetworkOde {
 public:
  /// `model` must outlive it; `start` is the State that y = start_values() stands for.
  NetworkOde(const Model& model, const State& start, const Press& press);

  std::size_t size() const { return 6 * spheres_ + start_.kelvin_elongation.size(); }
  std::size_t sphere_count() const { return spheres_; }
  std::vector<double> start_values() const;

  /// Reference sizes of displacement [m], velocity [m/s] and Kelvin elongation [m] for tolerances (size()).
  std::vector<double> scales() const;

  /// y' = f(t, y).
  void derive(double time, const double* y, double* derivative);

  /// Sets up core's preconditioner: the 3x3 block of each sphere of M + gamma C + gamma^2 K at (t, y).
  void take_blocks(double time, double gamma, const double* y);

  /// Solves (1 - gamma f'(y)) z = r with these blocks only.
  void precondition(double gamma, const double* r, double* z) const;

 private:
  void take_state(const double* y);
  void add_loads(double time);
  template <class Touch>
  void for_each_touched(double time, Touch&& touch) const;

  const Model& model_;
  const State start_;
  const Press press_;
  const std::size_t spheres_;
  parallel::Team team_;
  elements::Elements elements_;
  State state_;
  elements::Coordinates force_;
  elements::DiagonalBlocks blocks_, factor_;
};

}  // namespace ctpm::testing
