// The page about error against run time.

#include <sys/utsname.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "studio/bench/bench.h"

namespace ctpm::bench {
namespace {

/// The processor's name, or else its architecture.
std::string machine() {
  std::ifstream info("/proc/cpuinfo");
  const std::string threads = ", " + std::to_string(std::thread::hardware_concurrency()) + " hardware threads";
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) {
      const std::size_t colon = line.find(':');
      if (colon != std::string::npos && colon + 2 < line.size()) return line.substr(colon + 2) + threads;
    }
  utsname system{};
  return (uname(&system) == 0 ? std::string(system.machine) : std::string("unknown machine")) + threads;
}

reports::Table all_points(const std::vector<BenchStudy>& studies) {
  reports::Table table = bench_layout();
  for (const BenchStudy& study : studies)
    table.rows.insert(table.rows.end(), study.points.rows.begin(), study.points.rows.end());
  for (std::vector<reports::Cell>& row : table.rows) row.resize(table.columns.size());
  return table;
}

std::string results_json(const std::vector<BenchStudy>& studies) {
  output::JsonWriter json;
  json.begin_object()
      .member("format", "ctpm-bench-results")
      .member("version", 1)
      .member("program_version", CTPM_VERSION)
      .member("machine", std::string_view(machine()));
  json.key("points");
  reports::write_rows(json, all_points(studies));
  json.key("studies").begin_list();
  for (const BenchStudy& study : studies) {
    json.begin_object()
        .member("key", std::string_view(study.section.key))
        .member("title", std::string_view(study.section.title));
    json.key("sentences").begin_list();
    for (const std::string& sentence : study.sentences) json.value(std::string_view(sentence));
    json.end_list().key("tables").begin_list();
    for (const reports::Table& table : study.section.tables) {
      json.begin_object().member("title", std::string_view(table.title)).key("rows");
      reports::write_rows(json, table);
      json.end_object();
    }
    json.end_list().key("plots").begin_list();
    for (const reports::Plot& plot : study.section.plots) reports::write_points(json, plot);
    json.end_list().end_object();
  }
  return json.end_list().end_object().text();
}

/// The settings on the Pareto front, with the main columns; results.csv has all.
reports::Table front_of(const BenchStudy& study) {
  static constexpr const char* kColumns[] = {"integrator",     "substeps",    "tolerance",
                                             "position_error", "force_error", "run_time_s_per_s",
                                             "tick_p50_ms",    "tick_p99_ms", "tick_p999_ms"};
  reports::Table table;
  table.title = "On the Pareto front of position";
  std::vector<std::size_t> kept;
  for (const char* key : kColumns)
    for (std::size_t i = 0; i < study.points.columns.size(); ++i)
      if (study.points.columns[i].key == key) kept.push_back(i), table.columns.push_back(study.points.columns[i]);
  for (const std::vector<reports::Cell>& row : study.points.rows) {
    if (!std::holds_alternative<std::string>(row.back())) continue;
    std::vector<reports::Cell>& cells = table.rows.emplace_back();
    for (const std::size_t i : kept) cells.push_back(row[i]);
  }
  return table;
}

}  // namespace

Result<Done> write_bench_report(const std::string& folder, const std::vector<BenchStudy>& studies) {
  reports::Report report("Error against run time",
                         "Measured on " + machine() +
                             ", one thread. Times are processor time of that thread, not that of other programs; "
                             "a busy machine still has colder caches.");
  std::vector<std::string> sentences;
  for (const BenchStudy& study : studies)
    sentences.insert(sentences.end(), study.sentences.begin(), study.sentences.end());
  if (!sentences.empty()) {
    const std::string first = sentences.front();
    sentences.front() = "Nothing here must hold: errors are against the finest run, times are those of this machine.";
    std::rotate(sentences.begin(), sentences.begin() + 1, sentences.end());
    report.conclude(reports::ReportVerdict::shown, first, sentences);
  }
  for (const BenchStudy& study : studies) {
    if (const Result<Done> added = report.add(study.section); !added) return added;
    if (const reports::Table front = front_of(study); study.section.key == "time" && !front.rows.empty())
      report.add_table(front);
  }
  return reports::write_report(folder, {{"results.json", results_json(studies)},
                                        {"results.csv", reports::to_csv(all_points(studies))},
                                        {"report.html", report.html()}});
}

}  // namespace ctpm::bench
