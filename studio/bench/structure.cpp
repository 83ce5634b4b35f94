// The four structures on the paper's rig, against the closed forms and the paper's table.

#include <cmath>
#include <ctime>

#include "studio/bench/bench.h"
#include "studio/rig/press_rig.h"
#include "studio/rig/site.h"

namespace ctpm::bench {
namespace {

struct Kind {
  const char* name;
  network::Structure structure;
  int colour;
};
constexpr Kind kKinds[] = {{"mass-spring", network::Structure::mass_spring, 1},
                           {"angle-mass-spring", network::Structure::angle_mass_spring, 2},
                           {"tpm", network::Structure::tpm, 4},
                           {"ctpm", network::Structure::ctpm, 0}};

/// Root mean square of `got` over `wanted` minus 1.
double relative_error(const std::vector<double>& got, const std::vector<double>& wanted) {
  double sum = 0;
  for (std::size_t i = 0; i < got.size(); ++i) sum += (got[i] / wanted[i] - 1) * (got[i] / wanted[i] - 1);
  return std::sqrt(sum / double(got.size()));
}

struct OrganResult {
  reports::Plot plot;
  std::vector<std::vector<reports::Cell>> rows, points;
};

Result<OrganResult> press_organ(const std::string& shipped, const std::string& organ) {
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(shipped + "/paper/rig-" + organ + ".json");
  if (!scene) return scene.errors();
  const std::vector<rig::PrintedRow>& printed = rig::printed_table(organ);
  const rig::Site site = rig::site_of(scene->scene.spec.organs[0]);
  std::vector<double> depths, closed, paper;
  for (const rig::PrintedRow& row : printed)
    depths.push_back(row.depth), closed.push_back(rig::table_force(site, row.depth, true)), paper.push_back(row.ctpm);
  OrganResult result;
  result.plot = {.title = organ + ": force at rest", .x_title = "depth of C [mm]", .y_title = "force [N]"};
  result.plot.series.push_back(
      {.name = "closed form, CTPM", .x = depths, .y = closed, .stroke = reports::Stroke::dashed, .colour = 6});
  result.plot.series.push_back(
      {.name = "paper's Table 1, CTPM", .x = depths, .y = paper, .stroke = reports::Stroke::crosses, .colour = 6});
  for (const Kind& kind : kKinds) {
    const Result<scenes::BuiltScene> built =
        loading::build_changed(*scene, [&](scenes::SceneSpec& spec) { spec.organs[0].structure = kind.structure; });
    if (!built) return built.errors();
    const std::clock_t start = std::clock();
    const Result<std::vector<double>> force = rig::press_rig(built->model, scene->path, printed);
    if (!force) return force.errors();
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
    const double off_closed = relative_error(*force, closed), off_paper = relative_error(*force, paper);
    result.plot.series.push_back({.name = kind.name, .x = depths, .y = *force, .colour = kind.colour});
    result.rows.push_back({organ, std::string(kind.name), force->back(), closed.back(), paper.back(), 100 * off_closed,
                           100 * off_paper, seconds});
    result.points.push_back({std::string("structure"), "rig " + organ, std::string(kind.name), reports::Cell(),
                             reports::Cell(), reports::Cell(), reports::Cell(), reports::Cell(),
                             std::int64_t(built->model.sphere_count()), reports::Cell(), off_closed, reports::Cell(),
                             reports::Cell(), reports::Cell(), reports::Cell(), reports::Cell(), reports::Cell(),
                             reports::Cell()});
  }
  return result;
}

}  // namespace

Result<BenchStudy> run_bench_structure(const BenchOptions& options, const BenchProgress& progress) {
  BenchStudy study;
  reports::Section& section = study.section;
  section.key = "structure", section.title = "Structure: four models on the paper's rig";
  study.points = bench_layout();
  reports::Table table;
  table.columns = {{"organ", "organ"},
                   {"model", "model"},
                   {"force_12mm_n", "force at 12 mm [N]"},
                   {"closed_12mm_n", "closed form, CTPM [N]"},
                   {"paper_12mm_n", "paper, CTPM [N]"},
                   {"off_closed_percent", "off the closed form [%]", 3},
                   {"off_paper_percent", "off the paper [%]", 3},
                   {"run_time_s", "processor time [s]", 3}};
  const std::vector<std::string> organs =
      options.is_quick ? std::vector<std::string>{"liver"} : std::vector<std::string>{"skin", "kidney", "liver"};
  std::int64_t done = 0;
  for (const std::string& organ : organs) {
    Result<OrganResult> result = press_organ(options.shipped, organ);
    if (!result) return result.errors();
    section.plots.push_back(result->plot);
    table.rows.insert(table.rows.end(), result->rows.begin(), result->rows.end());
    study.points.rows.insert(study.points.rows.end(), result->points.begin(), result->points.end());
    progress(++done, std::int64_t(organs.size()));
  }
  section.paragraphs = {
      "The same spheres and moduli, joined in four ways; C is pressed to 2, 4, ... 12 mm and held until "
      "nothing moves. The "
      "errors are root mean squares over the six depths, relative, from the closed form of the CTPM and from "
      "what the "
      "paper prints; the paper itself scatters by up to 39 % around its closed form. Only the CTPM has the "
      "constraint "
      "(Eq. 2) and the softening (Eq. 8) that the closed form describes."};
  section.tables = {table};
  return study;
}

}  // namespace ctpm::bench
