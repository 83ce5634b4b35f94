// What `ctpm cohort` costs: cuts in the shipped kidney, by experts and by trainees in ten attempts each. A few are
// recorded; the others are the same sessions under other numbers, which cost as much.
//   ctpm_cohort_benchmark FOLDER [SESSIONS]

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "recordings/rewrite.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;

constexpr int kRecorded = 8, kExperts = 3, kAttempts = 10;

/// A cut across the kidney at a depth and a pace that the number chooses.
void write_script(const fs::path& file, int number) {
  std::ofstream out(file);
  out << R"({"format": "ctpm-script", "version": 1, "steps": [
    {"take": {"tool": "scalpel", "at_mm": [-22, -5, 60], "facing": [1, 0, 0]}}, {"cut": {"smooth": true, "path_mm": [)";
  for (int i = 0; i <= 8; ++i) {
    const double beside = number < kExperts ? 0 : 1.5 * double((i * 7 + number * 5) % 5 - 2);
    out << (i ? ", [" : "[") << -22 + 5.5 * i << ", " << -5 + beside << ", " << 22 - 0.2 * number << "]";
  }
  out << R"(], "speed_mm_per_s": )" << 30 - 1.5 * number
      << R"(}}, {"move": {"to_mm": [22, -5, 65], "speed_mm_per_s": 60}},
    {"put_away": true}, {"wait_s": 0.5}]})";
}

bool copy_session(const fs::path& from, const fs::path& to, int number) {
  auto session = recordings::SessionReader::open(from.string());
  if (!session) return false;
  fs::create_directories(to.parent_path());
  char id[33];
  std::snprintf(id, sizeof id, "%032d", number + 1);
  return bool(recordings::rewrite_session(*session, to.string(),
                                          {.start = session->start(), .id = id, .created_unix_s = 60.0 * number}));
}

int run_benchmark(const fs::path& folder, int sessions) {
  fs::create_directories(folder);
  const std::string scene = std::string(CTPM_SOURCE_DIR) + "/scenes/kidney.json";
  for (int i = 0; i < kExperts + kRecorded; ++i) {
    const std::string name = (i < kExperts ? "experts/" : "recorded/") + std::to_string(i) + ".ctpm";
    if (fs::exists(folder / name)) continue;
    fs::create_directories((folder / name).parent_path());
    write_script(folder / "script.json", i);
    const auto recorded = testing::run_ctpm({"record", scene, "--script", "script.json", "-o", name, "--fast"}, folder);
    if (recorded.code != 0) return std::fprintf(stderr, "%s", recorded.err.c_str()), 1;
  }
  for (const int count : {sessions / 4, sessions / 2, sessions}) {
    const std::string trainees = "trainees-" + std::to_string(count);
    for (int i = 0; i < count; ++i) {
      const fs::path to =
          folder / trainees / ("trainee-" + std::to_string(i / kAttempts)) / (std::to_string(i % kAttempts) + ".ctpm");
      if (!fs::exists(to) &&
          !copy_session(folder / ("recorded/" + std::to_string(kExperts + i % kRecorded) + ".ctpm"), to, i))
        return std::fprintf(stderr, "%s: not made\n", to.c_str()), 1;
    }
    const auto begin = std::chrono::steady_clock::now();
    const auto done =
        testing::run_ctpm({"cohort", "--experts", "experts", "--trainees", trainees, "-o", "out-" + trainees}, folder);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (done.code != 0) return std::fprintf(stderr, "%s", done.err.c_str()), 1;
    std::printf("%4d sessions: %6.1f s, %6.1f s of processors, at most %.0f MiB\n", count, seconds, done.cpu_s,
                done.memory_mib);
  }
  return 0;
}

}  // namespace
}  // namespace ctpm

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "ctpm_cohort_benchmark FOLDER [SESSIONS]\n"), 2;
  return ctpm::run_benchmark(argv[1], argc > 2 ? std::atoi(argv[2]) : 200);
}
