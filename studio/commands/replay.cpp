#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/model/nearest_rank.h"
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
#include "studio/session/cut_measures.h"
#include "studio/session/probes.h"
#include "studio/session/time_range.h"

namespace ctpm::commands {
namespace {

struct ReplayArguments {
  std::string file, csv;
  bool overwrite = false;
  int times = 1;
  session::TimeRange range;
};

/// The least time of each tick over some replays [s]: what it takes where nothing else runs.
class LeastTimes {
 public:
  explicit LeastTimes(session::TickRange range)
      : least_(std::size_t(range.to - range.from), std::numeric_limits<double>::infinity()) {}

  void add(std::size_t tick, double time) { least_[tick] = std::min(least_[tick], time); }

  /// `tick`: how long one may take [s].
  std::string text(int times, double tick) const {
    const auto ms = [&](double share) { return output::fixed(1e3 * percentile(least_, share), 3); };
    const auto above = std::count_if(least_.begin(), least_.end(), [&](double time) { return time > tick; });
    return "least time of each tick over " + std::to_string(times) + " replays: p50 " + ms(0.5) + " ms, p99 " +
           ms(0.99) + " ms, p99.9 " + ms(0.999) + " ms, max " + ms(1) + " ms, " + std::to_string(above) + " of " +
           std::to_string(least_.size()) + " above " + output::fixed(1e3 * tick, 3) + " ms\n";
  }

