#include "tests/studio/server/train_benchmark.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <random>

#include "studio/cohort/statistics.h"
#include "studio/devices/open_device.h"
#include "studio/loading/loaded_scene.h"
#include "studio/server/page_hand.h"
#include "studio/session/record_session.h"
#include "studio/session/unkept_session.h"
#include "studio/session/urgency.h"
#include "tests/studio/server/serving.h"

namespace ctpm {
namespace {

using Clock = std::chrono::steady_clock;
using testing::Serving;
using testing::SocketClient;

constexpr double kStop = 10;  // of a page that stops reading, at most [s]

struct Variant {
  const char* name;
  int pages;       ///< that are connected; 0: there is no studio
  bool one_stops;  ///< reading for kStop
};
constexpr std::array kVariants{Variant{"no studio", 0, false}, Variant{"the page that leads", 1, false},
                               Variant{"four pages", 4, false}, Variant{"four, one stops reading", 4, true}};
constexpr std::size_t kBase = 1;     ///< poses come from a page
constexpr std::size_t kWithout = 0;  ///< late ticks may not rise against it
constexpr double kMostRise = 1.05;

/// What a run measured.
enum Measure {
  late_share,
  late_by_us,
  no_processor,
  tick_p50,
  tick_p99,
  wait_p50,
  wait_p99,
  way_p99,
  within,
  kMeasures
};
constexpr std::array kNames{"late ticks, % of all",
                            "late ticks but the machine's, % of all",
                            "without a processor, us a tick",
                            "tick p50, ms",
                            "tick p99, ms",
                            "pose to tick p50, ms",
                            "pose to tick p99, ms",
                            "of it until read p99, ms",
                            "poses within 5 ms, %"};
using Run = std::array<double, kMeasures>;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Moves a hand for so many seconds above the box of the scene's organs and down into them.
void lead(const Vec3& top, double seconds, const std::function<void(Vec3, double)>& move) {
  const Clock::time_point begin = Clock::now();
  for (int i = 0; seconds_since(begin) < seconds; ++i) {
    move(top + Vec3{0, 0, 0.03 - 0.02 * (1 - std::cos(0.01 * i))}, 1 + seconds_since(begin));
    std::this_thread::sleep_until(begin + std::chrono::milliseconds(8 * (i + 1)));
  }
}

/// The same hand, without server, pages and pictures.
std::optional<Run> run_alone(const recordings::SessionStart& start, const Vec3& top, double seconds) {
  devices::DeviceRequest request;
  request.buttons = {"0=" + start.model.tools[0].name};
  request.timeout_s = 1e5;
  auto made = std::make_unique<server::PageHand>();
  server::PageHand& hand = *made;
  auto followed = devices::follow_device(request, std::move(made), start.model);
  if (!followed) return std::nullopt;
  std::atomic<bool> ends{false};
  std::optional<Run> run;
  std::thread ticks([&] {
    session::become(session::Urgency::tick);  // as a training does
    const auto should_stop = [&] { return ends.load(); };
    if (!followed->source->wait_for_first_pose(should_stop)) return;
    session::RunOptions options;
    options.threads = session::threads_for(start.model), options.should_stop = should_stop;
    const session::UnkeptSession unkept;
    const auto outcome = session::record_session(start, *followed->source, unkept.file(), false, options);
    if (!outcome) return;
    const recordings::SessionStatistics& s = outcome->statistics;
    const std::int64_t by_us = outcome->run.late_ticks - outcome->run.late_by.of(recordings::LateCause::machine);
    run = Run{1e2 * double(outcome->run.late_ticks) / double(outcome->run.ticks),
              1e2 * double(by_us) / double(outcome->run.ticks), 1e6 * outcome->run.waited / double(outcome->run.ticks),
              1e3 * s.tick_time_p50, 1e3 * s.tick_time_p99};
    for (const auto& [name, value] : s.values) {
      if (name == "device_pose_wait_p50_s") (*run)[wait_p50] = 1e3 * value;
      if (name == "device_pose_wait_p99_s") (*run)[wait_p99] = 1e3 * value;
      if (name == "device_pose_way_p99_s") (*run)[way_p99] = 1e3 * value;
      if (name == "device_poses_within_5ms") (*run)[within] = 1e2 * value;
    }
  });
  lead(top, seconds, [&](Vec3 at, double time) { hand.move({{at, Quat{1, 0, 0, 0}}, 1}, time); });
  ends = true;
  ticks.join();
  return run;
}

/// A page that asks 60 times a second and reads the answers, from `stop` seconds on.
void ask(const Serving& serving, double stop, const std::atomic<bool>& ends) {
  SocketClient page(serving);
  const Clock::time_point begin = Clock::now();
  int waiting = 0;
  while (!ends) {
    page.send({{"id", 1}, {"call", "folder.list"}, {"params", nlohmann::json::object()}});
    for (++waiting; waiting > 0 && seconds_since(begin) >= stop; --waiting) page.receive();
    std::this_thread::sleep_for(std::chrono::milliseconds(16));
  }
}

/// What the event at the end of a training says; none if it does not come.
std::optional<Run> ended(SocketClient& page) try {
  for (;;) {
    const auto message = page.receive();
    if (!message.is_text || message.bytes.find("train_ended") == std::string::npos) continue;
    const nlohmann::json end = nlohmann::json::parse(message.bytes)["content"];
    const double late = end["late_ticks"], by_machine = end["late_by"].value("machine", 0.0);
    return Run{1e2 * late / double(end["ticks"]),
               1e2 * (late - by_machine) / double(end["ticks"]),
               1e6 * double(end["waited_for_processor_s"]) / double(end["ticks"]),
               1e3 * double(end["tick_time_p50_s"]),
               1e3 * double(end["tick_time_p99_s"]),
               1e3 * double(end["pose_wait_p50_s"]),
               1e3 * double(end["pose_wait_p99_s"]),
               1e3 * double(end["pose_way_p99_s"]),
               1e2 * double(end["poses_within_5ms"])};
  }
} catch (const std::exception&) {
  return std::nullopt;
}

std::optional<Run> run_beside(const Serving& serving, const std::string& scene, const Variant& variant, const Vec3& top,
                              double seconds) {
  SocketClient client(serving);
  if (!client.call("train.begin", {{"scene", scene}, {"stage", 2}}).contains("result")) return std::nullopt;
  std::atomic<bool> ends{false};
  std::vector<std::thread> others;
  for (int i = 1; i < variant.pages; ++i)
    others.emplace_back([&, i] { ask(serving, i == 1 && variant.one_stops ? kStop : 0, ends); });
  std::optional<Run> run;
  std::thread reader([&] { run = ended(client); });
  lead(top, seconds, [&](Vec3 at, double time) {
    client.send(
        {{"hand",
          {{"position", {at.x, at.y, at.z}}, {"orientation", {1, 0, 0, 0}}, {"buttons", 1}, {"time_s", time}}}});
  });
  client.send({{"id", 9}, {"call", "train.end"}, {"params", nlohmann::json::object()}});
  reader.join();
  ends = true;
  for (std::thread& other : others) other.join();
  return run;
}

struct Interval {
  double median = 0, low = 0, high = 0;
};

/// The median and the ranks between which it lies with 95 % whatever the distribution is: one bad run moves the mean of
/// late ticks more than all others together.
Interval median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t count = values.size();
  double tail = std::pow(0.5, double(count)), term = tail;  // of a binomial distribution, up to rank `out`
  std::size_t out = 0;                                      // values on either side that are outside
  while (2 * (out + 1) < count) {
    term *= double(count - out) / double(out + 1);
    if (tail + term > 0.025) break;
    tail += term, ++out;
  }
  return {0.5 * (values[(count - 1) / 2] + values[count / 2]), values[out], values[count - 1 - out]};
}

void print(const std::array<std::vector<Run>, kVariants.size()>& runs) {
  for (int m = 0; m < kMeasures; ++m) {
    std::printf("%s\n", kNames[std::size_t(m)]);
    double base = 0;
    for (const Run& run : runs[kBase]) base += run[std::size_t(m)] / double(runs[kBase].size());
    for (std::size_t v = 0; v < kVariants.size(); ++v) {
      std::vector<double> differences;
      double mean = 0;
      for (std::size_t i = 0; i < runs[v].size(); ++i) {
        differences.push_back(runs[v][i][std::size_t(m)] - runs[kBase][i][std::size_t(m)]);
        mean += runs[v][i][std::size_t(m)] / double(runs[v].size());
      }
      const Interval usual = median_of(differences);
      const auto interval = cohort::interval_of_mean(differences, {});
      std::printf("  %-28s mean %.4f, %+.4f [%+.4f, %+.4f]; median of differences %+.4f [%+.4f, %+.4f]\n",
                  kVariants[v].name, mean, mean - base, interval->low, interval->high, usual.median, usual.low,
                  usual.high);
    }
  }
}

/// How many times as many late ticks, by a measure of them, there are with pages as without any, in all rounds
/// together, and between which values that lies with 95 %: of rounds that are drawn again and again.
void print_rise(const std::array<std::vector<Run>, kVariants.size()>& runs, Measure late) {
  constexpr int kDraws = 4000;
  const std::size_t rounds = runs[kWithout].size();
  std::mt19937 random(1);
  std::printf("%s, times as many as without a studio; goal: %.2f at most\n", kNames[late], kMostRise);
  for (std::size_t v = 1; v < kVariants.size(); ++v) {
    const auto rise_of = [&](const std::function<std::size_t(std::size_t)>& round) {
      double with = 0, without = 0;
      for (std::size_t i = 0; i < rounds; ++i)
        with += runs[v][round(i)][late], without += runs[kWithout][round(i)][late];
      return without > 0 ? with / without : with > 0 ? INFINITY : 1;
    };
    const double rise = rise_of([](std::size_t i) { return i; });
    std::vector<double> drawn(kDraws);
    for (double& one : drawn) {
      std::vector<std::size_t> chosen(rounds);
      for (std::size_t& round : chosen) round = random() % rounds;
      one = rise_of([&](std::size_t i) { return chosen[i]; });
    }
    std::sort(drawn.begin(), drawn.end());
    const double low = drawn[kDraws / 40], high = drawn[kDraws - 1 - kDraws / 40];
    std::printf("  %-28s %.2f [%.2f, %.2f]: %s\n", kVariants[v].name, rise, low, high,
                high <= kMostRise   ? "met"
                : low > kMostRise   ? "missed"
                : rise <= kMostRise ? "met, but so few late ticks do not tell it surely"
                                    : "missed, but so few late ticks do not tell it surely");
  }
}

}  // namespace

