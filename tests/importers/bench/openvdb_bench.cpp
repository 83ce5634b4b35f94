// OpenVDB's mesh-to-volume with a dense interior at equal spacing: the signed distance of every voxel inside,
// which is what filling needs of it; binding, layers and connectedness are not in it. Compare with
// fill/200000/100000.
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include <benchmark/benchmark.h>

#include "sizes.h"

namespace ctpm {
namespace {

void openvdb_mesh_to_volume(benchmark::State& state) {
  openvdb::initialize();
  const tbb::global_control two_cores(tbb::global_control::max_allowed_parallelism, 2);
  const CheckedMesh mesh = bench::checked_ring_of(state.range(0));
  const double spacing = bench::spacing_for(state.range(1));
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  for (const Vec3& p : mesh.vertex)
    points.emplace_back(float(p.x / spacing), float(p.y / spacing), float(p.z / spacing));
  for (const Triangle& t : mesh.triangle)
    triangles.emplace_back(std::uint32_t(t[0]), std::uint32_t(t[1]), std::uint32_t(t[2]));
  std::int64_t inside = 0;
  for (auto _ : state) {
    openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(points, triangles);
    const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    const auto grid =
        openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, *transform, 1.0f, std::numeric_limits<float>::max());
    inside = 0;
    for (auto value = grid->cbeginValueOn(); value; ++value)
      inside += *value < 0 ? std::int64_t(value.getVoxelCount()) : 0;
  }
  state.counters["spheres"] = double(inside);
}
BENCHMARK(openvdb_mesh_to_volume)
    ->Args({100'000, 50'000})
    ->Args({200'000, 100'000})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace ctpm
