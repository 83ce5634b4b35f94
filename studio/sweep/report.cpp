// The page about a sweep: what goes with what, the closest first, and every session that failed.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "studio/output/number_text.h"
#include "studio/reports/report.h"
#include "studio/sweep/collect.h"
#include "studio/sweep/statistics.h"

namespace ctpm::sweep {
namespace {

constexpr std::size_t kMostPlots = 12, kMostPoints = 2000, kMostRows = 100, kMostGroups = 12;

/// A column of numbers beside a measure that it may move.
struct Relation {
  std::size_t column = 0, measure = 0;
  double correlation = 0;
};

class Page {
 public:
  explicit Page(const Collection& collection) : collection_(collection), plan_(collection.plan) {
    for (std::size_t k = 0; k < plan_.columns.size(); ++k) {
      numbers_.emplace_back();
      for (const Task& task : plan_.tasks)
        numbers_.back().push_back(plan_.is_number[k] ? std::strtod(task.shown[k].c_str(), nullptr) : NAN);
    }
    for (const std::vector<double>& values : collection.measured) spreads_.push_back(spread_of(of_done(values)));
  }

  std::string html() {
    reports::Report report("Sweep: " + plan_.name,
                           std::to_string(plan_.tasks.size()) + " sessions, which differ in " + columns_text() + ".");
    const std::vector<Relation> relations = closest_relations();
    conclude(report, relations);
    if (!relations.empty()) {
      report.add_heading("What goes with what, the closest first");
      report.add_plots(plots_of(relations));
      report.add_table(relation_table(relations));
    }
    report.add_heading("All values");
    report.add_table(spread_table());
    for (std::size_t k = 0; k < plan_.columns.size(); ++k)
      if (const reports::Table table = group_table(k); !table.rows.empty()) report.add_table(table);
    if (const reports::Table table = unfinished_table(); !table.rows.empty()) {
      report.add_heading("Sessions without a result");
      report.add_table(table);
    }
    return report.html();
  }

 private:
  /// Values of sessions that failed count nowhere.
  std::vector<double> of_done(std::vector<double> values) const {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (collection_.reports[i].state != TaskState::done) values[i] = NAN;
    return values;
  }

  bool varies(std::size_t measure) const { return spreads_[measure].most > spreads_[measure].least; }

  /// What has more than one value; a seed that all share is not listed.
  std::string columns_text() const {
    std::string text;
    for (std::size_t k = 0; k < plan_.columns.size(); ++k)
      if (std::any_of(plan_.tasks.begin(), plan_.tasks.end(),
                      [&](const Task& task) { return task.shown[k] != plan_.tasks[0].shown[k]; }))
        text += (text.empty() ? "" : ", ") + plan_.columns[k];
    return text.empty() ? "nothing" : text;
  }

  /// What moves most with what varies; empty: nothing that is not likely by chance.
  std::string finding(const std::vector<Relation>& relations) const {
    constexpr double kClear = 0.5;     // of a rank correlation
    constexpr double kMatters = 0.01;  // of the largest value: what varies by less, moves nothing however clearly
    const auto found = std::ranges::find_if(relations, [&](const Relation& relation) {
      const Spread& spread = spreads_[relation.measure];
      return spread.most - spread.least > kMatters * std::max(std::abs(spread.least), std::abs(spread.most));
    });
    if (found == relations.end() || std::abs(found->correlation) < kClear) return "";
    const Spread& spread = spreads_[found->measure];
    const bool rises = found->correlation > 0;
    const std::string least = output::short_number(spread.least, 3), most = output::short_number(spread.most, 3);
    return collection_.measures[found->measure] + (rises ? " rises" : " falls") + " most clearly with " +
           plan_.columns[found->column] + ": from " + (rises ? least + " to " + most : most + " to " + least) +
           " over the sessions, rank correlation " + output::fixed(found->correlation, 2) + ".";
  }

