#include "studio/calibrate/measurement.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "studio/output/csv_cells.h"

namespace ctpm::calibrate {
namespace {

constexpr double kMostSeconds = 1000, kMostMillimetres = 100, kMostNewtons = 1000;
constexpr std::size_t kLeastRows = 3, kMostErrors = 100;

class MeasurementReader {
 public:
  explicit MeasurementReader(const std::string& file) : file_(file) {}

  Result<std::vector<Measurement>> read(std::string_view text) {
    const std::vector<output::CsvLine> lines = output::csv_lines(text);
    if (lines.empty()) return Error{file_, "is empty", "the first row names the columns: depth_mm, force_n"};
    line_ = lines.front().number;
    if (!read_header(lines.front().text)) return errors_;
    for (std::size_t i = 1; i < lines.size(); ++i) line_ = lines[i].number, read_row(lines[i].text);
    if (errors_.empty()) check_specimens();
    if (!errors_.empty()) return errors_;
    return std::move(measurements_);
  }

 private:
  void add(std::size_t column, const std::string& message, const std::string& hint = "") {
    if (errors_.size() < kMostErrors)
      errors_.push_back({file_ + ":" + std::to_string(line_) + ":" + std::to_string(column), message, hint});
  }

  bool read_header(std::string_view line) {
    static const std::set<std::string_view> kKnown{"time_s", "depth_mm", "force_n", "load_n", "specimen"};
    if (output::has_other_separators(line)) return add(1, output::kOtherSeparators, output::kSeparatorHint), false;
    for (const output::CsvCell& cell : output::csv_cells(line)) {
      const std::string name(cell.text.substr(0, 40));
      if (!kKnown.contains(cell.text))
        add(cell.column, "the column '" + name + "' is not known",
            "time_s, depth_mm, force_n, load_n, specimen: each ends in its unit");
      else if (!place_.emplace(name, width_).second)
        add(cell.column, "the column " + name + " stands twice");
      ++width_;
    }
    const auto has = [&](const char* name) { return place_.contains(name); };
    if (has("time_s") && has("load_n") && has("depth_mm") && !has("force_n"))
      kind_ = Kind::creep;
    else if (has("depth_mm") && has("force_n") && !has("load_n"))
      kind_ = has("time_s") ? Kind::relaxation : Kind::indentation;
    else
      add(1, "the columns are those of no experiment",
          "depth_mm, force_n: indentation; time_s with them: relaxation; time_s, load_n, depth_mm: creep");
    return errors_.empty();
  }

  void read_row(std::string_view line) {
    cells_ = output::csv_cells(line);
    if (cells_.size() != width_)
      return add(1, "got " + std::to_string(cells_.size()) + " values, must be " + std::to_string(width_));
    const std::size_t before = errors_.size();
    Row row;
    if (kind_ != Kind::indentation) row.time = number("time_s", 0, kMostSeconds);
    const double depth = number("depth_mm", 0, kMostMillimetres);
    const double force =
        number(kind_ == Kind::creep ? "load_n" : "force_n", kind_ == Kind::creep ? 0 : -kMostNewtons, kMostNewtons);
    row.imposed = kind_ == Kind::creep ? force : depth, row.measured = kind_ == Kind::creep ? depth : force;
    if (errors_.size() != before) return;
    Measurement& own = of_specimen();
    if (kind_ != Kind::indentation && !own.rows.empty() && !(row.time > own.rows.back().time))
      return add(cells_[place_["time_s"]].column, "time_s: time must rise from row to row");
    if (kind_ == Kind::indentation && !own.rows.empty() && !(row.imposed > own.rows.back().imposed))
      return add(cells_[place_["depth_mm"]].column, "depth_mm: depth must rise from row to row");
    own.rows.push_back(row);
  }

  Measurement& of_specimen() {
    const std::string specimen = place_.contains("specimen") ? std::string(cells_[place_["specimen"]].text) : "";
    const std::string name = file_ + (specimen.empty() ? "" : ", " + specimen);
    const auto found = std::find_if(measurements_.begin(), measurements_.end(),
                                    [&](const Measurement& one) { return one.name == name; });
    return found != measurements_.end() ? *found : measurements_.emplace_back(Measurement{name, specimen, kind_, {}});
  }

  double number(const std::string& name, double least, double most) {
    const output::CsvCell& cell = cells_[place_[name]];
    double value = 0;
    const char* end = cell.text.data() + cell.text.size();
    const auto [stop, problem] = std::from_chars(cell.text.data(), end, value);
    if (problem != std::errc() || stop != end || !(value >= least && value <= most))
      add(cell.column, name + ": got '" + std::string(cell.text.substr(0, 40)) + "', must be a number in [" +
                           std::to_string(int(least)) + ", " + std::to_string(int(most)) + "]");
    return value;
  }

  void check_specimens() {
    if (measurements_.empty()) add(1, "there is no row after the names of the columns");
    for (const Measurement& one : measurements_) {
      if (one.rows.size() < kLeastRows)
        errors_.push_back({one.name,
                           "has " + std::to_string(one.rows.size()) + (one.rows.size() == 1 ? " row" : " rows") +
                               ", must have at least " + std::to_string(kLeastRows),
                           ""});
      double work = 0;  // of the ball, as far as it presses
      for (const Row& row : one.rows) work += row.imposed * row.measured;
      if (one.kind != Kind::creep && work <= 0)
        errors_.push_back({one.name, "the forces are not above 0 N where the ball presses",
                           "a force that pushes the ball away is above 0: turn the sign round if it is the other way"});
      // The specimen is at rest at 0 s. A force that was measured there under a press is met by no material.
      if (one.kind == Kind::relaxation && one.rows.front().time <= 0 && one.rows.front().imposed > 0)
        errors_.push_back({one.name, "is pressed at 0 s already, and the network is at rest then",
                           "let it begin with 0 mm and 0 N at 0 s, and the depth at the time when it was reached"});
      const double last = one.rows.back().imposed;
      if (one.kind == Kind::creep && (last <= 0 || std::any_of(one.rows.begin(), one.rows.end(),
                                                               [&](const Row& row) { return row.imposed > last; })))
        errors_.push_back({one.name, "the load must rise to its last value, more than 0, and stay there", ""});
    }
  }

  const std::string& file_;
  Kind kind_ = Kind::indentation;
  std::size_t line_ = 0, width_ = 0;
  std::map<std::string, std::size_t> place_;  ///< of each column in a row
  std::vector<output::CsvCell> cells_;        ///< of the present row
  std::vector<Measurement> measurements_;
  Errors errors_;
};

}  // namespace

const char* to_word(Kind kind) {
  static constexpr const char* words[] = {"indentation", "relaxation", "creep"};
  return words[int(kind)];
}

Result<std::vector<Measurement>> read_measurements(std::string_view text, const std::string& file_name) {
  return MeasurementReader(file_name).read(text);
}

}  // namespace ctpm::calibrate
