#include "studio/reports/plot.h"
#include "studio/output/number_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace ctpm::reports {
namespace {

/// Colours that are distinct for any colour vision (Okabe and Ito), darker first.
constexpr std::array<const char*, 7> kPalette{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                              "#e69f00", "#56b4e9", "#4d4d4d"};

constexpr double kLeft = 62, kRight = 14, kTop = 30, kBottom = 46, kLegendRow = 17, kLegendText = 28, kEventRow = 16,
                 kTitleRow = 18;
/// Of letters on narrow pages, where they are 15 pixels high, with some to spare.
constexpr double kLetter = 8, kTitleLetter = 9.6;
constexpr int kYTicks = 6;

const char* colour(int index) { return kPalette[std::size_t(std::max(index, 0)) % kPalette.size()]; }

std::string number(double pixels) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", pixels);
  return text;
}

/// One axis: its range, its ticks, and the map from value to pixels.
class Axis {
 public:
  Axis(double low, double high, bool is_log, double from, double to) : is_log_(is_log), from_(from), to_(to) {
    low_ = is_log ? std::log10(low) : low, high_ = is_log ? std::log10(high) : high;
    if (!(high_ > low_)) low_ -= 0.5, high_ += 0.5;
  }
  double at(double value) const {
    const double u = ((is_log_ ? std::log10(value) : value) - low_) / (high_ - low_);
    return from_ + u * (to_ - from_);
  }
  /// For plot_script(): the range, of logarithms if they are, and its pixels.
  std::string describe() const {
    return output::short_number(low_, 12) + " " + output::short_number(high_, 12) + " " + number(from_) + " " +
           number(to_) + (is_log_ ? " 1" : " 0");
  }
  bool can_show(double value) const { return std::isfinite(value) && (!is_log_ || value > 0); }

  std::vector<double> ticks(int most) const {
    std::vector<double> ticks;
    if (is_log_) {
      for (double e = std::ceil(low_ - 1e-9); e <= high_ + 1e-9; ++e) ticks.push_back(std::pow(10.0, e));
      return ticks;
    }
    // Steps of 1, 2 or 5 times a power of ten.
    const double rough = (high_ - low_) / most, power = std::pow(10.0, std::floor(std::log10(rough)));
    double step = power;
    for (const double factor : {2.0, 5.0, 10.0})
      if (step < rough * (1 - 1e-9)) step = factor * power;
    for (double i = std::ceil(low_ / step - 1e-6); i * step <= high_ + 1e-6 * step; ++i) ticks.push_back(i * step);
    return ticks;
  }

 private:
  bool is_log_;
  double from_, to_, low_ = 0, high_ = 1;
};

struct Range {
  double low = INFINITY, high = -INFINITY;
  void take(double v) { low = std::min(low, v), high = std::max(high, v); }
  bool is_empty() const { return !(low <= high); }
};

/// The range that an axis must show. Linear axes that nearly reach zero begin there and have a margin above.
Range range_of(const Plot& plot, bool is_y) {
  Range range;
  const bool is_log = is_y ? plot.is_log_y : plot.is_log_x;
  for (const Series& s : plot.series)
    for (const double v : is_y ? s.y : s.x)
      if (std::isfinite(v) && (!is_log || v > 0)) range.take(v);
  if (is_y)
    for (const Band& band : plot.bands) range.take(band.low), range.take(band.high);
  if (is_y && !range.is_empty()) range.high = std::max(range.high, range.low + plot.least_y_span);
  if (range.is_empty()) range = {is_log ? 1.0 : 0.0, is_log ? 10.0 : 1.0};
  if (is_log)
    return {std::pow(10.0, std::floor(std::log10(range.low))), std::pow(10.0, std::ceil(std::log10(range.high)))};
  const double size = std::max(range.high - range.low, 1e-12 * std::max(1.0, std::abs(range.high)));
  // Paths in a plane need margins on both sides, curves over time do not.
  const bool has_places =
      std::any_of(plot.series.begin(), plot.series.end(), [](const Series& s) { return s.stroke == Stroke::path; });
  if (!is_y && !has_places) return {range.low >= 0 && range.low < 0.1 * size ? 0.0 : range.low, range.high};
  const bool from_zero = !has_places && range.low >= 0 && range.low < 0.4 * size;
  return {from_zero ? 0.0 : range.low - 0.06 * size, range.high + 0.06 * size};
}

void add_text(std::string& svg, double x, double y, const char* anchor, const char* kind, const std::string& text,
              const std::string& more = "") {
  svg += "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\" class=\"" + kind + "\"" +
         more + ">" + escape_html(text) + "</text>\n";
}

