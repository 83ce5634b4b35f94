#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

#include "importers/import.h"
#include "zoo.h"

namespace ctpm {
namespace {

struct Sample {
  std::string name;
  std::string bytes;
};

std::vector<Sample> samples() {
  const importers::RawMesh mesh = zoo::sphere(0.06, 1, {0.01, 0.02, 0.04});
  return {{"a.obj", zoo::to_obj_text(mesh)},
          {"ascii.stl", zoo::to_ascii_stl(mesh)},
          {"binary.stl", zoo::to_binary_stl(mesh)},
          {"ascii.ply", zoo::to_ascii_ply(mesh)},
          {"binary.ply", zoo::to_binary_ply(mesh)},
          {"a.off", zoo::to_off(mesh)},
          {"a.gltf", zoo::to_gltf(mesh)},
          {"a.glb", zoo::to_glb(mesh)},
          {"a.dae", zoo::to_dae(mesh, 0.01)},
          {"a.fbx", zoo::to_fbx(mesh, 1)},
          {"a.3ds", zoo::to_3ds(mesh)}};
}

/// One way or another of damaging a file; the same seed always does the same.
std::string damaged(std::string bytes, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
  // Half of the damage goes to the head, where counts and offsets are.
  const auto place = [&] {
    return random() % 2 ? below(bytes.size()) : below(std::min<std::size_t>(bytes.size(), 200));
  };
  switch (random() % 5) {
    case 0:
      bytes.resize(below(bytes.size()) + 1);
      break;
    case 1:
      for (std::size_t n = 1 + below(16); n > 0; --n) bytes[place()] ^= char(1 << below(8));
      break;
    case 2: {
      constexpr std::uint32_t kHostile[] = {0,          1,          0x7FFFFFFF, 0x80000000,
                                            0xFFFFFFFF, 0x10000000, 0x7F800000, 0x7FC00000};
      const std::uint32_t word = kHostile[below(std::size(kHostile))];
      const std::size_t at = place();
      std::memcpy(bytes.data() + std::min(at, bytes.size() - 4), &word, 4);
      break;
    }
    case 3: {
      const std::size_t at = below(bytes.size()), count = below(bytes.size() - at) + 1;
      bytes.insert(below(bytes.size()), bytes.substr(at, count));
      break;
    }
    default: {
      const std::size_t at = place();
      bytes.erase(at, 1 + below(std::min<std::size_t>(64, bytes.size() - at)));
      break;
    }
  }
  return bytes;
}

std::int64_t resident_mib() {
  std::int64_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * sysconf(_SC_PAGESIZE) / (1 << 20);
}

int lowest_free_file() {
  const int file = open("/dev/null", O_RDONLY);
  close(file);
  return file;
}

/// A mesh that is accepted must keep its promises, however damaged the file was.
void expect_sound(const Result<importers::CheckedMesh>& mesh, const std::string& path) {
  if (!mesh) {
    ASSERT_FALSE(mesh.errors().empty());
    for (const Error& error : mesh.errors()) {
      EXPECT_EQ(error.where, path);
      EXPECT_FALSE(error.message.empty());
    }
    return;
  }
  const importers::MeshCounts counts = importers::count_mesh(mesh->vertex, mesh->triangle);
  EXPECT_EQ(counts.open_edges, 0);
  EXPECT_EQ(counts.non_manifold_edges, 0);
  EXPECT_GT(mesh->volume, 0);
  EXPECT_TRUE(std::isfinite(mesh->volume));
}

class Fuzz : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Fuzz, DamagedFilesEndAsAMeshOrAsAnError) {
  constexpr double kLimit = 1.0;                       // [s] for one file
  constexpr double kSlack = 4.0;                       // [s] a loaded machine may need to stop a child
  [[maybe_unused]] constexpr std::int64_t kLeak = 64;  // [MiB] the heap may grow from use
  const Sample sample = samples()[GetParam()];
  const zoo::Folder folder;
  std::mt19937 random(std::uint32_t(20240501 + GetParam()));
  const int first_free = lowest_free_file();
  [[maybe_unused]] const std::int64_t resident = resident_mib();
  int accepted = 0;
  for (int round = 0; round < CTPM_FUZZ_ROUNDS; ++round) {
    SCOPED_TRACE(sample.name + ", round " + std::to_string(round));
    const std::string path = folder.write(sample.name, damaged(sample.bytes, random));
    importers::ReadOptions options;
    options.time_limit_s = kLimit;
    options.memory_limit_mib = 512;
    const auto start = std::chrono::steady_clock::now();
    const Result<importers::RawMesh> read = importers::read_mesh(path, options);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), kLimit + kSlack);
    if (!read) {
      ASSERT_FALSE(read.errors().empty());
      EXPECT_EQ(read.errors()[0].where, path);
      EXPECT_FALSE(read.errors()[0].message.empty());
      continue;
    }
    ++accepted;
    for (const importers::Triangle& t : read->triangle)
      for (const std::int32_t v : t) {
        ASSERT_TRUE(v >= 0 && v < std::int32_t(read->vertex.size()));
        ASSERT_TRUE(is_finite(read->vertex[std::size_t(v)]));
      }
    const Result<importers::CheckedMesh> mesh =
        importers::repair_mesh(*read, importers::choose_unit(*read, {}, {}).in_metres);
    expect_sound(mesh, path);
    if (!mesh) continue;
    importers::FillOptions fill;
    fill.sphere_radius = norm(mesh->box_most - mesh->box_least) / 60;
    (void)importers::fill_organ(*mesh, fill);
  }
  EXPECT_EQ(lowest_free_file(), first_free) << "a file of the parent stayed open";
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LT(resident_mib() - resident, kLeak);
#endif
  RecordProperty("accepted", accepted);
}

