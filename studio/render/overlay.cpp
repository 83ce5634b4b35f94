#include "studio/render/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <span>

#include "studio/output/number_text.h"
#include "studio/render/font.h"

namespace ctpm::render {
namespace {

constexpr Ink kWhite{240, 243, 246}, kGrey{168, 178, 188}, kAmber{255, 190, 80}, kRed{255, 150, 132},
    kBlue{110, 190, 255}, kGreen{96, 205, 140};
/// Tints a rectangle with rounded corners; `opacity` of 256.
void draw_panel(cv::Mat& rgb, const PixelBox& box, const Ink& tint, int opacity, int radius) {
  for (int y = std::max(0, box.y); y < std::min(rgb.rows, box.y + box.height); ++y) {
    const int dy = std::max({box.y + radius - y, y - (box.y + box.height - 1 - radius), 0});
    const int inset = radius - int(std::sqrt(radius * radius - dy * dy));
    const int left = std::max(0, box.x + inset), right = std::min(rgb.cols, box.x + box.width - inset);
    std::uint8_t* to = rgb.ptr<std::uint8_t>(y) + 3 * left;
    for (int x = left; x < right; ++x, to += 3)
      for (int k = 0; k < 3; ++k) to[k] = std::uint8_t((to[k] * (256 - opacity) + tint[std::size_t(k)] * opacity) >> 8);
  }
}

/// How much of a panel is shown: less the nearer the tools are, so that they are never hidden.
double share_shown(const PixelBox& box, const std::vector<Pixel>& tools, double reach) {
  constexpr double kLeast = 0.45;  // words are still read, and the tool is seen
  double nearest = reach * reach;
  for (const Pixel& p : tools) {
    const double x = std::max({box.x - p.x, p.x - box.x - box.width, 0.0}),
                 y = std::max({box.y - p.y, p.y - box.y - box.height, 0.0});
    nearest = std::min(nearest, x * x + y * y);
  }
  return kLeast + (1 - kLeast) * std::sqrt(nearest) / reach;
}

/// The pixels below a panel, to let them shine through it afterwards.
struct Beneath {
  cv::Rect place;
  cv::Mat before;
  double shown = 1;

  void shine_through(cv::Mat& rgb) const {
    cv::Mat drawn = rgb(place);
    cv::addWeighted(drawn, shown, before, 1 - shown, 0, drawn);
  }
};

struct Line {
  PlacedText placed;
  Ink ink;
  bool is_large = false;
};

/// All texts, and the panels behind them.
struct Plan {
  std::vector<Line> lines;
  PixelBox names, facts, plot, verdict, warning, legend, caption, marks;
  PixelBox bar;                   ///< the legend's colours
  std::vector<PixelBox> samples;  ///< of the marks
  PixelBox curve;                 ///< inside of the plot
  double top_force = 1;
};

bool is_too_deep(const OverlayData& data, const HandLoad& hand) {
  return !hand.is_blade && data.damage_depth > 0 && hand.depth > data.damage_depth;
}
bool is_too_strong(const OverlayData& data, const HandLoad& hand) {
  return data.damage_force > 0 && hand.force > data.damage_force;
}

/// The damage warning: the limits that are exceeded; empty if none is.
std::string damage_text(const OverlayData& data) {
  std::string text;
  double depth = 0, force = 0;  // the largest that are beyond their limits
  const auto look_at = [&](const HandLoad& hand) {
    if (is_too_deep(data, hand)) depth = std::max(depth, hand.depth);
    if (is_too_strong(data, hand)) force = std::max(force, hand.force);
  };
  look_at(data.hand), look_at(data.worst);
  if (data.second) look_at(*data.second);
  if (depth > 0)
    text += " " + output::fixed(1000 * depth, 1) + " mm, limit " + output::fixed(1000 * data.damage_depth, 1) + " mm";
  if (force > 0)
    text += (text.empty() ? " " : "; ") + output::fixed(force, 2) + " N, limit " + output::fixed(data.damage_force, 2) +
            " N";
  return text.empty() ? text : "TISSUE DAMAGE:" + text;
}

struct Fact {
  std::string name, value;
  bool is_bad = false;
  bool is_detail = false;  ///< left out where there is little room
};

std::string counted(std::int64_t count, const std::string& thing) {
  return count == 0 ? "" : std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

/// By Stands.
constexpr std::array<const char*, 3> kNamesOfTime{"time", "not begun", "ended"};

/// What the panel says, row by row; rows without a value are left out.
std::vector<Fact> facts_of(const OverlayData& data) {
  const auto force_of = [&](const char* name, const HandLoad& hand) {
    return Fact{name, output::fixed(hand.force, 3) + " N", is_too_strong(data, hand)};
  };
  const auto depth_of = [&](const std::string& which, const HandLoad& hand) {
    return Fact{(!hand.is_blade  ? "depth"
                 : which.empty() ? "deepest cut"
                                 : "deepest") +
                    which,
                output::fixed(1000 * hand.depth, 2) + " mm", is_too_deep(data, hand)};
  };
  return {{"model", data.model, false, true},
          {kNamesOfTime[std::size_t(data.stands)], output::fixed(data.time, 3) + " s"},
          {"speed", !data.pace                  ? ""
                    : data.stands == Stands::no ? output::fixed(*data.pace, 2) + " x"
                                                : "-"},
          {"clock behind", data.slip < 0.01 ? "" : output::fixed(data.slip, 2) + " s", true},
          {"tick", std::to_string(data.tick), false, true},
          force_of("force", data.hand),
          depth_of("", data.hand),
          data.second ? force_of("force 2", *data.second) : Fact{},
          data.second ? depth_of(" 2", *data.second) : Fact{},
          {"loose", counted(data.loose, "piece")},
          {"inside out", counted(data.inside_out, "cell"), true}};
}

}  // namespace

double round_up(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(std::max(value, 1e-3))));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * decade >= value * (1 - 1e-9)) return step * decade;
  return 10 * decade;
}

