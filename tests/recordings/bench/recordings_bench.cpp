// Cost of recording per tick, file size and opening time. Block of 10 x 10 x 10 spheres, pressed and cut.

#include <benchmark/benchmark.h>

#include <chrono>
#include <filesystem>

#include "core/model/nearest_rank.h"
#include "recordings/replay.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;

constexpr std::int64_t ticks_per_minute = 60'000;
constexpr std::int64_t session_ticks = 20'000;  // length of the simulated session

const recordings::SessionStart& block_start() {
  static const recordings::SessionStart start = small_start(10, 10, 10);
  return start;
}

/// 20 s of session, simulated once.
const Lived& lived_block() {
  static const Lived lived = live(block_start(), session_ticks, [](const State&, const recordings::TickRecord&) {});
  return lived;
}

void StateHash1000Spheres(benchmark::State& state) {
  const State& last = lived_block().last;
  for (auto _ : state) benchmark::DoNotOptimize(recordings::state_hash(last));
}
BENCHMARK(StateHash1000Spheres)->Unit(benchmark::kMicrosecond);

/// append() alone, at the rate of real ticks, so that the writing thread runs beside it as in use.
void Append1000Spheres(benchmark::State& state) {
  const Folder folder;
  const Lived& lived = lived_block();
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", block_start());
  std::size_t tick = 0;
  for (auto _ : state) {
    std::this_thread::sleep_for(std::chrono::microseconds(300));
    const auto begin = std::chrono::steady_clock::now();
    writer->append(lived.last, lived.records[tick++ % lived.records.size()]);
    state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  if (!writer->finish()) state.SkipWithError("not recorded");
}
BENCHMARK(Append1000Spheres)->UseManualTime()->Iterations(5000)->Unit(benchmark::kMicrosecond);

/// A live tick with and without recording. The counters are the medians and the share of recording in the tick.
void TickWithRecording1000Spheres(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  const recordings::SessionStart& start = block_start();
  const Folder folder;
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start);
  std::vector<double> step_us, record_us;
  State now = start.initial_state;
  stepping::Stepper stepper(start.model);
  std::int64_t tick = 0;
  for (auto _ : state) {
    const Inputs inputs = scripted_inputs(tick++, start.model.rest_position.z.back());
    const auto t0 = Clock::now();
    const stepping::StepReport report = stepper.step(now, inputs);
    const auto t1 = Clock::now();
    writer->append(now, recordings::make_record(inputs, report, 1e-3, recordings::state_hash(now)));
    const auto t2 = Clock::now();
    step_us.push_back(std::chrono::duration<double, std::micro>(t1 - t0).count());
    record_us.push_back(std::chrono::duration<double, std::micro>(t2 - t1).count());
  }
  if (!writer->finish()) state.SkipWithError("not recorded");
  state.counters["step_p50_us"] = percentile(step_us, 0.5);
  state.counters["record_p50_us"] = percentile(record_us, 0.5);
  state.counters["record_p999_us"] = percentile(record_us, 0.999);
  state.counters["record_percent_of_tick_p50"] = 100 * percentile(record_us, 0.5) / percentile(step_us, 0.5);
}
BENCHMARK(TickWithRecording1000Spheres)->Iterations(5000)->Unit(benchmark::kMicrosecond);

/// Size of a session in which every tick differs, with its keyframes.
void FileSize1000Spheres(benchmark::State& state) {
  const Folder folder;
  const recordings::SessionStart& start = block_start();
  recordings::WriterOptions options;
  options.wait_when_full = true;
  for (auto _ : state) {
    auto empty = recordings::SessionWriter::create(folder / "empty.ctpm", start, options);
    if (!empty || !empty->finish()) return state.SkipWithError("not recorded");
    auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, options);
    auto bare = recordings::SessionWriter::create(folder / "bare.ctpm", start,
                                                  {.wait_when_full = true, .keyframe_ticks = 1 << 30});
    live(start, session_ticks, [&](const State& after, const recordings::TickRecord& record) {
      writer->append(after, record);
      bare->append(after, record);
    });
    if (!writer->finish() || !bare->finish()) return state.SkipWithError("not recorded");
  }
  const auto size = [&](const char* name) {
    return static_cast<double>(std::filesystem::file_size(folder / name)) / 1e6;
  };
  const double minutes = static_cast<double>(session_ticks) / ticks_per_minute;
  state.counters["start_mb"] = size("empty.ctpm");
  state.counters["mb_per_minute"] = (size("a.ctpm") - size("empty.ctpm")) / minutes;
  state.counters["mb_per_minute_without_keyframes"] = (size("bare.ctpm") - size("empty.ctpm")) / minutes;
}
BENCHMARK(FileSize1000Spheres)->Iterations(1)->Unit(benchmark::kSecond);

