#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace ctpm::server {

/// Files of the folder that this run has written for its pages, as they were then. One that anybody has changed since
/// is no longer among them. Any thread may ask.
class OwnFiles {
 public:
  /// Remembers a file that was just written. `path`: absolute, links resolved.
  void add(const std::string& path);
  bool holds(const std::string& path) const;
  /// Removes it from the disk. False: it is not among them, and stays.
  bool remove(const std::string& path);

 private:
  struct Stamp {
    std::filesystem::file_time_type modified;
    std::uintmax_t bytes;
    bool operator==(const Stamp&) const = default;
  };
  static std::optional<Stamp> stamp_of(const std::string& path);
  bool is_as_written(const std::string& path) const;

  mutable std::mutex mutex_;
  std::map<std::string, Stamp> files_;
};

}  // namespace ctpm::server
