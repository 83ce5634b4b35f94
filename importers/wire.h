#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace ctpm::importers::wire {

/// Message of the reading child: a kind, then its content. `failed`: a text. `refused`: a message and a hint.
/// `no_such_part`: the parts. `mesh`: the parts, the unit [m], the vertices as x y z doubles, the triangles as three
/// int32, the part of each triangle as int32, and the parts' colours as three doubles, NaN for none. A uint64 count
/// precedes each list.
enum class Kind : std::uint32_t { failed = 1, no_such_part = 2, mesh = 3, refused = 4 };

/// Appends plain values to a message.
class Writer {
 public:
  template <class T>
  void put(const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put_text(std::string_view text) {
    put<std::uint64_t>(text.size());
    bytes.append(text);
  }
  template <class T>
  void put_list(const std::vector<T>& list) {
    put<std::uint64_t>(list.size());
    bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T));
  }
  std::string bytes;
};

/// Reads values from a message that may be truncated or wrong. Each get returns false if bytes are missing.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  bool get(T& value) {
    if (rest_.size() < sizeof value) return false;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return true;
  }
  bool get_text(std::string& text) {
    std::uint64_t count = 0;
    if (!get(count) || count > rest_.size()) return false;
    text.assign(rest_.data(), count);
    rest_.remove_prefix(count);
    return true;
  }
  template <class T>
  bool get_list(std::vector<T>& list) {
    std::uint64_t count = 0;
    if (!get(count) || count > rest_.size() / sizeof(T)) return false;
    list.resize(count);
    if (count > 0) std::memcpy(list.data(), rest_.data(), count * sizeof(T));
    rest_.remove_prefix(count * sizeof(T));
    return true;
  }
  bool is_at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

}  // namespace ctpm::importers::wire
