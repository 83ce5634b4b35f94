#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/model/errors.h"
#include "recordings/session_reader.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/flags.h"
#include "studio/commands/physics_warning.h"
#include "studio/commands/stop_signal.h"
#include "studio/compare/matched_moments.h"
#include "studio/compare/session_track.h"
#include "studio/exchange/export_shapes.h"
#include "studio/film/contact_sheet.h"
#include "studio/film/expert_cut_of.h"
#include "studio/film/export_video.h"
#include "studio/film/stills.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"
#include "studio/render/picture_size.h"
#include "studio/reports/table.h"

namespace ctpm::commands {
namespace {

struct ExportArguments {
  std::vector<std::string> files;
  std::string beside, ghost, output, align, size = "1280x720";
  std::optional<double> at_s;
  bool no_expert_line = false;
  film::ExportOptions options;
};

void print_outcome(const film::ExportOutcome& outcome) {
  const video::VideoFacts& video = outcome.video;
  print("%s: %lld frames, %dx%d, %g frames/s, %s, %.1f MB; replay %s\n", video.path.c_str(), (long long)video.frames,
        video.width, video.height, video.fps, video.codec.c_str(), double(video.bytes) / 1e6,
        outcome.same_as_recorded() ? "same as recorded" : "DIFFERS from what was recorded; every frame says so");
  const film::StageTimes& times = outcome.times;
  const auto share = [&](double part) { return output::fixed(100 * part / times.work(), 0) + " %"; };
  print_remark("exported in " + output::fixed(times.elapsed, 1) + " s, " +
               output::fixed(double(video.frames) / video.fps / times.elapsed, 2) + " times real time; of the work " +
               share(times.simulation) + " simulation, " + share(times.rendering) + " rendering, " +
               share(times.encoding) + " encoding");
}

bool is_sheet(const std::string& path) { return path.ends_with(".png"); }

/// Two sessions are shown in videos, and in the picture of a moment.
Errors check_pair(const ExportArguments& arguments, const std::string& what_output_is) {
  Errors errors;
  for (const auto& [flag, other] : {std::pair{"--beside", &arguments.beside}, {"--ghost", &arguments.ghost}})
    if (!other->empty())
      errors.push_back({flag, "is for videos only, and " + arguments.output + what_output_is,
                        std::string("give --output a name that ends in .mp4") +
                            (is_sheet(arguments.output) ? ", or a moment with --at-s" : "")});
  return errors;
}

/// Options of pictures that were given for a file that holds shapes.
Errors check_given(const CLI::App& app, const ExportArguments& arguments) {
  // Of a pair check_pair() tells more.
  const std::set<std::string> others{"session",   "output",         "at-s",   "from-s", "to-s",  "fps",
                                     "overwrite", "allow-diverged", "beside", "ghost",  "align", "help"};
  Errors errors;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_lnames().empty() ? option->get_name() : option->get_lnames().front();
    if (option->count() > 0 && !others.contains(name))
      errors.push_back({"--" + name, "is of pictures, and " + arguments.output + " holds shapes", ""});
  }
  return errors;
}

/// Exports the shape of the tissue for other programs.
int run_shapes(const CLI::App& app, const ExportArguments& arguments) {
  Errors errors = check_given(app, arguments);
  append(errors, check_pair(arguments, " holds the shapes of one session"));
  if (!errors.empty()) return print_errors(errors);
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(arguments.files[0]);
  if (!reader) return print_errors(reader.errors());
  warn_of_physics(*reader);
  const StopSignal stop;
  exchange::ExportOptions options;
  options.at_s = arguments.at_s, options.range = arguments.options.range, options.fps = arguments.options.fps;
  options.overwrite = arguments.options.overwrite, options.allow_diverged = arguments.options.allow_diverged;
  options.should_stop = [&] { return stop.came(); };
  const Result<exchange::ExportOutcome> outcome = [&] {
    ProgressLine progress("exporting");
    options.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
    return exchange::export_shapes(*reader, arguments.output, options);
  }();
  if (!outcome) return print_errors(outcome.errors());
  const bool is_same = outcome->first_different_tick < 0;
  const std::size_t files = outcome->files.size();
  print("%s: %lld %s in %zu %s; replay %s\n", arguments.output.c_str(), (long long)outcome->moments,
        outcome->moments == 1 ? "moment" : "moments", files, files == 1 ? "file" : "files",
        is_same ? "same as recorded" : "DIFFERS from what was recorded");
  return is_same ? exit_good : exit_bad_verdict;
}

/// Of some sessions those that stand side by side; writes to the arguments what brings them together, and the ghost.
Result<std::vector<recordings::SessionReader*>> pair_up(std::vector<recordings::SessionReader>& readers,
                                                        ExportArguments& arguments) {
  std::vector<recordings::SessionReader*> sessions;
  for (recordings::SessionReader& reader : readers) sessions.push_back(&reader);
  if (sessions.size() < 2) return sessions;
  Result<compare::MatchedMoments> matched = compare::match_sessions(*sessions[0], *sessions[1], arguments.align);
  if (!matched) return matched.errors();
  arguments.options.matched = std::move(*matched);
  const Result<Done> same = compare::check_same_scene(*sessions[0], *sessions[1]);
  const bool is_ghost = !arguments.ghost.empty();
  if (!same && is_ghost) return same.errors();
  if (!same) print_warnings(same.errors());
  const Result<Done> line = film::pair_up(sessions, is_ghost, same && !arguments.no_expert_line, arguments.options);
  if (!line) print_warnings(line.errors());
  return sessions;
}

/// Draws one moment of a session or of a pair.
int run_moment(std::vector<recordings::SessionReader>& readers, ExportArguments& arguments) {
  const Result<std::vector<recordings::SessionReader*>> sessions = pair_up(readers, arguments);
  if (!sessions) return print_errors(sessions.errors());
  const Result<Done> written = film::write_still(*sessions, arguments.output, *arguments.at_s, arguments.options);
  if (!written) return print_errors(written.errors());
  print("%s: at %g s, %dx%d\n", arguments.output.c_str(), *arguments.at_s, arguments.options.size.width,
        arguments.options.size.height);
  return exit_good;
}

/// Draws all of a session on one page.
int run_sheet(recordings::SessionReader& session, ExportArguments& arguments) {
  const Result<Done> written = [&] {
    ProgressLine progress("drawing");
    arguments.options.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
    return film::write_contact_sheet(session, arguments.output, arguments.options);
  }();
  if (!written) return print_errors(written.errors());
  print("%s: %d moments, %dx%d\n", arguments.output.c_str(), film::kSheetColumns * film::kSheetRows,
        arguments.options.size.width, arguments.options.size.height);
  return exit_good;
}

/// What options of one kind of output or number of sessions do with another.
Errors check_arguments(const ExportArguments& arguments) {
  Errors errors;
  const bool is_many = arguments.files.size() > 1, is_picture = is_sheet(arguments.output);
  if (arguments.at_s && !is_picture)
    errors.push_back({"--at-s", "is for .png, .vtp, .vtu and .glb, which hold one moment", ""});
  if (!arguments.options.caption.empty() && is_picture && !arguments.at_s)
    errors.push_back({"--caption", "is for videos and for the picture of a moment", "give --at-s too"});
  if (is_picture && !arguments.at_s) append(errors, check_pair(arguments, " is a picture of one session"));
  for (const auto& [flag, other] : {std::pair{"--beside", &arguments.beside}, {"--ghost", &arguments.ghost}})
    if (is_many && !other->empty()) errors.push_back({flag, "is for one session, and several are given", ""});
  if (!arguments.align.empty() && arguments.beside.empty() && arguments.ghost.empty())
    errors.push_back({"--align", "needs --beside or --ghost", ""});
  if (is_many && (is_picture || arguments.output.ends_with(".mp4") || arguments.output.ends_with(".avi")))
    errors.push_back({"--output", "is one file, and several sessions are given", "give a folder: one video each"});
  return errors;
}

/// One video of a session, alone, beside another or with its ghost. `arguments` belong to it alone.
Result<film::ExportOutcome> export_one(ExportArguments arguments, std::vector<recordings::SessionReader>& readers) {
  const Result<std::vector<recordings::SessionReader*>> sessions = pair_up(readers, arguments);
  if (!sessions) return sessions.errors();
  ProgressLine progress("exporting");
  arguments.options.progress = [&](std::int64_t done, std::int64_t total) { progress.show(done, total); };
  return film::export_video(*sessions, arguments.output, arguments.options);
}

Result<std::vector<recordings::SessionReader>> open_all(const std::vector<std::string>& files) {
  Errors errors;
  std::vector<recordings::SessionReader> readers;
  for (const std::string& file : files) {
    if (file.empty()) continue;
    Result<recordings::SessionReader> reader = recordings::SessionReader::open(file);
    if (reader)
      warn_of_physics(*reader), readers.push_back(std::move(*reader));
    else
      append(errors, reader);
  }
  if (!errors.empty()) return errors;
  return readers;
}

/// A name for each file: that of the file, after those of as many of its folders as tell it from the others.
std::map<std::string, std::string> names_of(const std::vector<std::string>& files) {
  std::map<std::string, std::string> names;
  std::map<std::string, std::filesystem::path> folders;  // that are not in the names yet
  for (const std::string& file : files) {
    const std::filesystem::path path = std::filesystem::absolute(file).lexically_normal();
    names[file] = path.stem().string(), folders[file] = path.parent_path();
  }
  for (bool any = true; std::exchange(any, false);) {
    std::map<std::string, int> count;
    for (const auto& [file, name] : names) ++count[name];
    for (auto& [file, name] : names) {
      std::filesystem::path& folder = folders[file];
      if (count[name] < 2 || !folder.has_filename()) continue;
      name = folder.filename().string() + "-" + name, folder = folder.parent_path(), any = true;
    }
  }
  return names;
}

/// A video of each session in a folder, and a table of them. A session that fails leaves the others alone.
int run_many(const ExportArguments& arguments) {
  const std::filesystem::path folder = arguments.output;
  const std::string table_path = (folder / "results.csv").string();
  Errors errors;
  const std::map<std::string, std::string> names = names_of(arguments.files);
  std::map<std::string, std::string> files;
  for (const std::string& file : arguments.files) {
    const auto [other, is_new] = files.emplace(names.at(file), file);
    if (!is_new) errors.push_back({file, "would have the same video as " + other->second, "give each session once"});
  }
  std::error_code failed;
  if (std::filesystem::exists(folder, failed))
    append(errors, output::check_new(table_path, arguments.options.overwrite));
  if (!errors.empty()) return print_errors(errors);
  std::filesystem::create_directories(folder, failed);
  if (failed) return print_errors({{arguments.output, "cannot be made: " + failed.message(), ""}});
  reports::Table table;
  table.columns = {{"session", "session"}, {"video", "video"},   {"frames", "frames"}, {"duration_s", "duration [s]"},
                   {"bytes", "bytes"},     {"replay", "replay"}, {"error", "error"}};
  int code = exit_good;
  for (const std::string& file : arguments.files) {
    if (arguments.options.should_stop()) break;
    ExportArguments own = arguments;
    own.output = (folder / (names.at(file) + ".mp4")).string();
    Result<std::vector<recordings::SessionReader>> readers = open_all({file});
    const Result<film::ExportOutcome> outcome =
        readers ? export_one(own, *readers) : Result<film::ExportOutcome>(readers.errors());
    std::vector<reports::Cell>& row = table.rows.emplace_back(table.columns.size());
    row[0] = file;
    if (!outcome) {
      row[6] = to_string(outcome.errors()[0]);
      code = print_errors(outcome.errors());
      continue;
    }
    const video::VideoFacts& video = outcome->video;
    const bool is_same = outcome->same_as_recorded();
    row[1] = video.path, row[2] = video.frames, row[3] = double(video.frames) / video.fps, row[4] = video.bytes;
    row[5] = std::string(is_same ? "same" : "differs");
    if (!is_same && code == exit_good) code = exit_bad_verdict;
    print_outcome(*outcome);
  }
  if (const Result<Done> written = output::write_text_file(table_path, reports::to_csv(table)); !written)
    return print_errors(written.errors());
  print_remark("written: " + table_path);
  return code;
}

int run_export(const CLI::App& app, ExportArguments& arguments) {
  if (exchange::is_shape_file(arguments.output) && arguments.files.size() == 1) return run_shapes(app, arguments);
  Errors errors = check_arguments(arguments);
  const Result<render::PictureSize> size = render::parse_picture_size(arguments.size);
  if (size)
    arguments.options.size = *size;
  else
    append(errors, size);
  const StopSignal stop;  // Ctrl-C ends the loop, and the unfinished file is removed on the way out
  arguments.options.should_stop = [&] { return stop.came(); };
  if (arguments.files.size() > 1) return errors.empty() ? run_many(arguments) : print_errors(errors);
  Result<std::vector<recordings::SessionReader>> readers =
      open_all({arguments.files[0], arguments.beside, arguments.ghost});
  if (!readers) errors.insert(errors.begin(), readers.errors().begin(), readers.errors().end());
  if (!errors.empty()) return print_errors(errors);
  if (is_sheet(arguments.output))
    return arguments.at_s ? run_moment(*readers, arguments) : run_sheet((*readers)[0], arguments);
  const Result<film::ExportOutcome> outcome = export_one(arguments, *readers);
  if (!outcome) return print_errors(outcome.errors());
  if (!outcome->video.note.empty()) print_remark("warning: " + outcome->video.note);
  print_outcome(*outcome);
  return outcome->same_as_recorded() ? exit_good : exit_bad_verdict;
}

}  // namespace

