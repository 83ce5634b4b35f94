#include "studio/loading/standing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/stepping/step.h"
#include "studio/loading/tools_aside.h"

namespace ctpm::loading {
namespace {

/// Ticks between two looks at the sag and at `should_stop`.
constexpr std::int64_t kStretch = 50;

Vec3 way_of(const Model& model, const State& state, std::size_t sphere) {
  return state.position[sphere] - model.rest_position[sphere];
}

OrganStanding one_standing(const Model& model, const State& state, const OrganRange& range) {
  OrganStanding standing;
  const auto first = std::size_t(range.first), last = first + std::size_t(range.count);
  if (first == last) return standing;
  Vec3 least = model.rest_position[first], most = least, mean;
  for (std::size_t i = first; i < last; ++i) {
    const Vec3 p = model.rest_position[i];
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    standing.held += model.held_axes[i] == kAnchored;
    mean = mean + way_of(model, state, i) / double(range.count);
  }
  // What nothing holds falls onto something as a whole.
  if (standing.held > 0) mean = {};
  standing.way = norm(mean);
  for (std::size_t i = first; i < last; ++i)
    standing.sag = std::max(standing.sag, norm(way_of(model, state, i) - mean));
  standing.size = norm(most - least);
  return standing;
}

}  // namespace

std::vector<OrganStanding> standing_of(const Model& model, const State& settled) {
  std::vector<OrganStanding> standing;
  for (const OrganRange& range : model.organs) standing.push_back(one_standing(model, settled, range));
  return standing;
}

bool Standing::stands() const {
  return !is_refused && std::all_of(organ.begin(), organ.end(), [](const OrganStanding& o) { return o.stands(); });
}

namespace {

using Progress = std::function<void(std::int64_t done, std::int64_t most)>;

std::optional<Standing> settle_from(State rest, const scenes::SceneSpec& scene, const Model& model,
                                    std::optional<double> most_sag, const std::function<bool()>& should_stop,
                                    const Progress& progress) {
  const std::int64_t ticks = std::llround(scene.settle / model.tick);
  Standing standing;
  standing.state = std::move(rest);
  stepping::Stepper stepper(model);
  const auto look = [&] { standing.organ = standing_of(model, standing.state); };
  const auto fastest = [&] {
    double speed = 0;
    for (std::size_t i = 0; i < model.sphere_count(); ++i) speed = std::max(speed, norm(standing.state.velocity[i]));
    return speed;
  };
  constexpr double kAtRest = 1e-5;  // [m/s], where Stepper::settle() ends
  for (std::int64_t done = 0; done < ticks; done += kStretch) {
    if (should_stop && should_stop()) return std::nullopt;
    if (progress) progress(done, ticks);
    const stepping::StepReport report = stepper.settle(standing.state, std::min(kStretch, ticks - done));
    standing.is_refused = stepping::is_refused(report.status);
    look();
    const bool is_down = most_sag && std::any_of(standing.organ.begin(), standing.organ.end(),
                                                 [&](const OrganStanding& o) { return o.share() > *most_sag; });
    if (standing.is_refused || is_down || fastest() < kAtRest) break;
  }
  look();
  return standing;
}

}  // namespace

std::optional<Standing> settle_scene(const scenes::SceneSpec& scene, const Model& model, std::optional<double> most_sag,
                                     const std::function<bool()>& should_stop, const Progress& progress) {
  return settle_from(rest_state(model), scene, model, most_sag, should_stop, progress);
}

std::optional<Standing> settle_without_tools(const scenes::SceneSpec& scene, Model& model,
                                             std::optional<double> most_sag, const std::function<bool()>& should_stop) {
  State rest = rest_state(model);
  const ToolsAside aside(model);
  return settle_from(std::move(rest), scene, model, most_sag, should_stop, {});
}

}  // namespace ctpm::loading
