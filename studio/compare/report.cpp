#include "studio/compare/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "studio/compare/advice.h"
#include "studio/compare/plots.h"
#include "studio/compare/reach.h"
#include "studio/output/number_text.h"
#include "studio/reports/report.h"

namespace ctpm::compare {
namespace {

reports::Cell cell_of(std::optional<double> value) { return value ? reports::Cell(*value) : reports::Cell(); }

reports::Table measures_table(const Comparison& comparison) {
  reports::Table table;
  table.columns = {{"key", "key"},
                   {"measure", "measure"},
                   {"expert", "expert"},
                   {"trainee", "trainee"},
                   {"unit", "unit"},
                   {"better_is", "better is"},
                   {"trainee_is", "trainee is", 4, true},
                   {"meaning", "what it is"},
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
  table.columns = {{"worst_s", "worst at [s]", 4, true},
                   {"from_s", "from [s]"},
                   {"to_s", "to [s]"},
                   {"what", "what"},
                   {"value", "value"},
                   {"limit", "limit"},
                   {"unit", "unit"},
                   {"severity", "severity", 3}};
  for (const Moment& moment : comparison.moments)
    table.rows.push_back({moment.worst_s, moment.from_s, moment.to_s, std::string(to_word(moment.kind)), moment.value,
                          moment.limit > 0 ? reports::Cell(moment.limit) : reports::Cell(), std::string(moment.unit),
                          moment.severity});
  table.caption =
      "Times are those of the trainee's session. Severity is how far the worst value is beyond its limit, in limits, "
      "and less for what lasts less than some tenths of a second: of force as in the plot, of depth the scene's, of "
      "the path half a sphere spacing, of a pause the expert's longest and at least 1 s; for cuts it is the number of "
      "elements that the expert left whole over those that the expert severed, and of a forbidden zone the seconds in "
      "it. The path counts while the tool touches or cuts, and its value is the distance from the nearest place of the "
      "expert's; pauses count from the first motion to the last touch or cut. Forbidden zones come first, then what "
      "harms the tissue (cuts, force, depth), then the path, then pauses, and last what is next to nothing, by "
      "severity; after three of a kind others have their turn. The order is this program's.";
  return table;
}

/// The columns with these keys, as a person reads them: what has no unit has none.
reports::Table with_columns(const reports::Table& table, const std::vector<std::string>& keys) {
  reports::Table result;
  result.title = table.title, result.caption = table.caption;
  result.rows.resize(table.rows.size());
  for (const std::string& key : keys)
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      if (table.columns[i].key != key) continue;
      result.columns.push_back(table.columns[i]);
      for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const auto* text = std::get_if<std::string>(&table.rows[row][i]);
        result.rows[row].push_back(key == "unit" && text && *text == "1" ? reports::Cell() : table.rows[row][i]);
      }
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

/// What to do better, what that rests on, and what must be known to believe it.
void add_conclusion(reports::Report& report, const ComparedSessions& compared) {
  constexpr std::size_t kPoints = 4;
  std::vector<std::string> advice = advice_of(compared);
  const std::string first = advice.front();
  advice.erase(advice.begin());
  if (advice.size() > kPoints) advice.resize(kPoints);
  const Comparison& comparison = compared.comparison;
  const bool is_good = comparison.moments.empty() && comparison.way == Way::same &&
                       shortfalls_of(comparison.values, comparison.damage_depth).empty();
  report.conclude(is_good ? reports::ReportVerdict::met : reports::ReportVerdict::missed, first, advice);
  for (const std::string& remark : remarks_of(compared)) report.add_verdict(false, remark);
  report.add_paragraph(
      "This page shows how two hands differ. No measure has a pass mark, and none was validated in this scene.");
}

/// A moment in one line.
std::string caption_of(const Moment& moment, std::size_t number) {
  return std::to_string(number) + ". " + to_word(moment.kind) + " at " + output::fixed(moment.worst_s, 2) +
         " s: " + output::short_number(moment.value) + " " + moment.unit +
         (moment.limit > 0 ? ", limit " + output::short_number(moment.limit) + " " + moment.unit : "");
}

Result<Done> add_moments(reports::Report& report, const Comparison& comparison,
                         const std::vector<MomentPictures>& pictures, const std::string& to_see_worst) {
  if (comparison.moments.empty()) return Done{};
  report.add_heading("Worst moments first");
  std::vector<reports::Picture> shown;
  for (std::size_t i = 0; i < std::min(pictures.size(), comparison.moments.size()); ++i) {
    const Moment& moment = comparison.moments[i];
    shown.push_back({pictures[i].trainee, caption_of(moment, i + 1), place_of_moment(i + 1)});
    shown.push_back({pictures[i].expert, "The expert at the same place of the path, at " +
                                             output::fixed(expert_time_at(comparison, moment.worst_s), 2) + " s"});
  }
  if (!shown.empty())
    if (const Result<Done> added = report.add_pictures(shown); !added) return added.errors();
  report.add_table(with_columns(moments_table(comparison),
                                {"what", "worst_s", "value", "unit", "limit", "severity", "from_s", "to_s"}));
  report.add_paragraph("To see the worst: " + to_see_worst);
  return Done{};
}

void add_plots(reports::Report& report, const ComparedSessions& compared) {
  report.add_heading("Force and depth");
  if (const std::vector<reports::Plot> plots = plots_over_time(compared); !plots.empty())
    report.add_plots(plots);
  else
    report.add_paragraph("No tool met a force.");
  if (const std::vector<reports::Plot> cut = plots_of_cut(compared); !cut.empty()) {
    report.add_heading("The cut");
    report.add_plots(cut);
  }
  report.add_heading("The path of the tool");
  report.add_plots(plots_of_paths(compared));
  report.add_paragraph(
      "The paths are aligned by dynamic time warping: each point of one belongs to a point of the other, in "
      "order, at most " +
      output::short_number(100 * kAlignmentBand) +
      " % of the longer session out of step, so that a slow hand is not taken for a wrong one.");
  if (const std::vector<reports::Plot> probes = plots_of_probes(compared); !probes.empty()) {
    report.add_heading("The tissue at the probes");
    report.add_plots(probes);
  }
}

void add_measures(reports::Report& report, const Comparison& comparison) {
  report.add_heading("Measures");
  if (const std::string less = less_done_text(comparison); !less.empty()) report.add_paragraph(less);
  report.add_table(
      with_columns(measures_table(comparison), {"measure", "trainee_is", "trainee", "expert", "unit", "better_is"}));
  report.add_heading("What the measures are");
  report.add_table(with_columns(measures_table(comparison), {"measure", "meaning", "source"}));
}

}  // namespace

std::string standing_of(const MeasuredValue& value) {
  if (!value.expert || !value.trainee) return "";
  const double more = *value.trainee - *value.expert;
  const double share = kSameShare * std::max(std::abs(*value.expert), std::abs(*value.trainee));
  if (std::abs(more) <= std::max(share, value.measure->rounding)) return "same";
  if (value.measure->direction == Direction::nearer) return "differs";
  if ((more < 0) != (value.measure->direction == Direction::lower)) return "worse";
  return value.less_done ? "less done" : "better";
}

std::string less_done_text(const Comparison& comparison) {
  const std::string what = to_words(shortfalls_of(comparison.values, comparison.damage_depth));
  return what.empty() ? ""
                      : "Less was done than the expert did (" + what +
                            "): what grows with the work, such as force and time, is not better for being lower.";
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
      remarks.push_back(track->path +
                        " was not replayed for this comparison: its forces and depths are those that it states");
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
  if (const std::string less = less_done_text(comparison); !less.empty())
    json.member("less_done", std::string_view(less));
  json.key("advice").begin_list();
  for (const std::string& sentence : advice_of(compared)) json.value(std::string_view(sentence));
  json.end_list().key("measures");
  reports::write_rows(json, measures_table(comparison));
  json.key("moments");
  reports::write_rows(json, moments_table(comparison));
  json.key("plots").begin_list();
  for (const auto& plots :
       {plots_over_time(compared), plots_of_probes(compared), plots_of_paths(compared), plots_of_cut(compared)})
    for (const reports::Plot& plot : plots) reports::write_points(json, plot);
  return json.end_list().end_object().text();
}

double expert_time_at(const Comparison& comparison, double trainee_s) {
  double nearest = INFINITY, time = 0;
  for (const AlignedPair& pair : comparison.alignment.pairs)
    if (const double off = std::abs(comparison.trainee_time[pair.b] - trainee_s); off < nearest)
      nearest = off, time = comparison.expert_time[pair.a];
  return time;
}

Result<Done> write_comparison(const std::string& folder, const ComparedSessions& compared,
                              const std::vector<MomentPictures>& pictures, const std::string& to_see_worst) {
  const std::string scene = compared.expert.scene_name.empty() ? "" : "Scene " + compared.expert.scene_name + ". ";
  reports::Report report("A trainee's session beside an expert's",
                         scene + "Expert: " + compared.expert.path + ". Trainee: " + compared.trainee.path + ".");
  add_conclusion(report, compared);
  if (const Result<Done> added = add_moments(report, compared.comparison, pictures, to_see_worst); !added)
    return added.errors();
  add_plots(report, compared);
  add_measures(report, compared.comparison);
  return reports::write_report(folder, {{"report.html", report.html()}, {"results.json", comparison_json(compared)}});
}

}  // namespace ctpm::compare
