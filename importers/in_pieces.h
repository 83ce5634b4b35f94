#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <vector>

namespace ctpm::importers {

/// Calls `work(begin, end)` for ranges of 0 .. count on several threads. The ranges do not depend on the number of
/// threads.
template <class Work>
void in_pieces(std::size_t count, int threads, const Work& work) {
  constexpr std::size_t kPiece = 2048;
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t begin; (begin = next.fetch_add(kPiece)) < count;) work(begin, std::min(begin + kPiece, count));
  };
  std::vector<std::future<void>> others;
  for (int t = 1; t < threads && std::size_t(t) * kPiece < count; ++t)
    others.push_back(std::async(std::launch::async, run));
  run();
  for (auto& other : others) other.get();
}

}  // namespace ctpm::importers
