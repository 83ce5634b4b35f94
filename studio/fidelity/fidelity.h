#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/reports/report.h"

// What an organ does in the simulation, measured against references that nobody here wrote.
namespace ctpm::fidelity {

/// The range in which a figure meets its goal; an unset end is open.
struct Goal {
  std::optional<double> least = {}, most = {};

  bool is_met(double value) const;                  ///< false for NaN
  std::string text(const std::string& unit) const;  ///< "0.95 to 1.05", "at most 0.3 mm"
};

/// One measured number.
struct Figure {
  std::string recipe;                    ///< key of its recipe
  std::string name = {};                 ///< what was measured: "sag of the end"
  double radius = 0;                     ///< r of the spheres [m]; 0: irrelevant
  double measured = 0;                   ///< in `unit`; NaN: could not be measured
  std::string unit = "1";                ///< "1" for a ratio
  std::optional<double> reference = {};  ///< in `unit`
  std::string source = {};               ///< where the reference comes from
  std::optional<Goal> goal = {};         ///< unset: the number is only shown
  std::string note = {};

  double error() const;  ///< measured over reference - 1 [share]; NaN without reference
  reports::ReportVerdict verdict() const;
};

/// What one recipe found.
struct Chapter {
  reports::Section section;
  std::vector<Figure> figures;
};

struct FidelityOptions {
  std::vector<std::string> recipes = {};  ///< keys of those to run; empty: all
  std::optional<std::string> scene = {};  ///< a scene file whose first organ is measured too
  bool allow_outside_paths = false;       ///< the scene's meshes may lie outside its folder
  std::string shipped;                    ///< folder of the shipped scenes
  bool is_quick = false;                  ///< coarse fillings, few places and turns; titles and notes say so
};

/// A recipe: its key, its title, and whether it needs a scene.
struct RecipeInfo {
  const char* key;
  const char* title;
  bool is_of_scene;
};
std::vector<RecipeInfo> fidelity_recipes();

struct FidelityResults {
  std::vector<Chapter> chapters;
  std::optional<std::string> scene = {};  ///< the scene file whose organ was measured
  bool is_quick = false;

  std::int64_t count(reports::ReportVerdict verdict) const;  ///< figures with this verdict
};

/// Title of the recipe that begins, and how many of `total` are done.
using FidelityProgress = std::function<void(const std::string& title, std::int64_t done, std::int64_t total)>;

/// Runs the recipes in their order. Errors, all before any work: unknown recipes; a recipe of a scene without one;
/// those of the scene. A body that cannot be built is an error of its recipe.
Result<FidelityResults> run_fidelity(const FidelityOptions& options, const FidelityProgress& progress);

/// All figures in one table, for the page, results.json and results.csv.
reports::Table figures_table(const std::vector<Chapter>& chapters);

/// Writes report.html, results.json (every table and the points of every plot) and results.csv (all figures) into a
/// folder.
Result<Done> write_fidelity_report(const std::string& folder, const FidelityResults& results);

}  // namespace ctpm::fidelity
