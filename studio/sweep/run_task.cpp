#include "studio/sweep/run_task.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <memory>

#include "recordings/byte_hash.h"
#include "scenes/script.h"
#include "studio/output/number_text.h"
#include "studio/session/record_session.h"
#include "studio/sources/motion_source.h"
#include "studio/sources/open_file.h"

namespace ctpm::sweep {
namespace {

/// What is measured while a session runs.
class Measures {
 public:
  explicit Measures(const loading::LoadedScene& scene, const State& start)
      : scene_(scene), start_(start), moved_(scene.scene.spec.probes.size(), 0.0) {}

  void add(const State& state, const recordings::TickRecord& record) {
    hash_.add(&record.state_hash, sizeof record.state_hash);
    double force = 0;
    bool touches = false;
    for (std::size_t hand = 0; hand < kMostHands; ++hand) {
      const stepping::HandReport report = record.of_hand(hand);
      force = std::max(force, norm(report.tool_force)), touches = touches || report.contacts > 0;
    }
    impulse_ += force * tick(), last_force_ = force, contact_ticks_ += touches;
    for (std::size_t i = 0; i < moved_.size(); ++i) {
      const std::size_t sphere = std::size_t(scene_.built.probe_sphere[i]);
      moved_[i] = std::max(moved_[i], norm(state.position[sphere] - start_.position[sphere]));
    }
  }

  TaskResult result(const session::RecordOutcome& outcome) const {
    const recordings::SessionStatistics& s = outcome.statistics;
    TaskResult result;
    result.ticks_hash = recordings::hash_text(hash_.value());
    result.values = {{"duration_s", double(s.ticks) * tick()},
                     {"max_force_n", s.max_force},
                     {"last_force_n", last_force_},
                     {"impulse_n_s", impulse_},
                     {"contact_s", double(contact_ticks_) * tick()},
                     {"max_depth_mm", 1e3 * s.max_depth},
                     {"severed", double(s.severed)}};
    for (std::size_t i = 0; i < moved_.size(); ++i)
      result.values.emplace_back("moved_" + scene_.scene.spec.probes[i].name + "_mm", 1e3 * moved_[i]);
    result.is_good = !stepping::is_refused(outcome.run.status) && outcome.run.fault.empty();
    if (!outcome.run.fault.empty()) result.error = outcome.run.fault;
    if (stepping::is_refused(outcome.run.status))
      result.error = "the simulation was refused at tick " + std::to_string(outcome.run.ticks) + ", sphere " +
                     std::to_string(outcome.run.worst_sphere);
    return result;
  }

 private:
  double tick() const { return scene_.built.model.tick; }

  const loading::LoadedScene& scene_;
  const State& start_;
  recordings::ByteHash hash_;
  std::vector<double> moved_;  ///< furthest of each probe [m] (probe_count)
  double impulse_ = 0, last_force_ = 0;
  std::int64_t contact_ticks_ = 0;
};

/// Of this process [ns].
std::int64_t own_processor_ns() {
  struct timespec time {};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return std::int64_t(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

TaskResult failed(const Errors& errors) {
  TaskResult result;
  for (const Error& error : errors) result.error += (result.error.empty() ? "" : "; ") + to_string(error);
  return result;
}

Result<sources::OpenedSource> open_source(const TaskFiles& files, const loading::LoadedScene& scene) {
  const Model& model = scene.built.model;
  if (files.script_path.empty())
    return sources::play_script(scenes::default_script(scene.scene.spec, scene.organs), model);
  if (std::filesystem::path(files.script_path).extension() == ".csv")
    return sources::read_motion_source(files.script_text, files.script_path, model);
  return sources::read_script_source(files.script_text, files.script_path, model, scene.scene.spec);
}

}  // namespace

Errors Recorder::start(const TaskFiles& files) {
  if (started_ && started_->path == files.scene_path && started_->text == files.scene_text) return {};
  started_.reset();
  Result<loading::LoadedScene> scene = loading::load_whole_scene(files.scene_path, {.text = files.scene_text});
  if (!scene) return scene.errors();
  started_.emplace(Started{files.scene_path, files.scene_text, std::move(*scene), {}});
  started_->start = session::start_session(started_->scene);
  return {};
}

std::optional<TaskResult> Recorder::run(const TaskFiles& files, std::size_t task, const std::string& id,
                                        const Claim& claim, const std::function<bool()>& should_stop) {
  Result<sources::OpenedSource> source = open_source(files, started_->scene);
  if (!source) return failed(sweep_.said(source.errors(), task));
  recordings::SessionStart start = started_->start;
  for (const auto& [key, value] : source->metadata) start.metadata[key] = value;
  start.metadata["sweep"] = sweep_.spec().name, start.metadata["sweep_task"] = id;
  Measures measures(started_->scene, start.initial_state);
  session::RunOptions options;
  options.in_real_time = false;
  options.most_ticks = std::llround(sweep_.spec().duration.value_or(0) / start.model.tick);
  options.should_stop = should_stop;
  options.watch = [&](const State& state, const recordings::TickRecord& record, const session::RunOutcome&) {
    measures.add(state, record);
  };
  const Result<session::RecordOutcome> outcome =
      session::record_session(start, *source->source, claim.session_path(), false, options);
  if (should_stop && should_stop()) return std::nullopt;
  return outcome ? measures.result(*outcome) : failed(outcome.errors());
}

Result<std::optional<TaskResult>> Recorder::record(std::size_t task, const std::string& id, const Claim& claim,
                                                   const std::function<bool()>& should_stop) {
  const Result<TaskFiles> files = sweep_.files_of(task);
  if (!files) return files.errors();
  const std::int64_t begin = own_processor_ns();
  if (const Errors errors = start(*files); !errors.empty()) return std::optional(failed(sweep_.said(errors, task)));
  const std::int64_t started = own_processor_ns();
  const Result<std::string> now = sweep_.id_of(*files, started_->scene.scene.spec);
  if (!now) return now.errors();
  if (*now != id)
    return Error{sweep_.file(), "or a file that it names has changed since it was planned",
                 "plan it again: what is done and did not change stays"};
  const std::int64_t checked = own_processor_ns();
  std::optional<TaskResult> result = run(*files, task, id, claim, should_stop);
  if (result) result->processor_s = 1e-9 * double(own_processor_ns() - checked + started - begin);
  return result;
}

}  // namespace ctpm::sweep
