#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "sizes.h"

namespace ctpm {
namespace {

/// The most memory that the program ever held [MiB].
double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;
}

/// Filling with depth, layers and the binding of the surface. Arguments: triangles, spheres.
void fill(benchmark::State& state) {
  const importers::CheckedMesh mesh = bench::checked_ring_of(state.range(0));
  const importers::FillOptions options = bench::options_for(state.range(1));
  std::int64_t spheres = 0;
  for (auto _ : state) {
    const Result<importers::Filling> filling = importers::fill_organ(mesh, options);
    if (!filling) return state.SkipWithError(zoo::text_of(filling.errors()).c_str());
    spheres = filling->report.spheres;
  }
  state.counters["spheres"] = double(spheres);
  state.counters["triangles"] = double(mesh.triangle.size());
  state.counters["us_per_sphere_and_triangle"] =
      benchmark::Counter(1e-6 * double(spheres + std::int64_t(mesh.triangle.size())),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["peak_MiB"] = peak_mib();
}
BENCHMARK(fill)
    ->Args({25'000, 12'500})
    ->Args({50'000, 25'000})
    ->Args({100'000, 50'000})
    ->Args({200'000, 100'000})
    ->Args({400'000, 200'000})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

/// Unwelded, a third of it turned round, with holes, repeats, a second part and places that pass through
/// themselves.
importers::RawMesh dirty_ring(std::int64_t triangles) {
  importers::RawMesh mesh = bench::ring_of(triangles);
  const std::size_t count = mesh.triangle.size();
  for (std::size_t n = 0; n < 20; ++n)
    mesh.vertex[n * (mesh.vertex.size() / 20)] = 0.9 * mesh.vertex[n * (mesh.vertex.size() / 20)];
  for (std::size_t n = 0; n < 100; ++n) mesh.triangle.push_back(mesh.triangle[n * (count / 100)]);
  mesh = zoo::flipped(mesh, 3);
  std::erase_if(mesh.triangle, [n = 0](const importers::Triangle&) mutable { return ++n % 5'000 == 0; });
  return zoo::both(zoo::unwelded(mesh), zoo::sphere(0.005, 4, {0.2, 0, 0}));
}

void repair(benchmark::State& state) {
  const importers::RawMesh mesh = dirty_ring(state.range(0));
  for (auto _ : state) {
    const Result<importers::CheckedMesh> checked = importers::repair_mesh(mesh, 1);
    if (!checked) return state.SkipWithError(zoo::text_of(checked.errors()).c_str());
    state.SetLabel(zoo::summary(checked->findings));
  }
  state.counters["peak_MiB"] = peak_mib();
}
BENCHMARK(repair)->Arg(25'000)->Arg(100'000)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void coarsen_to_tenth(benchmark::State& state) {
  const importers::CheckedMesh mesh = bench::checked_ring_of(state.range(0));
  importers::FillOptions options = bench::options_for(2'000);
  options.most_triangles = state.range(0) / 10;
  for (auto _ : state) benchmark::DoNotOptimize(importers::fill_organ(mesh, options));
}
BENCHMARK(coarsen_to_tenth)->Arg(200'000)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
}  // namespace ctpm