void add_line(std::string& svg, double x1, double y1, double x2, double y2, const char* kind) {
  svg += "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" + number(y2) +
         "\" class=\"" + kind + "\"/>\n";
}

bool has_marks_only(const Series& series) { return series.stroke == Stroke::marks || series.stroke == Stroke::crosses; }

/// Whether the legend names it.
bool is_listed(const Series& series) { return !series.name.empty() && !series.x.empty(); }

/// Two, unless a name would be longer than its half.
int legend_columns(const Plot& plot) {
  std::size_t longest = 0;
  for (const Series& s : plot.series) longest = std::max(longest, is_listed(s) ? s.name.size() : 0);
  for (const Band& band : plot.bands) longest = std::max(longest, band.name.size());
  return kLegendText + kLetter * double(longest) > 0.5 * (plot.width - kLeft - kRight) ? 1 : 2;
}

int legend_rows(const Plot& plot) {
  int entries = 0;
  for (const Series& s : plot.series) entries += is_listed(s) ? 1 : 0;
  for (const Band& band : plot.bands) entries += band.name.empty() ? 0 : 1;
  const int columns = legend_columns(plot);
  return (entries + columns - 1) / columns;
}

/// Where the y axis stands: its numbers do not reach its title, on narrow pages neither.
double left_of(const Axis& y) {
  constexpr double kTitle = 30;
  std::size_t longest = 0;
  for (const double v : y.ticks(kYTicks)) longest = std::max(longest, output::short_number(v).size());
  return std::max(kLeft, kTitle + kLetter * double(longest));
}

/// The title in lines that fit, of whole words.
std::vector<std::string> title_lines(const Plot& plot) {
  const auto most = std::size_t((plot.width - 4) / kTitleLetter);
  std::vector<std::string> lines{plot.title};
  while (lines.back().size() > most) {
    const std::size_t end = lines.back().rfind(' ', most);
    if (end == std::string::npos || end == 0) break;
    std::string rest = lines.back().substr(end + 1);
    lines.back().resize(end), lines.push_back(std::move(rest));
  }
  return lines;
}

/// Draws one plot.
struct Drawing {
  const Plot& plot;
  Axis x, y;
  double left, right, top, bottom;
  std::string svg;

  void add_axes() {
    for (const double v : x.ticks(7)) {
      if (plot.counts_x && std::abs(v - std::round(v)) > 1e-6) continue;
      add_line(svg, x.at(v), top, x.at(v), bottom, "grid");
      add_text(svg, x.at(v), bottom + 18, "middle", "tick", output::short_number(v));
    }
    for (const double v : y.ticks(kYTicks)) {
      add_line(svg, left, y.at(v), right, y.at(v), "grid");
      add_text(svg, left - 6, y.at(v) + 4, "end", "tick", output::short_number(v));
    }
    add_line(svg, left, bottom, right, bottom, "axis"), add_line(svg, left, top, left, bottom, "axis");
    add_text(svg, 0.5 * (left + right), bottom + 36, "middle", "title", plot.x_title);
    const std::string turn = " transform=\"rotate(-90 15 " + number(0.5 * (top + bottom)) + ")\"";
    add_text(svg, 15, 0.5 * (top + bottom), "middle", "title", plot.y_title, turn);
    // A long title begins before the axis.
    const std::vector<std::string> lines = title_lines(plot);
    double room = left;
    for (const std::string& text : lines) room = std::min(room, plot.width - kTitleLetter * double(text.size()));
    for (std::size_t i = 0; i < lines.size(); ++i)
      add_text(svg, std::max(room, 4.0), 18 + kTitleRow * double(i), "start", "head", lines[i]);
  }

  void add_bands() {
    for (const Band& band : plot.bands)
      svg += "<rect x=\"" + number(left) + "\" y=\"" + number(y.at(band.high)) + "\" width=\"" + number(right - left) +
             "\" height=\"" + number(y.at(band.low) - y.at(band.high)) + "\" fill=\"" + colour(band.colour) +
             "\" fill-opacity=\"0.15\"/>\n";
  }

  void add_mark(double px, double py, double radius, const char* ink, bool is_filled) {
    svg += "<circle cx=\"" + number(px) + "\" cy=\"" + number(py) + "\" r=\"" + number(radius) + "\" stroke=\"" + ink +
           "\" stroke-width=\"1.4\" fill=\"" + (is_filled ? ink : "white") + "\"/>\n";
  }

