#include <optional>
#include <string>

#include "scenes/rewrite_json.h"
#include "scenes/scene_file.h"

namespace ctpm::scenes {

std::string rewrite_scene(const std::string& text, const SceneSpec& before, const SceneSpec& after) {
  std::string new_text = write_scene(after);
  std::optional<std::string> changed = rewrite_json(text, write_scene(before), new_text);
  if (!changed) return new_text;
  // Places by meaning stay texts, which stand for nothing here.
  const Result<SceneDraft> was = read_draft(text, ""), is = read_draft(*changed, "");
  const bool is_sound = was && is && is->problems.is_empty() && is->open_places == was->open_places;
  return is_sound && (!is->open_places.empty() || is->scene.spec == after) ? *std::move(changed) : new_text;
}

}  // namespace ctpm::scenes
