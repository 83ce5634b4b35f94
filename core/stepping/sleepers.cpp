#include "core/stepping/sleepers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/elements/parts.h"
#include "core/stepping/substep.h"

namespace ctpm::stepping {
namespace {

constexpr double kStillFor = 0.1;  ///< [s], before a part sleeps

constexpr std::vector<double> Vec3Array::*kAxes[3] = {&Vec3Array::x, &Vec3Array::y, &Vec3Array::z};

}  // namespace

std::int32_t Sleepers::ticks_before_sleep(const Model& model) {
  return std::max(2, std::int32_t(std::ceil(kStillFor / model.tick)));
}

Sleepers::Sleepers(const Model& model, elements::Elements& elements, parallel::Team& team,
                   const elements::Kernels& kernels, const contact::Contacts& contacts)
    : model_(model),
      elements_(elements),
      team_(team),
      kernels_(kernels),
      ticks_(ticks_before_sleep(model)),
      all_mass_(total_mass(model)),
      awake_mass_(all_mass_) {
  if (!(model.solver.sleep_bound > 0)) return;
  parts_ = elements::parts_of(model);
  const parallel::Slabs& slabs = elements_.slabs();
  for (int slab = 0; slab < slabs.count(); ++slab) part_of_slab_.push_back(part_of(slabs.begin(slab)));
  is_asleep_.resize(std::size_t(slabs.count()));
  for (const parallel::SphereRange& part : parts_)
    mass_of_part_.push_back(std::accumulate(model.mass.begin() + part.begin, model.mass.begin() + part.end, 0.0));
  is_awake_.resize(parts_.size()), is_disturbed_.resize(parts_.size());
  island_.resize(parts_.size()), has_moving_.resize(parts_.size());
  contacts.reserve(merged_);
  kept_.reserve(merged_.point.capacity());
}

std::size_t Sleepers::part_of(std::int32_t sphere) const {
  const auto next = std::upper_bound(parts_.begin(), parts_.end(), sphere,
                                     [](std::int32_t s, const parallel::SphereRange& part) { return s < part.begin; });
  return std::size_t(next - parts_.begin()) - 1;
}

void Sleepers::begin(const State& from, const contact::HeldTools& tools, const Substep& substep) {
  has_woken_ = false;
  if (parts_.empty()) return;
  kept_.clear();
  // Nothing sleeps while a scene settles, nor while faces of a cut are about to touch each other, nor while a pin may
  // draw spheres away from what they touch before the contact is looked for.
  const bool all = !substep.has_loads || from.opening_cuts_at != 0;
  const bool has_pin =
      std::any_of(tools.begin(), tools.end(), [](const contact::HeldTool& tool) { return tool.is(ToolKind::pin); });
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    is_disturbed_[p] = all ? 1 : 0;
    is_awake_[p] = all || has_pin || still_in(from, p) < ticks_ ? 1 : 0;
    island_[p] = p;
  }
  for (const contact::HeldTool& tool : tools) {
    if (tool.is(ToolKind::pin)) disturb(tool.tool->sphere);
    if (!tool.is(ToolKind::scalpel)) continue;
    for (const std::int32_t organ : from.edge_organ)
      if (organ >= 0 && std::size_t(organ) < model_.organs.size()) disturb(model_.organs[std::size_t(organ)].first);
  }
  const Loads& loads = model_.loads;
  for (std::size_t l = 0; l < loads.size(); ++l) {
    const double since = substep.time - loads.start[l];
    if (since > -substep.h && since < loads.ramp[l] + 2 * substep.h) disturb(loads.sphere[l]);
  }
  set_asleep();
}

void Sleepers::set_asleep() {
  for (std::size_t slab = 0; slab < is_asleep_.size(); ++slab) is_asleep_[slab] = is_awake_[part_of_slab_[slab]] == 0;
  elements_.slabs().set_asleep(is_asleep_);
  awake_mass_ = all_mass_;
  if (elements_.slabs().asleep().empty()) return;
  awake_mass_ = 0;
  for (std::size_t p = 0; p < parts_.size(); ++p)
    if (is_awake_[p] != 0) awake_mass_ += mass_of_part_[p];
}

bool Sleepers::wakes(contact::ContactSet& contacts) {
  if (parts_.empty()) return false;
  if (wake_touching(contacts.points())) {
    set_asleep();
    return has_woken_ = true;
  }
  kept_.clear();
  contacts.leave_out([&](const contact::PointContact& contact) {
    const auto spheres = contacts.points().carriers(contact).sphere;
    if (spheres.empty() || is_awake_[part_of(spheres.front())] != 0) return false;
    if (contact.point >= 0) kept_.push_back(contact.point);
    return true;
  });
  return false;
}

