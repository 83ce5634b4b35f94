#include "studio/paper/paper.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

#include "scenes/presets.h"

namespace ctpm::paper {
namespace {

/// Values within this share of the printed number count as agreeing where there is no bound.
constexpr double kAgrees = 0.10;

double share(const std::optional<double>& got, const std::optional<double>& wanted) {
  return got && wanted && *wanted != 0 ? *got / *wanted - 1 : std::nan("");
}

reports::Cell cell(const std::optional<double>& value) { return value ? reports::Cell(*value) : reports::Cell(); }
reports::Cell percent(double value) { return std::isfinite(value) ? reports::Cell(100 * value) : reports::Cell(); }

}  // namespace

double Claim::error_to_closed_form() const {
  return closed_form_error ? *closed_form_error : share(network, closed_form);
}
double Claim::error_to_paper() const { return share(network, paper); }

reports::ReportVerdict Claim::verdict() const {
  bool is_met = true;
  // A NaN error counts as missed.
  if (closed_form_bound) is_met = is_met && std::abs(error_to_closed_form()) <= *closed_form_bound;
  if (paper_bound) is_met = is_met && std::abs(error_to_paper()) <= *paper_bound;
  if (holds) is_met = is_met && *holds;
  if (!is_met) return reports::ReportVerdict::missed;
  return closed_form_bound || paper_bound || holds ? reports::ReportVerdict::met : reports::ReportVerdict::shown;
}

reports::Table claims_table(const std::vector<Claim>& claims) {
  reports::Table table;
  table.columns = {{"experiment", "experiment"},
                   {"organ", "organ"},
                   {"model", "model"},
                   {"viscosity", "viscosity"},
                   {"quantity", "quantity"},
                   {"paper", "paper"},
                   {"closed_form", "closed form"},
                   {"network", "network"},
                   {"error_to_closed_form_percent", "error to closed form [%]", 2},
                   {"bound_percent", "bound [%]", 3},
                   {"error_to_paper_percent", "error to paper [%]", 2},
                   {"paper_bound_percent", "bound [%]", 3},
                   {"verdict", "must hold"},
                   {"paper_verdict", "paper"},
                   {"note", "note"}};
  for (const Claim& c : claims) {
    const double off = c.error_to_paper();
    const char* agrees = !std::isfinite(off)                                ? ""
                         : std::abs(off) <= c.paper_bound.value_or(kAgrees) ? "agrees"
                                                                            : "differs";
    table.rows.push_back({c.experiment, c.organ, c.structure, c.viscosity, c.quantity, cell(c.paper),
                          cell(c.closed_form), cell(c.network), percent(c.error_to_closed_form()),
                          c.closed_form_bound ? percent(*c.closed_form_bound) : reports::Cell(), percent(off),
                          c.paper_bound ? percent(*c.paper_bound) : reports::Cell(), c.verdict(), std::string(agrees),
                          c.note});
  }
  return table;
}

std::string full_name(const Variant& variant) {
  return variant.name + (*variant.reading ? std::string(", ") + variant.reading : "");
}

void use_variant(scenes::SceneSpec& scene, const Variant& variant) {
  scene.organs[0].structure = variant.structure;
  if (!variant.is_pa_s) return;
  scene.organs[0].material.preset += "-pa-s";
  for (scenes::LayerSpec& layer : scene.organs[0].layers) layer.material.preset += "-pa-s";
}

namespace {

/// The parts of a scene that an experiment requires.
struct Need {
  const char* name;
  std::size_t cells, loads, probes, tools;
};
constexpr Need kNeeds[] = {{"paper/rig-skin.json", 7, 0, 0, 1},
                           {"paper/rig-kidney.json", 7, 0, 0, 1},
                           {"paper/rig-liver.json", 7, 0, 0, 1},
                           {"paper/creep-liver.json", 7, 1, 1, 0},
                           {"paper/block-liver.json", 0, 1, 1, 1},
                           {"paper/convergence-liver.json", 0, 0, 0, 0},
                           {"liver.json", 0, 0, 0, 1},
                           {"incision.json", 0, 0, 4, 1}};

}  // namespace

Result<loading::LoadedScene> load_experiment(const std::string& scenes, const std::string& name) {
  Result<loading::LoadedScene> scene = loading::load_whole_scene(scenes + "/" + name);
  if (!scene) return scene;
  const auto need = std::find_if(std::begin(kNeeds), std::end(kNeeds), [&](const Need& n) { return n.name == name; });
  CTPM_CHECK(need != std::end(kNeeds), "every experiment says what it needs");
  const scenes::SceneSpec& spec = scene->scene.spec;
  Errors errors;
  const std::size_t cells = spec.organs[0].rig ? spec.organs[0].rig->cells.size() : 0;
  if (cells < need->cells)
    errors.push_back(scene->scene.places.error_at(
        "/organs/0/rig/cells",
        "got " + std::to_string(cells) + " spheres, the rig of Fig. 3 has 7: A to E on a line, and two below C"));
  const auto check = [&](const char* key, std::size_t got, std::size_t wanted) {
    if (got < wanted)
      errors.push_back(scene->scene.places.error_at(std::string("/") + key, "the experiment needs one"));
  };
  check("loads", spec.loads.size(), need->loads), check("probes", spec.probes.size(), need->probes),
      check("tools", spec.tools.size(), need->tools);
  if (!errors.empty()) return errors;
  return scene;
}

Errors check_experiments(const std::string& scenes) {
  Errors errors;
  for (const Need& need : kNeeds)
    if (const Result<loading::LoadedScene> scene = load_experiment(scenes, need.name); !scene)
      errors.insert(errors.end(), scene.errors().begin(), scene.errors().end());
  return errors;
}

}  // namespace ctpm::paper
