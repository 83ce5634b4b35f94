#include "studio/compare/compare_files.h"

#include <array>
#include <future>
#include <mutex>
#include <utility>

#include "core/model/errors.h"
#include "scenes/scene_file.h"
#include "studio/compare/slip.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm::compare {

Result<OpenedFiles> open_files(const std::string& expert, const std::string& trainee) {
  Result<recordings::SessionReader> a = recordings::SessionReader::open(expert);
  Result<recordings::SessionReader> b = recordings::SessionReader::open(trainee);
  Errors errors;
  for (const auto* session : {&a, &b}) append(errors, *session);
  if (!errors.empty()) return errors;
  if (const Result<Done> same = check_same_scene(*a, *b); !same) return same.errors();
  return OpenedFiles{std::move(*a), std::move(*b)};
}

namespace {

/// How far two replays have come that run beside each other.
class SharedProgress {
 public:
  SharedProgress(const CompareFilesOptions& options, std::int64_t total) : options_(options), total_(total) {}

  ReplayWatch of(std::size_t session) {
    return [this, session](std::int64_t tick) {
      if (options_.should_stop && options_.should_stop()) return false;
      const std::lock_guard lock(mutex_);
      at_[session] = tick;
      if (options_.progress) options_.progress(at_[0] + at_[1], total_);
      return true;
    };
  }

 private:
  const CompareFilesOptions& options_;
  std::int64_t total_;
  std::mutex mutex_;
  std::array<std::int64_t, 2> at_{};
};

}  // namespace

Result<ComparedFiles> compare_files(OpenedFiles files, const CompareFilesOptions& how) {
  SharedProgress progress(how, files.expert.tick_count() + files.trainee.tick_count());
  // Each replay takes one processor.
  std::future<Result<SessionTrack>> other =
      std::async(std::launch::async, [&] { return read_track(files.expert, how.replaying, progress.of(0)); });
  Result<SessionTrack> trainee = read_track(files.trainee, how.replaying, progress.of(1)), expert = other.get();
  Errors errors;
  for (const auto* track : {&expert, &trainee}) append(errors, *track);
  if (!errors.empty()) return errors;
  // What a replay reports is what was recorded, to the bit, where somebody has replayed all of it.
  if (how.is_expert_known) expert->is_verified = expert->replays;
  if (how.is_trainee_known) trainee->is_verified = trainee->replays;
  CompareOptions options;
  options.force_limit = how.force_limit;
  const recordings::SessionStart& scene = files.expert.start();
  // A scene text of another version may be unreadable; only the limit is needed from it.
  if (const Result<scenes::SceneText> text = scenes::read_scene(scene.scene_text, files.expert.path()); text)
    options.damage_force = loading::damage_force_of(text->spec);
  Comparison comparison = compare_sessions(*expert, *trainee, scene, options);
  refuse_times(comparison, *expert, *trainee);
  return ComparedFiles{std::move(files.expert), std::move(files.trainee), std::move(*expert), std::move(*trainee),
                       std::move(comparison)};
}

}  // namespace ctpm::compare