/// Wakes what a tool touches, and what touches a part that is awake. True: some of that slept.
bool Sleepers::wake_touching(const contact::PointContacts& contacts) {
  bool has_woken = false;
  const auto wake = [&](std::size_t part) {
    has_woken = has_woken || is_awake_[part] == 0;
    is_awake_[part] = 1;
  };
  for (const contact::PointContact& contact : contacts.all())
    if (contact.hand >= 0)
      for (const std::int32_t sphere : contacts.carriers(contact).sphere)
        wake(part_of(sphere)), is_disturbed_[part_of(sphere)] = 1;
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (const contact::PointContact& contact : contacts.all()) {
      std::size_t first = parts_.size();
      bool is_awake = false;
      for (const std::int32_t sphere : contacts.carriers(contact).sphere) {
        const std::size_t part = part_of(sphere);
        first = std::min(first, island_[part]), is_awake = is_awake || is_awake_[part] != 0;
      }
      if (!is_awake) continue;
      for (const std::int32_t sphere : contacts.carriers(contact).sphere) {
        const std::size_t part = part_of(sphere);
        goes_on = goes_on || is_awake_[part] == 0 || island_[part] != first;
        wake(part), island_[part] = first;
      }
    }
  }
  return has_woken;
}

void Sleepers::keep(const State& from, Motion& to) const {
  const parallel::Slabs& slabs = elements_.slabs();
  if (slabs.asleep().empty()) return;
  slabs.for_each_asleep(team_, [&](int slab) {
    const std::ptrdiff_t begin = slabs.begin(slab), end = slabs.end(slab);
    for (const auto axis : kAxes) {
      const auto place = (from.position.*axis).begin();
      std::copy(place + begin, place + end, (to.position.*axis).begin() + begin);
      std::fill((to.velocity.*axis).begin() + begin, (to.velocity.*axis).begin() + end, 0.0);
      if (to.acceleration.size() > 0)
        std::fill((to.acceleration.*axis).begin() + begin, (to.acceleration.*axis).begin() + end, 0.0);
    }
  });
  keep_kelvin(from, to);
}

bool Sleepers::is_still(std::size_t part, const Vec3Array& velocity) const {
  const double bound = model_.solver.sleep_bound;
  return is_awake_[part] == 0 ||
         kernels_.fastest_squared(velocity.x.data(), velocity.y.data(), velocity.z.data(),
                                  std::size_t(parts_[part].begin), std::size_t(parts_[part].end)) <= bound * bound;
}

void Sleepers::finish(const State& from, const Substep& substep, Motion& to) {
  to.still_ticks.assign(parts_.size(), 0);
  if (parts_.empty()) return;
  const std::int32_t more = substep.share == 1 ? 1 : 0;
  std::fill(has_moving_.begin(), has_moving_.end(), std::uint8_t(0));
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    if (is_disturbed_[p] == 0 && is_still(p, to.velocity))
      to.still_ticks[p] = std::min(std::min(still_in(from, p), ticks_) + more, ticks_);
    else
      has_moving_[island_[p]] = 1;
  }
  // What touches something that moves must not sleep as soon as that is gone: it may have been held by it.
  for (std::size_t p = 0; p < parts_.size(); ++p)
    if (has_moving_[island_[p]] != 0) to.still_ticks[p] = std::min(to.still_ticks[p], ticks_ / 2);
  keep_touched(from, to);
}

/// What sleeping tissue touches stays as it was.
void Sleepers::keep_touched(const State& from, Motion& to) {
  if (kept_.empty()) return;
  std::sort(kept_.begin(), kept_.end());
  merged_.point.clear(), merged_.grip.resize(0), merged_.kelvin_dent.clear();
  const auto add = [&](std::int32_t point, Vec3 grip, double kelvin_dent) {
    merged_.point.push_back(point), merged_.grip.push_back(grip), merged_.kelvin_dent.push_back(kelvin_dent);
  };
  const contact::Touched& now = to.touched;
  std::size_t n = 0, then = 0;
  for (const std::int32_t point : kept_) {
    for (; n < now.point.size() && now.point[n] < point; ++n) add(now.point[n], now.grip[n], now.kelvin_dent[n]);
    while (then < from.touched.size() && from.touched[then] < point) ++then;
    if (then < from.touched.size() && from.touched[then] == point) add(point, from.grip[then], from.kelvin_dent[then]);
  }
  for (; n < now.point.size(); ++n) add(now.point[n], now.grip[n], now.kelvin_dent[n]);
  std::swap(to.touched, merged_);
}

std::int32_t Sleepers::count() const {
  std::int32_t spheres = 0;
  const parallel::Slabs& slabs = elements_.slabs();
  for (const int slab : slabs.asleep()) spheres += slabs.end(slab) - slabs.begin(slab);
  return spheres;
}

}  // namespace ctpm::stepping