  void add_cross(double px, double py, const char* ink) {
    for (const double slope : {-1.0, 1.0})
      svg += "<line x1=\"" + number(px - 4) + "\" y1=\"" + number(py - 4 * slope) + "\" x2=\"" + number(px + 4) +
             "\" y2=\"" + number(py + 4 * slope) + "\" stroke=\"" + ink + "\" stroke-width=\"1.6\"/>\n";
  }

  void add_series(const Series& series, const char* ink) {
    std::string points;
    std::vector<std::pair<double, double>> places;
    for (std::size_t i = 0; i < series.x.size(); ++i)
      if (x.can_show(series.x[i]) && y.can_show(series.y[i]))
        places.emplace_back(x.at(series.x[i]) + series.shift, y.at(series.y[i]));
    for (const auto& [px, py] : places) points += number(px) + "," + number(py) + " ";
    if (!has_marks_only(series))
      svg += "<polyline data-name=\"" + escape_html(series.name) + "\" fill=\"none\" stroke=\"" + std::string(ink) +
             "\" stroke-linejoin=\"round\" stroke-width=\"" + (series.stroke == Stroke::path ? "1" : "1.8") + "\"" +
             (series.stroke == Stroke::dashed ? " stroke-dasharray=\"6 4\"" : "") + " points=\"" + points + "\"/>\n";
    else
      svg += "<g data-name=\"" + escape_html(series.name) + "\" stroke=\"" + std::string(ink) + "\" data-marks=\"" +
             points + "\"/>\n";
    if (series.stroke == Stroke::crosses)
      for (const auto& [px, py] : places) add_cross(px, py, ink);
    if (series.stroke == Stroke::marks || series.stroke == Stroke::path)
      for (std::size_t i = 0; i < places.size(); ++i)
        add_mark(places[i].first, places[i].second, series.stroke == Stroke::path && i == 0 ? 4.5 : 3, ink,
                 series.stroke == Stroke::path);
  }

  /// Labels stand above the plot, one beside the other where they would lie on each other.
  void add_events() {
    double free_from = left;
    for (const PlotEvent& event : plot.events) {
      if (!x.can_show(event.x) || x.at(event.x) < left - 1 || x.at(event.x) > right + 1) continue;
      const double px = x.at(event.x), width = 8 + 7 * double(event.label.size());
      const double label = std::max(px, free_from + 0.5 * width);
      free_from = label + 0.5 * width + 2;
      svg +=
          event.link.empty() ? "<g class=\"event\">" : "<a class=\"event\" href=\"" + escape_html(event.link) + "\">";
      svg += "<title>" + escape_html(event.text) + "</title>";
      svg += "<path d=\"M" + number(label) + " " + number(top + 3) + "L" + number(px) + " " + number(top + 10) + "V" +
             number(bottom) + "\"/><rect x=\"" + number(label - 0.5 * width) + "\" y=\"" + number(top - 12) +
             "\" width=\"" + number(width) + "\" height=\"15\" rx=\"3\"/>";
      add_text(svg, label, top - 0.5, "middle", "flag", event.label);
      svg += event.link.empty() ? "</g>\n" : "</a>\n";
    }
  }

  /// Below the axes.
  void add_legend(const std::vector<const char*>& inks) {
    int entry = 0;
    const int columns = legend_columns(plot);
    const auto place = [&] {
      const double px = left + (entry % columns) * (right - left) / columns,
                   py = bottom + 54 + kLegendRow * (entry / columns);
      ++entry;
      return std::pair{px, py};
    };
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
      const Series& s = plot.series[i];
      if (!is_listed(s)) continue;
      const auto [px, py] = place();
      if (s.stroke == Stroke::crosses)
        add_cross(px + 11, py - 4, inks[i]);
      else if (s.stroke == Stroke::marks)
        add_mark(px + 11, py - 4, 3, inks[i], false);
      else
        svg += "<line x1=\"" + number(px) + "\" y1=\"" + number(py - 4) + "\" x2=\"" + number(px + 22) + "\" y2=\"" +
               number(py - 4) + "\" stroke=\"" + inks[i] + "\" stroke-width=\"2\"" +
               (s.stroke == Stroke::dashed ? " stroke-dasharray=\"6 4\"" : "") + "/>\n";
      if (s.stroke == Stroke::path) add_mark(px + 11, py - 4, 3, inks[i], true);
      add_text(svg, px + kLegendText, py, "start", "legend", s.name);
    }
    for (const Band& band : plot.bands) {
      if (band.name.empty()) continue;
      const auto [px, py] = place();
      svg += "<rect x=\"" + number(px) + "\" y=\"" + number(py - 10) + "\" width=\"22\" height=\"11\" fill=\"" +
             colour(band.colour) + "\" fill-opacity=\"0.25\"/>\n";
      add_text(svg, px + kLegendText, py, "start", "legend", band.name);
    }
  }
};

}  // namespace

