#include "core/stepping/motion.h"

#include <utility>

namespace ctpm::stepping {
namespace {

constexpr std::vector<double> Vec3Array::*kAxes[3] = {&Vec3Array::x, &Vec3Array::y, &Vec3Array::z};

}  // namespace

double total_mass(const Model& model) {
  double total = 0;
  for (const double mass : model.mass) total += mass;
  return total;
}

void commit(Motion& motion, State& state) {
  std::swap(state.position, motion.position), std::swap(state.velocity, motion.velocity);
  std::swap(state.kelvin_elongation, motion.kelvin_elongation);
  std::swap(state.touched, motion.touched.point), std::swap(state.grip, motion.touched.grip);
  std::swap(state.kelvin_dent, motion.touched.kelvin_dent);
  std::swap(state.still_ticks, motion.still_ticks);
  if (motion.acceleration.size() > 0) std::swap(state.acceleration, motion.acceleration);
}

void drift(const parallel::Slabs& slabs, parallel::Team& team, const Vec3Array& position, const Vec3Array& velocity,
           double h, Vec3Array& to) {
  slabs.for_each_awake(team, [&](int slab) {
    for (const auto axis : kAxes) {
      const double *v = (velocity.*axis).data(), *p = (position.*axis).data();
      double* __restrict out = (to.*axis).data();
      for (auto i = std::size_t(slabs.begin(slab)); i < std::size_t(slabs.end(slab)); ++i) out[i] = p[i] + h * v[i];
    }
  });
}

void drift(const parallel::Slabs& slabs, parallel::Team& team, const Vec3Array& velocity, double h,
           Vec3Array& position) {
  slabs.for_each_awake(team, [&](int slab) {
    for (const auto axis : kAxes) {
      const double* v = (velocity.*axis).data();
      double* __restrict p = (position.*axis).data();
      for (auto i = std::size_t(slabs.begin(slab)); i < std::size_t(slabs.end(slab)); ++i) p[i] += h * v[i];
    }
  });
}

void commit_velocity(const parallel::Slabs& slabs, parallel::Team& team, const elements::Coordinates& velocity,
                     const Vec3Array& position, double h, Motion& to) {
  const std::size_t n = position.size();
  slabs.for_each_awake(team, [&](int slab) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double *next = &velocity[k * n], *p = (position.*kAxes[k]).data();
      double* __restrict v = (to.velocity.*kAxes[k]).data();
      double* __restrict out = (to.position.*kAxes[k]).data();
      for (auto i = std::size_t(slabs.begin(slab)); i < std::size_t(slabs.end(slab)); ++i)
        v[i] = next[i], out[i] = p[i] + h * next[i];
    }
  });
}

}  // namespace ctpm::stepping
