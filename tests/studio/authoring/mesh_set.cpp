// Imports every mesh of a folder with the program, from outside, and sorts what comes of it: a scene that is good, a
// refusal that names its cause and what would help, or a fault. Prints a table of all and their number by cause.
//
//   ctpm_mesh_set PROGRAM FOLDER OUT [--no-record] [--one-at-a-time] [--from=N] [PART-OF-A-PATH]
//
// A scene is good if `check` takes it without a warning about how it stands, the volume of its spheres is within 5 % of
// the mesh's, and the import's script touches and cuts every organ; without --no-record also a session that is recorded
// with it.
// --from=N goes on with the N-th mesh, from 0, of a run that was stopped. A refusal that names an option with its value
// is followed, once. Exit code 1: a fault, or fewer scenes than the goal.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "importers/mesh_file.h"
#include "recordings/session_reader.h"
#include "tests/studio/commands/run_program.h"

namespace {

namespace fs = std::filesystem;
using ctpm::importers::suffix_of;
using ctpm::testing::ProgramOutcome;

constexpr double kMostSeconds = 60, kMostMebibytes = 1024, kVolumeKept = 0.05;
constexpr int kGoal = 180;
constexpr int kThreads = 2;

enum class Verdict { scene, scene_by_option, refusal, fault };
constexpr const char* kNames[] = {"scene", "scene by option", "refusal", "FAULT"};

struct Row {
  std::string file;
  Verdict verdict = Verdict::fault;
  std::string cause;
  double seconds = 0, mebibytes = 0;
};

bool is_mesh(const fs::path& path) {
  static const std::vector<std::string> kSuffixes{"obj", "stl", "ply", "off", "gltf", "glb", "dae", "fbx"};
  const bool is_broken_on_purpose = path.string().find("/invalid/") != std::string::npos;
  return !is_broken_on_purpose &&
         std::find(kSuffixes.begin(), kSuffixes.end(), suffix_of(path.string())) != kSuffixes.end();
}

std::string first_line_with(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  if (at == std::string::npos) return "";
  const std::size_t begin = text.rfind('\n', at) + 1;
  return text.substr(begin, text.find('\n', at) - begin);
}

/// Without what differs from file to file: paths, numbers, names in quotes.
std::string shape_of(std::string message) {
  if (const std::size_t at = message.find("error: "); at != std::string::npos) message.erase(0, at + 7);
  message = std::regex_replace(message, std::regex("\"[^\"]*\"|'[^']*'"), "X");
  message = std::regex_replace(message, std::regex("-?[0-9]+(\\.[0-9]+)?(e[-+]?[0-9]+)?"), "N");
  return message.substr(0, 100);
}

/// All numbers behind `"key": ` in JSON text.
std::vector<double> numbers_of(const std::string& json, const std::string& key) {
  std::vector<double> values;
  const std::string start = "\"" + key + "\": ";
  for (std::size_t at = json.find(start); at != std::string::npos; at = json.find(start, at + 1))
    values.push_back(std::stod(json.substr(at + start.size(), 30)));
  return values;
}

class Trial {
 public:
  Trial(std::string program, fs::path mesh, fs::path folder, bool records)
      : program_(std::move(program)), mesh_(std::move(mesh)), folder_(std::move(folder)), records_(records) {}

  Row run() {
    fs::create_directories(folder_);
    row_.file = mesh_.string();
    ProgramOutcome import = run_program(import_arguments());
    bool is_by_option = false;
    std::smatch option;
    if (import.code == 2 && std::regex_search(import.err, option, std::regex("(--largest-hole-mm) ([0-9.]+)"))) {
      refused_for_ = import.err;
      std::vector<std::string> again = import_arguments();
      again.insert(again.end(), {option[1], option[2]});
      // Holes may be nested one in the other: the limit has a margin.
      import = run_program(again);
      is_by_option = true;
    }
    if (import.code == 2) return refuse(import);
    if (import.code != 0)
      return fault(import.code == 124 ? "import: too long"
                                      : "import: exit code " + std::to_string(import.code) + " " + import.err);
    if (const std::string bad = judge(); !bad.empty()) return fault(bad);
    row_.verdict = is_by_option ? Verdict::scene_by_option : Verdict::scene;
    row_.cause = is_by_option ? shape_of(first_line_with(refused_for_, "error: ")) : "";
    return limits();
  }

 private:
  std::vector<std::string> import_arguments() const {
    return {"import", mesh_.string(), "-o", "my/scene.json", "--report", "report.json", "--overwrite"};
  }

  ProgramOutcome run_program(const std::vector<std::string>& arguments, double limit = 10 * kMostSeconds) {
    // The wall clock of a loaded machine is no measure; the processor's time is judged below.
    std::vector<std::string> command{"timeout", "-k", "5", std::to_string(int(limit)), program_};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const ProgramOutcome outcome = ctpm::testing::run(command, folder_);
    row_.seconds = std::max(row_.seconds, outcome.cpu_s);
    row_.mebibytes = std::max(row_.mebibytes, outcome.memory_mib);
    return outcome;
  }

