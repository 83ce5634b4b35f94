#include "studio/cohort/stroke_part.h"

#include <algorithm>
#include <cmath>

#include "studio/output/number_text.h"

namespace ctpm::cohort {
namespace {

using output::short_number;

constexpr int kExpertColour = 0, kTraineeColour = 1;
constexpr double kMillimetres = 1e3;
constexpr double kForceRounding = 0.01, kPlaceRounding = 0.5e-3;  // of what is called outside the band [N], [m]

/// A quantity along the stroke, as it is told.
struct Told {
  const char* what;
  const char* unit;
  double scale, rounding;
  const StrokeBand& band;
};

Told told(const TaskResult& task, bool is_of_force) {
  if (is_of_force) return {"the force is above the experts' band", "N", 1, kForceRounding, task.force};
  return {"the tool is farther from the experts' way than they are", "mm", kMillimetres, kPlaceRounding,
          task.deviation};
}

/// Two are equally far from their middle.
bool has_spread(const TaskResult& task, bool is_of_force) { return is_of_force || task.experts.size() > 2; }

std::string text_of(const TaskResult& task, const StrokeMoment& moment) {
  const StrokeExcess& excess = moment.excess;
  const Told what = told(task, moment.is_of_force);
  const auto value = [&](double of) { return short_number(what.scale * of, 3) + " " + what.unit; };
  // A mean below what counts at all is told as that, not with the digits of its rounding.
  const std::string mean =
      std::abs(what.scale * excess.mean) < 1e-6 ? std::string("0 ") + what.unit : value(excess.mean);
  const std::string worst = std::to_string(excess.worst);
  const std::string where = excess.from == excess.to ? "At " + worst + " % of the way "
                                                     : "Between " + std::to_string(excess.from) + " and " +
                                                           std::to_string(excess.to) + " % of the way ";
  const std::string spread = !has_spread(task, moment.is_of_force) ? "two experts have no spread of it"
                             : excess.deviation < what.rounding    ? "their spread is below " + value(what.rounding)
                                                                   : "their spread " + value(excess.deviation);
  return where + what.what + ": " + value(excess.value) + " at " + worst + " %, the experts' mean there is " + mean +
         ", " + spread + ".";
}

reports::Series along(const std::string& name, const std::vector<double>& values, double scale, reports::Stroke stroke,
                      int colour) {
  reports::Series series{.name = name, .stroke = stroke, .colour = colour};
  for (std::size_t i = 0; i < values.size(); ++i) series.x.push_back(double(i)), series.y.push_back(scale * values[i]);
  return series;
}

std::string place_of(const std::string& part, std::size_t number) { return part + "-moment-" + std::to_string(number); }

/// A quantity along the stroke: the latest attempt over the experts' band.
reports::Plot stroke_plot(const TaskResult& task, bool is_of_force, const std::vector<double>& latest,
                          const std::vector<StrokeMoment>& moments, const std::string& part) {
  const Told what = told(task, is_of_force);
  const StrokeBand& band = what.band;
  std::vector<double> high, low;
  for (std::size_t i = 0; i < kStrokePlaces; ++i) {
    high.push_back(band.high(i));
    low.push_back(std::max(0.0, band.mean[i] - StrokeBand::kOutside * band.deviation[i]));
  }
  reports::Plot plot{.title = is_of_force ? "Force along the stroke" : "Distance from the experts' way",
                     .x_title = "way [%]",
                     .y_title = is_of_force ? "force [N]" : "distance [mm]"};
  plot.series = {along("experts' mean", band.mean, what.scale, reports::Stroke::line, kExpertColour)};
  if (has_spread(task, is_of_force)) {
    plot.series.push_back(along("mean and two spreads", high, what.scale, reports::Stroke::dashed, kExpertColour));
    plot.series.push_back(along("", low, what.scale, reports::Stroke::dashed, kExpertColour));
  }
  plot.series.push_back(along("latest attempt", latest, what.scale, reports::Stroke::line, kTraineeColour));
  for (std::size_t i = 0; i < moments.size(); ++i)
    if (moments[i].is_of_force == is_of_force)
      plot.events.push_back({double(moments[i].excess.worst), std::to_string(i + 1), moments[i].text,
                             part.empty() ? "" : "#" + place_of(part, i + 1)});
  return plot;
}

/// How far the latest attempt is from the experts' way where it or they work; 0 on the way through the air.
std::vector<double> distance_at_work(const TaskResult& task, const Attempt& latest) {
  std::vector<double> distance = distance_from(task.middle, latest.curve);
  for (std::size_t i = 0; i < distance.size(); ++i)
    if (!(std::max(task.force.mean[i], latest.curve.force[i]) > kForceRounding)) distance[i] = 0;
  return distance;
}

}  // namespace

std::vector<StrokeMoment> moments_of(const TaskResult& task, const Attempt& latest) {
  std::vector<StrokeMoment> moments;
  for (const bool is_of_force : {true, false}) {
    const Told what = told(task, is_of_force);
    const StrokeExcess excess =
        excess_of(is_of_force ? latest.curve.force : distance_at_work(task, latest), what.band, what.rounding);
    if (!excess.any) continue;
    moments.push_back({is_of_force, excess, "", latest.curve.time[excess.worst],
                       task.experts[task.middle_expert].curve.time[excess.worst]});
    moments.back().text = text_of(task, moments.back());
  }
  return moments;
}

Result<Done> add_stroke(reports::Report& report, const std::string& part, const TaskResult& task, const Attempt& latest,
                        const MomentArtist& draw) {
  const std::vector<StrokeMoment> moments = moments_of(task, latest);
  std::vector<std::array<double, 2>> times;
  for (const StrokeMoment& moment : moments) times.push_back({moment.trainee_s, moment.expert_s});
  const std::string& expert = task.experts[task.middle_expert].session.file;
  const std::vector<compare::MomentPictures> drawn =
      draw && !times.empty() ? draw(latest.session.file, expert, times) : std::vector<compare::MomentPictures>();
  std::vector<reports::Picture> pictures;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    pictures.push_back(
        {drawn[i].trainee,
         std::to_string(i + 1) + ". " + output::fixed(moments[i].trainee_s, 2) + " s: " + moments[i].text,
         place_of(part, i + 1)});
    pictures.push_back(
        {drawn[i].expert, "The middle expert at the same place, at " + output::fixed(moments[i].expert_s, 2) + " s"});
  }
  if (!pictures.empty())
    if (Result<Done> added = report.add_pictures(pictures); !added) return added;
  const std::string linked = drawn.empty() ? "" : part;
  report.add_plots({stroke_plot(task, true, latest.curve.force, moments, linked),
                    stroke_plot(task, false, distance_from(task.middle, latest.curve), moments, linked)});
  return Done{};
}

}  // namespace ctpm::cohort
