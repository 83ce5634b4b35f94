#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "recordings/replay.h"
#include "recordings/session_reader.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/extremes_text.h"
#include "studio/commands/flags.h"
#include "studio/commands/physics_warning.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"
#include "studio/output/printable.h"
#include "studio/session/time_range.h"

namespace ctpm::commands {
namespace {

struct ReplayArguments {
  std::string file, csv;
  bool overwrite = false;
  session::TimeRange range;
};

std::string csv_header() {
  return "tick,time_s,tool,tool_x_mm,tool_y_mm,tool_z_mm,tool_qw,tool_qx,tool_qy,tool_qz,buttons,"
         "force_x_n,force_y_n,force_z_n,force_n,depth_mm,contacts,severed,same_as_recorded\n";
}

std::string csv_row(const Model& model, const recordings::ReplayCursor& cursor) {
  const recordings::TickRecord& record = cursor.record();
  const stepping::StepReport& report = cursor.report();
  const Inputs& in = record.inputs;
  const std::string tool = in.tool >= 0 ? output::csv_text(model.tools[std::size_t(in.tool)].name) : "";
  const Vec3 p = in.position, f = report.tool_force;
  const Quat q = in.world_from_tool;
  const std::int64_t tick = cursor.tick() - 1;
  char numbers[512];
  std::snprintf(numbers, sizeof numbers, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%u,%.9g,%.9g,%.9g,%.9g,%.9g,%d,%d,%d\n",
                p.x * 1e3, p.y * 1e3, p.z * 1e3, q.w, q.x, q.y, q.z, in.buttons, f.x, f.y, f.z, norm(f),
                report.depth * 1e3, report.contacts, report.severed, cursor.same_so_far() ? 1 : 0);
  return std::to_string(tick) + "," + output::fixed(double(tick) * model.tick, 6) + "," + tool + "," + numbers;
}

int run_replay(const ReplayArguments& arguments) {
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(arguments.file);
  if (!reader) return print_errors(reader.errors());
  const Model& model = reader->start().model;
  const Result<session::TickRange> range = arguments.range.in_ticks(arguments.file, model.tick, reader->tick_count());
  if (!range) return print_errors(range.errors());
  if (!arguments.csv.empty())
    if (const Result<Done> writable = output::check_new(arguments.csv, arguments.overwrite); !writable)
      return print_errors(writable.errors());

  warn_of_physics(*reader);
  Result<recordings::ReplayCursor> cursor = recordings::ReplayCursor::create(*reader);
  if (!cursor) return print_errors(cursor.errors());
  if (const Result<Done> found = cursor->seek(range->from); !found) return print_errors(found.errors());
  ProgressLine progress("replaying");
  std::string rows = csv_header();
  double most_force = 0, most_depth = 0;
  while (cursor->tick() < range->to) {
    const Result<bool> went_on = cursor->step();
    if (!went_on) return print_errors(went_on.errors());
    if (!arguments.csv.empty()) rows += csv_row(model, *cursor);
    most_force = std::max(most_force, norm(cursor->report().tool_force));
    most_depth = std::max(most_depth, cursor->report().depth);
    progress.show(cursor->tick() - range->from, range->to - range->from);
  }
  if (!arguments.csv.empty())
    if (const Result<Done> written = output::write_text_file(arguments.csv, rows); !written)
      return print_errors(written.errors());
  print("%s: %lld ticks replayed, %s, %s%s%s\n", arguments.file.c_str(), (long long)(range->to - range->from),
        extremes_text(most_force, most_depth).c_str(), cursor->same_so_far() ? "as recorded" : "NOT as recorded",
        arguments.csv.empty() ? "" : "; written to ", arguments.csv.c_str());
  return cursor->same_so_far() ? exit_good : exit_bad_verdict;
}

}  // namespace

Command add_replay(CLI::App& program) {
  auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* app =
      program.add_subcommand("replay", "Simulates a session again; writes what happened in each tick as CSV.");
  app->footer("Example: ctpm replay out/demo.ctpm --from-s 1 --to-s 3 --csv out/demo.csv");
  app->add_option("session", arguments->file, "Session file (.ctpm)")->required();
  add_time_range(*app, arguments->range);
  app->add_option("--csv", arguments->csv, "Table with time, tool, force and depth of each tick");
  app->add_flag("--overwrite", arguments->overwrite, "Replace an existing table");
  return {app, [arguments] { return run_replay(*arguments); }};
}

}  // namespace ctpm::commands
