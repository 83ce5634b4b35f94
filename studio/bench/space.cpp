// Error against run time for the sphere radius, at one tool and path.

#include <algorithm>
#include <cmath>

#include "core/model/nearest_rank.h"
#include "studio/bench/press.h"
#include "studio/output/number_text.h"

namespace ctpm::bench {
namespace {

/// One filling, and how far it is off the reference.
struct Compared {
  PressedOrgan organ;
  bool is_own = false;  ///< of the scene's own radius
  double position_error = 0, force_error = 0;
  bool feels = false, is_on_front = false;
};

/// The order of an error between two fillings that follow each other.
double order_between(double coarse, double fine) { return std::log(coarse / fine) / std::log(kRefinement); }

/// Why errors do not fall with the radius; empty if they do.
std::string why_not_converged(const std::vector<Compared>& fillings) {
  for (const auto& [name, error] :
       {std::pair{"position", &Compared::position_error}, {"force", &Compared::force_error}}) {
    std::vector<double> errors;
    for (const Compared& f : fillings) errors.push_back(f.*error);
    const auto radius = [&](std::size_t i) { return output::short_number(1e3 * fillings[i].organ.radius, 3) + " mm"; };
    if (const std::optional<std::size_t> i = first_growth(errors))
      return std::string("the error in ") + name + " grows from " + percent(errors[*i - 1]) + " at " + radius(*i - 1) +
             " to " + percent(errors[*i]) + " at " + radius(*i);
  }
  return "";
}

std::string recommendation(const std::string& name, const std::vector<Compared>& fillings, double tick,
                           const std::string& why) {
  if (!why.empty()) return name + ": the radius does not converge: " + why + ". No radius is recommended.";
  const Compared* best = nullptr;
  for (const Compared& f : fillings)
    if (f.feels && percentile(f.organ.run.seconds, 0.99) <= tick) best = &f;
  const std::string rate = output::short_number(1e-3 / tick) + " kHz";
  if (!best) return name + ": no filling holds " + rate + " at p99 on this machine.";
  const std::vector<double>& seconds = best->organ.run.seconds;
  return name + ": the finest filling that holds " + rate +
         " in this press on this machine has r = " + output::short_number(1e3 * best->organ.radius, 3) + " mm (" +
         std::to_string(best->organ.spheres) + " spheres): error " + percent(best->position_error) +
         " of the surface, " + percent(best->force_error) + " in force; ticks of " +
         output::short_number(1e3 * percentile(seconds, 0.5), 3) + " ms (p50), " +
         output::short_number(1e3 * percentile(seconds, 0.99), 3) + " ms (p99, of " + std::to_string(seconds.size()) +
         " ticks).";
}

reports::Table table_of(const std::vector<Compared>& fillings, const PressedOrgan& reference) {
  reports::Table table;
  table.columns = {{"radius_mm", "r [mm]", 3},
                   {"layers", "layers"},
                   {"spheres", "spheres"},
                   {"force_n", "force at 6 mm [N]"},
                   {"position_error", "error in position", 3},
                   {"position_order", "its order", 3},
                   {"force_error", "error in force", 3},
                   {"force_order", "its order", 3},
                   {"tick_p50_ms", "tick p50 [ms]", 3},
                   {"tick_p99_ms", "p99 [ms]", 3}};
  for (std::size_t i = 0; i < fillings.size(); ++i) {
    const Compared& f = fillings[i];
    const auto order = [&](double Compared::*error) {
      return i == 0 ? reports::Cell() : reports::Cell(order_between(fillings[i - 1].*error, f.*error));
    };
    table.rows.push_back({1e3 * f.organ.radius, f.organ.layers, f.organ.spheres, norm(f.organ.run.force.back()),
                          f.position_error, order(&Compared::position_error), f.force_error,
                          order(&Compared::force_error), 1e3 * percentile(f.organ.run.seconds, 0.5),
                          1e3 * percentile(f.organ.run.seconds, 0.99)});
  }
  table.rows.push_back({1e3 * reference.radius, reference.layers, reference.spheres, norm(reference.run.force.back()),
                        std::string("reference"), reports::Cell(), std::string("reference"), reports::Cell(),
                        1e3 * percentile(reference.run.seconds, 0.5), 1e3 * percentile(reference.run.seconds, 0.99)});
  return table;
}

reports::Plot plot_of(const std::vector<Compared>& fillings, bool over_radius) {
  reports::Plot plot{.title = over_radius ? "over the radius" : "against the reference",
                     .x_title = over_radius ? "sphere radius [mm]" : "processor time [ms a tick, p50]",
                     .y_title = "relative L2 error"};
  plot.is_log_x = plot.is_log_y = true;
  reports::Series position{.name = "surface", .colour = 0}, force{.name = "force on the ball", .colour = 1},
      front{.name = "Pareto front (surface)", .stroke = reports::Stroke::marks, .colour = 0};
  for (const Compared& f : fillings) {
    const double x = 1e3 * (over_radius ? f.organ.radius : percentile(f.organ.run.seconds, 0.5));
    position.x.push_back(x), position.y.push_back(f.position_error);
    force.x.push_back(x), force.y.push_back(f.force_error);
    if (f.is_on_front) front.x.push_back(x), front.y.push_back(f.position_error);
  }
  plot.series = {position, force};
  if (!over_radius && !front.x.empty()) plot.series.push_back(front);
  return plot;
}

Result<BenchStudy> study_of(const loading::LoadedScene& own, bool is_quick, const std::function<void()>& advance) {
  // Coarser and finer than the scene's own radius, which is among them.
  const std::vector<int> refinements = is_quick ? std::vector{-2, -1, 0} : std::vector{-2, -1, 0, 1};
  const std::string name = own.scene.spec.organs[0].name;
  const auto pressed = [&](int refinement) -> Result<PressedOrgan> {
    const Result<loading::LoadedScene> scene = load_refilled(own, std::pow(kRefinement, -refinement));
    if (!scene) return scene.errors();
    Result<PressedOrgan> organ = press_organ(*scene, scene->built.model);
    advance();
    return organ;
  };
  const Result<PressedOrgan> reference = pressed(refinements.back() + kReferenceRefinements);
  if (!reference) return reference.errors();
  Vec3Array rest;
  std::vector<Compared> fillings;
  std::vector<std::string> too_coarse;
  std::vector<double> cost, errors;
  for (const int refinement : refinements) {
    Result<PressedOrgan> organ = pressed(refinement);
    if (!organ && refinement < 0) {
      too_coarse.push_back(left_out_sentence(own, std::pow(kRefinement, -refinement), organ.errors()));
      advance();
      continue;
    }
    if (!organ) return organ.errors();
    Compared f{*std::move(organ), refinement == 0};
    // Finer fillings divide long triangles: the vertices of the first, the coarsest, are the first of all.
    for (std::size_t v = rest.size(); fillings.empty() && v < f.organ.run.position.front().size(); ++v)
      rest.push_back(own.organs[0].surface.vertex[v]);
    f.position_error = position_error(f.organ.run, reference->run, rest);
    f.force_error = force_error(f.organ.run, reference->run), f.feels = feels(f.organ.run);
    cost.push_back(percentile(f.organ.run.seconds, 0.5)), errors.push_back(f.feels ? f.position_error : INFINITY);
    fillings.push_back(std::move(f));
  }
  const std::string why = why_not_converged(fillings);
  if (why.empty())
    for (const std::size_t i : pareto_front(cost, errors)) fillings[i].is_on_front = true;
  const double tick = own.built.model.tick;
  BenchStudy study;
  study.section.key = "space", study.section.title = "Space: " + name + ", press, sphere radius";
  study.points = bench_layout();
  for (const Compared& f : fillings) {
    study.points.rows.push_back(row_of("space", name, "ctpm", f.organ, tick, f.position_error, f.force_error));
    if (f.is_on_front) study.points.rows.back().back() = std::string("front");
    if (why.empty() && f.feels)
      study.costs.push_back({name, "space", "r = " + output::short_number(1e3 * f.organ.radius, 3) + " mm",
                             1e3 * percentile(f.organ.run.seconds, 0.5), f.force_error, f.is_own});
  }
  if (!why.empty()) study.left_out.push_back({name, "space", why});
  study.section.plots = {plot_of(fillings, false), plot_of(fillings, true)};
  study.section.tables = {table_of(fillings, *reference)};
  study.sentences = {recommendation(name, fillings, tick, why)};
  study.section.paragraphs = {
      "A ball comes down 6 mm on the highest point of the surface at 60 mm/s and stays, whatever the filling; contacts "
      "are as stiff as those of the scene's own filling. Errors are relative differences in L2 over time of the drawn "
      "surface's vertices and of the force on the ball, from a filling of r = " +
          output::short_number(1e3 * reference->radius, 3) + " mm, " + std::to_string(kReferenceRefinements) +
          " refinements finer than the finest that is compared; orders are those of each row and the one above it.",
      study.sentences[0]};
  for (const std::string& sentence : too_coarse) study.section.paragraphs.push_back(sentence);
  return study;
}

}  // namespace

Result<std::vector<BenchStudy>> run_bench_space(const BenchOptions& options, const BenchProgress& progress) {
  std::vector<BenchStudy> studies;
  const std::vector<std::string> paths = scenes_of(options);
  std::int64_t done = 0;
  const std::int64_t each = options.is_quick ? 4 : 5;
  for (const std::string& path : paths) {
    const Result<loading::LoadedScene> own = loading::load_whole_scene(path);
    if (!own) return own.errors();
    if (!can_press(*own)) continue;
    Result<BenchStudy> study =
        study_of(*own, options.is_quick, [&] { progress(++done, each * std::int64_t(paths.size())); });
    if (!study) return study.errors();
    studies.push_back(*std::move(study));
  }
  return studies;
}

}  // namespace ctpm::bench