double largest_force(const OverlayData& data) {
  double largest = 0;
  for (const ForcePoint& p : data.history)
    if (p.time >= data.time - data.plot_span) largest = std::max({largest, p.force, p.second});
  return largest;
}

struct Overlay::Parts {
  Parts(int w, int h, double zoom)
      : width(w),
        height(h),
        is_narrow(w < 1.4 * h),
        scale(zoom * std::min(w / (is_narrow ? 720.0 : 1280.0), h / 720.0)),
        small(std::max(5, px(17))),
        large(std::max(6, px(23))) {}

  int px(double at_720) const { return int(std::lround(at_720 * scale)); }
  Plan plan(const OverlayData& data);
  void add_fact(const Fact& fact, int x, int y, int inner, Plan& plan);
  void plan_facts(const OverlayData& data, Plan& plan);
  void plan_plot(const OverlayData& data, Plan& plan);
  void plan_banners(const OverlayData& data, Plan& plan);
  void plan_legend(const OverlayData& data, Plan& plan);
  void plan_marks(const OverlayData& data, Plan& plan);
  void draw_samples(cv::Mat& rgb, const OverlayData& data, const Plan& plan) const;
  void draw_bar(cv::Mat& rgb, const Legend& legend, const PixelBox& bar) const;
  void draw_curve(cv::Mat& rgb, const OverlayData& data, const Plan& plan) const;
  Line line(Font& font, const std::string& text, int x, int y, const Ink& ink) {
    return {{text, {x, y, font.width(text), font.height() + font.height() / 4}}, ink, &font == &large};
  }

  int width, height;
  bool is_narrow;
  double scale;
  Font small, large;
};

/// A name and its value, right-aligned, so that digits stand still.
void Overlay::Parts::add_fact(const Fact& fact, int x, int y, int inner, Plan& plan) {
  plan.lines.push_back(line(small, fact.name, x, y, kGrey));
  Line shown = line(small, fact.value, 0, y, fact.is_bad ? kRed : kWhite);
  shown.placed.box.x = x + inner - shown.placed.box.width;
  plan.lines.push_back(shown);
}

