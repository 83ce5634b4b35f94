#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include "importers/text.h"
#include "recordings/session_reader.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/extremes_text.h"
#include "studio/output/number_text.h"
#include "studio/output/printable.h"
#include "studio/session/anonymise.h"
#include "studio/session/late_ticks.h"
#include "studio/session/record_session.h"
#include "studio/session/session_info.h"

namespace ctpm::commands {
namespace {

using output::printable;

struct InfoArguments {
  std::string file;
  bool json = false;
};

std::string metadata_of(const recordings::SessionReader& reader, const char* key) {
  const auto& metadata = reader.start().metadata;
  const auto it = metadata.find(key);
  return it == metadata.end() ? "" : it->second;
}

void print_origin(const recordings::SessionReader& reader) {
  if (const std::string trainee = metadata_of(reader, session::trainee_key); !trainee.empty())
    print("trainee    %s\n", printable(trainee).c_str());
  if (const std::string source = metadata_of(reader, "source"); !source.empty())
    print("source     %s\n", printable(source).c_str());
  if (const std::string parent = metadata_of(reader, recordings::parent_session_key); !parent.empty())
    print("parent     %s, from tick %s on\n", printable(parent).c_str(),
          printable(metadata_of(reader, recordings::parent_tick_key)).c_str());
}

/// Lists the events. Late ticks are only counted, because on a busy machine they would hide the others.
void print_events(const std::vector<recordings::Event>& events, const Model& model) {
  constexpr std::int64_t kMostShown = 20;
  std::int64_t count = 0;
  for (const recordings::Event& event : events) {
    if (event.kind == recordings::EventKind::late_tick || count++ >= kMostShown) continue;
    print("event      %8.3f s  %s: %s\n", double(event.tick) * model.tick, recordings::name_of(event.kind),
          printable(recordings::describe(event, model)).c_str());
  }
  if (count > kMostShown) print("           and %lld more events\n", (long long)(count - kMostShown));
}

void print_physics(const recordings::SessionReader& reader) {
  const std::int32_t revision = reader.start().physics_revision;
  if (const std::string remark = recordings::physics_remark(revision); !remark.empty())
    print("physics    %s\n", remark.c_str());
  else
    print("physics    revision %d, as this build computes it\n", revision);
}

void print_text(recordings::SessionReader& reader, const recordings::SessionStatistics& s,
                const std::vector<recordings::Event>& events) {
  const Model& model = reader.start().model;
  const std::string begin = session::begins_at_elapsed_time(reader)
                                ? output::fixed(reader.created_unix_s(), 0) + " s after the first session"
                                : session::utc_text(reader.created_unix_s());
  print("session    %s, recorded %s%s\n", reader.session_id().c_str(), begin.c_str(),
        reader.ended_cleanly() ? "" : ", without a clean end");
  print("build      %s\n", printable(reader.start().build_fingerprint).c_str());
  print_physics(reader);
  for (const std::string& remark : reader.remarks()) print("note       %s\n", remark.c_str());
  print_origin(reader);
  print("duration   %.3f s, %lld ticks of %g ms\n", double(reader.tick_count()) * model.tick,
        (long long)reader.tick_count(), model.tick * 1e3);
  for (const OrganRange& organ : model.organs)
    print("organ      %s: %d spheres in %d layers, radius %g mm, spacing %g mm\n", printable(organ.name).c_str(),
          organ.count, organ.layer_count, organ.sphere_radius * 1e3, organ.spacing * 1e3);
  print("network    %s, %s\n", importers::counted(std::int64_t(model.sphere_count()), "sphere").c_str(),
        importers::counted(std::int64_t(model.element_count()), "element").c_str());
  // Only who records in real time knows how long it waited.
  const bool has_clock =
      std::ranges::any_of(s.values, [](const auto& value) { return value.first == session::kWaited; });
  const std::string late = std::to_string(s.late_ticks) + " late";
  print("tick time  p50 %.3f ms, p99 %.3f ms, p99.9 %.3f ms, max %.3f ms; %s\n", s.tick_time_p50 * 1e3,
        s.tick_time_p99 * 1e3, s.tick_time_p999 * 1e3, s.tick_time_max * 1e3,
        s.late_ticks > 0 || has_clock ? late.c_str() : "nothing known of late ones (--fast, or anonymised)");
  if (s.late_ticks > 0)
    print("late       because of: %s (%s)\n", session::late_ticks_of(events, model.tick).text().c_str(),
          session::kLateCausesSay);
  if (s.input_age_max > 0)
    print("input age  p50 %.3f ms, p99 %.3f ms, max %.3f ms\n", s.input_age_p50 * 1e3, s.input_age_p99 * 1e3,
          s.input_age_max * 1e3);
  if (s.slip_max > 0) print("clock      %.3f s behind real time at the end, %.3f s at most\n", s.slip, s.slip_max);
  for (const auto& [name, value] : s.values) print("value      %s = %g\n", printable(name).c_str(), value);
  print("tissue     %s; %s severed, %s came loose\n", extremes_text(s.max_force, s.max_depth).c_str(),
        importers::counted(s.severed, "element").c_str(),
        importers::counted(recordings::pieces_came_loose(events, reader.tick_count()), "piece").c_str());
  if (model.tissue_cells.size() > 0)
    print("inside out %s at the end\n",
          recordings::cells_inside_out(events, reader.tick_count()) > 0 ? "TISSUE IS INSIDE OUT" : "no tissue");
  print_events(events, model);
}

int run_info(const InfoArguments& arguments) {
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(arguments.file);
  if (!reader) return print_errors(reader.errors());
  const Result<session::SessionInfo> info = session::read_info(*reader);
  if (!info) return print_errors(info.errors());
  if (arguments.json)
    std::fputs(session::info_json(*reader, *info).c_str(), stdout);
  else
    print_text(*reader, info->statistics, info->events);
  return exit_good;
}

}  // namespace

Command add_info(CLI::App& program) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App* app = program.add_subcommand("info", "Says what is in a session.");
  app->footer("Example: ctpm info out/demo.ctpm");
  app->add_option("session", arguments->file, "Session file (.ctpm)")->required();
  app->add_flag("--json", arguments->json, "Print JSON");
  return {app, [arguments] { return run_info(*arguments); }};
}

}  // namespace ctpm::commands
