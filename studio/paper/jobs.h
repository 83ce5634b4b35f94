#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <future>
#include <optional>
#include <utility>
#include <vector>

#include "core/model/errors.h"
#include "core/model/result.h"

namespace ctpm::paper {

/// Results of job(0) to job(count - 1), which two threads run in that order. Errors: those of all jobs.
template <class T>
Result<std::vector<T>> run_jobs(std::size_t count, const std::function<Result<T>(std::size_t)>& job) {
  std::vector<std::optional<Result<T>>> done(count);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) done[i].emplace(job(i));
  };
  std::future<void> other = std::async(std::launch::async, work);
  work(), other.get();
  std::vector<T> values;
  Errors errors;
  for (std::optional<Result<T>>& result : done) {
    if (*result)
      values.push_back(std::move(**result));
    else
      append(errors, *result);
  }
  if (!errors.empty()) return errors;
  return values;
}

}  // namespace ctpm::paper
