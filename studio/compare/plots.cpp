#include "studio/compare/plots.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace ctpm::compare {
namespace {

constexpr double kMillimetres = 1e3;
constexpr std::size_t kCurvePoints = 1200;  // of a curve over time, more than a screen resolves
constexpr int kExpertColour = 0, kTraineeColour = 1, kNeutralColour = 6;
constexpr int kPlaneWidth = 520, kPlaneHeight = 400;
constexpr double kPlaneAspect = double(kPlaneWidth - 76) / (kPlaneHeight - 76);  // of the area within the axes

/// Resamples values over time: the largest of each run of values, so that no peak is lost.
reports::Series curve(const std::string& name, const SessionTrack& track, const std::vector<double>& value,
                      double scale, int colour) {
  reports::Series series{.name = name, .colour = colour};
  const std::size_t step = std::max<std::size_t>(1, value.size() / kCurvePoints);
  for (std::size_t i = 0; i < value.size(); i += step) {
    const auto first = value.begin() + std::ptrdiff_t(i);
    series.x.push_back(track.seconds(i));
    series.y.push_back(scale * *std::max_element(first, first + std::ptrdiff_t(std::min(step, value.size() - i))));
  }
  return series;
}

reports::Series level(const std::string& name, double from, double to, double value) {
  return {
      .name = name, .x = {from, to}, .y = {value, value}, .stroke = reports::Stroke::dashed, .colour = kNeutralColour};
}

/// The worst moments of one kind, as events of a plot over the trainee's time.
std::vector<reports::PlotEvent> events_of(const Comparison& comparison, std::initializer_list<MomentKind> kinds) {
  std::vector<reports::PlotEvent> events;
  for (std::size_t i = 0; i < std::min(kShownMoments, comparison.moments.size()); ++i) {
    const Moment& moment = comparison.moments[i];
    if (std::ranges::find(kinds, moment.kind) != kinds.end())
      events.push_back({moment.worst_s, std::to_string(i + 1), to_word(moment.kind), "#" + place_of_moment(i + 1)});
  }
  std::ranges::sort(events, {}, &reports::PlotEvent::x);
  return events;
}

/// A plane through the scene: from above, or from the side with z up.
struct Plane {
  const char* title;
  const char* x_title;
  const char* y_title;
  double Vec3::*x;
  double Vec3::*y;
};
constexpr Plane kPlanes[]{{"from above", "x [mm]", "y [mm]", &Vec3::x, &Vec3::y},
                          {"from the side", "x [mm]", "z [mm]", &Vec3::x, &Vec3::z}};

reports::Series in_plane(const std::string& name, const std::vector<Vec3>& points, const Plane& plane,
                         reports::Stroke stroke, int colour) {
  reports::Series series{.name = name, .stroke = stroke, .colour = colour};
  for (const Vec3& p : points)
    series.x.push_back(kMillimetres * p.*plane.x), series.y.push_back(kMillimetres * p.*plane.y);
  return series;
}

/// Ranges that show all points with the same scale along both axes.
void set_equal_scales(reports::Plot& plot) {
  double low[2]{INFINITY, INFINITY}, high[2]{-INFINITY, -INFINITY};
  for (const reports::Series& s : plot.series)
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      low[0] = std::min(low[0], s.x[i]), high[0] = std::max(high[0], s.x[i]);
      low[1] = std::min(low[1], s.y[i]), high[1] = std::max(high[1], s.y[i]);
    }
  const double half = 0.54 * std::max({(high[0] - low[0]) / kPlaneAspect, high[1] - low[1], 1.0});
  const double x = 0.5 * (low[0] + high[0]), y = 0.5 * (low[1] + high[1]);
  plot.x_range = {x - kPlaneAspect * half, x + kPlaneAspect * half}, plot.y_range = {y - half, y + half};
  plot.width = kPlaneWidth, plot.height = kPlaneHeight;
}

