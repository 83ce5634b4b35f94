// What the choice of the structure and the place of the lattice change in an organ's force, beside what a tick costs.

#include <algorithm>
#include <cmath>

#include "core/model/nearest_rank.h"
#include "studio/bench/press.h"
#include "studio/fidelity/recipes.h"
#include "studio/fidelity/scene.h"
#include "studio/output/number_text.h"

namespace ctpm::bench {
namespace {

struct Kind {
  const char* name;
  network::Structure structure;
};
constexpr Kind kKinds[] = {{"mass-spring", network::Structure::mass_spring},
                           {"angle-mass-spring", network::Structure::angle_mass_spring},
                           {"tpm", network::Structure::tpm}};

/// The other structures of the scene's own filling, against the CTPM.
Result<Done> compare_structures(const loading::LoadedScene& own, const std::string& name, BenchStudy& study) {
  const Result<loading::LoadedScene> scene = load_refilled(own, 1);
  if (!scene) return scene.errors();
  const Result<PressedOrgan> ctpm = press_organ(*scene, scene->built.model);
  if (!ctpm) return ctpm.errors();
  reports::Table& table = study.section.tables[0];
  for (const Kind& kind : kKinds) {
    const Result<scenes::BuiltScene> built =
        loading::build_changed(*scene, [&](scenes::SceneSpec& spec) { spec.organs[0].structure = kind.structure; });
    if (!built) return built.errors();
    const Result<PressedOrgan> organ = press_organ(*scene, built->model);
    if (!organ) return organ.errors();
    const double off = force_error(organ->run, ctpm->run), p50 = 1e3 * percentile(organ->run.seconds, 0.5);
    table.rows.push_back(
        {std::string("structure"), std::string(kind.name), 1e3 * organ->radius, organ->spheres, 100 * off, p50});
    study.points.rows.push_back(
        row_of("organ structure", name, kind.name, *organ, own.built.model.tick, reports::Cell(), off));
    study.costs.push_back({name, "structure", kind.name, p50, off, false});
  }
  return Done{};
}

/// How much the force on the same place scatters as the lattice is turned, at the scene's own and coarser radii.
Result<Done> compare_phases(const loading::LoadedScene& own, const std::string& name, bool is_quick, BenchStudy& study,
                            const std::function<void()>& advance) {
  const Result<fidelity::SceneOrgan> organ = fidelity::read_scene_organ(own.path, {});
  if (!organ) return organ.errors();
  std::vector<Quat> turns = fidelity::twelve_turns();
  if (is_quick) turns.resize(fidelity::kQuickTurns);
  for (const int coarser : {2, 1, 0}) {
    const double factor = std::pow(kRefinement, coarser);
    fidelity::SceneOrgan filled = *organ;
    scenes::FillSpec& fill = filled.scene.organs[0].fill;
    fill.radius *= factor, fill.gap *= factor;
    const Result<fidelity::SceneResult> turned = fidelity::measure_scene_turns(filled, turns);
    if (!turned && coarser > 0) {
      study.section.paragraphs.push_back(left_out_sentence(own, factor, turned.errors()));
      advance();
      continue;
    }
    if (!turned) return turned.errors();
    const Result<loading::LoadedScene> scene = load_refilled(own, factor);
    if (!scene) return scene.errors();
    const Result<PressedOrgan> pressed = press_organ(*scene, scene->built.model);
    if (!pressed) return pressed.errors();
    const double scatter = fidelity::spread_of(turned->turns.back().forces).deviation;
    const double p50 = 1e3 * percentile(pressed->run.seconds, 0.5);
    study.section.tables[0].rows.push_back({std::string("lattice phase"), std::to_string(turns.size()) + " turns",
                                            1e3 * pressed->radius, pressed->spheres, 100 * scatter, p50});
    study.points.rows.push_back(
        row_of("lattice phase", name, "ctpm", *pressed, own.built.model.tick, reports::Cell(), scatter));
    study.costs.push_back({name, "lattice phase", "r = " + output::short_number(1e3 * pressed->radius, 3) + " mm", p50,
                           scatter, coarser == 0});
    advance();
  }
  return Done{};
}

}  // namespace

Result<std::vector<BenchStudy>> run_bench_organ(const BenchOptions& options, const BenchProgress& progress) {
  std::vector<BenchStudy> studies;
  const std::vector<std::string> paths = scenes_of(options);
  std::int64_t done = 0;
  const auto advance = [&] { progress(++done, 4 * std::int64_t(paths.size())); };
  for (const std::string& path : paths) {
    const Result<loading::LoadedScene> own = loading::load_whole_scene(path);
    if (!own) return own.errors();
    if (!can_press(*own)) continue;
    const std::string name = own->scene.spec.organs[0].name;
    BenchStudy study;
    study.section.key = "organ", study.section.title = "Structure and lattice phase: " + name;
    study.section.paragraphs = {
        "How far the force of other structures on the same spheres is from the CTPM's, in the press of the study in "
        "space (relative L2 difference); and by how much the force at rest scatters when the lattice is turned under "
        "the organ (standard deviation over the mean, at the deepest press of `ctpm fidelity`)."};
    study.points = bench_layout();
    study.section.tables.emplace_back().columns = {{"what", "what"},
                                                   {"which", "which"},
                                                   {"radius_mm", "r [mm]", 3},
                                                   {"spheres", "spheres"},
                                                   {"force_percent", "in force [%]", 3},
                                                   {"tick_p50_ms", "tick p50 [ms]", 3}};
    if (const Result<Done> compared = compare_structures(*own, name, study); !compared) return compared.errors();
    advance();
    if (const Result<Done> compared = compare_phases(*own, name, options.is_quick, study, advance); !compared)
      return compared.errors();
    studies.push_back(std::move(study));
  }
  return studies;
}

}  // namespace ctpm::bench
