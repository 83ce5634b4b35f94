#include "studio/render/overlay.h"
#include "studio/output/number_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace ctpm::render {
namespace {

using Ink = std::array<int, 3>;

constexpr Ink kWhite{240, 243, 246}, kGrey{168, 178, 188}, kAmber{255, 190, 80}, kRed{235, 72, 60},
    kBlue{110, 190, 255}, kGreen{96, 205, 140};
constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
constexpr int kOversample = 4;  // strokes are drawn this many times larger and averaged down

/// The strokes of one character, ready to be blended.
struct Glyph {
  cv::Mat mask;
  int advance = 0;  ///< [pixels]
};

/// A stroke font in one size.
class Font {
 public:
  explicit Font(int height) : height_(height), scale_(kOversample * height / 22.0) {}

  int height() const { return height_; }

  int width(const std::string& text) {
    int sum = 0;
    for (const char c : text) sum += glyph(c).advance;
    return sum;
  }

  /// The text, or as much of its beginning as fits into `width`, with an ellipsis.
  std::string shortened(std::string text, int limit) {
    if (width(text) <= limit) return text;
    while (!text.empty() && width(text + "...") > limit) text.pop_back();
    return text + "...";
  }

  /// The text, or as much of its beginning and end as fits: names of a pair differ at their end.
  std::string shortened_inside(const std::string& text, int limit) {
    std::string shown = text;
    for (std::size_t kept = text.size(); kept > 0 && width(shown) > limit; --kept)
      shown = text.substr(0, (kept - 1) / 2) + "..." + text.substr(text.size() - kept / 2);
    return shown;
  }

  void write(cv::Mat& rgb, int x, int y, const std::string& text, const Ink& ink) {
    for (const char c : text) {
      const Glyph& g = glyph(c);
      blend(rgb, g.mask, x - height_ / 4, y - height_ / 4, ink);
      x += g.advance;
    }
  }

 private:
  const Glyph& glyph(char c) {
    const auto found = glyphs_.find(c);
    if (found != glyphs_.end()) return found->second;
    const std::string text(1, c >= 32 && c < 127 ? c : '?');
    const int thickness = std::max(1, int(std::lround(1.15 * kOversample * height_ / 18.0)));
    int baseline = 0;
    const cv::Size size = cv::getTextSize(text, kFont, scale_, 1, &baseline);
    const int pad = height_ / 4, advance = int(std::lround(double(size.width) / kOversample));
    cv::Mat large(kOversample * (height_ + height_ / 2 + 2 * pad), kOversample * (advance + 2 * pad), CV_8U,
                  cv::Scalar(0));
    cv::putText(large, text, {kOversample * pad, kOversample * (pad + height_)}, kFont, scale_, cv::Scalar(255),
                thickness, cv::LINE_AA);
    Glyph g{{}, advance};
    cv::resize(large, g.mask, {large.cols / kOversample, large.rows / kOversample}, 0, 0, cv::INTER_AREA);
    return glyphs_.emplace(c, g).first->second;
  }

  static void blend(cv::Mat& rgb, const cv::Mat& mask, int x, int y, const Ink& ink) {
    for (int r = std::max(0, -y); r < mask.rows && y + r < rgb.rows; ++r)
      for (int c = std::max(0, -x); c < mask.cols && x + c < rgb.cols; ++c) {
        const int cover = mask.at<std::uint8_t>(r, c);
        if (!cover) continue;
        auto& pixel = rgb.at<cv::Vec3b>(y + r, x + c);
        for (int k = 0; k < 3; ++k)
          pixel[k] = std::uint8_t((pixel[k] * (255 - cover) + ink[std::size_t(k)] * cover + 127) / 255);
      }
  }

