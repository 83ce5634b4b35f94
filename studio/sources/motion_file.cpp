#include "studio/sources/motion_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "studio/output/csv_cells.h"
#include "studio/sources/rotation.h"

namespace ctpm::sources {
namespace {

enum Column { time, x, y, z, qw, qx, qy, qz, buttons, tool, column_count };
constexpr std::array<const char*, column_count> kNames{"time_s",  "tool_x_mm", "tool_y_mm", "tool_z_mm", "tool_qw",
                                                       "tool_qx", "tool_qy",   "tool_qz",   "buttons",   "tool"};
constexpr double kMostMillimetres = 100000, kMostSeconds = 100000;
constexpr double kLengthTolerance = 0.1;  // of a quaternion's length: allows loggers that round to two digits
constexpr std::size_t kMostErrors = 100;

/// The text of a cell, shortened for a message.
std::string shown(std::string_view text) { return "'" + std::string(text.substr(0, 40)) + "'"; }

class MotionReader {
 public:
  MotionReader(const std::string& file_name, const std::vector<Tool>& tools) : file_(file_name), tools_(tools) {}

  Result<Motion> read(std::string_view text) {
    const std::vector<output::CsvLine> lines = output::csv_lines(text);
    for (const output::CsvLine& line : lines) {
      line_ = line.number;
      if (&line != &lines.front())
        read_row(line.text);
      else if (!read_header(line.text))
        return errors_;  // rows cannot be checked without the columns
    }
    if (lines.empty()) return Error{file_, "is empty", "the first row names the columns: time_s, tool_x_mm ..."};
    if (motion_.samples.empty() && error_count_ == 0) {
      ++line_;
      add(1, "there is no row after the names of the columns");
    }
    if (error_count_ > kMostErrors)
      errors_.push_back({file_, "and " + std::to_string(error_count_ - kMostErrors) + " more errors", ""});
    if (!errors_.empty()) return errors_;
    return std::move(motion_);
  }

 private:
  void add(std::size_t column, const std::string& message, const std::string& hint = "") {
    if (++error_count_ <= kMostErrors)
      errors_.push_back({file_ + ":" + std::to_string(line_) + ":" + std::to_string(column), message, hint});
  }

  bool read_header(std::string_view line) {
    if (output::has_other_separators(line)) return add(1, output::kOtherSeparators, output::kSeparatorHint), false;
    const std::vector<output::CsvCell> cells = output::csv_cells(line);
    width_ = cells.size();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto name = std::find(kNames.begin(), kNames.end(), cells[i].text);
      if (name == kNames.end()) {
        motion_.unused_columns.emplace_back(cells[i].text.substr(0, 40));
        continue;
      }
      std::optional<std::size_t>& place = place_[std::size_t(name - kNames.begin())];
      if (place) add(cells[i].column, std::string("the column ") + *name + " stands twice");
      place = i;
    }
    std::string missing;
    for (const Column needed : {time, x, y, z})
      if (!place_[needed]) missing += (missing.empty() ? "" : ", ") + std::string(kNames[needed]);
    if (!missing.empty()) add(1, "missing columns: " + missing, "the first row names the columns");
    const auto turns = std::count_if(place_.begin() + qw, place_.begin() + qz + 1, [](auto& p) { return bool(p); });
    if (turns != 0 && turns != 4)
      add(1, "an orientation needs all of tool_qw, tool_qx, tool_qy, tool_qz; " + std::to_string(turns) + " are there");
    return errors_.empty();
  }

  void read_row(std::string_view line) {
    cells_ = output::csv_cells(line);
    if (cells_.size() != width_)
      return add(1, "got " + std::to_string(cells_.size()) + " values, must be " + std::to_string(width_) +
                        ", as many as names in the first row");
    const std::size_t errors_before = error_count_;
    MotionSample sample;
    sample.line = line_;
    sample.time = number(time, -1e12, 1e12);
    sample.inputs.position = 1e-3 * Vec3{length(x), length(y), length(z)};
    if (place_[qw]) sample.inputs.world_from_tool = orientation();
    if (place_[buttons]) sample.inputs.buttons = button_set();
    sample.inputs.tool = tool_index();
    if (error_count_ != errors_before) return;
    if (!motion_.samples.empty()) {
      const output::CsvCell& cell = cells_[*place_[time]];
      const double before = motion_.samples.back().time;
      if (!(sample.time > before))
        return add(cell.column, "time_s: got " + std::string(cell.text) + ", time must rise from row to row",
                   sample.time == before ? "it stands still here" : "it goes back here");
      if (sample.time - motion_.samples.front().time > kMostSeconds)
        return add(cell.column, "time_s: more than 100000 s after the first row");
    }
    motion_.samples.push_back(sample);
  }

