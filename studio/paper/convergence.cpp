// The same organ filled with r, r/2 and r/4: its sag under its own weight, and the order of convergence.

#include <algorithm>
#include <cmath>
#include <future>

#include "core/model/errors.h"
#include "studio/output/number_text.h"
#include "studio/paper/paper.h"

namespace ctpm::paper {
namespace {

constexpr Variant kVariants[] = {{"mass-spring", network::Structure::mass_spring, false, ""},
                                 {"angle mass-spring", network::Structure::angle_mass_spring, false, ""},
                                 {"TPM", network::Structure::tpm, false, "", kTpmStiffness},
                                 {"CTPM", network::Structure::ctpm, false, ""}};

/// Mean downward displacement of the tissue [mm]: each sphere counts as the tissue that it stands for, which at a
/// mesh's surface is the less the more of its cell lies outside.
double mean_sag(const Model& model, const State& state) {
  double sum = 0, mass = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    sum += model.mass[i] * (model.rest_position.z[i] - state.position.z[i]), mass += model.mass[i];
  return 1e3 * sum / mass;
}

/// How far gravity lets the spheres sink in the mean [mm]: what tension does to the unloaded organ is no sag.
Result<double> sag_of(const Model& model, const std::string& name) {
  const auto sag = [&](const State& state) { return mean_sag(model, state); };
  Model weightless = model;
  weightless.gravity = {};
  const Result<double> unloaded = at_rest(std::move(weightless), name, sag);
  if (!unloaded) return unloaded.errors();
  const Result<double> loaded = at_rest(model, name, sag);
  if (!loaded) return loaded.errors();
  return *loaded - *unloaded;
}

/// Height of the highest sphere that is held [mm].
double held_up_to(const Model& model) {
  double highest = -INFINITY;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.held_axes[i] == kAnchored) highest = std::max(highest, model.rest_position.z[i]);
  return 1e3 * highest;
}

/// The organ of a scene. Of a mesh, one layer of spheres lies where the scene's first anchor ends, so that finer and
/// coarser fillings are held up to the same height: otherwise they are not the same solid on the same foot. The
/// lattices of a rig's block lie in each other.
Result<FilledOrgan> fill_alike(const std::string& scene_path, const scenes::OrganSpec& organ) {
  Result<importers::ImportedOrgan> filled = loading::fill_of(scene_path, organ);
  if (!filled) return filled.errors();
  if (organ.rig || organ.anchors.empty() || !organ.anchors[0].lowest) return std::move(filled->organ);
  double end = INFINITY;
  for (const Vec3& p : filled->organ.surface.vertex) end = std::min(end, p.z + *organ.anchors[0].lowest);
  const double away = (end - filled->organ.centre.front().z) / filled->organ.spacing;
  Result<importers::ImportedOrgan> moved = loading::fill_of(scene_path, organ, {}, {0, 0, away - std::round(away)});
  if (!moved) return moved.errors();
  return std::move(moved->organ);
}

/// Divides the organ's sphere radius and gap by `finer`.
void fill_finer(scenes::OrganSpec& organ, int finer) {
  organ.fill.radius /= finer, organ.fill.gap /= finer;
  if (organ.rig && organ.rig->block) organ.rig->block = double(finer) * *organ.rig->block;
}

reports::Table fillings_layout() {
  reports::Table table;
  table.title = "Mean sag under gravity";
  table.columns = {{"organ", "organ"},
                   {"model", "model"},
                   {"radius_mm", "sphere radius [mm]"},
                   {"spheres", "spheres"},
                   {"sag_mm", "mean sag [mm]", 4},
                   {"change_percent", "change by the halving [%]", 3}};
  return table;
}

void add_fillings(Experiment& experiment, const std::string& organ, const Variant& variant, const Refinement& refined) {
  for (std::size_t i = 0; i < refined.fillings.size(); ++i) {
    const SagOfFilling& f = refined.fillings[i];
    experiment.section.tables[0].rows.push_back(
        {organ, std::string(variant.name), f.radius, std::int64_t(f.spheres), f.sag,
         i == 0 ? reports::Cell() : reports::Cell(100 * (f.sag / refined.fillings[i - 1].sag - 1))});
  }
  Claim claim{.kind = ClaimKind::convergence,
              .experiment = "convergence",
              .organ = organ,
              .structure = variant.name,
              .quantity = "observed order of r, r/2, r/4"};
  claim.network = refined.order();
  // An order of one half: each halving changes the sag by less than 0.71 times the change before.
  claim.holds = refined.shrinkage() < std::sqrt(0.5);
  claim.note = std::string(*claim.holds ? "it converges" : "it does not converge") + "; limit " +
               output::short_number(refined.limit()) + " mm";
  experiment.claims.push_back(claim);
}

reports::Plot sag_plot(const std::vector<Refinement>& refined) {
  reports::Plot plot{.title = "mean sag of the block against its spheres",
                     .x_title = "sphere radius [mm]",
                     .y_title = "mean sag [mm]"};
  for (std::size_t i = 0; i < refined.size(); ++i) {
    reports::Series series{.name = kVariants[i].name, .stroke = reports::Stroke::path, .colour = int(i)};
    for (const SagOfFilling& f : refined[i].fillings) series.x.push_back(f.radius), series.y.push_back(f.sag);
    reports::Series limit{.x = {0}, .y = {refined[i].limit()}, .stroke = reports::Stroke::crosses, .colour = int(i)};
    plot.series.push_back(series), plot.series.push_back(limit);
  }
  plot.x_range = {-0.1, 4.2};
  plot.caption = "Crosses: the limit that the three fillings point to.";
  return plot;
}

}  // namespace

