#include "recordings/internal/array_codec.h"

#include <algorithm>
#include <array>

namespace ctpm::recordings::session_file {
namespace {

constexpr int order_count = 3;

/// Predictor of a value: 0, the previous value, or linear extrapolation of the previous two.
template <class U>
U prediction(const U* value, int order) {
  if (order == 0) return 0;
  if (order == 1) return value[-1];
  return static_cast<U>(2 * value[-1] - value[-2]);
}

template <class U>
U fold(U difference) {
  using Signed = std::make_signed_t<U>;
  const auto sign = static_cast<U>(static_cast<Signed>(difference) >> (8 * sizeof(U) - 1));
  return static_cast<U>((difference << 1) ^ sign);
}

template <class U>
U unfold(U folded) {
  return static_cast<U>((folded >> 1) ^ (U{0} - (folded & 1)));
}

template <class U>
U coded(const U* value, int order) {
  const auto difference = static_cast<U>(*value - prediction(value, order));
  return order == 0 ? difference : fold(difference);
}

/// The order whose numbers have the fewest significant bits.
template <class U>
int best_order(std::span<const U> values) {
  std::array<std::uint64_t, order_count> bits{};
  for (int order = 0; order < order_count; ++order) {
    for (std::size_t i = order; i < values.size(); ++i) bits[order] += std::bit_width(coded(&values[i], order));
    bits[order] += 8 * sizeof(U) * std::min<std::size_t>(order, values.size());
  }
  return static_cast<int>(std::min_element(bits.begin(), bits.end()) - bits.begin());
}

}  // namespace

template <class U>
void put_array(Bytes& out, std::span<const U> values) {
  const int order = best_order(values);
  const std::size_t begin = std::min<std::size_t>(order, values.size());
  put(out, static_cast<std::uint8_t>(order));
  put_raw(out, values.data(), begin * sizeof(U));

  U all_bits = 0;
  for (std::size_t i = begin; i < values.size(); ++i) all_bits |= coded(&values[i], order);
  const std::size_t planes = (std::bit_width(all_bits) + 7) / 8;
  put(out, static_cast<std::uint8_t>(planes));

  const std::size_t coded_count = values.size() - begin, offset = out.size();
  out.resize(offset + planes * coded_count);
  for (std::size_t i = 0; i < coded_count; ++i) {
    const U number = coded(&values[begin + i], order);
    for (std::size_t plane = 0; plane < planes; ++plane)
      out[offset + plane * coded_count + i] = static_cast<std::uint8_t>(number >> (8 * plane));
  }
}

template <class U>
void get_array(ByteReader& in, std::uint64_t count, std::vector<U>& values) {
  values.clear();
  const int order = in.get<std::uint8_t>();
  if (order >= order_count) in.fail();
  const std::uint64_t begin = std::min<std::uint64_t>(order, count);
  const ByteView first = in.take(begin * sizeof(U));
  const std::size_t planes = in.get<std::uint8_t>();
  if (planes > sizeof(U)) in.fail();
  if (!in.spend(count, sizeof(U))) return;
  const std::uint64_t coded_count = count - begin;
  const ByteView body = in.take(planes * coded_count);
  if (in.failed()) return;

  values.resize(count);
  if (begin > 0) std::memcpy(values.data(), first.data(), first.size());
  for (std::uint64_t i = 0; i < coded_count; ++i) {
    U number = 0;
    for (std::size_t plane = 0; plane < planes; ++plane)
      number = static_cast<U>(number | static_cast<U>(body[plane * coded_count + i]) << (8 * plane));
    U* value = &values[begin + i];
    *value = static_cast<U>(prediction(value, order) + (order == 0 ? number : unfold(number)));
  }
}

ByteView skip_array(ByteReader& in, std::uint64_t count, std::size_t width) {
  ByteReader ahead = in;
  const std::uint64_t order = ahead.get<std::uint8_t>();
  const std::uint64_t begin = std::min(order, count);
  ahead.take(begin * width);
  const std::uint64_t planes = ahead.get<std::uint8_t>();
  if (order >= order_count || planes > width || (planes > 0 && count > in.left())) ahead.fail();
  if (ahead.failed()) {
    in.fail();
    return {};
  }
  return in.take(2 + begin * width + planes * (count - begin));
}

#define CTPM_ARRAY_CODEC(U)                               \
  template void put_array<U>(Bytes&, std::span<const U>); \
  template void get_array<U>(ByteReader&, std::uint64_t, std::vector<U>&);
CTPM_ARRAY_CODEC(std::uint8_t)
CTPM_ARRAY_CODEC(std::uint32_t)
CTPM_ARRAY_CODEC(std::uint64_t)

}  // namespace ctpm::recordings::session_file
