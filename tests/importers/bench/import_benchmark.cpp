// Whole imports, from a file to spheres: time of each stage, memory, and a hash of all that comes out, by which two
// builds are compared. Each file is imported in a process of its own.
//
//   ctpm_import_benchmark FOLDER 150000 600000 2400000    makes rings of so many triangles in FOLDER
//   ctpm_import_benchmark FOLDER liver.stl organ.obj      imports files

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "importers/import.h"
#include "sizes.h"

namespace ctpm {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// FNV-1a over the bytes of what an import gives.
class Hash {
 public:
  template <class T>
  void add(const std::vector<T>& list) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(list.data());
    for (std::size_t i = 0; i < list.size() * sizeof(T); ++i) value_ = (value_ ^ bytes[i]) * 0x100000001B3u;
  }
  void add(const std::string& text) { add(std::vector<char>(text.begin(), text.end())); }
  unsigned long long value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325u;
};

unsigned long long hash_of(const importers::ImportedOrgan& imported) {
  Hash hash;
  hash.add(imported.mesh.vertex), hash.add(imported.mesh.triangle);
  const FilledOrgan& organ = imported.organ;
  hash.add(organ.centre), hash.add(organ.layer), hash.add(organ.surface.vertex), hash.add(organ.surface.triangle);
  hash.add(organ.surface.binding.first), hash.add(organ.surface.binding.sphere);
  hash.add(organ.surface.binding.weight), hash.add(importers::to_text(imported.report));
  return hash.value();
}

/// A ring as binary STL, as scanners write it: every triangle with corners of its own.
std::string write_ring(const std::filesystem::path& folder, std::int64_t triangles) {
  const importers::RawMesh ring = bench::ring_of(triangles);
  const std::string file = (folder / ("ring-" + std::to_string(triangles) + ".stl")).string();
  std::ofstream(file, std::ios::binary) << zoo::to_binary_stl(zoo::moved(ring, [](Vec3 p) { return 1e3 * p; }));
  return file;
}

double processor_seconds(const rusage& used) {
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

int import_one(const std::string& file) {
  std::vector<std::pair<std::string, Clock::time_point>> stages;
  importers::ImportOptions options;
  options.sphere_radius = bench::spacing_for(2000) / 3, options.gap = options.sphere_radius;
  options.most_spheres = 200'000;
  const Clock::time_point start = Clock::now();
  options.progress = [&](const std::string& stage, double) {
    if (stages.empty() || stages.back().first != stage) stages.emplace_back(stage, Clock::now());
  };
  const Result<importers::ImportedOrgan> imported = importers::import_organ(file, options);
  const double total = seconds_since(start);
  if (!imported) return std::printf("%s: %s\n", file.c_str(), zoo::text_of(imported.errors()).c_str()), 1;
  rusage own{}, reader{};
  getrusage(RUSAGE_SELF, &own), getrusage(RUSAGE_CHILDREN, &reader);
  const auto triangles = double(imported->report.before.triangles);
  const double work = processor_seconds(own) + processor_seconds(reader);
  std::printf(
      "%s: %.0f triangles, %.2f s, processor time %.2f s, %.2f s per million, %.0f MiB (its reader %.0f), hash "
      "%016llx\n",
      file.c_str(), triangles, total, work, 1e6 * work / triangles, double(own.ru_maxrss) / 1024,
      double(reader.ru_maxrss) / 1024, hash_of(*imported));
  stages.emplace_back("", Clock::now());
  for (std::size_t i = 0; i + 1 < stages.size(); ++i)
    std::printf("  %-34s %.2f s\n", stages[i].first.c_str(),
                std::chrono::duration<double>(stages[i + 1].second - stages[i].second).count());
  return 0;
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 2) return std::printf("usage: ctpm_import_benchmark FOLDER TRIANGLES|FILE ...\n"), 2;
  int failures = 0;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::string& what = arguments[i];
    const bool is_number = what.find_first_not_of("0123456789") == std::string::npos;
    if (const pid_t child = fork(); child == 0) {
      // A ring is made in a process of its own, too, so that its memory is not counted.
      if (is_number) write_ring(arguments[0], std::stoll(what));
      _exit(0);
    } else {
      waitpid(child, nullptr, 0);
    }
    const std::string file =
        is_number ? (std::filesystem::path(arguments[0]) / ("ring-" + what + ".stl")).string() : what;
    std::fflush(stdout);
    int status = 1;
    if (const pid_t child = fork(); child == 0) {
      const int code = import_one(file);
      std::fflush(stdout);
      _exit(code);
    } else {
      waitpid(child, &status, 0);
    }
    failures += status != 0;
  }
  return failures > 0;
}

}  // namespace
}  // namespace ctpm

int main(int argc, char** argv) { return ctpm::run({argv + 1, argv + argc}); }
