#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace ctpm::recordings::session_file {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

static_assert(std::endian::native == std::endian::little, "session files are written as values lie in memory");

inline void put_raw(Bytes& out, const void* data, std::size_t size) {
  const std::size_t place = out.size();
  out.resize(place + size);
  if (size > 0) std::memcpy(out.data() + place, data, size);
}

template <class T>
requires std::is_arithmetic_v<T>
void put(Bytes& out, T value) { put_raw(out, &value, sizeof value); }

inline ByteView view(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
inline std::string text_of(ByteView bytes) { return {bytes.begin(), bytes.end()}; }

/// Reads untrusted bytes. After the first read beyond the end, every read fails. `budget` bounds the memory of
/// decoding, because a small block can declare large arrays.
class ByteReader {
 public:
  explicit ByteReader(ByteView bytes, std::uint64_t budget) : bytes_(bytes), budget_(budget) {}

  bool failed() const { return failed_; }
  bool at_end() const { return position_ == bytes_.size(); }
  std::size_t left() const { return bytes_.size() - position_; }
  void fail() { failed_ = true; }

  ByteView take(std::uint64_t size) {
    if (failed_ || size > left()) {
      failed_ = true;
      return {};
    }
    const ByteView taken = bytes_.subspan(position_, size);
    position_ += size;
    return taken;
  }

  template <class T>
  T get() {
    T value{};
    const ByteView taken = take(sizeof value);
    if (!failed_) std::memcpy(&value, taken.data(), sizeof value);
    return value;
  }

  /// Takes `count` items of `width` bytes from the budget. If the budget is too small, returns false and the reader
  /// fails.
  bool spend(std::uint64_t count, std::uint64_t width) {
    if (failed_ || count > budget_ / width) {
      failed_ = true;
      return false;
    }
    budget_ -= count * width;
    return true;
  }

  std::uint64_t budget() const { return budget_; }
  /// Hands back what a reader of nested bytes left of this reader's budget.
  void set_budget(std::uint64_t left) { budget_ = left; }

 private:
  ByteView bytes_;
  std::size_t position_ = 0;
  std::uint64_t budget_;
  bool failed_ = false;
};

}  // namespace ctpm::recordings::session_file
