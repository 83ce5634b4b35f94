#pragma once

#include <cstdint>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "studio/server/known_files.h"

namespace ctpm::server {

/// The newest answers of calls that depend on nothing but files and what was asked, for as long as nobody changes those
/// files. Any thread may ask.
class KeptAnswers {
 public:
  /// Files, absolute, as they were when they were read.
  using Files = std::vector<std::pair<std::string, std::optional<KnownFiles::Stamp>>>;
  static Files now(const std::vector<std::string>& paths);

  /// The answer to that question of the files as they are; nothing: it is not known.
  std::optional<std::string> find(const std::string& question, const Files& files);
  /// Keeps one. `files`: as they were before the answer was begun.
  void keep(const std::string& question, const Files& files, const std::string& answer);

 private:
  static constexpr std::size_t kMost = 16;
  struct Kept {
    std::string question;
    Files files;
    std::string answer;
  };

  std::mutex mutex_;
  std::list<Kept> kept_;  ///< the one that was asked for last comes first
};

}  // namespace ctpm::server
