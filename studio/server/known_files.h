#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace ctpm::server {

/// Files of the folder as they were when this run wrote them for its pages, or looked at them. One that anybody has
/// changed since is no longer among them. Any thread may ask.
class KnownFiles {
 public:
  /// What changes when a file is written to.
  struct Stamp {
    std::filesystem::file_time_type modified;
    std::uintmax_t bytes;
    bool operator==(const Stamp&) const = default;
  };
  /// Nothing: it is no file, or a link to one.
  static std::optional<Stamp> stamp_of(const std::string& path);

  /// Remembers a file that was just written. `path`: absolute, links resolved.
  void add(const std::string& path);
  /// Remembers a file as it was when it got that stamp.
  void add(const std::string& path, const Stamp& stamp);
  bool holds(const std::string& path) const;
  /// Removes it from the disk. False: it is not among them, and stays.
  bool remove(const std::string& path);

 private:
  bool is_as_it_was(const std::string& path) const;

  mutable std::mutex mutex_;
  std::map<std::string, Stamp> files_;
};

}  // namespace ctpm::server
