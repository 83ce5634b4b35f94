#include "studio/compare/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "studio/compare/plots.h"
#include "studio/output/number_text.h"
#include "studio/reports/report.h"

namespace ctpm::compare {
namespace {

reports::Cell cell_of(std::optional<double> value) { return value ? reports::Cell(*value) : reports::Cell(); }

reports::Table measures_table(const Comparison& comparison) {
  reports::Table table;
  table.columns = {
      {"key", "key"},      {"measure", "measure"},     {"expert", "expert"},         {"trainee", "trainee"},
      {"unit", "unit"},    {"better_is", "better is"}, {"trainee_is", "trainee is"}, {"meaning", "what it is"},
      {"source", "source"}};
  for (const MeasuredValue& value : comparison.values) {
    const Measure& m = *value.measure;
    table.rows.push_back({std::string(m.key), std::string(m.title), cell_of(value.expert), cell_of(value.trainee),
                          std::string(m.unit), std::string(to_word(m.direction)),
                          value.note.empty() ? standing_of(value) : "no value: " + value.note, std::string(m.meaning),
                          std::string(m.source)});
  }
  return table;
}

reports::Table moments_table(const Comparison& comparison) {
  reports::Table table;
  table.columns = {
      {"worst_s", "worst at [s]"}, {"from_s", "from [s]"}, {"to_s", "to [s]"}, {"what", "what"},
      {"value", "value"},          {"limit", "limit"},     {"unit", "unit"},   {"severity", "severity", 3}};
  for (const Moment& moment : comparison.moments)
    table.rows.push_back({moment.worst_s, moment.from_s, moment.to_s, std::string(to_word(moment.kind)), moment.value,
                          moment.kind == MomentKind::stray_cut ? reports::Cell() : reports::Cell(moment.limit),
                          std::string(moment.unit), moment.severity});
  table.caption =
      "Times are those of the trainee's session. Severity is how far the worst value is beyond its limit, in limits, "
      "and less for what lasts less than some tenths of a second: of force as in the plot, of depth the scene's, of "
      "the path half a sphere spacing, of a pause the expert's longest and at least 1 s; for cuts it is the number of "
      "elements that the expert left whole over those that the expert severed. What harms the tissue (force, depth, "
      "cuts) counts five times. The weights are this program's.";
  return table;
}

/// The columns with these keys.
reports::Table with_columns(const reports::Table& table, const std::vector<std::string>& keys) {
  reports::Table result;
  result.title = table.title, result.caption = table.caption;
  result.rows.resize(table.rows.size());
  for (const std::string& key : keys)
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      if (table.columns[i].key != key) continue;
      result.columns.push_back(table.columns[i]);
      for (std::size_t row = 0; row < table.rows.size(); ++row) result.rows[row].push_back(table.rows[row][i]);
    }
  return result;
}

void write_session(output::JsonWriter& json, const char* key, const SessionTrack& track) {
  json.key(key).begin_object().member("file", std::string_view(track.path));
  json.member("session_id", std::string_view(track.session_id))
      .member("duration_s", track.seconds(track.tick_count()))
      .member("has_end", track.has_end)
      .member("replays_as_recorded", track.replays)
      .end_object();
}

}  // namespace

std::string standing_of(const MeasuredValue& value) {
  if (!value.expert || !value.trainee) return "";
  const double more = *value.trainee - *value.expert;
  const double share = kSameShare * std::max(std::abs(*value.expert), std::abs(*value.trainee));
  if (std::abs(more) <= std::max(share, value.measure->rounding)) return "same";
  if (value.measure->direction == Direction::nearer) return "differs";
  return (more < 0) == (value.measure->direction == Direction::lower) ? "better" : "worse";
}

