#include "studio/session/session_cost.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "studio/session/unkept_session.h"

namespace ctpm::session {
namespace {

/// How the radii of a scene, all times one factor, change the dearest tick.
struct Tried {
  double factor, time;  ///< [1], [s]
};

/// Where `wanted` [s] lies between or beyond two fillings, if times are a power of the radius.
double factor_for(double wanted, const Tried& fine, const Tried& coarse) {
  // Ticks grow with the number of spheres, and in an implicit one with its iterations.
  constexpr double kLeast = 1.5, kUsual = 3.3, kMost = 6;
  const double rise = fine.time / coarse.time, span = coarse.factor / fine.factor;
  const double power = span > 1 ? std::clamp(std::log(rise) / std::log(span), kLeast, kMost) : kUsual;
  return fine.factor * std::pow(fine.time / wanted, 1 / power);
}

bool has_mesh(const scenes::OrganSpec& organ) { return !organ.mesh.empty(); }

}  // namespace

double SessionCost::dearest() const {
  const double worked = std::max(of(Deed::contact).own_p99, of(Deed::cut).own_p99);
  return worked > 0 ? worked : of(Deed::none).own_p99;
}

bool SessionCost::is_own() const {
  constexpr double kLeast = 0.75;  // of the processor time that all threads would have
  return threads == 1 || processor_share >= kLeast * threads;
}

Result<SessionCost> measure_session(const loading::LoadedScene& scene, const ScriptOf& script, RunOptions running,
                                    const SessionCost* like) {
  const Result<scenes::Script> steps = script(scene);
  if (!steps) return steps.errors();
  const UnkeptSession unkept;
  TickTimes times(scene.built.model);
  running.in_real_time = false;
  running.threads = threads_for(scene.built.model);
  TooLong too_long(like ? &like->times : nullptr, scene.built.model.tick);
  double lost = 0, all = 0;
  running.watch = [&](const State&, const recordings::TickRecord& record, const RunOutcome& so_far) {
    too_long.add(times.add(record, so_far.lost), record.tick_time - so_far.lost);
    lost += so_far.lost, all += record.tick_time;
  };
  const auto asked_to_stop = running.should_stop;
  running.should_stop = [&] { return too_long.is_sure() || (asked_to_stop && asked_to_stop()); };
  const std::clock_t work = std::clock();
  const auto start = std::chrono::steady_clock::now();
  const Result<RecordOutcome> outcome = record_script(scene, *steps, unkept.file(), false, running);
  if (!outcome) return outcome.errors();
  if (asked_to_stop && asked_to_stop()) return Error{scene.path, "stopped", ""};
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  SessionCost cost{*outcome,
                   {},
                   running.threads,
                   double(std::clock() - work) / CLOCKS_PER_SEC / taken.count(),
                   all > 0 ? lost / all : 0};
  for (const Deed deed : kDeeds) cost.times[std::size_t(deed)] = times.of(deed);
  return cost;
}

Result<std::optional<FittingRadius>> find_fitting_radius(const loading::LoadedScene& scene,
                                                         const scenes::LoadOptions& load, const ScriptOf& script,
                                                         const SessionCost& cost, const RunOptions& running) {
  constexpr int kMostTries = 4;
  constexpr double kGoal = 0.85, kGood = 0.75;  // of a tick
  const std::vector<scenes::OrganSpec>& organs = scene.scene.spec.organs;
  std::optional<FittingRadius> best;
  if (std::none_of(organs.begin(), organs.end(), has_mesh)) return best;
  const double tick = scene.built.model.tick;
  // The coarsest filling that is too dear, and the finest that is not; before there is one, the scene's own.
  Tried dear{1, cost.dearest()}, other = dear;
  for (int tries = 0; tries < kMostTries; ++tries) {
    const double factor = std::ceil(100 * factor_for(kGoal * tick, dear, other)) / 100;
    if (factor <= dear.factor || (best && factor >= best->factor)) break;
    const Result<loading::LoadedScene> coarser =
        loading::load_whole_scene(scene.path, load, [&](scenes::SceneSpec& spec) {
          for (scenes::OrganSpec& organ : spec.organs)
            if (has_mesh(organ)) organ.fill.radius *= factor, organ.fill.gap *= factor;
        });
    if (!coarser) break;  // an organ that is too thin for such spheres, an anchor that holds none
    Result<SessionCost> now = measure_session(*coarser, script, running, &cost);
    if (!now) return now.errors();
    const Tried tried{factor, now->dearest()};
    if (tried.time <= tick && !stepping::is_refused(now->outcome.run.status))
      best = FittingRadius{factor, coarser->built.model.sphere_count(), *std::move(now)}, other = tried;
    else
      dear = tried, other = best ? Tried{best->factor, best->cost.dearest()} : Tried{1, cost.dearest()};
    if (best && best->cost.dearest() >= kGood * tick) break;
  }
  return best;
}

}  // namespace ctpm::session
