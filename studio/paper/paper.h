#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "scenes/scene_spec.h"
#include "studio/loading/loaded_scene.h"
#include "studio/reports/report.h"

// The experiments of Bao & Wu, run on the sphere network. Each takes the folder of the shipped scenes, runs some of
// them, and compares the network's results with the closed forms and with the paper's printed values.
namespace ctpm::paper {

/// One quantity with up to three values: printed in the paper, by the closed form, by the network.
struct Claim {
  std::string experiment;  ///< "table-1", "relaxation", ...
  std::string organ;
  std::string structure;       ///< "CTPM", "TPM", "mass-spring"
  std::string viscosity = {};  ///< unit of the viscosity: "kPa s", "Pa s"; empty: irrelevant
  std::string quantity;        ///< with its unit: "force at 4 mm [N]"
  std::optional<double> paper = {}, closed_form = {}, network = {};
  std::optional<double> closed_form_error = {};  ///< of the network [share]; unset: computed from both values
  std::optional<double> closed_form_bound = {};  ///< largest error [share]; unset: none
  std::optional<double> paper_bound = {};        ///< largest error [share]; unset: none
  std::optional<bool> holds = {};  ///< whether a condition on the network alone holds; unset: no condition
  std::string note = {};

  double error_to_closed_form() const;  ///< [share]; NaN if a value is unknown
  double error_to_paper() const;        ///< [share]; NaN if a value is unknown
  reports::ReportVerdict verdict()
      const;  ///< missed if an error exceeds its bound or `holds` is false; shown without bound and condition
};

/// One of the models that an experiment compares.
struct Variant {
  const char* name;
  network::Structure structure;
  bool is_pa_s;         ///< viscosity as printed, in Pa s/mm
  const char* reading;  ///< unit of the viscosity, for the page; empty: the model has none
};
/// "CTPM, kPa s".
std::string full_name(const Variant& variant);
/// Gives the scene's first organ the variant's structure and viscosity.
void use_variant(scenes::SceneSpec& scene, const Variant& variant);

/// The result of one experiment.
struct Experiment {
  reports::Section section;
  std::vector<Claim> claims;
};

/// Table 1, Figs. 5 and 6: C of the rig pressed to 2, 4, ... 12 mm and held, three organs, TPM and CTPM.
Result<Experiment> run_table_1(const std::string& scenes);

/// Fig. 7: C of the rig pressed at 2 mm/s to 4 mm and held; three organs, both units of the viscosity.
Result<Experiment> run_relaxation(const std::string& scenes);

/// Fig. 8: 0.196 N and 0.98 N on C of the liver's rig for 33 s, both units of the viscosity.
Result<Experiment> run_creep(const std::string& scenes);

/// Figs. 9 to 11: 0.13 N on one surface sphere of a liver block, four structures, both units of the viscosity. Without
/// `with_pictures` nothing is drawn.
Result<Experiment> run_load(const std::string& scenes, bool with_pictures);

/// Figs. 12 to 14: a kidney is cut, and four points beside the cut are tracked from 1 s to 8 s after it.
Result<Experiment> run_cut(const std::string& scenes, bool with_pictures);

/// One filling of an organ.
struct SagOfFilling {
  double radius = 0;  ///< of its spheres [mm]
  std::size_t spheres = 0;
  double sag = 0;  ///< mean static displacement under gravity, downwards [mm]
};
/// The same organ filled with r, r/2 and r/4.
struct Refinement {
  std::vector<SagOfFilling> fillings = {};

  double shrinkage() const;  ///< |second change / first change|; converges if below 1
  double order() const;      ///< observed order of convergence, from the shrinkage
  double limit() const;      ///< extrapolated sag [mm] (Richardson)
};
/// Fills the scene's organ three times and settles each filling. Errors: those of the mesh; a filling does not settle.
Result<Refinement> refine(const loading::LoadedScene& scene, const Variant& variant);

/// The same organ with finer and finer fillings: a block in all four structures, and the shipped liver.
Result<Experiment> run_convergence(const std::string& scenes);

/// All experiments, in the paper's order.
struct PaperResults {
  std::vector<reports::Section> sections;
  std::vector<Claim> claims;
};
/// Runs all experiments, the long ones with two threads. Errors: those of the scenes; a run that diverged.
Result<PaperResults> run_paper_experiments(const std::string& scenes,
                                           const std::function<void(std::int64_t done, std::int64_t total)>& progress);

/// Writes report.html, results.json (all claims, and the points of every plot) and results.csv (all claims)
/// into a folder.
Result<Done> write_paper_report(const std::string& folder, const PaperResults& results);

/// A sphere's response to a constant load.
struct StepResponse {
  double rest = 0;           ///< final value [unit of the series]: mean of the last quarter
  double overshoot = 0;      ///< largest excess over rest [share of rest]
  int reversals = 0;         ///< reversals of direction by more than 0.1 % of rest
  double settling_time = 0;  ///< after which it stays within 5 % of rest [s]
};
StepResponse step_response_of(const reports::Series& series);

/// All claims as one table, for the page, results.json and results.csv.
reports::Table claims_table(const std::vector<Claim>& claims);

/// Loads a scene of an experiment by its path within the folder of the shipped scenes. Errors: those of the
/// scene; too few spheres for the rig of Fig. 3; no load, probe or tool where the experiment uses one.
Result<loading::LoadedScene> load_experiment(const std::string& scenes, const std::string& name);

/// The errors in the scenes of all experiments; empty if there are none.
Errors check_experiments(const std::string& scenes);

}  // namespace ctpm::paper