  void conclude(reports::Report& report, const std::vector<Relation>& relations) const {
    const std::size_t count = plan_.tasks.size();
    const std::string found = finding(relations),
                      recorded = "All " + std::to_string(count) + " sessions were recorded.";
    std::vector<std::string> points;
    if (!collection_.is_complete())
      points.push_back("Incomplete: " + state_text(collection_) +
                       ". Statistics are of what is done; what failed may not have failed by chance.");
    if (collection_.is_complete() && !found.empty()) points.push_back(recorded);
    points.push_back("Every row of results.csv names a session: ctpm verify simulates it again, hash by hash.");
    report.conclude(collection_.is_complete() ? reports::ReportVerdict::met : reports::ReportVerdict::missed,
                    !collection_.is_complete() ? state_text(collection_) + "."
                    : found.empty()            ? recorded
                                               : found,
                    points);
  }

  std::vector<Relation> closest_relations() const {
    std::vector<Relation> relations;
    for (std::size_t k = 0; k < plan_.columns.size(); ++k)
      for (std::size_t m = 0; m < collection_.measures.size(); ++m) {
        if (collection_.measures[m] == "duration_s") continue;  // follows from the script alone
        const double correlation = rank_correlation(numbers_[k], of_done(collection_.measured[m]));
        if (std::isfinite(correlation)) relations.push_back({k, m, correlation});
      }
    std::stable_sort(relations.begin(), relations.end(), [](const Relation& a, const Relation& b) {
      return std::abs(a.correlation) > std::abs(b.correlation);
    });
    return relations;
  }

  /// Means of a measure where a column has few values, at least one of them several times; empty otherwise.
  std::map<double, std::vector<double>> by_value(const Relation& relation) const {
    std::map<double, std::vector<double>> groups;
    const std::vector<double> values = of_done(collection_.measured[relation.measure]);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (std::isfinite(values[i])) groups[numbers_[relation.column][i]].push_back(values[i]);
    const bool repeats =
        std::any_of(groups.begin(), groups.end(), [](const auto& group) { return group.second.size() > 1; });
    if (groups.size() > kMostGroups || !repeats) groups.clear();
    return groups;
  }

  reports::Plot plot_of(const Relation& relation) const {
    reports::Plot plot{.title = collection_.measures[relation.measure] + " by " + plan_.columns[relation.column],
                       .x_title = plan_.columns[relation.column],
                       .y_title = collection_.measures[relation.measure]};
    reports::Series sessions{.name = "sessions", .stroke = reports::Stroke::marks};
    const std::vector<double> values = of_done(collection_.measured[relation.measure]);
    const std::size_t stride = (values.size() + kMostPoints - 1) / kMostPoints;
    for (std::size_t i = 0; i < values.size(); i += stride)
      if (std::isfinite(values[i])) sessions.x.push_back(numbers_[relation.column][i]), sessions.y.push_back(values[i]);
    plot.series.push_back(std::move(sessions));
    reports::Series means{.name = "mean"};
    for (const auto& [x, group] : by_value(relation)) means.x.push_back(x), means.y.push_back(spread_of(group).mean);
    if (means.x.size() > 1) plot.series.push_back(std::move(means));
    const Spread range = spread_of(numbers_[relation.column]);
    constexpr double kWide = 30;  // of most / least: on a linear axis most values would lie on its first tenth
    plot.is_log_x = range.least > 0 && range.most > kWide * range.least;
    if (!plot.is_log_x) {
      const double margin = 0.03 * (range.most - range.least);  // so that no mark is cut
      plot.x_range = {range.least - margin, range.most + margin};
    }
    plot.caption = "rank correlation " + output::fixed(relation.correlation, 2) +
                   (stride > 1 ? "; one of " + std::to_string(stride) + " sessions is drawn" : "");
    return plot;
  }

  std::vector<reports::Plot> plots_of(const std::vector<Relation>& relations) const {
    std::vector<reports::Plot> plots;
    for (const Relation& relation : relations)
      if (plots.size() < kMostPlots) plots.push_back(plot_of(relation));
    return plots;
  }