  int height_;
  double scale_;
  std::map<char, Glyph> glyphs_;
};

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

struct Line {
  PlacedText placed;
  Ink ink;
  bool is_large = false;
};

/// All texts, and the panels behind them.
struct Plan {
  std::vector<Line> lines;
  PixelBox facts, plot, verdict, warning, legend;
  PixelBox bar;    ///< the legend's colours
  PixelBox curve;  ///< inside of the plot
  double top_force = 1;
};

/// The next round number at or above `value`: 1, 2 or 5 times a power of ten.
double round_up(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(std::max(value, 1e-3))));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * decade >= value * (1 - 1e-9)) return step * decade;
  return 10 * decade;
}

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
  look_at(data.hand);
  if (data.second) look_at(*data.second);
  if (depth > 0)
    text += " " + output::fixed(1000 * depth, 1) + " mm, limit " + output::fixed(1000 * data.damage_depth, 1) + " mm";
  if (force > 0)
    text += (text.empty() ? " " : "; ") + output::fixed(force, 2) + " N, limit " + output::fixed(data.damage_force, 2) +
            " N";
  return text.empty() ? text : "TISSUE DAMAGE:" + text;
}

}  // namespace

double largest_force(const OverlayData& data) {
  double largest = 0;
  for (const ForcePoint& p : data.history)
    if (p.time >= data.time - data.plot_span) largest = std::max({largest, p.force, p.second});
  return largest;
}

struct Overlay::Parts {
  Parts(int w, int h)
      : width(w),
        height(h),
        is_narrow(w < 1.4 * h),
        scale(std::min(w / (is_narrow ? 720.0 : 1280.0), h / 720.0)),
        small(std::max(5, px(17))),
        large(std::max(6, px(23))) {}