/// A path as lines in the plane, one series for each stroke, without lines between strokes.
void add_path(reports::Plot& plot, const std::string& name, const SessionTrack& track, const Plane& plane, int colour) {
  const std::size_t step = std::max<std::size_t>(1, track.tick_count() / (2 * kCurvePoints));
  bool is_first = true;
  for (const Spell& stroke : track.strokes) {
    std::vector<Vec3> points;
    for (std::size_t i = stroke.first; i < stroke.last; i += step) points.push_back(track.tip[i]);
    plot.series.push_back(in_plane(is_first ? name : "", points, plane, reports::Stroke::line, colour));
    plot.series.push_back(in_plane("", {points.front()}, plane, reports::Stroke::marks, colour));
    is_first = false;
  }
  plot.caption = "A circle is where a tool was taken.";
}

reports::Plot deviation_plot(const Comparison& comparison) {
  reports::Plot plot{.title = "Distance from the expert's path, aligned in time",
                     .x_title = "time of the trainee [s]",
                     .y_title = "distance [mm]",
                     .caption = "Beyond the dashed line the tool can be at other spheres than the expert's was."};
  reports::Series series{.name = "trainee", .colour = kTraineeColour};
  for (const AlignedPair& pair : comparison.alignment.pairs) {
    series.x.push_back(comparison.trainee_time[pair.b]);
    series.y.push_back(kMillimetres * pair.distance);
  }
  plot.events = events_of(comparison, {MomentKind::deviation});
  plot.series = {
      series, level("half a sphere spacing", 0, comparison.trainee_time.back(), kMillimetres * comparison.path_limit)};
  return plot;
}

/// The marks of three kinds of element stand side by side where elements lie behind each other.
reports::Series marks(const std::string& name, const std::vector<Vec3>& points, const Plane& plane,
                      reports::Stroke stroke, int colour, double shift) {
  reports::Series series = in_plane(name, points, plane, stroke, colour);
  series.shift = shift;
  return series;
}

}  // namespace

std::string place_of_moment(std::size_t number) { return "moment-" + std::to_string(number); }

std::vector<reports::Plot> plots_over_time(const ComparedSessions& compared) {
  const auto& [expert, trainee, scene, comparison] = compared;
  const double end = std::max(expert.seconds(expert.tick_count()), trainee.seconds(trainee.tick_count()));
  const auto is_above_zero = [](double value) { return value > 0; };
  const auto has_any = [&](const std::vector<double>& a, const std::vector<double>& b) {
    return std::any_of(a.begin(), a.end(), is_above_zero) || std::any_of(b.begin(), b.end(), is_above_zero);
  };
  std::vector<reports::Plot> plots;
  if (has_any(expert.force, trainee.force)) {
    reports::Plot plot{.title = "Force on the tool", .x_title = "time [s]", .y_title = "force [N]"};
    plot.series = {curve("expert", expert, expert.force, 1, kExpertColour),
                   curve("trainee", trainee, trainee.force, 1, kTraineeColour)};
    if (comparison.force_limit)
      plot.series.push_back(
          level(std::string("limit: ") + comparison.force_limit_from, 0, end, *comparison.force_limit));
    plot.events =
        events_of(comparison, {MomentKind::zone, MomentKind::stray_cut, MomentKind::force, MomentKind::pause});
    plots.push_back(plot);
  }
  if (has_any(expert.depth, trainee.depth)) {
    reports::Plot plot{.title = "Depth", .x_title = "time [s]", .y_title = "depth [mm]"};
    plot.series = {curve("expert", expert, expert.depth, kMillimetres, kExpertColour),
                   curve("trainee", trainee, trainee.depth, kMillimetres, kTraineeColour)};
    if (comparison.damage_depth > 0)
      plot.series.push_back(level("damage limit", 0, end, kMillimetres * comparison.damage_depth));
    plot.events = events_of(comparison, {MomentKind::depth});
    plots.push_back(plot);
  }
  if (has_any(expert.blade_depth, trainee.blade_depth)) {
    reports::Plot plot{
        .title = "Depth of the blade in the tissue, along the blade", .x_title = "time [s]", .y_title = "depth [mm]"};
    plot.series = {curve("expert", expert, expert.blade_depth, kMillimetres, kExpertColour),
                   curve("trainee", trainee, trainee.blade_depth, kMillimetres, kTraineeColour)};
    plot.events = events_of(comparison, {MomentKind::stray_cut});
    plots.push_back(plot);
  }
  return plots;
}