std::vector<std::string> remarks_of(const ComparedSessions& compared) {
  const auto& [expert, trainee, scene, comparison] = compared;
  std::vector<std::string> remarks;
  if (expert.initial_state != trainee.initial_state)
    remarks.push_back("the sessions begin from different states of the tissue: one goes on from a moment of another");
  for (const SessionTrack* track : {&expert, &trainee}) {
    if (!track->has_end) remarks.push_back(track->path + " has no clean end: what is there is measured");
    if (!track->replays)
      remarks.push_back(
          track->path +
          " does not replay as it was recorded: which elements it severed comes from simulating it now, all "
          "else from the recording");
    else if (!track->is_verified)
      remarks.push_back(track->path + " was not replayed: its forces and depths are those that it states");
    if (!track->is_timed)
      remarks.push_back(track->path + " lacks " + output::fixed(track->slip, 3) +
                        " s of the real time, because ticks were late: no measure of time or smoothness is given");
  }
  return remarks;
}

std::string comparison_json(const ComparedSessions& compared) {
  const Comparison& comparison = compared.comparison;
  output::JsonWriter json;
  json.begin_object()
      .member("format", "ctpm-comparison-results")
      .member("version", 1)
      .member("program_version", CTPM_VERSION)
      .member("scene", std::string_view(compared.expert.scene_name));
  write_session(json, "expert", compared.expert);
  write_session(json, "trainee", compared.trainee);
  if (comparison.force_limit)
    json.member("force_limit_n", *comparison.force_limit).member("force_limit_from", comparison.force_limit_from);
  if (comparison.damage_depth > 0) json.member("damage_depth_mm", 1e3 * comparison.damage_depth);
  json.member("alignment_band", kAlignmentBand);
  json.key("measures");
  reports::write_rows(json, measures_table(comparison));
  json.key("moments");
  reports::write_rows(json, moments_table(comparison));
  json.key("plots").begin_list();
  for (const auto& plots :
       {plots_over_time(compared), plots_of_probes(compared), plots_of_paths(compared), plots_of_cut(compared)})
    for (const reports::Plot& plot : plots) reports::write_points(json, plot);
  return json.end_list().end_object().text();
}

Result<Done> write_comparison(const std::string& folder, const ComparedSessions& compared,
                              const std::string& to_see_worst) {
  const Comparison& comparison = compared.comparison;
  const std::string scene = compared.expert.scene_name.empty() ? "" : "Scene " + compared.expert.scene_name + ". ";
  reports::Report report("A trainee's session beside an expert's",
                         scene + "Expert: " + compared.expert.path + ". Trainee: " + compared.trainee.path + ".");
  for (const std::string& remark : remarks_of(compared)) report.add_verdict(false, remark);
  report.add_heading("Worst moments first");
  if (comparison.moments.empty()) {
    report.add_verdict(true, "No moment goes beyond a limit.");
  } else {
    report.add_table(moments_table(comparison));
    report.add_paragraph("To see the worst: " + to_see_worst);
  }
  report.add_heading("Measures");
  report.add_table(
      with_columns(measures_table(comparison), {"measure", "expert", "trainee", "unit", "better_is", "trainee_is"}));
  report.add_heading("Force and depth");
  if (const std::vector<reports::Plot> plots = plots_over_time(compared); !plots.empty())
    report.add_plots(plots);
  else
    report.add_paragraph("No tool met a force.");
  if (const std::vector<reports::Plot> probes = plots_of_probes(compared); !probes.empty()) {
    report.add_heading("The tissue at the probes");
    report.add_plots(probes);
  }
  if (const std::vector<reports::Plot> cut = plots_of_cut(compared); !cut.empty()) {
    report.add_heading("The cut");
    report.add_plots(cut);
  }
  report.add_heading("The path of the tool");
  report.add_paragraph(
      "The paths are aligned by dynamic time warping: each point of one belongs to a point of the other, in "
      "order, at most " +
      output::short_number(100 * kAlignmentBand) +
      " % of the longer session out of step, so that a slow hand is not taken for a wrong one.");
  report.add_plots(plots_of_paths(compared));
  report.add_heading("What the measures are");
  report.add_table(with_columns(measures_table(comparison), {"measure", "meaning", "source"}));
  return reports::write_report(folder, {{"report.html", report.html()}, {"results.json", comparison_json(compared)}});
}

}  // namespace ctpm::compare
