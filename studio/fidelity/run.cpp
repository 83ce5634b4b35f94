// The list of recipes, and the run of those that are asked for.

#include <algorithm>
#include <cmath>

#include "studio/fidelity/fidelity.h"
#include "studio/fidelity/recipes.h"
#include "studio/fidelity/scene.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"

namespace ctpm::fidelity {
namespace {

struct Recipe {
  RecipeInfo info;
  std::function<Result<Chapter>(const FidelityOptions& options)> run;
};

using Radii = std::vector<double>;

scenes::LoadOptions loading_of(bool allow_outside_paths) {
  scenes::LoadOptions options;
  options.allow_outside_paths = allow_outside_paths;
  return options;
}

/// A recipe's run from its measurement.
template <class T>
Result<Chapter> told(const Result<T>& measured) {
  if (!measured) return measured.errors();
  return chapter_of(*measured);
}

Result<Chapter> turned_scene(const FidelityOptions& options, const std::string& path, bool allow_outside_paths,
                             const std::string& key, const std::string& title) {
  const Result<SceneOrgan> organ = read_scene_organ(path, loading_of(allow_outside_paths));
  if (!organ) return organ.errors();
  const std::vector<Quat> turns = twelve_turns();
  const Result<SceneResult> result =
      measure_scene_turns(*organ, std::span(turns).first(options.is_quick ? kQuickTurns : turns.size()));
  if (!result) return result.errors();
  return turns_chapter(*result, key, title);
}

std::vector<Recipe> recipes() {
  return {
      {{"tension", "Tension of a bar", false},
       [](const FidelityOptions& o) {
         return told(measure_tension(o.is_quick ? Radii{4e-3, 2e-3} : Radii{4e-3, 2e-3, 1e-3}));
       }},
      {{"cantilever", "Cantilever under its own weight", false},
       [](const FidelityOptions& o) {
         return told(measure_cantilever(o.is_quick ? Radii{4e-3} : Radii{4e-3, 2e-3, 1e-3}));
       }},
      {{"indentation", "Indentation of a block", false},
       [](const FidelityOptions& o) {
         return told(measure_indentation(o.is_quick ? Radii{4e-3} : Radii{4e-3, 2e-3, 1e-3}, o.is_quick ? 2 : 3));
       }},
      {{"orientation", "Orientation of the lattice", false},
       [](const FidelityOptions& o) {
         const std::vector<Quat> turns = twelve_turns();
         return told(measure_orientation(o.is_quick ? Radii{4e-3} : Radii{4e-3, 2e-3},
                                         std::span(turns).first(o.is_quick ? 4 : turns.size())));
       }},
      {{"first-contact", "First contact", false},
       [](const FidelityOptions& o) {
         return told(measure_first_contact(o.is_quick ? Radii{4e-3} : Radii{4e-3, 2e-3}, o.is_quick ? 2 : 4));
       }},
      {{"surface", "The drawn surface under a ball, and a small ball", false},
       [](const FidelityOptions& o) {
         return told(measure_surface(o.is_quick ? Radii{4e-3} : Radii{4e-3, 2e-3}, o.is_quick ? 2 : 3));
       }},
      {{"drag", "A ball drawn over a flat block", false},
       [](const FidelityOptions& o) {
         return told(measure_drag(o.is_quick ? Radii{4e-3} : Radii{4e-3, 2e-3}, o.is_quick));
       }},
      {{"blade", "A blade through a block", false},
       [](const FidelityOptions& o) {
         const std::vector<double> toughnesses{20, 200, 1000};
         return told(measure_blade(o.is_quick ? Radii{4e-3} : Radii{4e-3, 2e-3},
                                   std::span(toughnesses).first(o.is_quick ? 2 : toughnesses.size())));
       }},
      {{"cuts", "Cuts of every kind", false},
       [](const FidelityOptions& o) { return told(measure_cuts(o.shipped, o.is_quick)); }},
      {{"strokes", "Strokes through the shipped organs", false},
       [](const FidelityOptions& o) { return told(measure_strokes(o.shipped, o.is_quick)); }},
      {{"pieces", "Pieces that fall", false}, [](const FidelityOptions&) { return told(measure_pieces(4e-3)); }},
      {{"grip", "Grip", false}, [](const FidelityOptions& o) { return told(measure_grip(o.is_quick ? 8e-3 : 4e-3)); }},
      {{"recovery", "Recovery from abuse", false},
       [](const FidelityOptions& o) {
         return told(measure_recovery(o.is_quick ? Radii{4e-3} : Radii{4e-3, 2e-3}));
       }},
      {{"relaxation", "Relaxation under a ball", false},
       [](const FidelityOptions& o) {
         return told(measure_relaxation(o.is_quick ? Radii{4e-3} : Radii{4e-3, 2e-3},
                                        o.is_quick ? Radii{0.05} : Radii{0.005, 0.05, 0.5}));
       }},
      {{"free-motion", "Free spin and free fall", false},
       [](const FidelityOptions&) { return told(measure_free_motion(4e-3)); }},
      {{"meeting", "Bodies that meet", false},
       [](const FidelityOptions& o) { return told(measure_meeting(o.is_quick ? 8e-3 : 4e-3)); }},
      {{"liver", "The shipped liver, turned under its own tool", false},
       [](const FidelityOptions& o) {
         return turned_scene(o, o.shipped + "/liver.json", true, "liver",
                             "The shipped liver, turned under its own tool");
       }},
      {{"scene-turns", "The scene's organ, turned under its own tool", true},
       [](const FidelityOptions& o) {
         return turned_scene(o, *o.scene, o.allow_outside_paths, "scene-turns",
                             "The scene's organ, turned under its own tool");
       }},
      {{"scene-places", "The scene's organ at places over one lattice cell", true},
       [](const FidelityOptions& o) -> Result<Chapter> {
         const Result<SceneOrgan> organ = read_scene_organ(*o.scene, loading_of(o.allow_outside_paths));
         if (!organ) return organ.errors();
         const Result<SceneResult> result = measure_scene_places(*organ, o.is_quick ? kQuickPlaces : 3);
         if (!result) return result.errors();
         return places_chapter(*result, "scene-places", "The scene's organ at places over one lattice cell");
       }},
  };
}

/// The recipes that are asked for, in their own order. Errors: names that no recipe has; a recipe of a scene without
/// one.
Result<std::vector<Recipe>> chosen_recipes(const FidelityOptions& options) {
  std::vector<Recipe> all = recipes(), chosen;
  Errors errors;
  std::string names;
  for (const Recipe& recipe : all) names += (names.empty() ? "" : ", ") + std::string(recipe.info.key);
  for (const std::string& key : options.recipes) {
    const auto it = std::find_if(all.begin(), all.end(), [&](const Recipe& r) { return r.info.key == key; });
    if (it == all.end())
      errors.push_back({output::option_name("fidelity.recipes"), "there is no recipe " + key, "there are " + names});
    else if (it->info.is_of_scene && !options.scene)
      errors.push_back(
          {output::option_name("fidelity.recipes"), "the recipe " + key + " needs a scene", "name a scene file"});
  }
  if (!errors.empty()) return errors;
  for (const Recipe& recipe : all) {
    const bool is_asked =
        std::find(options.recipes.begin(), options.recipes.end(), recipe.info.key) != options.recipes.end();
    // With a scene and without names, the scene's own recipes run: the others do not depend on it.
    if (is_asked || (options.recipes.empty() && recipe.info.is_of_scene == options.scene.has_value()))
      chosen.push_back(recipe);
  }
  return chosen;
}

}  // namespace

bool Goal::is_met(double value) const {
  return !std::isnan(value) && (!least || value >= *least) && (!most || value <= *most);
}

std::string Goal::text(const std::string& unit) const {
  const std::string with_unit = unit == "1" ? "" : " " + unit;
  const auto number = [](double value) { return output::short_number(value); };
  if (least && most) return number(*least) + " to " + number(*most) + with_unit;
  if (least) return "at least " + number(*least) + with_unit;
  return most ? "at most " + number(*most) + with_unit : "";
}

double Figure::error() const { return reference && *reference != 0 ? measured / *reference - 1 : std::nan(""); }

reports::ReportVerdict Figure::verdict() const {
  if (!goal) return reports::ReportVerdict::shown;
  return goal->is_met(measured) ? reports::ReportVerdict::met : reports::ReportVerdict::missed;
}

std::int64_t FidelityResults::count(reports::ReportVerdict verdict) const {
  std::int64_t count = 0;
  for (const Chapter& chapter : chapters)
    count += std::count_if(chapter.figures.begin(), chapter.figures.end(),
                           [&](const Figure& figure) { return figure.verdict() == verdict; });
  return count;
}

std::vector<RecipeInfo> fidelity_recipes() {
  std::vector<RecipeInfo> infos;
  for (const Recipe& recipe : recipes()) infos.push_back(recipe.info);
  return infos;
}

Result<FidelityResults> run_fidelity(const FidelityOptions& options, const FidelityProgress& progress) {
  const Result<std::vector<Recipe>> chosen = chosen_recipes(options);
  if (!chosen) return chosen.errors();
  if (options.scene)
    if (const Result<SceneOrgan> organ = read_scene_organ(*options.scene, loading_of(options.allow_outside_paths));
        !organ)
      return organ.errors();
  FidelityResults results;
  results.is_quick = options.is_quick, results.scene = options.scene;
  Errors errors;
  std::int64_t done = 0;
  for (const Recipe& recipe : *chosen) {
    progress(recipe.info.title, done++, std::int64_t(chosen->size()));
    Result<Chapter> chapter = recipe.run(options);
    if (chapter)
      results.chapters.push_back(*std::move(chapter));
    else
      for (Error error : chapter.errors()) {
        error.message = std::string("recipe ") + recipe.info.key + ": " + error.message;
        errors.push_back(std::move(error));
      }
  }
  if (!errors.empty()) return errors;
  return results;
}

}  // namespace ctpm::fidelity