std::vector<reports::Plot> plots_of_probes(const ComparedSessions& compared) {
  const auto& [expert, trainee, scene, comparison] = compared;
  std::vector<reports::Plot> plots;
  for (std::size_t i = 0; i < std::min(expert.probes.size(), trainee.probes.size()); ++i) {
    reports::Plot plot{
        .title = "Probe " + expert.probes[i].name, .x_title = "time [s]", .y_title = "from its first place [mm]"};
    plot.series = {curve("expert", expert, expert.probes[i].way, kMillimetres, kExpertColour),
                   curve("trainee", trainee, trainee.probes[i].way, kMillimetres, kTraineeColour)};
    plots.push_back(plot);
  }
  return plots;
}

std::vector<reports::Plot> plots_of_paths(const ComparedSessions& compared) {
  std::vector<reports::Plot> plots;
  for (const Plane& plane : kPlanes) {
    reports::Plot plot{
        .title = std::string("Path of the tool, ") + plane.title, .x_title = plane.x_title, .y_title = plane.y_title};
    add_path(plot, "expert", compared.expert, plane, kExpertColour);
    add_path(plot, "trainee", compared.trainee, plane, kTraineeColour);
    set_equal_scales(plot);
    plots.push_back(plot);
  }
  plots.push_back(deviation_plot(compared.comparison));
  return plots;
}

std::vector<reports::Plot> plots_of_cut(const ComparedSessions& compared) {
  const auto& [expert, trainee, scene, comparison] = compared;
  std::vector<Vec3> both, expert_only, trainee_only;
  // Axial elements only: constraints and angle springs end with them.
  const std::size_t axial_count = ElementPlaces(scene.model).constraints;
  for (std::size_t i = 0; i < axial_count; ++i) {
    const bool in_a = expert.severed_at[i] >= 0, in_b = trainee.severed_at[i] >= 0;
    if (in_a || in_b) (in_a && in_b ? both : in_a ? expert_only : trainee_only).push_back(rest_middle(scene.model, i));
  }
  std::vector<reports::Plot> plots;
  if (both.empty() && expert_only.empty() && trainee_only.empty()) return plots;
  for (const Plane& plane : kPlanes) {
    reports::Plot plot{.title = std::string("Cut, ") + plane.title, .x_title = plane.x_title, .y_title = plane.y_title};
    for (const Path& path : cut_paths(expert))
      plot.series.push_back(in_plane("", path, plane, reports::Stroke::line, kExpertColour));
    for (const Path& path : cut_paths(trainee))
      plot.series.push_back(in_plane("", path, plane, reports::Stroke::line, kTraineeColour));
    constexpr double kBeside = 10;  // [pixels]
    plot.series.push_back(marks("severed by both", both, plane, reports::Stroke::marks, 2, 0));
    plot.series.push_back(
        marks("by the expert only", expert_only, plane, reports::Stroke::crosses, kExpertColour, -kBeside));
    plot.series.push_back(
        marks("by the trainee only", trainee_only, plane, reports::Stroke::crosses, kTraineeColour, kBeside));
    plot.caption =
        "Marks: severed elements at rest, those of one alone a little to the left (expert) or right (trainee). "
        "Lines: the blade's tip while it severs.";
    set_equal_scales(plot);
    plots.push_back(plot);
  }
  return plots;
}

}  // namespace ctpm::compare
