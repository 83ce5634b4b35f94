#include "studio/fidelity/press.h"

#include <algorithm>
#include <cmath>

namespace ctpm::fidelity {
namespace {

constexpr double kStep = 0.5e-3;         // the ball's way in a tick [m]
constexpr std::int64_t kPatience = 200;  // ticks at one depth
constexpr double kStill = 1e-7;          // [m] a tick, thousandths of a percent of a press

}  // namespace

Inputs ball_at(std::int32_t tool, Vec3 centre) {
  Inputs inputs;
  inputs.tool = tool, inputs.position = centre;
  return inputs;
}

Vec3 ball_centre(const Body& body, std::int32_t tool, const PressSite& site, double depth) {
  return body.to_world(site.place + (depth - body.model.tools[std::size_t(tool)].radius) * site.inward);
}

std::vector<PressPoint> press(const Body& body, std::int32_t tool, const PressSite& site,
                              std::span<const double> depths, bool with_surface) {
  const Vec3 inward = rotate(body.turn, site.inward);
  const double radius = body.model.tools[std::size_t(tool)].radius;
  stepping::Stepper stepper(body.model);
  State state = rest_state(body.model);
  std::vector<PressPoint> points;
  double depth = 0;
  bool is_refused = false;
  for (const double wanted : depths) {
    PressPoint point{.depth = wanted};
    while (depth < wanted && !is_refused) {
      depth = std::min(wanted, depth + kStep);
      is_refused =
          stepping::is_refused(stepper.step(state, ball_at(tool, ball_centre(body, tool, site, depth))).status);
    }
    const Vec3 centre = ball_centre(body, tool, site, wanted);
    const stepping::StepReport report = settle(stepper, state, ball_at(tool, centre), kPatience, kStill);
    point.rests = !is_refused && report.status == stepping::StepStatus::ok;
    point.force = -dot(report.tool_force, inward);
    if (with_surface)
      point.inside = std::max(0.0, radius - distance_to(body.organ.surface, drawn_at(body, state), centre));
    points.push_back(point);
  }
  return points;
}

std::vector<PressSite> places_over_cell(double spacing, double height, int count) {
  std::vector<PressSite> sites;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) sites.push_back({{spacing * i / count, spacing * j / count, height}, {0, 0, -1}});
  return sites;
}

Spread spread_of(const std::vector<double>& values) {
  Spread spread;
  const double count = double(values.size());
  for (const double v : values) spread.mean += v / count;
  double squares = 0;
  for (const double v : values) squares += (v - spread.mean) * (v - spread.mean) / count;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  spread.least = *least, spread.most = *most;
  spread.deviation = spread.mean > 0 ? std::sqrt(squares) / spread.mean : std::numeric_limits<double>::infinity();
  return spread;
}

}  // namespace ctpm::fidelity
