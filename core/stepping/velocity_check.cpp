#include "core/stepping/velocity_check.h"

#include <algorithm>

namespace ctpm::stepping {
namespace {

/// Limit of physical speeds [m/s].
constexpr double kFastest = 1e4;

}  // namespace

VelocityCheck::VelocityCheck(const StepContext& context)
    : context_(context), fastest_of_slab_(std::size_t(context.elements.slabs().count())) {}

bool VelocityCheck::passes(const Vec3Array& velocity, StepReport& report) {
  const parallel::Slabs& slabs = context_.elements.slabs();
  std::fill(fastest_of_slab_.begin(), fastest_of_slab_.end(), 0.0);
  slabs.for_each_awake(context_.team, [&](int slab) {
    fastest_of_slab_[std::size_t(slab)] =
        context_.kernels.fastest_squared(velocity.x.data(), velocity.y.data(), velocity.z.data(),
                                         std::size_t(slabs.begin(slab)), std::size_t(slabs.end(slab)));
  });
  const auto fastest = std::max_element(fastest_of_slab_.begin(), fastest_of_slab_.end());
  const auto slab = int(fastest - fastest_of_slab_.begin());
  report.worst_sphere = slabs.begin(slab);
  for (std::int32_t sphere = slabs.begin(slab); sphere < slabs.end(slab); ++sphere) {
    const Vec3 v = velocity[std::size_t(sphere)];
    if (dot(v, v) < *fastest) continue;  // false if the speed is not a number
    report.worst_sphere = sphere;
    break;
  }
  if (*fastest <= kFastest * kFastest) return true;
  report.status = StepStatus::diverged;
  return false;
}

}  // namespace ctpm::stepping