 private:
  std::vector<double> least_;
};

std::string csv_header(const Model& model, const std::vector<session::Probe>& probes) {
  std::string of_probes;
  for (const session::Probe& probe : probes)
    for (const char* axis : {"_x_mm", "_y_mm", "_z_mm"})
      of_probes += "," + output::csv_text("probe_" + probe.name + axis);

  const char* const of_second =
      ",second_tool,second_x_mm,second_y_mm,second_z_mm,second_qw,second_qx,second_qy,second_qz,second_buttons,"
      "second_force_x_n,second_force_y_n,second_force_z_n,second_force_n,second_depth_mm,second_contacts";
  return std::string(
             "tick,time_s,tool,tool_x_mm,tool_y_mm,tool_z_mm,tool_qw,tool_qx,tool_qy,tool_qz,buttons,"
             "force_x_n,force_y_n,force_z_n,force_n,depth_mm,contacts,severed,same_as_recorded") +
         (model.has_scalpel() ? ",blade_depth_mm" : "") + (model.hands > 1 ? of_second : "") + of_probes + "\n";
}

/// Tool, pose and buttons of a hand; force and depth; contacts.
struct HandCells {
  std::string inputs, loads, contacts;
};

HandCells cells_of(const Model& model, const Hand& in, const stepping::HandReport& report) {
  const bool is_known = in.tool >= 0 && std::size_t(in.tool) < model.tools.size();
  const std::string tool = is_known ? output::csv_text(model.tools[std::size_t(in.tool)].name) : "";
  const Vec3 p = in.position, f = report.tool_force;
  const Quat q = in.world_from_tool;
  char pose[256], loads[256];
  std::snprintf(pose, sizeof pose, ",%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%u", p.x * 1e3, p.y * 1e3, p.z * 1e3, q.w, q.x,
                q.y, q.z, in.buttons);
  std::snprintf(loads, sizeof loads, "%.9g,%.9g,%.9g,%.9g,%.9g", f.x, f.y, f.z, norm(f), report.depth * 1e3);
  return {tool + pose, loads, std::to_string(report.contacts)};
}

/// `blade` measures its depth along itself; none: the scene has none.
std::string csv_row(const Model& model, const recordings::ReplayCursor& cursor,
                    const std::vector<session::Probe>& probes, const std::optional<session::CutMeasures>& blade) {
  const Inputs& inputs = cursor.record().inputs;
  const stepping::StepReport& report = cursor.report();
  const HandCells first = cells_of(model, inputs, report);
  const std::int64_t tick = cursor.tick() - 1;
  std::string row = std::to_string(tick) + "," + output::fixed(double(tick) * model.tick, 6) + "," + first.inputs +
                    "," + first.loads + "," + first.contacts + "," + std::to_string(report.severed) + "," +
                    (cursor.same_so_far() ? "1" : "0");
  if (blade) {
    const bool is_held = model.is_scalpel(inputs.tool) || model.is_scalpel(inputs.second.tool);
    row += "," + output::fixed(is_held ? 1e3 * blade->edge_depth(cursor.state()) : 0, 3);
  }
  if (model.hands > 1) {
    const HandCells second = cells_of(model, inputs.second, report.second);
    row += "," + second.inputs + "," + second.loads + "," + second.contacts;
  }
  for (const session::Probe& probe : probes) {
    const Vec3 at = cursor.state().position[probe.sphere];
    char place[96];
    std::snprintf(place, sizeof place, ",%.9g,%.9g,%.9g", at.x * 1e3, at.y * 1e3, at.z * 1e3);
    row += place;
  }
  return row + "\n";
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
  ProgressLine progress("replaying");
  const std::vector<session::Probe> probes = session::probes_of(*reader);
  const std::int64_t ticks = range->to - range->from;
  std::string rows = csv_header(model, probes);
  std::optional<session::CutMeasures> blade;
  if (!arguments.csv.empty() && model.has_scalpel()) blade.emplace(model);
  double most_force = 0, most_depth = 0;
  LeastTimes least(*range);
  bool is_same = true;
  for (int time = 0; time < arguments.times; ++time) {
    if (const Result<Done> found = cursor->seek(range->from); !found) return print_errors(found.errors());
    while (cursor->tick() < range->to) {
      const Result<bool> went_on = cursor->step();
      if (!went_on) return print_errors(went_on.errors());
      least.add(std::size_t(cursor->tick() - 1 - range->from), cursor->tick_time());
      if (!arguments.csv.empty() && time == 0) rows += csv_row(model, *cursor, probes, blade);
      for (std::size_t hand = 0; hand < kMostHands; ++hand) {
        most_force = std::max(most_force, norm(cursor->report().of_hand(hand).tool_force));
        most_depth = std::max(most_depth, cursor->report().of_hand(hand).depth);
      }
      progress.show(time * ticks + cursor->tick() - range->from, arguments.times * ticks);
    }
    is_same = is_same && cursor->same_so_far();
  }
  if (!arguments.csv.empty())
    if (const Result<Done> written = output::write_text_file(arguments.csv, rows); !written)
      return print_errors(written.errors());
  print("%s: %lld ticks replayed, %s, %s%s%s\n", arguments.file.c_str(), (long long)ticks,
        extremes_text(most_force, most_depth).c_str(), is_same ? "as recorded" : "NOT as recorded",
        arguments.csv.empty() ? "" : "; written to ", arguments.csv.c_str());
  if (arguments.times > 1 && ticks > 0) print("%s", least.text(arguments.times, model.tick).c_str());
  return is_same ? exit_good : exit_bad_verdict;
}

}  // namespace

Command add_replay(CLI::App& program) {
  auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* app =
      program.add_subcommand("replay", "Simulates a session again; writes what happened in each tick as CSV.");
  app->footer("Example: ctpm replay out/demo.ctpm --from-s 1 --to-s 3 --csv out/demo.csv");
  app->add_option("session", arguments->file, "Session file (.ctpm)")->required();
  add_time_range(*app, arguments->range);
  app->add_option(
      "--csv", arguments->csv,
      "Table with time, tool, force, depth, that of a blade along itself, and probes of each tick; a picture after "
      "tick n says n + 1");
  app->add_flag("--overwrite", arguments->overwrite, "Replace an existing table");
  app->add_option("--times", arguments->times,
                  "Replay it so often, and print the least that each tick took: its own time, whatever else runs")
      ->check(CLI::Range(1, 100));
  return {app, [arguments] { return run_replay(*arguments); }};
}

}  // namespace ctpm::commands