int benchmark_training(const std::string& folder, const std::string& scene, int rounds, double seconds) {
  const auto loaded = loading::load_whole_scene(folder + "/" + scene, {}, {});
  if (!loaded || rounds < 2) return std::fprintf(stderr, "no such scene, or fewer than 2 rounds\n"), 2;
  const recordings::SessionStart start = session::start_session(*loaded);
  Vec3 least{INFINITY, INFINITY, INFINITY}, most = -1.0 * least;
  for (std::size_t i = 0; i < start.initial_state.position.size(); ++i) {
    const Vec3 at = start.initial_state.position[i];
    least = {std::min(least.x, at.x), std::min(least.y, at.y), std::min(least.z, at.z)};
    most = {std::max(most.x, at.x), std::max(most.y, at.y), std::max(most.z, at.z)};
  }
  const Vec3 top{0.5 * (least.x + most.x), 0.5 * (least.y + most.y), most.z};
  const Serving serving(folder);
  std::array<std::vector<Run>, kVariants.size()> runs;
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < kVariants.size(); ++i) {
      const std::size_t v = (i + std::size_t(round)) % kVariants.size();
      const auto run = kVariants[v].pages == 0 ? run_alone(start, top, seconds)
                                               : run_beside(serving, scene, kVariants[v], top, seconds);
      if (!run) return std::fprintf(stderr, "%s: the training did not end as it should\n", kVariants[v].name), 2;
      runs[v].push_back(*run);
    }
  std::printf("%s, %d rounds of %.0f s each\n", scene.c_str(), rounds, seconds);
  print(runs);
  // What the machine takes comes in bursts, with pages and without.
  for (const Measure late : {late_share, late_by_us}) print_rise(runs, late);
  return 0;
}

}  // namespace ctpm
