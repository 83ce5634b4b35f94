#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "scenes/scene_spec.h"
#include "studio/loading/loaded_scene.h"
#include "studio/paper/claims.h"
#include "studio/paper/variants.h"
#include "studio/reports/report.h"

// The experiments of Bao & Wu, run on the sphere network. Each takes the folder of the shipped scenes, runs some of
// them, and compares the network's results with the closed forms and with the paper's printed values.
namespace ctpm::paper {

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

/// Figs. 9 to 11: 0.13 N on one surface sphere of a liver block, four structures and a mass-spring network with
/// dashpots, both units of the viscosity, one integrator. Without `with_pictures` nothing is drawn.
Result<Experiment> run_load(const std::string& scenes, bool with_pictures);

/// Figs. 12 to 14: a kidney at rest is cut, with and without tension in its capsule, and four points beside the cut are
/// tracked from 1 s to 8 s after it; one integrator.
Result<Experiment> run_cut(const std::string& scenes, bool with_pictures);

/// One filling of an organ.
struct SagOfFilling {
  double radius = 0;  ///< of its spheres [mm]
  std::size_t spheres = 0;
  double sag = 0;   ///< mean static displacement of the tissue that gravity makes, downwards [mm]
  double held = 0;  ///< height of the highest sphere that is held [mm]
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

/// Writes report.html, results.json (counts, all claims, and the points of every plot) and results.csv (all claims)
/// into a folder.
Result<Done> write_paper_report(const std::string& folder, const PaperResults& results);

/// A sphere's response to a constant load. A swing goes from one reversal of direction to the next.
struct StepResponse {
  double overshoot = 0;      ///< largest excess over rest [share of rest]
  int reversals = 0;         ///< reversals of direction by more than 0.1 % of rest
  double late_swing = 0;     ///< largest swing that ends in the second half of the series [share of rest]; 0: none
  double settling_time = 0;  ///< after which it stays within 5 % of rest [s]
};
/// `rest`: the static value [unit of the series], which a creeping sphere may not have reached at the end.
StepResponse step_response_of(const reports::Series& series, double rest);

/// Loads a scene of an experiment by its path within the folder of the shipped scenes. Errors: those of the
/// scene; too few spheres for the rig of Fig. 3; no load, probe or tool where the experiment uses one.
Result<loading::LoadedScene> load_experiment(const std::string& scenes, const std::string& name);

/// The errors in the scenes of all experiments; empty if there are none.
Errors check_experiments(const std::string& scenes);

}  // namespace ctpm::paper