Command add_export(CLI::App& program) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* app =
      program.add_subcommand("export", "Replays a session off-screen into a video, or into shapes for other programs.");
  app->footer(
      "Examples: ctpm export out/demo.ctpm -o out/demo.mp4 --from-s 4 --speed 0.5 --camera follow\n"
      "          ctpm export trainee.ctpm --ghost expert.ctpm --strip -o ghost.mp4\n"
      "          ctpm export out/*.ctpm -o out/films --size 640x360\n"
      "          ctpm export expert.ctpm --beside trainee.ctpm -o both.mp4 --view elements --by force\n"
      "          ctpm export out/demo.ctpm -o out/demo.pvd --fps 25\n"
      "          ctpm export out/demo.ctpm -o out/demo.glb --at-s 4");
  film::ExportOptions& options = arguments->options;
  app->add_option("session", arguments->files,
                  "Session file (.ctpm); of several a video each, in a folder, with a table")
      ->required();
  app->add_option("-o,--output", arguments->output,
                  "Video: .mp4 (H.264), .avi (Motion JPEG), or a folder/ of PNG pictures; .png: a contact sheet; "
                  "shapes: .pvd (ParaView) or .usda "
                  "of a series, .vtp, .vtu or .glb of a moment")
      ->required();
  CLI::Option* beside = app->add_option("--beside", arguments->beside, "Another session, in step on the right half");
  app->add_option("--ghost", arguments->ghost,
                  "Another session, whose tool is shown through in the picture, and its way")
      ->excludes(beside);
  app->add_option(
      "--align", arguments->align,
      "What brings both together: path of the tool, first contact, first cut, clock, or the seconds that the "
      "second one's clock shows more; the half that is ahead is slowed down. If not given the path, else the contact");
  app->add_flag("--no-expert-line", arguments->no_expert_line,
                "Of a pair, without the line of the expert's cut on the trainee's organ and the marks of what is cut "
                "elsewhere");
  app->add_option("--size", arguments->size, "Width x height in pixels")->capture_default_str();
  app->add_option("--fps", options.fps, "Frames per second")->capture_default_str();
  app->add_option("--speed", options.speed, "Times real speed")->capture_default_str();
  app->add_option("--slow-at", options.slow_at,
                  "Four times slower around these moments: cut, damage, worst, with commas");
  app->add_option("--caption", options.caption,
                  "Words in the picture from the first to the last, in place of what happens; of a pair in the right "
                  "half");
  app->add_option("--overlay", options.overlay, "What stands in the picture: none, small or full")
      ->capture_default_str();
  app->add_option("--inset", options.inset,
                  "Small pictures in the corner: near (the tool), section (the tissue opened at it)");
  app->add_flag("--strip", options.strip, "The whole session's force, limit and moments on a line below the picture");
  add_time_range(*app, options.range);
  app->add_option("--at-s", arguments->at_s,
                  "Moment of a picture (.png), of a pair by the first session's clock; or of a .vtp, .vtu or .glb, "
                  "whose end is taken if it is not given");
  add_look(*app, options.look);
  app->add_flag("--overwrite", arguments->options.overwrite, "Replace an existing video");
  app->add_flag("--allow-diverged", options.allow_diverged,
                "Export although the replay differs, and say so on every frame; it is verified first");
  return {app, [app, arguments] { return run_export(*app, *arguments); }};
}

}  // namespace ctpm::commands