/// Top left: title, session, time, tick, force, depth, pieces that came loose, cells that are inside out. In a narrow
/// picture the names stand at the top and the rest is at the bottom right, so that the tool has the room above.
void Overlay::Parts::plan_facts(const OverlayData& data, Plan& plan) {
  const int pad = px(16), step = px(28), margin = px(20), gap = px(16);
  const std::string role = data.role.empty() ? "session" : data.role;
  const bool is_short = is_narrow || data.level != OverlayLevel::full;
  std::vector<Fact> facts = facts_of(data);
  std::erase_if(facts, [&](const Fact& fact) { return fact.value.empty() || (is_short && fact.is_detail); });
  const int most = width - 2 * margin - 2 * pad, label = small.width(role) + gap;
  const std::string title = is_short ? "" : large.shortened(data.title, std::min(px(440), most));
  const std::string session = small.shortened_inside(data.session, std::min(px(340), most - label));
  int inner = px(300);
  const std::string ghost = is_narrow ? "" : small.shortened_inside(data.ghost, std::min(px(340), most - label));
  if (!is_narrow) inner = std::max({inner, label + small.width(session), label + small.width(ghost)});
  inner = std::max(inner, large.width(title));
  for (const Fact& fact : facts) inner = std::max(inner, small.width(fact.name) + gap + small.width(fact.value));
  int x = margin + pad, y = margin + pad;
  if (is_narrow && !session.empty()) {
    const int names = label + small.width(session);
    plan.names = {margin, margin, names + 2 * pad, px(43)};
    add_fact({role, session}, x, margin + px(13), names, plan);
  } else if (!is_narrow) {
    if (!title.empty()) plan.lines.push_back(line(large, title, x, y, kWhite)), y += px(38);
    if (!session.empty()) add_fact({role, session}, x, y, inner, plan), y += step;
    if (!ghost.empty()) {
      add_fact({"in blue", ghost}, x, y, inner, plan), y += step;
      for (Line& line : std::span(plan.lines).last(2)) line.ink = kBlue;
    }
  }
  const int rows = int(facts.size()) * step + pad - px(7);
  if (is_narrow) x = width - margin - pad - inner, y = height - margin - rows;
  plan.facts = {x - pad, is_narrow ? y - pad : margin, inner + 2 * pad, (is_narrow ? pad : y - margin) + rows};
  for (const Fact& fact : facts) add_fact(fact, x, y, inner, plan), y += step;
}

/// Bottom left: the force of the last seconds.
void Overlay::Parts::plan_plot(const OverlayData& data, Plan& plan) {
  if (data.history.empty() || data.level != OverlayLevel::full) return;
  plan.top_force = round_up(std::max(data.least_top_force, largest_force(data)));
  const int pad = px(16), w = is_narrow ? px(300) : px(332), h = px(160);
  plan.plot = {px(20), height - px(20) - h, w, h};
  const int title_x = plan.plot.x + pad, title_y = plan.plot.y + px(12);
  if (data.second) {
    const std::string first = "hand 1 [N]";
    plan.lines.push_back(line(small, first, title_x, title_y, kAmber));
    plan.lines.push_back(line(small, "hand 2 [N]", title_x + small.width(first) + px(16), title_y, kBlue));
  } else {
    plan.lines.push_back(line(small, "force [N]", title_x, title_y, kGrey));
  }
  const std::string scale_text = output::fixed(plan.top_force, plan.top_force < 0.1 ? 2 : plan.top_force < 1 ? 1 : 0);
  const int label = pad + std::max(small.width("0.02"), small.width(scale_text)) + px(8);
  plan.curve = {plan.plot.x + label, plan.plot.y + px(46), w - label - pad, h - px(46) - px(34)};
  const auto left_label = [&](const std::string& text, int y) {
    Line shown = line(small, text, 0, y - small.height() / 2, kGrey);
    shown.placed.box.x = plan.curve.x - px(8) - shown.placed.box.width;
    plan.lines.push_back(shown);
  };
  left_label(scale_text, plan.curve.y), left_label("0", plan.curve.y + plan.curve.height);
  Line now = line(small, "last " + output::fixed(data.plot_span, data.plot_span < 1 ? 1 : 0) + " s", 0,
                  plan.curve.y + plan.curve.height + px(8), kGrey);
  now.placed.box.x = plan.curve.x + plan.curve.width - now.placed.box.width;
  plan.lines.push_back(now);
}

