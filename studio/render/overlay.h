#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "studio/render/frame.h"
#include "studio/render/scene_view.h"

namespace ctpm::render {

/// One point of the running force plot.
struct ForcePoint {
  double time = 0;    ///< [s]
  double force = 0;   ///< [N], >= 0
  double second = 0;  ///< that of the second hand [N], >= 0
};

/// What the tissue does to the tool in a hand.
struct HandLoad {
  double force = 0;       ///< magnitude on the tool [N]
  double depth = 0;       ///< indentation of the touched tissue, or depth of the cut along the blade [m]
  bool is_blade = false;  ///< the depth is that of the cut, which has no limit
};

/// What the marks of one colour mean.
struct MarkMeaning {
  Colour colour{};
  std::string text;
  bool is_line = false;  ///< else they are dots
};

/// Whether a session stands still while the one beside it goes on.
enum class Stands { no, before_start, after_end };

enum class VerdictTone { none, good, bad };

/// How much the overlay says. A bad verdict is shown at every level.
enum class OverlayLevel { none, caption, small, full };

/// The content of the overlay. Empty texts are left out; long ones are shortened with an ellipsis.
struct OverlayData {
  std::string title;    ///< of the scene
  std::string model;    ///< structure of the tissue: "CTPM"
  std::string session;  ///< which recording it is, if there may be several
  std::string role;     ///< of a pair, whose it is: expert or trainee; empty: said of none
  std::string ghost;    ///< whose tool is shown through; not told in a narrow picture
  double time = 0;      ///< [s]
  Stands stands = Stands::no;
  std::optional<double> pace;  ///< time of the session against that of the film; not shown if unset
  std::int64_t tick = 0;
  OverlayLevel level = OverlayLevel::full;
  HandLoad hand;
  HandLoad worst;                  ///< what was beyond a limit before; the warning of it stays
  std::optional<HandLoad> second;  ///< of the second hand, in a scene that has two
  std::int64_t loose = 0;          ///< pieces of tissue that came loose; not shown if 0
  std::int32_t inside_out = 0;     ///< tissue cells that are inside out; not shown if 0
  double slip = 0;                 ///< real time that the session lacks up to now [s]; not shown below 10 ms
  double damage_depth = 0;         ///< depth beyond which the tissue is damaged [m]; 0: no limit
  double damage_force = 0;         ///< force beyond which the tissue is damaged [N]; 0: no limit
  std::string verdict;             ///< result of the replay, one line
  VerdictTone verdict_tone = VerdictTone::none;
  std::string caption;              ///< what happens now
  std::vector<ForcePoint> history;  ///< in order of time; empty: no plot
  Legend legend;                    ///< of the view; not drawn without a title
  std::vector<MarkMeaning> marks;   ///< in the picture; empty: no panel
  double plot_span = 5;             ///< time that the plot covers, up to now [s], > 0
  double least_top_force = 0.1;     ///< smallest upper end of the plot's axis [N], > 0
  std::vector<Pixel> tools;         ///< points of the tools: panels near them fade
  int taken_right = 0;              ///< width at the lower right where small pictures stand [pixels]
  bool has_insets = false;          ///< there are small pictures; in a narrow picture at the right above the panels
};

/// The next round number at or above `value`, at least 1e-3: 1, 2 or 5 times a power of ten.
double round_up(double value);

/// The largest force in the running plot [N].
double largest_force(const OverlayData& data);

/// A rectangle of the picture [pixels].
struct PixelBox {
  int x = 0, y = 0, width = 0, height = 0;

  bool holds(const Pixel& p) const { return x <= p.x && p.x < x + width && y <= p.y && p.y < y + height; }
  bool overlaps(const PixelBox& o) const {
    return x < o.x + o.width && o.x < x + width && y < o.y + o.height && o.y < y + height;
  }
};

/// A text and its rectangle.
struct PlacedText {
  std::string text;
  PixelBox box;
};

/// Draws on pictures of one size. The layout of 1280x720 is scaled. Narrow pictures (one of a pair side by side) get
/// larger letters and stacked banners.
class Overlay {
 public:
  /// `zoom`: of letters and panels, for pictures that are looked at in small.
  Overlay(int width, int height, double zoom = 1);
  ~Overlay();
  Overlay(Overlay&&) noexcept;

  /// Draws the panels onto the frame, which must have the overlay's size. Equal frames and data give equal pixels.
  void draw(Frame& frame, const OverlayData& data);

  /// All texts of draw() and their rectangles, without drawing.
  std::vector<PlacedText> layout(const OverlayData& data);

  /// The panels of draw() but the warning, without drawing.
  std::vector<PixelBox> standing_panels(const OverlayData& data);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ctpm::render
