#include "studio/authoring/script_choice.h"

#include <span>

#include "core/surface/surface.h"
#include "studio/loading/script_trial.h"

namespace ctpm::authoring {
namespace {

/// The usual place first, then others, then right through the organ, where what holds it may be near.
constexpr scenes::ScriptPlace kPlaces[] = {{},           {0.12},        {-0.12},      {0.24},
                                           {-0.24},      {0, true},     {0.3, true},  {-0.3, true},
                                           {0.15, true}, {-0.15, true}, {0.45, true}, {-0.38, true}};

}  // namespace

std::optional<ScriptChoice> choose_script(const scenes::SceneSpec& scene, const FilledOrgan& filled,
                                          const AnchorChoice& standing, bool is_timed,
                                          const std::function<bool()>& should_stop) {
  // An organ's surface as it lies, without what binds it to the spheres.
  FilledOrgan settled;
  settled.sphere_radius = filled.sphere_radius, settled.spacing = filled.spacing, settled.centre = filled.centre;
  surface::deform_surface(filled.surface, standing.standing.state.position, 0, settled.surface.vertex);
  ScriptChoice choice;
  stepping::Stepper stepper(standing.model);
  for (const scenes::ScriptPlace place : kPlaces) {
    scenes::Script script = scenes::organ_script(scene, std::span(&settled, 1), 0, place);
    const std::optional<loading::ScriptTrial> trial =
        loading::try_script(standing.model, stepper, standing.standing.state, script,
                            is_timed ? std::nullopt : std::optional<std::size_t>(0), should_stop);
    if (!trial) return std::nullopt;
    const bool is_better =
        trial->most_force > 0 && !trial->is_refused && (trial->was_cut[0] || choice.script.steps.empty());
    if (is_better || choice.script.steps.empty()) {
      choice.most_force = trial->most_force, choice.was_cut = trial->was_cut[0] && trial->severed > 0;
      choice.usual_work = trial->usual_work, choice.dearest_work = trial->dearest_work;
      choice.script = std::move(script);
    }
    if (choice.most_force > 0 && choice.was_cut) break;
  }
  return choice;
}

}  // namespace ctpm::authoring
