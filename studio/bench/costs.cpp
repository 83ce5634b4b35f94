// The errors of all studies of one organ in one diagram: where a millisecond is spent best.

#include <algorithm>
#include <cmath>
#include <iterator>

#include "studio/bench/bench.h"
#include "studio/output/number_text.h"

namespace ctpm::bench {
namespace {

/// One line for each kind of error; marks where the scene's own choice is.
reports::Plot diagram(const std::vector<CostPoint>& points) {
  reports::Plot plot{.title = "error in force against the cost of a tick",
                     .x_title = "processor time [ms a tick, p50]",
                     .y_title = "error in force [%]"};
  plot.is_log_x = plot.is_log_y = true;
  reports::Series own{.name = "the scene's own choice", .stroke = reports::Stroke::marks, .colour = 1};
  for (const CostPoint& p : points) {
    auto it = std::find_if(plot.series.begin(), plot.series.end(),
                           [&](const reports::Series& series) { return series.name == p.kind; });
    if (it == plot.series.end()) {
      reports::Series series{.name = p.kind};
      // Structures are no refinements of each other.
      if (p.kind == "structure") series.stroke = reports::Stroke::crosses;
      it = plot.series.insert(plot.series.end(), series);
    }
    it->x.push_back(p.tick_ms), it->y.push_back(100 * p.force_error);
    if (p.is_own) own.x.push_back(p.tick_ms), own.y.push_back(100 * p.force_error);
  }
  plot.series.push_back(own);
  return plot;
}

/// The errors of the scene's own choices, the largest first: that is where more time buys most.
std::string sentence_of(const std::string& organ, const std::vector<CostPoint>& points,
                        const std::vector<LeftOut>& left_out) {
  std::vector<CostPoint> own;
  for (const CostPoint& p : points)
    if (p.is_own) own.push_back(p);
  std::sort(own.begin(), own.end(),
            [](const CostPoint& a, const CostPoint& b) { return a.force_error > b.force_error; });
  std::string text = organ + ": as the scene is, its force is off by ";
  for (std::size_t i = 0; i < own.size(); ++i)
    text += (i == 0 ? "" : ", ") + percent(own[i].force_error) + " by " + own[i].kind + " (" + own[i].name + ")";
  if (own.empty()) text = organ + ": no study converged at the scene's own choice";
  for (const LeftOut& out : left_out) text += "; by " + out.kind + " it cannot be told: " + out.why;
  return text + (own.size() > 1 && left_out.empty() ? "; more time buys most where that is most." : ".");
}

}  // namespace

std::vector<BenchStudy> compare_costs(const std::vector<BenchStudy>& studies) {
  std::vector<std::string> organs;
  std::vector<CostPoint> all;
  for (const BenchStudy& study : studies) all.insert(all.end(), study.costs.begin(), study.costs.end());
  for (const CostPoint& p : all)
    if (std::find(organs.begin(), organs.end(), p.organ) == organs.end()) organs.push_back(p.organ);
  std::vector<BenchStudy> compared;
  for (const std::string& organ : organs) {
    std::vector<CostPoint> points;
    std::copy_if(all.begin(), all.end(), std::back_inserter(points),
                 [&](const CostPoint& p) { return p.organ == organ; });
    std::vector<LeftOut> left_out;
    for (const BenchStudy& study : studies)
      std::copy_if(study.left_out.begin(), study.left_out.end(), std::back_inserter(left_out),
                   [&](const LeftOut& out) { return out.organ == organ; });
    BenchStudy study;
    study.points = bench_layout();
    study.section.key = "costs", study.section.title = "Where a millisecond buys most: " + organ;
    study.sentences = {sentence_of(organ, points, left_out)};
    study.section.paragraphs = {
        "Each line changes one choice and leaves the others as the scene has them: the integrator and its substeps "
        "(against fine steps), the radius (against fine spheres), the structure (against the CTPM on the same "
        "spheres), "
        "and the turn of the lattice under the organ (scatter of the force at rest). Errors in time are those of a "
        "press and release, in space and of structures those of a press that stays.",
        study.sentences[0]};
    study.section.plots = {diagram(points)};
    compared.push_back(std::move(study));
  }
  return compared;
}

}  // namespace ctpm::bench
