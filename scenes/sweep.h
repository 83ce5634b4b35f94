#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/result.h"
#include "scenes/problems.h"
#include "scenes/text_places.h"

namespace ctpm::scenes {

/// One value that a sweep puts into a file.
struct SweepValue {
  std::string json;   ///< as a text of JSON
  std::string shown;  ///< for tables: a text without its quotes, the numbers of a point with spaces between
  std::optional<double> number;

  friend bool operator==(const SweepValue& a, const SweepValue& b) { return a.json == b.json; }
};

enum class SweepMethod { grid, list, latin_hypercube };
enum class SweepTarget { scene, script };
enum class SweepScale { linear, logarithmic };

/// One thing that varies: a key of the scene or of the script, or the whole file.
struct SweepAxis {
  std::string name;  ///< of its column; empty: the last part of the key, or "scene", "script"
  SweepTarget of = SweepTarget::scene;
  std::string key;                 ///< JSON pointer; empty: the whole file, whose paths are the values
  std::vector<SweepValue> values;  ///< empty: from `from` to `to`
  std::optional<double> from, to;
  std::optional<std::int32_t> steps;  ///< of a grid, both ends included
  SweepScale scale = SweepScale::linear;

  std::string column() const;
};

/// What varies between sessions that are otherwise alike.
struct SweepSpec {
  std::string name, scene;
  std::string script;              ///< empty: the script that presses and cuts at the organs' tops
  std::optional<double> duration;  ///< after which a session ends [s]
  SweepMethod method = SweepMethod::grid;
  std::optional<std::int32_t> samples;  ///< of one Latin hypercube
  std::vector<SweepValue> seeds;        ///< of a Latin hypercube each; none: seed 1
  std::vector<SweepAxis> vary;
};

struct SweepText {
  SweepSpec spec;
  TextPlaces places;
};

/// A sweep of which some values may be refused. Refused values keep their defaults; `problems` names them.
struct SweepDraft {
  SweepText sweep;
  Problems problems;
};

/// As read_sweep(), but returns what could be read together with its errors. Errors: the text is not JSON.
Result<SweepDraft> read_sweep_draft(std::string_view text, const std::string& file_name);

/// Reads the text of a sweep (SWEEP.md). Reports every error at once, each with `file:line:col`: those of the text, its
/// values, and the rules between them. Reads no scene and no script.
Result<SweepText> read_sweep(std::string_view text, const std::string& file_name);

/// A text of a scene or a script with places for values. Comments and layout stay.
class ValueSlots {
 public:
  /// A text without places, of any format.
  explicit ValueSlots(const std::string& text) : between_{text} {}

  /// Finds the places of JSON pointers. A key that is not written is added where the object around it is, or can be.
  /// Errors: the text is not JSON; a pointer that leads through an item of a list that is not there, or through a value
  /// that is no object; one that leads into the value of another.
  static Result<ValueSlots> find(const std::string& text, const std::string& file_name,
                                 const std::vector<std::string>& pointers);

  /// The text with these values, as JSON, at the places (pointer_count).
  std::string with(const std::vector<std::string>& values) const;

  /// Where values stand in the text as its author wrote it; of a text without slots: nothing is known.
  const TextPlaces& places() const { return places_; }

 private:
  TextPlaces places_;
  std::vector<std::string> between_;  ///< the text around the places, in its order (pointer_count + 1)
  std::vector<std::size_t> pointer_;  ///< whose place follows each of them (pointer_count)
};

/// JSON Schema (2020-12) of sweeps, checked in as sweep.schema.json, and the Markdown tables within SWEEP.md.
std::string sweep_schema();
std::string sweep_reference();

}  // namespace ctpm::scenes
