#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "studio/output/json_writer.h"

namespace ctpm::reports {

/// How a series is drawn.
enum class Stroke {
  line,     ///< a full line
  dashed,   ///< a dashed line
  marks,    ///< a circle at each point, no line
  crosses,  ///< a cross at each point, no line
  path,     ///< a thin line with a mark at each point, the first one larger: a path in space
};

/// Points of a line plot; `x` and `y` have the same length. Non-finite points are left out.
struct Series {
  std::string name = {};  ///< in the legend; empty: not listed
  std::vector<double> x = {}, y = {};
  Stroke stroke = Stroke::line;
  int colour = -1;  ///< index of the report's palette; -1: the next free one
  double shift =
      0;  ///< to the right of marks, so that those of several series at one place stand side by side [pixels]
};

/// Something that happened at an x: a line with a short label, which leads to `link` within the page.
struct PlotEvent {
  double x = 0;
  std::string label;      ///< one or two letters
  std::string text;       ///< shown where the label is pointed at
  std::string link = {};  ///< "#..."; empty: none
};

/// A range of y that is tinted over the whole width, for example of measured values.
struct Band {
  std::string name;
  double low = 0, high = 0;
  int colour = 0;
};

/// A line plot with axes, units, grid and legend.
struct Plot {
  std::string title = {};
  std::string x_title = {}, y_title = {};  ///< with their units
  std::vector<Series> series = {};
  std::vector<Band> bands = {};
  std::vector<PlotEvent> events = {};
  std::string caption = {};                                             ///< below the plot; empty: none
  std::optional<std::pair<double, double>> x_range = {}, y_range = {};  ///< unset: the range of the data
  bool is_log_x = false;  ///< x on a logarithmic axis; points with x <= 0 are left out
  bool is_log_y = false;
  bool counts_x = false;          ///< x counts something: its ticks are whole numbers
  double least_y_span = 0;        ///< the y axis shows at least so much, so that rounding is not drawn as a difference
  int width = 520, height = 340;  ///< [pixels]
};

/// The plot as a self-contained SVG element. It names its axes and series for plot_script().
std::string to_svg(const Plot& plot);

/// Values as shares of their bounds, one mark each: what is above 1 is missed.
Plot plot_of_bounds(const std::string& title, const std::vector<double>& shares);

/// A script for pages with plots: the values under a mouse or finger are shown beside it. It loads nothing.
std::string plot_script();

/// The points of the plot as a JSON object: title, axes, series with their x and y, bands.
void write_points(output::JsonWriter& json, const Plot& plot);

/// Escapes text for HTML, SVG and attributes.
std::string escape_html(const std::string& text);

}  // namespace ctpm::reports