/// Bottom right, above the place of the warning, or above the facts; where small pictures stand there, below the
/// verdict.
void Overlay::Parts::plan_legend(const OverlayData& data, Plan& plan) {
  if (data.legend.title.empty()) return;
  const int pad = px(16), w = px(250), h = px(98);
  const int bottom = is_narrow ? plan.facts.y - px(10) : height - px(20) - px(43) - px(10), right = width - px(20) - w;
  plan.legend = {right - data.taken_right, bottom - h, w, h};
  if (data.has_insets) plan.legend = {is_narrow ? px(20) : right, px(20) + (is_narrow ? 2 : 1) * px(53), w, h};
  const int x = plan.legend.x + pad, inner = w - 2 * pad, y = plan.legend.y + px(12);
  plan.lines.push_back(line(small, small.shortened(data.legend.title, inner), x, y, kGrey));
  plan.bar = {x, y + px(30), inner, px(16)};
  plan.lines.push_back(line(small, data.legend.low, x, plan.bar.y + px(22), kWhite));
  Line high = line(small, data.legend.high, 0, plan.bar.y + px(22), kWhite);
  high.placed.box.x = x + inner - high.placed.box.width;
  plan.lines.push_back(high);
}

/// The verdict: top right, or in a narrow picture beside or below the names. The damage warning: bottom right, or above
/// all that stands at the bottom.
void Overlay::Parts::plan_banners(const OverlayData& data, Plan& plan) {
  const int pad = px(16), margin = px(20), step = px(24), h = px(17) + 2 * px(13);
  const int most_wide = std::min(px(640), width - 2 * margin - 2 * pad);
  const auto banner = [&](const std::string& text, int y, bool is_right, const Ink& ink, std::size_t most_lines) {
    const std::vector<std::string> shown = small.in_lines(text, most_wide, most_lines);
    int w = 2 * pad;
    for (const std::string& one : shown) w = std::max(w, small.width(one) + 2 * pad);
    const int right = width - margin - (y > height / 2 ? data.taken_right : 0);
    const PixelBox box{is_right ? std::max(margin, right - w) : margin, y, w, h + step * int(shown.size() - 1)};
    for (std::size_t i = 0; i < shown.size(); ++i)
      plan.lines.push_back(line(small, shown[i], box.x + pad, y + px(13) + int(i) * step, ink));
    return box;
  };
  const bool is_bad = data.verdict_tone == VerdictTone::bad;
  if (!data.verdict.empty() && (is_bad || data.level == OverlayLevel::full)) {
    const Ink ink = data.verdict_tone == VerdictTone::good ? kGreen : is_bad ? kAmber : kWhite;
    const bool fits = plan.names.x + plan.names.width + px(10) + small.width(data.verdict) + 2 * pad + margin <= width;
    plan.verdict = banner(data.verdict, fits || !is_narrow ? margin : margin + plan.names.height + px(10),
                          fits || !is_narrow, ink, 2);
  }
  if (data.level == OverlayLevel::none) return;
  int bottom = height - margin;
  if (is_narrow)
    for (const PixelBox& box : {plan.facts, plan.plot, data.has_insets ? PixelBox{} : plan.legend})
      if (box.height > 0) bottom = std::min(bottom, box.y - px(10));
  const bool is_alone = data.level == OverlayLevel::caption;
  if (const std::string text = damage_text(data); !text.empty() && !is_alone)
    plan.warning = banner(text, bottom - h, !is_narrow, kWhite, 1);
  if (data.caption.empty()) return;
  // Between the plot and the legend and above the warning; in the middle of the picture where it fits there.
  const bool is_free = is_narrow || is_alone;
  const int left = is_free ? px(5) : plan.plot.height > 0 ? plan.plot.x + plan.plot.width + px(10) : margin;
  const int right = is_free                                      ? width - px(5)
                    : plan.legend.height > 0 && !data.has_insets ? plan.legend.x - px(10)
                                                                 : width - margin - data.taken_right;
  const std::vector<std::string> texts = large.in_lines(data.caption, right - left - 2 * pad, 2);
  int wide = 0;
  for (const std::string& text : texts) wide = std::max(wide, large.width(text) + 2 * pad);
  const int high = px(23) + 2 * px(13) + px(32) * int(texts.size() - 1);
  plan.caption = {std::clamp((width - wide) / 2, left, std::max(left, right - wide)),
                  is_alone ? height - high : bottom - h - px(10) - high, wide, high};
  for (std::size_t i = 0; i < texts.size(); ++i)
    plan.lines.push_back(line(large, texts[i], plan.caption.x + (wide - large.width(texts[i])) / 2,
                              plan.caption.y + px(13) + int(i) * px(32), kWhite));
}

