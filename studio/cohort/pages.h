#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "studio/cohort/cohort.h"
#include "studio/compare/report.h"
#include "studio/reports/report.h"

namespace ctpm::cohort {

/// Name of the page of everybody.
inline constexpr const char* kFirstPage = "index.html";

/// The page of everybody.
std::string educator_page(const Cohort& cohort);

/// Draws moments of a trainee's session and of an expert's, each of them [s]; none if they cannot be drawn.
using MomentArtist = std::function<std::vector<compare::MomentPictures>(
    const std::string& trainee, const std::string& expert, const std::vector<std::array<double, 2>>& times)>;

/// The page of one trainee, by the place in Cohort::trainees. Empty `draw`: it has no pictures. Error: a picture that
/// cannot be encoded.
Result<std::string> trainee_page(const Cohort& cohort, std::size_t trainee, const MomentArtist& draw);

/// Name of a trainee's page within the folder of the report; no two are equal.
std::string page_name(const Cohort& cohort, std::size_t trainee);

/// What a reader must know to believe any page: whether the course was validated, and the sessions verified.
void add_caveats(reports::Report& report, const Cohort& cohort);

/// What has been learned by somebody's attempts of a task; open if it has no marks.
struct Learned {
  LearningState state = LearningState::open;
  std::vector<LearningStep> steps;  ///< one for each attempt
  std::size_t reached = 0;          ///< attempt in which the state began, from 1; 0: it is open
};
Learned learned_of(const TaskResult& task, const std::string& person, const scenes::LearningSpec& learning);

/// "learned", "not yet known", "fails too often".
const char* to_word(LearningState state);

/// The measures that a page of the task shows: those with marks, or else all that have a value; indices of
/// compare::all_measures().
std::vector<std::size_t> shown_measures(const TaskResult& task);

/// "at most 4 N", "between 2 and 5 mm"; empty: no pass mark.
std::string mark_text(const TaskResult& task, std::size_t measure);

/// The unit as a person reads it; empty: it has none.
std::string shown_unit(const compare::Measure& measure);

/// Lets a plot show at least the range that the educator declared for a measure; all points stay in it.
void show_declared(reports::Plot& plot, const TaskResult& task, std::size_t measure);

/// Makes a small plot over attempts; differences up to `rounding` [its unit] are not drawn as such.
void shape_small(reports::Plot& plot, double rounding);

/// What the measures of the pages are, with their sources.
reports::Table meanings(const Cohort& cohort);

/// Writes index.html, a page for each trainee, results.csv, results.sqlite and statements.jsonl to `folder`, and
/// removes the pages of trainees who were in an earlier report there and are in this one no more. `draw` is called by
/// `threads` threads at once. Errors: those of trainee_page() and of writing them.
Result<Done> write_cohort(const Cohort& cohort, const std::string& folder, const std::string& home,
                          const MomentArtist& draw, int threads);

}  // namespace ctpm::cohort
