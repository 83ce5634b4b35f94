#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/inputs.h"
#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/result.h"
#include "scenes/places.h"
#include "scenes/scene_spec.h"

namespace ctpm::scenes {

struct SceneDraft;

/// A tool appears in a hand.
struct TakeStep {
  std::string tool;            ///< name of a tool of the scene
  Vec3 at;                     ///< where its frame's origin appears [m]
  Vec3 pointing{0, 0, -1};     ///< direction from handle to tip; any length but zero
  std::optional<Vec3> facing;  ///< direction of the tool's +x, a blade's cutting side; not along `pointing`
  friend bool operator==(const TakeStep&, const TakeStep&) = default;
};

/// It moves along a straight line.
struct MoveStep {
  Vec3 to;           ///< [m]
  double speed = 0;  ///< between the ramps at start and end [m/s]
  friend bool operator==(const MoveStep&, const MoveStep&) = default;
};

/// It moves into the tissue.
struct PressStep {
  double distance = 0;                ///< at most [m]
  Vec3 direction{0, 0, -1};           ///< any length but zero
  double speed = 0;                   ///< [m/s]
  std::optional<double> until_force;  ///< ends when the tissue's reaction reaches it [N]
  friend bool operator==(const PressStep&, const PressStep&) = default;
};

/// It leaves the tissue.
struct ReleaseStep {
  double distance = 0;      ///< [m]
  Vec3 direction{0, 0, 1};  ///< where the tool leaves to; any length but zero
  double speed = 0;         ///< [m/s]
  friend bool operator==(const ReleaseStep&, const ReleaseStep&) = default;
};

/// Its tip moves along a path.
struct CutStep {
  std::vector<Vec3> path;      ///< of the tip, from where it is [m]
  double speed = 0;            ///< [m/s]
  std::optional<bool> smooth;  ///< along one curve through the points; otherwise straight, at rest at each
  std::optional<bool> turns;   ///< about its own axis, as much as the curve does; only with `smooth`
  friend bool operator==(const CutStep&, const CutStep&) = default;
};

/// One step of a script: exactly one of `take`, `move`, `press`, `release`, `cut`, `wait`, `put_away` is
/// set. SCRIPT.md.
struct ScriptStep {
  using Take = TakeStep;
  using Move = MoveStep;
  using Press = PressStep;
  using Release = ReleaseStep;
  using Cut = CutStep;

  std::optional<Take> take;
  std::optional<Move> move;
  std::optional<Press> press;
  std::optional<Release> release;
  std::optional<Cut> cut;
  std::optional<double> wait;    ///< [s]
  std::optional<bool> put_away;  ///< no tool from here on
  /// Which hand does it, 1 or 2; unset: the first. The other one holds still. Not with `wait`.
  std::optional<std::int32_t> hand;

  std::size_t hand_number() const { return hand == 2 ? 1 : 0; }  ///< in Inputs
  friend bool operator==(const ScriptStep&, const ScriptStep&) = default;
};

/// A sequence of tool motions, as an author wrote it.
struct Script {
  std::vector<ScriptStep> steps;
  friend bool operator==(const Script&, const Script&) = default;
};

/// Reads a script's text. Reports every error at once, each with `file:line:col`: those of the text and its values; a
/// tool or a hand that the scene does not have; a step that moves a tool before one was taken; a tool that both hands
/// hold. Without `finder`, places by meaning are checked as texts, and have coordinates that stand for nothing.
Result<Script> read_script(std::string_view text, const std::string& file_name,
                           const std::vector<std::string>& tool_names, std::int32_t hands = 1,
                           PlaceFinder* finder = nullptr);
/// The same for a Model. Also reports other tools that two hands cannot hold at once (stepping::hands_conflict()).
Result<Script> read_script_for(std::string_view text, const std::string& file_name, const Model& model,
                               PlaceFinder* finder = nullptr);

/// The errors of a script for a scene that is not built yet and may have refused values: what those decide is not
/// judged.
Errors check_script(std::string_view text, const std::string& file_name, const SceneDraft& scene);

/// Text of a script. The same steps give the same text, and read_script gives the same steps again.
std::string write_script(const Script& script);

/// A script that presses the top of each organ with the scene's first ball and cuts across it with its first scalpel,
/// if the scene has them, one organ after the other.
Script default_script(const SceneSpec& scene, std::span<const FilledOrgan> organs);

/// Where and how the default script works on an organ that is too thin or too soft where it usually does.
struct ScriptPlace {
  double along = 0;           ///< moves its places by this share of the organ's length
  bool cuts_through = false;  ///< the blade is drawn through the whole organ, from back to front
  double depth_share = 1;     ///< of the usual depth of a cut that does not go through
  bool cuts_first = false;    ///< nothing is pressed before the cut
};

/// The steps of default_script() for organ `index`.
Script organ_script(const SceneSpec& scene, std::span<const FilledOrgan> organs, std::size_t index,
                    ScriptPlace place = {});

/// How far a tool has turned about its own axis, its +z.
struct ToolTurn {
  double cosine = 1, sine = 0;
};

/// How a press to a force ended.
enum class PressEnd { none, at_force, at_depth };

/// The inputs of a script, tick by tick, one hand after the other. Each stretch starts and ends at rest: speed rises
/// and falls along a cubic; in between it is the step's speed. A press to a force stops when the force is reached. Uses
/// no transcendental function, so every machine gives the same inputs.
class ScriptPlayer {
 public:
  /// `tick` [s]; the script's tools must be those of `tools`.
  ScriptPlayer(const Script& script, std::span<const Tool> tools, double tick);

  /// Ticks of the script as far as they are known: a press to a force counts with its largest length until it has
  /// ended.
  std::int64_t tick_count() const;

  /// A pure function of the tick and of the forces of earlier calls of feel(). After the end the last inputs stay.
  Inputs at(std::int64_t tick) const;

  /// The hand that moves in a tick.
  std::size_t hand_at(std::int64_t tick) const;

  /// Tells the player the tissue's `force` on the tool in hand_at(tick) [N] in tick `tick`. If that ends a press to a
  /// force, the next step starts where the tool is. Without these calls each press has its largest length.
  PressEnd feel(std::int64_t tick, Vec3 force);

 private:
  struct Stretch {
    std::int64_t first = 0, count = 0;  ///< ticks
    std::int64_t planned = 0;           ///< ticks, had it not ended before
    std::size_t hand = 0;               ///< that moves
    Inputs held;                        ///< what both hands do, but for the place of the one that moves
    std::vector<Vec3> points;           ///< of the way, straight from one to the next; at least one [m]
    std::vector<double> lengths;        ///< of the way up to each point [m]
    std::vector<ToolTurn> turns;        ///< since the first point, at each; empty: the tool does not turn
    std::size_t step = 0;               ///< of the script, to which it belongs
    double until_force = 0;             ///< [N]; 0: none
  };
  void plan(std::size_t first_step, Inputs hands);
  Stretch& add_stretch(std::size_t step, const Inputs& hands, std::vector<Vec3> points, double duration);
  const Stretch& stretch_at(std::int64_t tick) const;

  Script script_;
  std::vector<Tool> tools_;
  double tick_;
  std::vector<Stretch> stretches_;
};

}  // namespace ctpm::scenes
