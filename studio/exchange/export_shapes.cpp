#include "studio/exchange/export_shapes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "recordings/replay.h"
#include "scenes/scene_file.h"
#include "studio/exchange/writers.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"

namespace ctpm::exchange {
namespace {

namespace fs = std::filesystem;

std::string ending_of(const std::string& path) { return fs::path(path).extension().string(); }

bool is_series(const std::string& path) { return ending_of(path) == ".pvd" || ending_of(path) == ".usda"; }

/// Removes what was written unless it is kept.
class Written {
 public:
  ~Written() {
    std::error_code ignored;
    if (!is_kept_)
      for (auto file = files.rbegin(); file != files.rend(); ++file) fs::remove(*file, ignored);
    if (!is_kept_ && !folder.empty()) fs::remove(folder, ignored);
  }
  void keep() { is_kept_ = true; }
  Result<Done> write(const std::string& path, const std::string& text) {
    Result<Done> written = output::write_text_file(path, text);
    if (written) files.push_back(path);
    return written;
  }

  std::vector<std::string> files;
  std::string folder;  ///< made by the export

 private:
  bool is_kept_ = false;
};

/// The ticks of the moments.
Result<std::vector<std::int64_t>> choose_ticks(const recordings::SessionReader& session, const std::string& path,
                                               const ExportOptions& options) {
  const double tick = session.start().model.tick, end = double(session.tick_count()) * tick;
  if (!is_series(path)) {
    const double at = options.at_s.value_or(end);
    if (!(at >= 0 && at <= end + 0.5 * tick))
      return Error{output::option_name("exchange.at_s"),
                   "got " + output::short_number(at, 6) + ", the session lasts " + output::short_number(end, 6) + " s",
                   ""};
    return std::vector<std::int64_t>{std::min<std::int64_t>(std::llround(at / tick), session.tick_count())};
  }
  if (options.at_s)
    return Error{output::option_name("exchange.at_s"), "is for files that hold one moment: .vtp, .vtu and .glb",
                 output::option_name("time_range.from_s") + " and " + output::option_name("time_range.to_s") +
                     " bound a series"};
  if (!(options.fps >= 1 && options.fps <= 1000))
    return Error{output::option_name("export.fps"),
                 "got " + output::short_number(options.fps, 6) + ", must be in [1, 1000]", ""};
  const Result<session::TickRange> range = options.range.in_ticks(session.path(), tick, session.tick_count());
  if (!range) return range.errors();
  std::vector<std::int64_t> ticks;
  for (std::int64_t n = 0;; ++n) {
    const std::int64_t at = range->from + std::llround(double(n) / (options.fps * tick));
    if (at > range->to) break;
    if (ticks.empty() || at > ticks.back()) ticks.push_back(at);
  }
  return ticks;
}

/// Files of the moments of a `.pvd`.
Result<Done> write_members(const Model& model, const Moment& moment, const std::string& path, std::size_t number,
                           std::vector<SeriesMember>& members, Written& written) {
  const std::string folder = fs::path(path).stem().string();
  char name[32];
  std::snprintf(name, sizeof name, "%06zu", number);
  const auto add = [&](const std::string& file, int part, const std::string& text) {
    members.push_back({moment.time, part, folder + "/" + file});
    return written.write((fs::path(path).parent_path() / folder / file).string(), text);
  };
  if (Result<Done> done = add("surface_" + std::string(name) + ".vtp", 0, to_vtp(model, moment)); !done) return done;
  return add("network_" + std::string(name) + ".vtu", 1, to_vtu(model, moment));
}

Error differs(const std::string& path, std::int64_t tick, double length) {
  return {path,
          "the replay differs from the recording since " + output::fixed(double(tick) * length, 3) +
              " s; nothing was written",
          "verify the session to see what differs; " + output::option_name("export.allow_diverged") +
              " exports all the same"};
}

}  // namespace

bool is_shape_file(const std::string& path) {
  const std::string ending = ending_of(path);
  return ending == ".vtp" || ending == ".vtu" || ending == ".glb" || is_series(path);
}

Result<ExportOutcome> export_shapes(recordings::SessionReader& session, const std::string& path,
                                    const ExportOptions& options) {
  const Model& model = session.start().model;
  const Result<std::vector<std::int64_t>> ticks = choose_ticks(session, path, options);
  if (!ticks) return ticks.errors();
  if (const Result<Done> is_new = output::check_new(path, options.overwrite); !is_new) return is_new.errors();
  const Result<scenes::SceneText> scene =
      scenes::read_scene(session.start().scene_text, session.path() + " (its scene)");
  if (!scene) return scene.errors();
  if (std::all_of(model.surfaces.begin(), model.surfaces.end(), [](const Surface& s) { return s.triangle.empty(); }) &&
      ending_of(path) != ".vtu" && ending_of(path) != ".pvd")
    return Error{path, "the session's organs have no surface", "a .vtu holds their spheres"};
  Result<recordings::ReplayCursor> cursor = recordings::ReplayCursor::create(session);
  if (!cursor) return cursor.errors();

  Written written;
  if (ending_of(path) == ".pvd") {
    const fs::path folder = fs::path(path).parent_path() / fs::path(path).stem();
    std::error_code trouble;
    if (fs::create_directory(folder, trouble)) written.folder = folder.string();
    if (trouble) return Error{folder.string(), "cannot be made: " + trouble.message(), ""};
    if (written.folder.empty() && !options.overwrite)
      return Error{folder.string(), "exists already", output::option_name("overwrite") + " replaces it"};
  }
  ExportOutcome outcome;
  Shaper shaper(model, scene->spec);
  UsdWriter usd(model, options.fps);
  std::vector<SeriesMember> members;
  std::string text;
  for (const std::int64_t tick : *ticks) {
    if (options.should_stop && options.should_stop()) return Error{path, "stopped", "nothing was written"};
    if (cursor->tick() != tick && outcome.moments == 0)
      if (const Result<Done> found = cursor->seek(std::max<std::int64_t>(0, tick - 1)); !found) return found.errors();
    while (cursor->tick() < tick) {
      const Result<bool> went_on = cursor->step();
      if (!went_on) return went_on.errors();
      if (!*went_on) break;
      if (outcome.first_different_tick < 0 && !cursor->same_so_far()) outcome.first_different_tick = cursor->tick() - 1;
      if (outcome.first_different_tick >= 0 && !options.allow_diverged)
        return differs(session.path(), outcome.first_different_tick, model.tick);
    }
    Moment moment{double(tick) * model.tick, shaper.shapes(cursor->state()), cursor->state(),
                  tick > 0 ? cursor->report().tool_force : Vec3{}};
    const std::string ending = ending_of(path);
    if (ending == ".usda") usd.add(moment);
    if (ending == ".vtp") text = to_vtp(model, moment);
    if (ending == ".vtu") text = to_vtu(model, moment);
    if (ending == ".glb") text = to_glb(moment);
    if (ending == ".pvd")
      if (const Result<Done> done = write_members(model, moment, path, std::size_t(outcome.moments), members, written);
          !done)
        return done.errors();
    ++outcome.moments;
    if (options.progress) options.progress(outcome.moments, std::int64_t(ticks->size()));
  }
  if (ending_of(path) == ".usda") text = usd.text();
  if (ending_of(path) == ".pvd") text = to_pvd(members);
  if (text.empty()) return Error{path, "could not be made by the glTF writer", ""};
  if (const Result<Done> done = written.write(path, text); !done) return done.errors();
  written.keep();
  outcome.files = written.files;
  return outcome;
}

}  // namespace ctpm::exchange