/// An hour at 1 kHz: repeats the records of the simulated session.
const std::string& one_hour() {
  static const Folder folder;
  static const std::string path = [] {
    const std::string name = folder / "hour.ctpm";
    auto writer =
        recordings::SessionWriter::create(name, block_start(), {.wait_when_full = true, .queue_ticks = 1 << 18});
    const Lived& lived = lived_block();
    for (std::int64_t tick = 0; tick < 60 * ticks_per_minute; ++tick)
      writer->append(lived.last, lived.records[static_cast<std::size_t>(tick) % lived.records.size()]);
    CTPM_CHECK(bool(writer->finish()), "an hour can be recorded");
    return name;
  }();
  return path;
}

void OpenOneHour(benchmark::State& state) {
  const std::string& path = one_hour();
  for (auto _ : state) {
    auto reader = recordings::SessionReader::open(path);
    if (!reader || reader->tick_count() != 60 * ticks_per_minute) return state.SkipWithError("not opened");
  }
  state.counters["file_mb"] = static_cast<double>(std::filesystem::file_size(path)) / 1e6;
}
BENCHMARK(OpenOneHour)->Unit(benchmark::kMillisecond);

void ReadOneMinuteInTheMiddleOfAnHour(benchmark::State& state) {
  auto reader = recordings::SessionReader::open(one_hour());
  for (auto _ : state) benchmark::DoNotOptimize(reader->ticks(30 * ticks_per_minute, 31 * ticks_per_minute));
}
BENCHMARK(ReadOneMinuteInTheMiddleOfAnHour)->Unit(benchmark::kMillisecond);

/// Seeks in ten minutes of a block with as many spheres as the shipped liver, to the worst ticks, just before a
/// keyframe. The session repeats 20 s of simulation with its keyframes, so each seek reads and simulates as much as in
/// a fully simulated session.
void SeekInTenMinutes(benchmark::State& state) {
  const Folder folder;
  const recordings::SessionStart start = small_start(9, 9, 9);
  const recordings::WriterOptions options{.wait_when_full = true, .keyframe_ticks = 1000};
  std::vector<State> keyframes;
  const Lived lived = live(start, session_ticks, [&](const State& after, const recordings::TickRecord&) {
    if (after.tick % options.keyframe_ticks == 0) keyframes.push_back(after);
  });
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, options);
  for (std::int64_t tick = 0; tick < 10 * ticks_per_minute; ++tick) {
    const std::int64_t lived_tick = tick % session_ticks;
    writer->append(keyframes[static_cast<std::size_t>(lived_tick / options.keyframe_ticks)],
                   lived.records[static_cast<std::size_t>(lived_tick)]);
  }
  if (!writer->finish()) return state.SkipWithError("not recorded");
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  auto cursor = recordings::ReplayCursor::create(*reader);
  std::int64_t keyframe = 0;
  double longest = 0;
  for (auto _ : state) {
    // Far from the last target, so that the cursor's position does not help.
    keyframe = (keyframe + 131) % (reader->tick_count() / options.keyframe_ticks);
    const auto begin = std::chrono::steady_clock::now();
    if (!cursor->seek((keyframe + 1) * options.keyframe_ticks - 1)) return state.SkipWithError("not found");
    longest = std::max(longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  state.counters["longest_s"] = longest;
}
BENCHMARK(SeekInTenMinutes)->Iterations(20)->Unit(benchmark::kMillisecond);

/// Verification time compared with the duration of the session.
void VerifySession(benchmark::State& state) {
  const Folder folder;
  const recordings::SessionStart& start = block_start();
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true});
  live(start, 5000, [&](const State& after, const recordings::TickRecord& record) { writer->append(after, record); });
  if (!writer->finish()) return state.SkipWithError("not recorded");
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  double seconds = 0;
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    const auto verdict = recordings::verify_session(*reader);
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!verdict || !verdict->same) return state.SkipWithError("differs");
  }
  state.counters["times_real_time"] = 5.0 / seconds;
}
BENCHMARK(VerifySession)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace ctpm

BENCHMARK_MAIN();
