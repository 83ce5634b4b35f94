#include "studio/compare/compare_files.h"

#include <future>
#include <utility>

#include "scenes/scene_file.h"
#include "studio/compare/slip.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm::compare {

Result<OpenedFiles> open_files(const std::string& expert, const std::string& trainee) {
  Result<recordings::SessionReader> a = recordings::SessionReader::open(expert);
  Result<recordings::SessionReader> b = recordings::SessionReader::open(trainee);
  Errors errors;
  for (const auto* session : {&a, &b})
    if (!*session) errors.insert(errors.end(), session->errors().begin(), session->errors().end());
  if (!errors.empty()) return errors;
  if (const Result<Done> same = check_same_scene(*a, *b); !same) return same.errors();
  return OpenedFiles{std::move(*a), std::move(*b)};
}

Result<ComparedFiles> compare_files(OpenedFiles files, std::optional<double> force_limit, Replaying replaying) {
  // Each replay takes one processor.
  std::future<Result<SessionTrack>> other =
      std::async(std::launch::async, [&] { return read_track(files.expert, replaying); });
  Result<SessionTrack> trainee = read_track(files.trainee, replaying), expert = other.get();
  Errors errors;
  for (const auto* track : {&expert, &trainee})
    if (!*track) errors.insert(errors.end(), track->errors().begin(), track->errors().end());
  if (!errors.empty()) return errors;
  CompareOptions options;
  options.force_limit = force_limit;
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