  /// Why a scene is not good; empty if it is.
  std::string judge() {
    const ProgramOutcome check = run_program({"check", "my/scene.json"});
    if (check.code != 0) return "check refuses: " + shape_of(first_line_with(check.err, "error: "));
    for (const char* bad :
         {"sags by", "so that it falls", "holds the organ where it is", "hold every sphere", "cannot settle"})
      if (check.err.find(bad) != std::string::npos) return "check warns: " + shape_of(first_line_with(check.err, bad));
    const std::string report = ctpm::testing::slurp(folder_ / "report.json");
    // Each organ has the volume of its mesh and then that of its spheres.
    const std::vector<double> volumes = numbers_of(report, "volume_ml"), spheres = numbers_of(report, "spheres");
    for (std::size_t i = 0; i + 1 < volumes.size(); i += 2)
      if (!(std::abs(volumes[i + 1] / volumes[i] - 1) <= kVolumeKept)) return "volume is off by more than 5 %";
    if (spheres.empty() || *std::min_element(spheres.begin(), spheres.end()) < 50) return "fewer than 50 spheres";
    if (report.find("\"script_cuts\": false") != std::string::npos) return "the script does not cut an organ";
    if (report.find("\"script_force_n\": 0,") != std::string::npos) return "the script does not touch an organ";
    return records_ ? record() : "";
  }

  std::string record() {
    const double before = row_.seconds;
    const ProgramOutcome record = run_program(
        {"record", "my/scene.json", "--script", "my/scene.script.json", "-o", "cut.ctpm", "--fast", "--overwrite"},
        20 * kMostSeconds);
    row_.seconds = before;  // a session may last longer
    if (record.code != 0) return "record: exit code " + std::to_string(record.code);
    if (record.out.find("at most 0.000 N") != std::string::npos) return "recorded, but nothing is touched";
    const std::string uncut = uncut_organ();
    fs::remove(folder_ / "cut.ctpm");
    return uncut.empty() ? "" : "recorded, but not cut: " + uncut;
  }

  /// The first organ of the recorded session that no blade went through, or why the session cannot be read; else empty.
  std::string uncut_organ() const {
    auto session = ctpm::recordings::SessionReader::open((folder_ / "cut.ctpm").string());
    if (!session) return session.errors()[0].message;
    const auto end = session->keyframe_at_or_before(session->tick_count());
    if (!end) return end.errors()[0].message;
    const std::vector<ctpm::OrganRange>& organs = session->start().model.organs;
    for (std::size_t o = 0; o < organs.size(); ++o)
      if (std::ranges::count(end->state.swept_organ, o + 1) == 0) return organs[o].name;
    return "";
  }

  Row refuse(const ProgramOutcome& import) {
    const std::string line = first_line_with(import.err, "error: ");
    row_.verdict = Verdict::refusal, row_.cause = shape_of(line);
    if (line.empty()) return fault("a refusal without a cause");
    if (line.back() != ')') return fault("a refusal without help: " + row_.cause);
    if (fs::exists(folder_ / "my")) return fault("a refusal that leaves files behind");
    return limits();
  }

  Row fault(const std::string& cause) {
    row_.verdict = Verdict::fault, row_.cause = cause.substr(0, 160);
    return row_;
  }

  Row limits() {
    if (row_.seconds > kMostSeconds) return fault("takes more than 60 s");
    if (row_.mebibytes > kMostMebibytes) return fault("takes more than 1 GB");
    return row_;
  }

  std::string program_, refused_for_;
  fs::path mesh_, folder_;
  bool records_;
  Row row_;
};

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const bool records = std::erase(arguments, "--no-record") == 0;
  const bool is_alone = std::erase(arguments, "--one-at-a-time") > 0;
  std::size_t from = 0;
  std::erase_if(arguments, [&](const std::string& argument) {
    const bool is_from = argument.starts_with("--from=");
    if (is_from) from = std::stoul(argument.substr(7));
    return is_from;
  });
  if (arguments.size() < 3)
    return std::fprintf(stderr, "ctpm_mesh_set PROGRAM FOLDER OUT [--no-record] [--one-at-a-time] [--from=N] [PART]\n"),
           2;
  std::vector<fs::path> meshes;
  for (const auto& entry : fs::recursive_directory_iterator(arguments[1]))
    if (entry.is_regular_file() && is_mesh(entry.path()) &&
        (arguments.size() < 4 || entry.path().string().find(arguments[3]) != std::string::npos))
      meshes.push_back(fs::absolute(entry.path()));
  std::sort(meshes.begin(), meshes.end());
  fs::create_directories(arguments[2]);
  meshes.erase(meshes.begin(), meshes.begin() + std::ptrdiff_t(std::min(from, meshes.size())));
  const bool is_whole = arguments.size() < 4 && from == 0;
  std::vector<Row> rows(meshes.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i; (i = next++) < meshes.size();) {
      const fs::path folder = fs::absolute(arguments[2]) / std::to_string(from + i);
      fs::remove_all(folder);
      rows[i] = Trial(fs::absolute(arguments[0]).string(), meshes[i], folder, records).run();
      std::printf("%zu\t%s\t%.1f s\t%.0f MiB\t%s\t%s\n", from + i, kNames[int(rows[i].verdict)], rows[i].seconds,
                  rows[i].mebibytes, meshes[i].filename().c_str(), rows[i].cause.c_str());
      std::fflush(stdout);
    }
  };
  std::vector<std::thread> others;
  for (int t = 1; t < (is_alone ? 1 : kThreads); ++t) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();

  std::map<std::pair<int, std::string>, int> causes;
  int count[4] = {};
  for (const Row& row : rows) ++causes[{int(row.verdict), row.cause}], ++count[int(row.verdict)];
  std::printf("\n");
  for (const auto& [key, number] : causes)
    std::printf("%4d  %-16s %s\n", number, kNames[key.first], key.second.c_str());
  const int scenes = count[0] + count[1];
  std::printf("\n%zu meshes: %d scenes, %d more by the option that the refusal names, %d refusals, %d faults\n",
              rows.size(), count[0], count[1], count[2], count[3]);
  return count[3] > 0 || (is_whole && scenes < kGoal) ? 1 : 0;
}