  double number(Column column, double low, double high) {
    const output::CsvCell& cell = cells_[*place_[column]];
    double value = 0;
    const char* end = cell.text.data() + cell.text.size();
    const auto [stop, problem] = std::from_chars(cell.text.data(), end, value);
    if (problem != std::errc() || stop != end || !std::isfinite(value)) {
      add(cell.column, std::string(kNames[column]) + ": got " + shown(cell.text) + ", must be a finite number");
      return 0;
    }
    if (!(value >= low && value <= high))
      add(cell.column, std::string(kNames[column]) + ": got " + std::string(cell.text) + ", is out of range");
    return value;
  }

  double length(Column column) { return number(column, -kMostMillimetres, kMostMillimetres); }

  Quat orientation() {
    const Quat q{number(qw, -2, 2), number(qx, -2, 2), number(qy, -2, 2), number(qz, -2, 2)};
    if (!(std::abs(length_of(q) - 1) <= kLengthTolerance)) {
      add(cells_[*place_[qw]].column, "tool_qw, tool_qx, tool_qy, tool_qz: must have length 1");
      return {};
    }
    return normalised(q);
  }

  std::uint32_t button_set() {
    const output::CsvCell& cell = cells_[*place_[buttons]];
    std::uint32_t set = 0;
    const char* end = cell.text.data() + cell.text.size();
    const auto [stop, problem] = std::from_chars(cell.text.data(), end, set);
    if (problem != std::errc() || stop != end)
      add(cell.column, "buttons: got " + shown(cell.text) + ", must be a whole number in [0, 4294967295]");
    return set;
  }

  std::int32_t tool_index() {
    if (!place_[tool]) return tools_.empty() ? -1 : 0;
    const output::CsvCell& cell = cells_[*place_[tool]];
    if (cell.text.empty()) return -1;
    std::string known;
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      if (tools_[i].name == cell.text) return std::int32_t(i);
      known += (known.empty() ? "" : ", ") + tools_[i].name;
    }
    add(cell.column, "tool: the scene has no tool " + shown(cell.text),
        known.empty() ? "the scene has no tools" : "its tools: " + known);
    return -1;
  }

  const std::string& file_;
  const std::vector<Tool>& tools_;
  Motion motion_;
  Errors errors_;
  std::size_t error_count_ = 0, line_ = 1, width_ = 0;
  std::array<std::optional<std::size_t>, column_count> place_;  ///< in a row
  std::vector<output::CsvCell> cells_;                          ///< of the present row
};

}  // namespace

Result<Motion> read_motion(std::string_view text, const std::string& file_name, const std::vector<Tool>& tools) {
  return MotionReader(file_name, tools).read(text);
}

Inputs motion_at(const Motion& motion, double time) {
  const std::vector<MotionSample>& samples = motion.samples;
  // A motion that was sampled at the ticks is not interpolated: a tick's time is rounded by less than this.
  constexpr double kRounding = 1e-9;  // [s]
  const double moment = samples.front().time + time;
  const auto next = std::upper_bound(samples.begin(), samples.end(), moment + kRounding,
                                     [](double t, const MotionSample& s) { return t < s.time; });
  if (next == samples.begin()) return samples.front().inputs;
  const MotionSample& a = *(next - 1);
  if (next == samples.end() || moment <= a.time + kRounding) return a.inputs;
  // Between two tools no hand moved either of them: the first stays where it was last seen.
  if (next->inputs.tool != a.inputs.tool) return a.inputs;
  const double share = (moment - a.time) / (next->time - a.time);
  Inputs inputs = a.inputs;
  inputs.position = a.inputs.position + share * (next->inputs.position - a.inputs.position);
  inputs.world_from_tool = turned_towards(a.inputs.world_from_tool, next->inputs.world_from_tool, share);
  return inputs;
}

std::int64_t motion_tick_count(const Motion& motion, double tick) {
  return std::int64_t(std::floor((motion.samples.back().time - motion.samples.front().time) / tick + 1e-6)) + 1;
}

}  // namespace ctpm::sources