/// Top left, below what stands there.
void Overlay::Parts::plan_marks(const OverlayData& data, Plan& plan) {
  if (data.marks.empty()) return;
  const int pad = px(16), step = px(24), sample = px(22), gap = px(10);
  int y = px(10);
  for (const PixelBox& box : {plan.names, is_narrow ? PixelBox{} : plan.facts, plan.verdict, plan.legend})
    if (box.height > 0 && box.x < width / 2 && box.y < height / 3) y = std::max(y, box.y + box.height);
  const int x = px(20), top = y + px(10), most = width - 2 * x - 2 * pad - sample - gap;
  int wide = 0, row = top + px(13);
  for (const MarkMeaning& mark : data.marks) {
    const std::string text = small.shortened(mark.text, most);
    plan.samples.push_back({x + pad, row, sample, px(17)});
    plan.lines.push_back(line(small, text, x + pad + sample + gap, row, kWhite));
    wide = std::max(wide, small.width(text)), row += step;
  }
  plan.marks = {x, top, wide + sample + gap + 2 * pad, px(43) + step * int(data.marks.size() - 1)};
}

/// Marks as they are in the picture.
void Overlay::Parts::draw_samples(cv::Mat& rgb, const OverlayData& data, const Plan& plan) const {
  for (std::size_t i = 0; i < plan.samples.size(); ++i) {
    const PixelBox& box = plan.samples[i];
    const auto& [red, green, blue] = data.marks[i].colour;
    const cv::Scalar colour{255 * red, 255 * green, 255 * blue};
    const cv::Point left(box.x, box.y + box.height / 2), right(box.x + box.width, left.y);
    if (data.marks[i].is_line)
      cv::line(rgb, left, right, colour, std::max(1, px(4)), cv::LINE_AA);
    else
      for (const int share : {1, 3, 5})
        cv::circle(rgb, left + cv::Point(box.width * share / 6, 0), std::max(1, px(3)), colour, cv::FILLED,
                   cv::LINE_AA);
  }
}

void Overlay::Parts::draw_bar(cv::Mat& rgb, const Legend& legend, const PixelBox& bar) const {
  const int count = int(legend.colours.size());
  for (int x = 0; x < bar.width && count > 0; ++x) {
    // Single values fill their field; a range runs from the first to the last colour.
    const double place =
        legend.is_stepped ? double(x * count / bar.width) : double(x) * (count - 1) / std::max(bar.width - 1, 1);
    const int low = std::min(int(place), count - 1), high = std::min(low + 1, count - 1);
    cv::Vec3b colour;
    for (int c = 0; c < 3; ++c) {
      const double a = legend.colours[std::size_t(low)][std::size_t(c)],
                   b = legend.colours[std::size_t(high)][std::size_t(c)];
      colour[c] = std::uint8_t(std::lround(255 * (a + (place - low) * (b - a))));
    }
    for (int y = 0; y < bar.height; ++y)
      if (bar.x + x < rgb.cols && bar.y + y < rgb.rows) rgb.at<cv::Vec3b>(bar.y + y, bar.x + x) = colour;
  }
}

Plan Overlay::Parts::plan(const OverlayData& data) {
  Plan plan;
  if (data.level >= OverlayLevel::small) plan_facts(data, plan), plan_plot(data, plan), plan_legend(data, plan);
  plan_banners(data, plan);
  if (data.level >= OverlayLevel::small) plan_marks(data, plan);
  return plan;
}

