#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <thread>

#include "core/model/errors.h"
#include "scenes/course.h"
#include "studio/cohort/pages.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/moment_pictures.h"
#include "studio/compare/compare_files.h"
#include "studio/compare/measure_table.h"
#include "studio/output/printable.h"

namespace ctpm::commands {
namespace {

struct CohortArguments {
  std::string course, experts, trainees, folder, home = "https://ctpm.invalid";
  bool verify = false, no_pictures = false;
};

Result<scenes::CourseSpec> course_of(const CohortArguments& arguments) {
  if (arguments.course.empty() && arguments.experts.empty())
    return Error{"cohort", "give a course, or a folder of experts with --experts", ""};
  if (!arguments.course.empty() && !arguments.experts.empty())
    return Error{"--experts", "is for a cohort without a course, and " + arguments.course + " is given", ""};
  if (!arguments.experts.empty()) return cohort::course_of_folder(arguments.experts);
  return scenes::load_course(arguments.course, compare::measure_keys());
}

/// Sessions that cannot be drawn, because another version wrote their scene, have no pictures.
std::vector<compare::MomentPictures> draw_pictures(const std::string& trainee, const std::string& expert,
                                                   const std::vector<std::array<double, 2>>& times) {
  Result<compare::OpenedFiles> files = compare::open_files(expert, trainee);
  Errors errors = files ? Errors() : files.errors();
  if (files) {
    Result<std::vector<compare::MomentPictures>> pictures = draw_moments(files->trainee, files->expert, times, true);
    if (pictures) return std::move(*pictures);
    errors = pictures.errors();
  }
  print_remark("warning: no pictures of " + trainee + ": " + errors[0].message);
  return {};
}

void print_cohort(const cohort::Cohort& cohort) {
  for (const cohort::TaskResult& task : cohort.tasks) {
    print("%s: %zu experts, %zu %s\n", output::printable(task.task.name).c_str(), task.experts.size(),
          task.attempts.size(), task.attempts.size() == 1 ? "attempt" : "attempts");
    for (const std::string& person : cohort.trainees) {
      const auto attempts = task.attempts_of(person);
      if (attempts.empty()) continue;
      const cohort::Attempt& latest = *attempts.back();
      const std::string verdict = !latest.passed ? "" : *latest.passed ? ", passed" : ", not passed";
      const std::string learned =
          latest.passed ? std::string(", ") + to_word(learned_of(task, person, cohort.course.learning).state) : "";
      print("  %-24s attempt %zu%s%s\n", output::printable(person).c_str(), latest.session.attempt, verdict.c_str(),
            learned.c_str());
    }
  }
  if (cohort.course.evidence.empty()) print("not validated: the course names no evidence\n");
  for (const std::string& text : cohort.left_out) print_remark("left out: " + text);
  for (const Error& damage : cohort.damaged) print_remark("left out: " + to_string(damage));
}

int run_cohort(const CohortArguments& arguments) {
  const Result<scenes::CourseSpec> course = course_of(arguments);
  Errors errors;
  append(errors, course);
  append(errors, reports::check_folder(arguments.folder, cohort::kFirstPage));
  if (!errors.empty() && course) append(errors, cohort::gather(*course, arguments.trainees));
  if (!errors.empty()) return print_errors(errors);
  cohort::CohortOptions options;
  options.verify = arguments.verify;
  options.threads = int(std::max(1u, std::thread::hardware_concurrency()));
  ProgressLine progress("sessions");
  options.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
  const Result<cohort::Cohort> measured = cohort::measure_cohort(*course, arguments.trainees, options);
  if (!measured) return print_errors(measured.errors());
  // A scene that was changed since the experts worked in it is why sessions are of no task; else `check` says so.
  if (arguments.experts.empty() && !measured->left_out.empty()) {
    const cohort::CourseFindings scenes = cohort::find_other_scenes(*course);
    print_warnings(scenes.errors), print_warnings(scenes.warnings);
  }
  for (const cohort::TaskResult& task : measured->tasks) {
    print_warnings(cohort::find_hard_marks(task));
    for (const auto* all : {&task.experts, &task.attempts})
      for (const cohort::Attempt& attempt : *all)
        for (const std::string& remark : attempt.remarks) print_remark("note: " + attempt.session.file + " " + remark);
  }
  if (const Result<Done> ready = reports::prepare_folder(arguments.folder, cohort::kFirstPage); !ready)
    return print_errors(ready.errors());
  if (const Result<Done> written =
          cohort::write_cohort(*measured, arguments.folder, arguments.home,
                               arguments.no_pictures ? cohort::MomentArtist() : draw_pictures, options.threads);
      !written)
    return print_errors(written.errors());
  print_cohort(*measured);
  print_remark("written: " + arguments.folder +
               "/index.html, a page for each trainee, results.csv, results.sqlite, statements.jsonl");
  return measured->damaged.empty() ? exit_good : exit_bad_verdict;
}

}  // namespace

Command add_cohort(CLI::App& program) {
  auto arguments = std::make_shared<CohortArguments>();
  CLI::App* app = program.add_subcommand(
      "cohort", "Measures many trainees against several experts, attempt by attempt; a page for each and one for all.");
  app->footer(
      "Examples: ctpm cohort course.json --trainees sessions/ -o out/course\n"
      "          ctpm cohort --experts experts/ --trainees sessions/ -o out/cohort");
  app->add_option("course", arguments->course, "Course file (.json): tasks, experts, ranges and pass marks");
  app->add_option("--experts", arguments->experts, "In place of a course: folder of at least two experts' sessions");
  app->add_option("--trainees", arguments->trainees,
                  "Folder of the sessions; those of one trainee in a folder of its own")
      ->required();
  app->add_option("-o,--output", arguments->folder, "Folder for pages and tables; made if missing")->required();
  app->add_flag("--verify", arguments->verify, "Replay every session; otherwise forces that they state are believed");
  app->add_flag("--no-pictures", arguments->no_pictures, "Draw no pictures of where trainees leave the experts' band");
  app->add_option("--home", arguments->home, "Address below which the statements for xAPI name people and tasks");
  return {app, [arguments] { return run_cohort(*arguments); }};
}

}  // namespace ctpm::commands
