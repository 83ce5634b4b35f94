// Time of one picture. Run: build/release/tests/ctpm_render_benchmark
#include <benchmark/benchmark.h>

#include <optional>
#include <thread>
#include <vector>

#include "studio/film/bounded_queue.h"
#include "studio/film/pipeline.h"
#include "studio/render/cut_surface.h"
#include "studio/render/expert_cut.h"
#include "studio/render/overlay.h"
#include "studio/video/video_writer.h"
#include "tests/studio/render/scene.h"

namespace ctpm::render_test {
namespace {

/// A blob of 20,448 triangles, cut half through, with the scalpel in it.
struct Bench {
  std::unique_ptr<TestScene> scene = make_blob_scene(0.003, 72);
  std::unique_ptr<render::Renderer> renderer = std::move(*render::Renderer::create(1280, 720, scene->view));
  State rest = rest_state(scene->model), severed = rest;
  render::DrawOptions options;
  render::OverlayData data;

  Bench() {
    options.camera = render::default_camera(scene->view);
    cut(scene->model, severed, {{0, -0.1, 0}, {0, -0.1, 0.1}}, {{0, 0.02, 0}, {0, 0.02, 0.1}});
    severed.last_inputs.tool = 1, severed.last_inputs.position = {0, 0.02, 0};
    data.title = "Liver", data.model = "CTPM", data.session = "liver-press", data.verdict = "replay same as recorded";
    for (int i = 0; i < 600; ++i) data.history.push_back({i * 0.01, std::abs(std::sin(0.1 * i))});
    data.time = 6;
  }
};

void picture_with_overlay(benchmark::State& run) {
  Bench bench;
  render::Overlay overlay(1280, 720);
  const State& state = run.range(0) ? bench.severed : bench.rest;
  bench.renderer->draw(state, bench.options);  // the cut's surface is made once, as in a film
  for (auto _ : run) {
    render::Frame frame = bench.renderer->draw(state, bench.options);
    overlay.draw(frame, bench.data);
    benchmark::DoNotOptimize(frame.rgb.data());
  }
}
BENCHMARK(picture_with_overlay)
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->ArgName("cut");

/// The parts of a frame: the picture without its overlay, and the overlay.
void picture_alone(benchmark::State& run) {
  Bench bench;
  for (auto _ : run) benchmark::DoNotOptimize(bench.renderer->draw(bench.rest, bench.options).rgb.data());
}
BENCHMARK(picture_alone)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void overlay_alone(benchmark::State& run) {
  Bench bench;
  render::Overlay overlay(1280, 720);
  render::Frame frame = bench.renderer->draw(bench.rest, bench.options);
  for (auto _ : run) {
    overlay.draw(frame, bench.data);
    benchmark::DoNotOptimize(frame.rgb.data());
  }
}
BENCHMARK(overlay_alone)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// A blade goes 1 mm from State to State.
std::vector<State> growing_cut(const Bench& bench) {
  std::vector<State> growing;
  State state = bench.rest;
  for (int y = -40; y < 20; ++y) {
    const double from = 1e-3 * y, to = 1e-3 * (y + 1);
    cut(bench.scene->model, state, {{0, from, 0}, {0, from, 0.1}}, {{0, to, 0}, {0, to, 0.1}});
    growing.push_back(state);
  }
  return growing;
}

/// What another session's cut on the organ costs.
void give_expert(Bench& bench) {
  bench.options.expert =
      std::make_shared<const render::ExpertCut>(bench.scene->model, cut_along_y(bench.scene->model, 0.01, 0.02, 0));
}

void without_and_with_expert(benchmark::internal::Benchmark* picture) {
  picture->Arg(0)->Arg(1)->ArgName("expert");
  picture->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}

void picture_with_expert(benchmark::State& run) {
  Bench bench;
  if (run.range(0)) give_expert(bench);
  bench.renderer->draw(bench.severed, bench.options);
  for (auto _ : run) benchmark::DoNotOptimize(bench.renderer->draw(bench.severed, bench.options).rgb.data());
}
BENCHMARK(picture_with_expert)->Apply(without_and_with_expert);

/// The split and the wall follow the blade from picture to picture.
void picture_while_cutting(benchmark::State& run) {
  Bench bench;
  if (run.range(0)) give_expert(bench);
  const std::vector<State> growing = growing_cut(bench);
  std::size_t next = growing.size();
  for (auto _ : run) {
    if (next == growing.size()) {
      run.PauseTiming();
      bench.renderer->draw(growing.front(), bench.options), next = 1;
      run.ResumeTiming();
    }
    benchmark::DoNotOptimize(bench.renderer->draw(growing[next++], bench.options).rgb.data());
  }
}
BENCHMARK(picture_while_cutting)->Apply(without_and_with_expert);

/// The same in a film, where the thread that replays the session makes the cut's surface of the next pictures.
void picture_of_a_film_while_cutting(benchmark::State& run) {
  Bench bench;
  render::Overlay overlay(1280, 720);
  const std::vector<State> growing = growing_cut(bench);
  for (auto _ : run) {
    run.PauseTiming();
    bench.renderer->draw(growing.front(), bench.options);
    film::BoundedQueue<const State*> followed(film::kFilmQueue);
    run.ResumeTiming();
    std::thread replay([&] {
      for (std::size_t i = 1; i < growing.size(); ++i) {
        for (render::CutSurface& cut : *bench.renderer->scene().cuts) cut.follow_ahead(growing[i]);
        followed.push(&growing[i]);
      }
      followed.close();
    });
    while (const std::optional<const State*> state = followed.pop()) {
      render::Frame frame = bench.renderer->draw(**state, bench.options);
      overlay.draw(frame, bench.data);
      benchmark::DoNotOptimize(frame.rgb.data());
    }
    replay.join();
  }
  run.counters["pictures"] = double(growing.size() - 1);
  run.counters["ms_a_picture"] = benchmark::Counter(
      1e-3 * double(growing.size() - 1), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(picture_of_a_film_while_cutting)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void encoded_frame(benchmark::State& run) {
  Bench bench;
  const render::Frame frame = bench.renderer->draw(bench.rest, bench.options);
  auto writer = video::VideoWriter::create("/tmp/ctpm_render_benchmark.mp4", 1280, 720, 30);
  for (auto _ : run)
    if (!(*writer)->add(frame)) run.SkipWithError("a frame could not be written");
}
BENCHMARK(encoded_frame)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace ctpm::render_test

BENCHMARK_MAIN();