double Refinement::shrinkage() const {
  return std::abs((fillings[2].sag - fillings[1].sag) / (fillings[1].sag - fillings[0].sag));
}
double Refinement::order() const { return -std::log2(shrinkage()); }
double Refinement::limit() const {
  const double ratio = (fillings[2].sag - fillings[1].sag) / (fillings[1].sag - fillings[0].sag);
  return fillings[2].sag + (fillings[2].sag - fillings[1].sag) * ratio / (1 - ratio);
}

Result<Refinement> refine(const loading::LoadedScene& scene, const Variant& variant) {
  Refinement refined;
  for (const int finer : {1, 2, 4}) {
    scenes::SceneSpec spec = scene.scene.spec;
    use_variant(spec, variant);
    fill_finer(spec.organs[0], finer);
    Result<FilledOrgan> filled = fill_alike(scene.path, spec.organs[0]);
    if (!filled) return filled.errors();
    Result<scenes::BuiltScene> built = scenes::build_model(spec, {&*filled, 1});
    if (!built) return built.errors();
    const std::size_t spheres = built->model.sphere_count();
    const Result<double> sag = sag_of(built->model, scene.path);
    if (!sag) return sag.errors();
    refined.fillings.push_back({1e3 * spec.organs[0].fill.radius, spheres, *sag, held_up_to(built->model)});
  }
  return refined;
}

Result<Experiment> run_convergence(const std::string& scenes) {
  const Result<loading::LoadedScene> block = load_experiment(scenes, "paper/convergence-liver.json"),
                                     liver = load_experiment(scenes, "liver.json");
  if (!block) return block.errors();
  if (!liver) return liver.errors();
  // The liver takes longest and runs in parallel with the others.
  std::future<Result<Refinement>> other = std::async(std::launch::async, [&] { return refine(*liver, kVariants[3]); });
  std::vector<Refinement> refined;
  Errors errors;
  for (const Variant& variant : kVariants) {
    Result<Refinement> of_block = refine(*block, variant);
    if (of_block)
      refined.push_back(std::move(*of_block));
    else
      append(errors, of_block);
  }
  const Result<Refinement> of_liver = other.get();
  append(errors, of_liver);
  if (!errors.empty()) return errors;

  Experiment experiment;
  reports::Section& section = experiment.section;
  section.key = "convergence", section.title = "The same organ filled with r, r/2 and r/4";
  section.tables = {fillings_layout()};
  for (std::size_t i = 0; i < refined.size(); ++i) add_fillings(experiment, "liver block", kVariants[i], refined[i]);
  add_fillings(experiment, "liver", kVariants[3], *of_liver);
  section.plots = {sag_plot(refined)};
  section.paragraphs = {
      "A block of 96 x 96 x 72 mm and the shipped liver stand under gravity on their anchored lowest spheres, at rest. "
      "An edge's stiffness is K S0 (s / s_cal), so that a finer filling is the same solid. What is compared is how far "
      "gravity lets the tissue sink in the mean, from where the tension of the liver's capsule holds it without "
      "gravity: "
      "that tension is in balance in the shipped filling, and lifts the spheres of a finer one. In the mean a sphere "
      "counts as the tissue that it stands for, and the liver's lattices are moved in height by a part of a spacing, "
      "so "
      "that all three fillings are the same solid, held up to the same height: " +
          output::short_number(of_liver->fillings[0].held, 3) + " mm.",
      "The spheres at a free face have fewer neighbours and those at the foot are held at half a spacing above the "
      "face: both are errors of the size of a spacing, so the order is one. In CTPM the constraint and the softening "
      "fade out besides, since five spheres span less and less of a bend.",
      "All four models point to one and the same solid. The moduli of TPM are doubled for it: in TPM every edge holds "
      "a spring and a Kelvin unit one behind the other, where a triple of CTPM spreads them over two edges, so that "
      "with equal moduli TPM would be half as stiff. The factor 2 follows from that; nothing is fitted."};
  return experiment;
}

}  // namespace ctpm::paper