  int px(double at_720) const { return int(std::lround(at_720 * scale)); }
  Plan plan(const OverlayData& data);
  void plan_facts(const OverlayData& data, Plan& plan);
  void plan_plot(const OverlayData& data, Plan& plan);
  void plan_banners(const OverlayData& data, Plan& plan);
  void plan_legend(const OverlayData& data, Plan& plan);
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

/// Top left: title, time, tick, force, depth, pieces that came loose, cells that are inside out.
void Overlay::Parts::plan_facts(const OverlayData& data, Plan& plan) {
  const int pad = px(16), step = px(28), x = px(20) + pad, inner = px(300);
  int y = px(20) + pad;
  if (!data.title.empty()) {
    plan.lines.push_back(line(large, large.shortened(data.title, inner), x, y, kWhite));
    y += px(38);
  }
  struct Fact {
    std::string name, value;
    bool is_bad = false;
  };
  const auto force_of = [&](const char* name, const HandLoad& hand) {
    return Fact{name, output::fixed(hand.force, 3) + " N", is_too_strong(data, hand)};
  };
  const auto depth_of = [&](const std::string& which, const HandLoad& hand) {
    return Fact{(!hand.is_blade  ? "depth"
                 : which.empty() ? "cut depth"
                                 : "cut") +
                    which,
                output::fixed(1000 * hand.depth, 2) + " mm", is_too_deep(data, hand)};
  };
  const std::array<Fact, 11> facts{
      {{"session", small.shortened_inside(data.session, px(195))},
       {"model", small.shortened(data.model, px(195))},
       {data.is_over ? "ended" : "time", output::fixed(data.time, 3) + " s"},
       {"clock behind", data.slip < 0.01 ? "" : output::fixed(data.slip, 2) + " s", true},
       {"tick", std::to_string(data.tick)},
       force_of("force", data.hand),
       depth_of("", data.hand),
       data.second ? force_of("force 2", *data.second) : Fact{},
       data.second ? depth_of(" 2", *data.second) : Fact{},
       {"loose", data.loose == 0 ? "" : std::to_string(data.loose) + (data.loose == 1 ? " piece" : " pieces")},
       {"inside out",
        data.inside_out == 0 ? "" : std::to_string(data.inside_out) + (data.inside_out == 1 ? " cell" : " cells"),
        true}}};
  for (const auto& [name, value, is_bad] : facts) {
    if (value.empty()) continue;
    plan.lines.push_back(line(small, name, x, y, kGrey));
    Line shown = line(small, value, 0, y, is_bad ? kRed : kWhite);
    shown.placed.box.x = x + inner - shown.placed.box.width;  // right-aligned, so that digits stand still
    plan.lines.push_back(shown);
    y += step;
  }
  plan.facts = {px(20), px(20), inner + 2 * pad, y - px(20) + pad - px(28 - 21)};
}

/// Bottom left: the force of the last seconds.
void Overlay::Parts::plan_plot(const OverlayData& data, Plan& plan) {
  if (data.history.empty()) return;
  plan.top_force = round_up(std::max(data.least_top_force, largest_force(data)));
  const int pad = px(16), w = px(332), h = px(160);
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

/// The verdict: top right, or below the facts. The damage warning: bottom right, or above the plot.
void Overlay::Parts::plan_banners(const OverlayData& data, Plan& plan) {
  const int pad = px(16), margin = px(20), h = px(17) + 2 * px(13);
  const auto banner = [&](const std::string& text, int y, const Ink& ink) {
    const std::string shown = small.shortened(text, std::min(px(640), width - 2 * margin - 2 * pad));
    const int w = small.width(shown) + 2 * pad;
    const PixelBox box{is_narrow ? margin : width - margin - w, y, w, h};
    plan.lines.push_back(line(small, shown, box.x + pad, y + px(13), ink));
    return box;
  };
  if (!data.verdict.empty()) {
    const Ink ink = data.verdict_tone == VerdictTone::good  ? kGreen
                    : data.verdict_tone == VerdictTone::bad ? kAmber
                                                            : kWhite;
    plan.verdict = banner(data.verdict, is_narrow ? plan.facts.y + plan.facts.height + px(10) : margin, ink);
  }
  if (const std::string text = damage_text(data); !text.empty())
    plan.warning = banner(text, is_narrow ? height - margin - px(160) - px(10) - h : height - margin - h, kWhite);
}

/// Bottom right, above the place of the warning.
void Overlay::Parts::plan_legend(const OverlayData& data, Plan& plan) {
  if (data.legend.title.empty()) return;
  const int pad = px(16), w = px(250), h = px(98);
  plan.legend = {width - px(20) - w, height - px(20) - h - (is_narrow ? 0 : px(43) + px(10)), w, h};
  const int x = plan.legend.x + pad, inner = w - 2 * pad, y = plan.legend.y + px(12);
  plan.lines.push_back(line(small, small.shortened(data.legend.title, inner), x, y, kGrey));
  plan.bar = {x, y + px(30), inner, px(16)};
  plan.lines.push_back(line(small, data.legend.low, x, plan.bar.y + px(22), kWhite));
  Line high = line(small, data.legend.high, 0, plan.bar.y + px(22), kWhite);
  high.placed.box.x = x + inner - high.placed.box.width;
  plan.lines.push_back(high);
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
  plan_facts(data, plan), plan_plot(data, plan), plan_banners(data, plan), plan_legend(data, plan);
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

Overlay::Overlay(int width, int height) : parts_(std::make_unique<Parts>(width, height)) {}
Overlay::~Overlay() = default;
Overlay::Overlay(Overlay&&) noexcept = default;

void Overlay::draw(Frame& frame, const OverlayData& data) {
  CTPM_CHECK(frame.width == parts_->width && frame.height == parts_->height,
             "an overlay draws on frames of its own size");
  cv::Mat rgb(frame.height, frame.width, CV_8UC3, frame.rgb.data());
  const Plan plan = parts_->plan(data);
  const int radius = parts_->px(10);
  for (const PixelBox& box : {plan.facts, plan.plot, plan.verdict, plan.legend})
    draw_panel(rgb, box, {14, 19, 25}, 176, radius);
  draw_panel(rgb, plan.warning, {170, 24, 18}, 224, radius);
  for (const Line& line : plan.lines)
    (line.is_large ? parts_->large : parts_->small)
        .write(rgb, line.placed.box.x, line.placed.box.y, line.placed.text, line.ink);
  if (!data.history.empty()) parts_->draw_curve(rgb, data, plan);
  if (!data.legend.title.empty()) parts_->draw_bar(rgb, data.legend, plan.bar);
}

std::vector<PlacedText> Overlay::layout(const OverlayData& data) {
  std::vector<PlacedText> texts;
  for (const Line& line : parts_->plan(data).lines) texts.push_back(line.placed);
  return texts;
}

}  // namespace ctpm::render