INSTANTIATE_TEST_SUITE_P(EveryFormat, Fuzz, ::testing::Range<std::size_t>(0, samples().size()), [](const auto& info) {
  std::string name = samples()[info.param].name;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

/// A mesh with several random faults, from a vertex out of place to triangles that join what is far apart.
importers::RawMesh damaged(importers::RawMesh mesh, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
  const auto unit = [&] { return double(random()) / 4294967295.0 - 0.5; };
  for (std::size_t faults = 1 + below(12); faults > 0; --faults) {
    const std::size_t t = below(mesh.triangle.size()), v = below(mesh.vertex.size());
    switch (random() % 8) {
      case 0:
        mesh.vertex[v] = {0.2 * unit(), 0.2 * unit(), 0.2 * unit()};
        break;
      case 1:
        mesh.vertex[v] = mesh.vertex[below(mesh.vertex.size())];
        break;
      case 2:
        mesh.triangle[t][below(3)] = std::int32_t(v);
        break;
      case 3:
        std::swap(mesh.triangle[t][0], mesh.triangle[t][1]);
        break;
      case 4:
        mesh.triangle.push_back(mesh.triangle[t]);
        break;
      case 5:
        mesh.triangle[t] = mesh.triangle.back(), mesh.triangle.pop_back();
        break;
      case 6:
        mesh.vertex[v] = (random() % 2 ? 1e18 : 1e-18) * mesh.vertex[v];
        break;
      default:
        mesh.triangle.push_back({std::int32_t(v), mesh.triangle[t][0], mesh.triangle[t][1]});
        break;
    }
  }
  return mesh;
}

TEST(FuzzRepair, DamagedMeshesComeOutSoundOrAreRefused) {
  const importers::RawMesh whole[] = {
      zoo::sphere(0.05, 2), zoo::torus(0.05, 0.02, 16, 8), zoo::box({0.1, 0.1, 0.02}, 3),
      zoo::both(zoo::box({0.1, 0.1, 0.1}, 2), zoo::sphere(0.03, 1, {0.05, 0.05, 0.05}))};
  std::mt19937 random(20240502);
  int closed = 0;
  constexpr int kRounds = 8 * CTPM_FUZZ_ROUNDS;
  for (int round = 0; round < kRounds; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const importers::RawMesh raw = damaged(whole[round % 4], random);
    importers::RepairOptions options;
    options.all_parts = random() % 2;
    if (random() % 2) options.largest_hole = 1.0;
    const Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1, options);
    expect_sound(mesh, raw.path);
    if (!mesh) continue;
    ++closed;
    importers::FillOptions fill;
    fill.sphere_radius = norm(mesh->box_most - mesh->box_least) / 60;
    fill.most_triangles = random() % 2 ? 100 : 0;
    const Result<importers::Filling> filling = importers::fill_organ(*mesh, fill);
    if (!filling) continue;
    for (const double weight : filling->organ.surface.binding.weight) ASSERT_TRUE(std::isfinite(weight));
    for (const double depth : filling->organ.depth) ASSERT_TRUE(std::isfinite(depth));
  }
  EXPECT_GT(closed, kRounds / 10) << "most of the damage can be mended";
}

TEST(FuzzSamples, AreWholeBeforeTheyAreDamaged) {
  const zoo::Folder folder;
  for (const Sample& sample : samples())
    EXPECT_TRUE(importers::read_mesh(folder.write(sample.name, sample.bytes))) << sample.name;
}

}  // namespace
}  // namespace ctpm
