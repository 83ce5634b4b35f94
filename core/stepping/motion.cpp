#include "core/stepping/motion.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

namespace ctpm::stepping {
namespace {

constexpr std::vector<double> Vec3Array::*kAxes[3] = {&Vec3Array::x, &Vec3Array::y, &Vec3Array::z};

void copy_awake(const parallel::Slabs& slabs, parallel::Team& team, const Vec3Array& from, Vec3Array& to) {
  slabs.for_each_awake(team, [&](int slab) {
    for (const auto axis : kAxes)
      std::copy((from.*axis).begin() + slabs.begin(slab), (from.*axis).begin() + slabs.end(slab),
                (to.*axis).begin() + slabs.begin(slab));
  });
}

/// Whether any of the numbers is not +0.
bool has_motion(const double* first, const double* last) {
  std::uint64_t any = 0;
  for (; first != last; ++first) any |= std::bit_cast<std::uint64_t>(*first);
  return any != 0;
}

/// Stops what sleeps. Only what has just fallen asleep still moves, so most of the memory is only read.
void stop_asleep(const parallel::Slabs& slabs, parallel::Team& team, Vec3Array& velocity) {
  slabs.for_each_asleep(team, [&](int slab) {
    for (const auto axis : kAxes) {
      double* const all = (velocity.*axis).data();
      double *const first = all + slabs.begin(slab), *const last = all + slabs.end(slab);
      if (has_motion(first, last)) std::fill(first, last, 0.0);
    }
  });
}

}  // namespace

double total_mass(const Model& model) {
  double total = 0;
  for (const double mass : model.mass) total += mass;
  return total;
}

void commit(const parallel::Slabs& slabs, parallel::Team& team, Motion& motion, State& state) {
  const bool has_acceleration = motion.acceleration.size() > 0;
  if (slabs.asleep().empty()) {
    std::swap(state.position, motion.position), std::swap(state.velocity, motion.velocity);
    if (has_acceleration) std::swap(state.acceleration, motion.acceleration);
  } else {
    copy_awake(slabs, team, motion.position, state.position), copy_awake(slabs, team, motion.velocity, state.velocity);
    stop_asleep(slabs, team, state.velocity);
    if (has_acceleration) {
      state.acceleration.resize(motion.acceleration.size());
      copy_awake(slabs, team, motion.acceleration, state.acceleration), stop_asleep(slabs, team, state.acceleration);
    }
  }
  std::swap(state.kelvin_elongation, motion.kelvin_elongation);
  std::swap(state.touched, motion.touched.point), std::swap(state.grip, motion.touched.grip);
  std::swap(state.kelvin_dent, motion.touched.kelvin_dent);
  std::swap(state.still_ticks, motion.still_ticks);
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
