// How fast sessions become video. Run: build/release/tests/ctpm_export_benchmark
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "tests/studio/commands/run_program.h"

namespace ctpm::testing {
namespace {

const std::string kScenes = std::string(CTPM_SOURCE_DIR) + "/scenes/";

/// A number of the sidecar.
double number_of(const std::string& json, const std::string& key) {
  const auto at = json.find("\"" + key + "\": ");
  return at == std::string::npos ? 0 : std::atof(json.c_str() + at + key.size() + 4);
}

/// Records a shipped script and exports it at 1280x720 with 30 frames a second; prints one line.
bool measure(const TemporaryFolder& folder, const std::string& scene, const std::string& script) {
  if (run_ctpm({"record", kScenes + scene + ".json", "--script", kScenes + "scripts/" + script + ".json", "-o",
                script + ".ctpm", "--fast"},
               folder.path())
          .code != 0)
    return false;
  const auto exported = run_ctpm({"export", script + ".ctpm", "-o", script + ".mp4"}, folder.path());
  if (exported.code != 0) return false;
  const std::string json = slurp(folder.path() / (script + ".mp4.json"));
  const double video = number_of(json, "video_s"), elapsed = number_of(json, "elapsed_s"),
               simulation = number_of(json, "simulation_s"), rendering = number_of(json, "rendering_s"),
               encoding = number_of(json, "encoding_s"), work = simulation + rendering + encoding;
  // Others may use the machine too: processor time is what an export costs, whoever else is there.
  std::printf("%-12s %7.1f %9.2f %11.2f %9.0f %9.0f %9.0f %9.1f\n", script.c_str(), video, video / elapsed,
              exported.cpu_s / video, 100 * simulation / work, 100 * rendering / work, 100 * encoding / work,
              exported.memory_mib);
  return true;
}

int run_all() {
  const TemporaryFolder folder;
  std::printf("%u processors\n%-12s %7s %9s %11s %9s %9s %9s %9s\n", std::thread::hardware_concurrency(), "session",
              "video s", "real time", "CPU s per s", "simul. %", "render. %", "encod. %", "MiB");
  for (const auto& [scene, script] : std::vector<std::pair<std::string, std::string>>{
           {"liver", "liver-press"}, {"liver", "liver-cut"}, {"kidney", "kidney-cut"}, {"skin", "skin-press"}})
    if (!measure(folder, scene, script)) return std::fprintf(stderr, "%s failed\n", script.c_str()), 1;
  return 0;
}

}  // namespace
}  // namespace ctpm::testing

int main() { return ctpm::testing::run_all(); }