void write_points(output::JsonWriter& json, const Plot& plot) {
  const auto write_list = [&](const char* key, const std::vector<double>& values) {
    json.key(key).begin_list();
    for (const double v : values) json.value(v);
    json.end_list();
  };
  json.begin_object().member("title", std::string_view(plot.title));
  json.member("x", std::string_view(plot.x_title))
      .member("y", std::string_view(plot.y_title))
      .key("series")
      .begin_list();
  for (const Series& s : plot.series) {
    json.begin_object().member("name", std::string_view(s.name));
    write_list("x", s.x), write_list("y", s.y);
    json.end_object();
  }
  json.end_list().key("bands").begin_list();
  for (const Band& band : plot.bands)
    json.begin_object()
        .member("name", std::string_view(band.name))
        .member("low", band.low)
        .member("high", band.high)
        .end_object();
  json.end_list().end_object();
}

std::string escape_html(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

std::string to_svg(const Plot& plot) {
  const double above = kTitleRow * double(title_lines(plot).size() - 1);
  const int whole_height = plot.height + int(above + kLegendRow * legend_rows(plot)) + 6;
  const double right = plot.width - kRight, top = above + kTop + (plot.events.empty() ? 0 : kEventRow),
               bottom = above + plot.height - kBottom;
  const Range xs = plot.x_range ? Range{plot.x_range->first, plot.x_range->second} : range_of(plot, false);
  const Range ys = plot.y_range ? Range{plot.y_range->first, plot.y_range->second} : range_of(plot, true);
  const Axis y(ys.low, ys.high, plot.is_log_y, bottom, top);
  const double left = left_of(y);
  Drawing drawing{plot, Axis(xs.low, xs.high, plot.is_log_x, left, right), y, left, right, top, bottom, ""};
  std::string& svg = drawing.svg;
  // Names of clip paths must be unique within a page; they come from the plot's title and size.
  const std::string clip =
      "c" + std::to_string(std::hash<std::string>{}(plot.title + plot.y_title + std::to_string(plot.series.size())) %
                           1000000007);
  const bool is_over_x = std::all_of(plot.series.begin(), plot.series.end(), [](const Series& s) {
    return has_marks_only(s) || std::is_sorted(s.x.begin(), s.x.end());
  });
  // What is in a picture cannot be reached by those who hear a page.
  const bool has_links = std::ranges::any_of(plot.events, [](const PlotEvent& event) { return !event.link.empty(); });
  svg = "<svg data-x=\"" + drawing.x.describe() + "\" data-y=\"" + drawing.y.describe() + "\" data-along=\"" +
        (is_over_x ? "x" : "") + "\" data-titles=\"" + escape_html(plot.x_title + "|" + plot.y_title) +
        "\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + std::to_string(plot.width) + " " +
        std::to_string(whole_height) + "\" width=\"" + std::to_string(plot.width) + "\" height=\"" +
        std::to_string(whole_height) + "\" role=\"" + (has_links ? "group" : "img") + "\">\n<title>" +
        escape_html(plot.title) + "</title>\n";
  svg += "<clipPath id=\"" + clip + "\"><rect x=\"" + number(left) + "\" y=\"" + number(top - 5) + "\" width=\"" +
         number(right - left + 5) + "\" height=\"" + number(bottom - top + 10) + "\"/></clipPath>\n";
  drawing.add_axes();
  svg += "<g clip-path=\"url(#" + clip + ")\">\n";
  drawing.add_bands();
  std::vector<const char*> inks;
  int next = 0;
  for (const Series& s : plot.series) {
    inks.push_back(colour(s.colour >= 0 ? s.colour : next++));
    drawing.add_series(s, inks.back());
  }
  svg += "</g>\n";
  drawing.add_events();
  drawing.add_legend(inks);
  return svg + "</svg>\n";
}

Plot plot_of_bounds(const std::string& title, const std::vector<double>& shares) {
  constexpr double kLeast = 1e-3;  // what is nearer to perfect is drawn there
  Plot plot{.title = title, .x_title = "in the order of the page", .y_title = "share of the bound", .is_log_y = true};
  Series met{.name = "within its bound", .stroke = Stroke::marks, .colour = 2},
      missed{.name = "beyond it", .stroke = Stroke::crosses, .colour = 1};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    Series& series = shares[i] <= 1 ? met : missed;
    series.x.push_back(double(i + 1)), series.y.push_back(std::max(shares[i], kLeast));
  }
  const Series bound{
      .name = "bound", .x = {0, double(shares.size() + 1)}, .y = {1, 1}, .stroke = Stroke::dashed, .colour = 6};
  plot.series = {bound, met, missed};
  return plot;
}