void Overlay::Parts::draw_curve(cv::Mat& rgb, const OverlayData& data, const Plan& plan) const {
  const PixelBox& c = plan.curve;
  constexpr int kShift = 4;  // polylines in sixteenths of a pixel
  const auto at = [&](double time, double force) {
    const double x = c.x + c.width * (1 - (data.time - time) / data.plot_span);
    const double y = c.y + c.height * (1 - force / plan.top_force);
    return cv::Point(int(std::lround(x * (1 << kShift))), int(std::lround(y * (1 << kShift))));
  };
  cv::line(rgb, {c.x, c.y + c.height}, {c.x + c.width, c.y + c.height}, cv::Scalar(120, 130, 140), 1);
  cv::line(rgb, {c.x, c.y}, {c.x + c.width, c.y}, cv::Scalar(70, 78, 86), 1);
  const auto draw = [&](double ForcePoint::*force, const Ink& ink, const cv::Scalar& end) {
    std::vector<cv::Point> points;
    for (const ForcePoint& p : data.history)
      if (p.time >= data.time - data.plot_span && p.time <= data.time)
        points.push_back(at(p.time, std::max(p.*force, 0.0)));
    if (points.empty()) return;
    cv::polylines(rgb, points, false, cv::Scalar(ink[0], ink[1], ink[2]), std::max(1, px(2)), cv::LINE_AA, kShift);
    cv::circle(rgb, points.back(), std::max(1, px(4)) << kShift, end, cv::FILLED, cv::LINE_AA, kShift);
  };
  if (data.second) draw(&ForcePoint::second, kBlue, {190, 225, 255});
  draw(&ForcePoint::force, kAmber, {255, 225, 160});
}

Overlay::Overlay(int width, int height, double zoom) : parts_(std::make_unique<Parts>(width, height, zoom)) {}
Overlay::~Overlay() = default;
Overlay::Overlay(Overlay&&) noexcept = default;

void Overlay::draw(Frame& frame, const OverlayData& data) {
  CTPM_CHECK(frame.width == parts_->width && frame.height == parts_->height,
             "an overlay draws on frames of its own size");
  cv::Mat rgb(frame.height, frame.width, CV_8UC3, frame.rgb.data());
  const Plan plan = parts_->plan(data);
  const int radius = parts_->px(10);
  std::vector<Beneath> faded;
  for (const PixelBox* panel :
       {&plan.names, &plan.facts, &plan.plot, &plan.verdict, &plan.legend, &plan.warning, &plan.caption, &plan.marks}) {
    const PixelBox& box = *panel;
    const cv::Rect place = cv::Rect(box.x, box.y, box.width, box.height) & cv::Rect(0, 0, rgb.cols, rgb.rows);
    // Of a pair, nothing else says whose half it is.
    const bool must_stay = &box == &plan.names || (&box == &plan.verdict && data.verdict_tone == VerdictTone::bad) ||
                           (&box == &plan.caption && data.level == OverlayLevel::caption);
    const double shown = must_stay ? 1 : share_shown(box, data.tools, parts_->px(40));
    if (shown < 1 && place.area() > 0) faded.push_back({place, rgb(place).clone(), shown});
  }
  for (const PixelBox& box : {plan.names, plan.facts, plan.plot, plan.verdict, plan.legend, plan.caption, plan.marks})
    draw_panel(rgb, box, {14, 19, 25}, 176, radius);
  draw_panel(rgb, plan.warning, {170, 24, 18}, 224, radius);
  for (const Line& line : plan.lines)
    (line.is_large ? parts_->large : parts_->small)
        .write(rgb, line.placed.box.x, line.placed.box.y, line.placed.text, line.ink);
  if (plan.plot.height > 0) parts_->draw_curve(rgb, data, plan);
  if (plan.legend.height > 0) parts_->draw_bar(rgb, data.legend, plan.bar);
  parts_->draw_samples(rgb, data, plan);
  for (const Beneath& beneath : faded) beneath.shine_through(rgb);
}

std::vector<PlacedText> Overlay::layout(const OverlayData& data) {
  std::vector<PlacedText> texts;
  for (const Line& line : parts_->plan(data).lines) texts.push_back(line.placed);
  return texts;
}

std::vector<PixelBox> Overlay::standing_panels(const OverlayData& data) {
  const Plan plan = parts_->plan(data);
  std::vector<PixelBox> panels;
  for (const PixelBox& box :
       {plan.names, plan.facts, plan.plot, plan.verdict, plan.legend, plan.warning, plan.caption, plan.marks})
    if (box.height > 0) panels.push_back(box);
  return panels;
}

}  // namespace ctpm::render
