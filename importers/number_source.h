#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "importers/volume_mesh.h"

namespace ctpm::importers {

/// Takes lines, words and numbers from the front of a text whose numbers are words or binary. Throws BrokenMesh where
/// the text ends before they do.
class NumberSource {
 public:
  explicit NumberSource(std::string_view text) : rest_(text) {}

  bool is_binary = false, is_swapped = false;

  bool is_at_end() const { return rest_.empty(); }
  std::size_t size() const { return rest_.size(); }

  /// Up to the next line break, which is taken as well.
  std::string_view line() {
    if (rest_.empty()) throw BrokenMesh{"ends in the middle", "it may not have been copied whole"};
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view found = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (found.ends_with('\r')) found.remove_suffix(1);
    return found;
  }

  /// The next word; empty at the end.
  std::string_view word() {
    skip_space();
    const std::size_t end = std::min(rest_.find_first_of(kSpace), rest_.size());
    const std::string_view found = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return found;
  }

  /// A number: a word, or binary of type T.
  template <class T>
  T get() {
    return is_binary ? raw<T>() : parsed<T>(word());
  }

  template <class T>
  T raw() {
    std::string_view bytes = take(sizeof(T));
    char copy[sizeof(T)];
    std::memcpy(copy, bytes.data(), sizeof(T));
    if (is_swapped) std::reverse(copy, copy + sizeof(T));
    T value;
    std::memcpy(&value, copy, sizeof(T));
    return value;
  }

  template <class T>
  static T parsed(std::string_view word) {
    T value{};
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto [end, trouble] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (trouble != std::errc() || end != word.data() + word.size())
      throw BrokenMesh{
          word.empty() ? "ends in the middle" : "has '" + std::string(word.substr(0, 40)) + "' where a number belongs",
          "the file may be damaged"};
    return value;
  }

  std::string_view take(std::size_t bytes) {
    if (bytes > rest_.size()) throw BrokenMesh{"ends in the middle", "it may not have been copied whole"};
    const std::string_view found = rest_.substr(0, bytes);
    rest_.remove_prefix(bytes);
    return found;
  }

  void skip_space() { rest_.remove_prefix(std::min(rest_.find_first_not_of(kSpace), rest_.size())); }

  /// A count of things that each take a byte at least.
  template <class T>
  std::size_t count() {
    const T value = get<T>();
    if (value < T{} || std::uint64_t(value) > rest_.size())
      throw BrokenMesh{"promises more than it holds: " + std::to_string(value) + " of something",
                       "the file may be damaged"};
    return std::size_t(value);
  }

 private:
  static constexpr std::string_view kSpace = " \t\r\n";
  std::string_view rest_;
};

}  // namespace ctpm::importers
