// Measures the studio's server as a page sees it, without a browser:
//   ctpm_studio_benchmark review FOLDER SESSION [WAIT_S]    opening, and seeks all over the session, at once and later
//   ctpm_studio_benchmark train FOLDER SCENE [ROUNDS [SECONDS]]   what pages cost the thread that ticks:
//   train_benchmark.h

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "tests/studio/server/serving.h"
#include "tests/studio/server/train_benchmark.h"

namespace ctpm {
namespace {

using Clock = std::chrono::steady_clock;
using testing::Serving;
using testing::SocketClient;
using testing::value_at;

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void print_times(const char* what, std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const auto rank = [&](double share) { return times[std::size_t(std::ceil(share * double(times.size()))) - 1]; };
  std::printf("%-48s p50 %.1f ms, p95 %.1f ms, max %.1f ms (%zu)\n", what, rank(0.5), rank(0.95), times.back(),
              times.size());
}

/// Times from requests to what was shown for them, at places all over a session.
struct SeekTimes {
  std::vector<double> first, replayed;  ///< until the first picture, glimpse or not; until the replayed one [ms]
};

/// Seeks in the first `stages` stages at once, which show the same session; a time is that of the last of them.
SeekTimes seek(SocketClient& client, int stages, std::int64_t ticks, int count, unsigned seed) {
  std::mt19937 random(seed);
  SeekTimes times;
  for (int i = 0; i < count; ++i) {
    const std::uint32_t request = seed * 100000 + std::uint32_t(i) + 1;
    const std::uint64_t tick = random() % std::uint64_t(ticks);
    const Clock::time_point begin = Clock::now();
    for (int stage = 0; stage < stages; ++stage)
      client.send({{"show", {{"stage", stage}, {"tick", tick}, {"request", request}}}});
    std::vector<double> first(std::size_t(stages), NAN), last = first;
    while (std::any_of(last.begin(), last.end(), [](double t) { return std::isnan(t); })) {
      const std::string frame = client.any_frame();
      const std::size_t stage = value_at<std::uint32_t>(frame, 4);
      if (value_at<std::uint32_t>(frame, 16) != request) continue;
      if (std::isnan(first[stage])) first[stage] = ms_since(begin);
      if (!SocketClient::is_glimpse(frame)) last[stage] = ms_since(begin);
    }
    times.first.push_back(*std::max_element(first.begin(), first.end()));
    times.replayed.push_back(*std::max_element(last.begin(), last.end()));
  }
  return times;
}

void print_seeks(const std::string& when, const SeekTimes& times) {
  print_times((when + ", first picture").c_str(), times.first);
  print_times((when + ", replayed").c_str(), times.replayed);
}

int review(const std::string& folder, const std::string& session, double wait_s) {
  const Serving serving(folder);
  SocketClient client(serving);
  Clock::time_point begin = Clock::now();
  const nlohmann::json opened = client.call("session.open", {{"path", session}, {"stage", 0}});
  if (!opened.contains("result")) return std::printf("%s\n", opened.dump().c_str()), 2;
  const std::int64_t ticks = opened["result"]["info"]["ticks"];
  client.send({{"show", {{"stage", 0}, {"tick", 0}, {"request", 1}}}});
  client.frame();
  std::printf("%s: %.1f s, %lld spheres\n", session.c_str(), opened["result"]["info"]["duration_s"].get<double>(),
              (long long)opened["result"]["info"]["spheres"]);
  std::printf("%-48s %.0f ms\n", "opened, first picture after", ms_since(begin));
  begin = Clock::now();
  client.call("session.timeline", {{"path", session}, {"points", 3000}});
  std::printf("%-48s %.0f ms\n", "timeline after", ms_since(begin));
  print_seeks("seeks, just opened", seek(client, 1, ticks, 60, 1));
  client.call("session.open", {{"path", session}, {"stage", 1}});
  print_seeks("seeks in two sessions beside each other", seek(client, 2, ticks, 60, 2));
  std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
  const std::string later = ", " + std::to_string(int(wait_s)) + " s later";
  print_seeks("seeks" + later, seek(client, 1, ticks, 60, 3));
  print_seeks("seeks in both" + later, seek(client, 2, ticks, 60, 4));
  return 0;
}

}  // namespace
}  // namespace ctpm

int main(int argc, char** argv) {
  if (argc >= 4 && argc <= 5 && std::string(argv[1]) == "review")
    return ctpm::review(argv[2], argv[3], argc == 5 ? std::atof(argv[4]) : 20);
  if (argc >= 4 && argc <= 6 && std::string(argv[1]) == "train")
    return ctpm::benchmark_training(argv[2], argv[3], argc >= 5 ? std::atoi(argv[4]) : 20,
                                    argc == 6 ? std::atof(argv[5]) : 12);
  std::fprintf(stderr,
               "usage: ctpm_studio_benchmark review FOLDER SESSION [WAIT_S] | train FOLDER SCENE [ROUNDS [SECONDS]]\n");
  return 2;
}
