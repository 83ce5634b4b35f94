#include "studio/authoring/script_choice.h"

#include <algorithm>
#include <span>

#include "core/model/box.h"
#include "core/surface/surface.h"
#include "studio/loading/script_trial.h"

namespace ctpm::authoring {
namespace {

/// The usual place first, there without the press before the cut too (a wall that stands on its edge folds away under
/// it, so that the blade finds nothing), then others.
constexpr scenes::ScriptPlace kPlaces[] = {{}, {.cuts_first = true}, {0.12}, {-0.12}, {0.24}, {-0.24}};
/// Right through the organ, where what holds it may be near.
constexpr scenes::ScriptPlace kThrough[] = {{0, true},     {0.3, true},  {-0.3, true}, {0.15, true},
                                            {-0.15, true}, {0.45, true}, {-0.38, true}};
/// Of the usual depth, for an organ that a blade so deep takes along: its force is toughness times depth.
constexpr double kShallower[] = {0.7, 0.5, 0.35};
/// A blade may take an organ's spheres along by so much of its least extent in the mean (our choice: at a tenth the
/// wound of a soft lump still zigzagged).
constexpr double kMostDragged = 0.08;

double least_extent(const std::vector<Vec3>& point) {
  Box box(point.front());
  for (const Vec3& p : point) box.add(p);
  const Vec3 size = box.high - box.low;
  return std::min({size.x, size.y, size.z});
}

bool is_better(const ScriptChoice& a, const ScriptChoice& b) {
  if (a.works() != b.works()) return a.works();
  if (!a.works()) return false;
  return a.is_inside_out != b.is_inside_out ? b.is_inside_out : a.dragged < b.dragged;
}

/// Tries scripts on one organ where it has settled.
class Trials {
 public:
  Trials(const scenes::SceneSpec& scene, const FilledOrgan& filled, const AnchorChoice& standing, bool is_timed,
         const std::function<bool()>& should_stop)
      : scene_(scene), standing_(standing), stepper_(standing.model), should_stop_(should_stop) {
    if (!is_timed) until_cut_ = 0;
    // The surface as it lies, without what binds it to the spheres.
    settled_.sphere_radius = filled.sphere_radius, settled_.spacing = filled.spacing, settled_.centre = filled.centre;
    surface::deform_surface(filled.surface, standing.standing.state.position, 0, settled_.surface.vertex);
    most_dragged_ = kMostDragged * least_extent(settled_.surface.vertex);
  }

  /// None: stopped.
  std::optional<ScriptChoice> at(scenes::ScriptPlace place) {
    ScriptChoice choice;
    choice.script = scenes::organ_script(scene_, std::span(&settled_, 1), 0, place);
    const std::optional<loading::ScriptTrial> trial = loading::try_script(
        standing_.model, stepper_, standing_.standing.state, choice.script, until_cut_, should_stop_);
    if (!trial) return std::nullopt;
    choice.is_refused = trial->is_refused;
    choice.most_force = trial->most_force, choice.was_cut = trial->was_cut[0] && trial->severed > 0;
    choice.is_inside_out = trial->is_inside_out, choice.dragged = trial->dragged;
    choice.drags = trial->is_inside_out || (!place.cuts_through && trial->dragged > most_dragged_);
    choice.usual_work = trial->usual_work, choice.dearest_work = trial->dearest_work;
    return choice;
  }

 private:
  const scenes::SceneSpec& scene_;
  const AnchorChoice& standing_;
  stepping::Stepper stepper_;
  const std::function<bool()>& should_stop_;
  std::optional<std::size_t> until_cut_;
  FilledOrgan settled_;
  double most_dragged_ = 0;  ///< [m]
};

}  // namespace

std::optional<ScriptChoice> choose_script(const scenes::SceneSpec& scene, const FilledOrgan& filled,
                                          const AnchorChoice& standing, bool is_timed,
                                          const std::function<bool()>& should_stop) {
  Trials trials(scene, filled, standing, is_timed, should_stop);
  std::optional<ScriptChoice> best;
  // Returns whether it went on.
  const auto try_at = [&](scenes::ScriptPlace place) {
    std::optional<ScriptChoice> choice = trials.at(place);
    if (!choice) return false;
    if (!best || is_better(*choice, *best)) best = std::move(choice);
    return true;
  };
  for (scenes::ScriptPlace place : kPlaces) {
    if (!try_at(place)) return std::nullopt;
    // Where an organ gives way before it is cut, a blade that is less deep may cut it.
    const bool goes_on = (place.along == 0 && !place.cuts_first) || best->works();
    for (const double share : kShallower) {
      if (!goes_on || !best->drags) break;
      place.depth_share = share;
      if (!try_at(place)) return std::nullopt;
    }
    if (best->works()) return best;
  }
  for (const scenes::ScriptPlace& place : kThrough) {
    if (!try_at(place)) return std::nullopt;
    if (best->works() && !best->drags) break;
  }
  return best;
}

}  // namespace ctpm::authoring
