#include "studio/session/probes.h"

#include "scenes/build_model.h"
#include "scenes/scene_file.h"

namespace ctpm::session {

std::vector<Probe> probes_of(const recordings::SessionReader& session) {
  std::vector<Probe> probes;
  if (const Result<scenes::SceneText> scene = scenes::read_scene(session.start().scene_text, session.path()))
    for (const scenes::ProbeSpec& probe : scene->spec.probes)
      probes.push_back({probe.name, std::size_t(scenes::nearest_sphere(session.start().model, probe.at))});
  return probes;
}

}  // namespace ctpm::session