  reports::Table relation_table(const std::vector<Relation>& relations) const {
    reports::Table table;
    table.title = "Rank correlations (Spearman)";
    table.columns = {{"varies", "varies"}, {"measure", "measure"}, {"correlation", "rank correlation", 2}};
    for (const Relation& relation : relations)
      table.rows.push_back(
          {plan_.columns[relation.column], collection_.measures[relation.measure], relation.correlation});
    table.caption =
        "1: more of the one always goes with more of the other; -1: with less; 0: neither. It sees no "
        "relation that rises and falls.";
    return table;
  }

  reports::Table spread_table() const {
    reports::Table table;
    table.columns = {{"measure", "measure"}, {"count", "sessions"},
                     {"mean", "mean"},       {"deviation", "standard deviation"},
                     {"least", "least"},     {"most", "most"}};
    for (std::size_t m = 0; m < spreads_.size(); ++m) {
      const Spread& s = spreads_[m];
      if (s.count > 0)
        table.rows.push_back({collection_.measures[m], std::int64_t(s.count), s.mean, s.deviation, s.least, s.most});
    }
    return table;
  }

  /// Means at each value of a column that has a few; no rows if it has one or many.
  reports::Table group_table(std::size_t column) const {
    reports::Table table;
    table.title = "Means by " + plan_.columns[column];
    table.columns = {{plan_.columns[column], plan_.columns[column]}, {"count", "sessions"}};
    std::vector<std::string> seen;
    for (const Task& task : plan_.tasks)
      if (std::find(seen.begin(), seen.end(), task.shown[column]) == seen.end() && seen.size() <= kMostGroups)
        seen.push_back(task.shown[column]);
    if (seen.size() < 2 || seen.size() > kMostGroups) return table;
    for (std::size_t m = 0; m < spreads_.size(); ++m)
      if (varies(m)) table.columns.push_back({collection_.measures[m], collection_.measures[m]});
    for (const std::string& value : seen) {
      std::vector<reports::Cell> row{value, std::int64_t(0)};
      for (std::size_t m = 0; m < spreads_.size(); ++m) {
        if (!varies(m)) continue;
        std::vector<double> values = of_done(collection_.measured[m]);
        for (std::size_t i = 0; i < values.size(); ++i)
          if (plan_.tasks[i].shown[column] != value) values[i] = NAN;
        const Spread spread = spread_of(values);
        row[1] = std::int64_t(spread.count);
        row.push_back(spread.count > 0 ? reports::Cell(spread.mean) : reports::Cell());
      }
      table.rows.push_back(std::move(row));
    }
    return table;
  }

  reports::Table unfinished_table() const {
    reports::Table table;
    table.columns = {{"task", "task"}, {"id", "id"}, {"state", "state", 4, true}};
    for (const std::string& column : plan_.columns) table.columns.push_back({column, column});
    table.columns.push_back({"error", "why"});
    for (std::size_t i = 0; i < plan_.tasks.size(); ++i) {
      const TaskReport& report = collection_.reports[i];
      if (report.state == TaskState::done) continue;
      if (table.rows.size() == kMostRows) {
        table.caption = "Only the first " + std::to_string(kMostRows) + "; results.csv has them all.";
        break;
      }
      std::vector<reports::Cell> row{std::int64_t(i + 1), plan_.tasks[i].id, std::string(to_word(report.state))};
      for (const std::string& value : plan_.tasks[i].shown) row.emplace_back(value);
      row.emplace_back(report.result.error);
      table.rows.push_back(std::move(row));
    }
    return table;
  }

  const Collection& collection_;
  const Plan& plan_;
  std::vector<std::vector<double>> numbers_;  ///< NaN where a column holds texts (column_count x task_count)
  std::vector<Spread> spreads_;               ///< (measure_count)
};

}  // namespace

std::string report_page(const Collection& collection) { return Page(collection).html(); }

}  // namespace ctpm::sweep