std::string plot_script() {
  return R"(<script>
for (const svg of document.querySelectorAll("svg[data-x]")) {
  const axis = text => { const [low, high, from, to, log] = text.split(" ").map(Number); return { low, high, from, to, log }; };
  const x = axis(svg.dataset.x), y = axis(svg.dataset.y), [xTitle, yTitle] = svg.dataset.titles.split("|");
  const value = (a, p) => { const v = a.low + (p - a.from) / (a.to - a.from) * (a.high - a.low); return Number((a.log ? 10 ** v : v).toPrecision(3)); };
  const lines = [...svg.querySelectorAll("polyline, [data-marks]")].map(line => ({
    name: line.dataset.name, ink: line.getAttribute("stroke"), isMarks: "marks" in line.dataset,
    points: (line.getAttribute("points") || line.dataset.marks || "").trim().split(" ").filter(p => p).map(p => p.split(",").map(Number)) }));
  if (!lines.some(line => line.points.length)) continue;
  const make = (name, attributes, parent) => { const e = document.createElementNS(svg.namespaceURI, name); for (const k in attributes) e.setAttribute(k, attributes[k]); return parent.appendChild(e); };
  const cursor = make("g", { class: "cursor" }, svg);
  const near = (points, px, py) => points.reduce((best, p) => { const d = Math.hypot(p[0] - px, p[1] - py); return best.d > d ? { d, p } : best; }, { d: Infinity });
  const between = (points, px) => {
    const i = points.findIndex(p => p[0] >= px - 0.05), b = points[i], a = points[Math.max(i - 1, 0)];
    if (i == -1 || a[0] > px + 0.05) return null;
    return [px, b[0] > a[0] ? a[1] + (px - a[0]) / (b[0] - a[0]) * (b[1] - a[1]) : b[1]];
  };
  const beside = (points, px) => points.reduce((best, p) => Math.abs((best || [px + 12])[0] - px) > Math.abs(p[0] - px) ? p : best, null);
  const show = event => {
    const place = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    cursor.replaceChildren();
    if (x.from - 4 > place.x || place.x > x.to + 4 || place.y > y.from + 4 || y.to - 8 > place.y) return;
    const drawn = lines.filter(line => line.points.length);
    const along = svg.dataset.along && drawn.some(line => !line.isMarks);
    const found = along
      ? drawn.map(line => ({ line, p: (line.isMarks ? beside : between)(line.points, Math.min(Math.max(place.x, x.from), x.to)) })).filter(one => one.p)
      : [drawn.map(line => ({ line, ...near(line.points, place.x, place.y) })).reduce((a, b) => b.d > a.d ? a : b)];
    if (!found.length) return;
    const at = along ? Math.min(Math.max(place.x, x.from), x.to) : found[0].p[0];
    const rows = [[xTitle + "  " + value(x, at), "#222"], ...found.map(one => [(one.line.name || yTitle) + "  " + value(y, one.p[1]), one.line.ink])];
    if (along) make("path", { d: `M${at} ${y.to}V${y.from}` }, cursor);
    for (const one of found) make("circle", { cx: one.p[0], cy: one.p[1], r: 3.5, fill: one.line.ink }, cursor);
    const box = make("rect", { rx: 3 }, cursor);
    const texts = rows.map(([text, ink]) => { const t = make("text", { fill: ink }, cursor); t.textContent = text; t.style.fill = ink; return t; });
    const width = 16 + Math.max(...texts.map(t => t.getComputedTextLength())), high = 1.35 * parseFloat(getComputedStyle(texts[0]).fontSize);
    const left = x.to > at + 10 + width ? at + 10 : Math.max(2, at - 10 - width);
    const height = high * rows.length + 8;
    const hidden = from => found.filter(one => one.p[0] > left - 4 && left + width + 4 > one.p[0] && one.p[1] > from - 4 && from + height + 4 > one.p[1]).length;
    const [above, below] = [y.to + 4, y.from - 4 - height], top = hidden(above) > hidden(below) ? below : above;
    texts.forEach((t, i) => { t.setAttribute("x", left + 8); t.setAttribute("y", top + 4 + high * (i + 0.8)); });
    for (const [k, v] of Object.entries({ x: left, y: top, width, height })) box.setAttribute(k, v);
  };
  for (const kind of ["pointermove", "pointerdown"]) svg.addEventListener(kind, show);
  svg.addEventListener("pointerleave", () => cursor.replaceChildren());
}
</script>)";
}

}  // namespace ctpm::reports
