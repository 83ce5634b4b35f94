#include "recordings/state_hash.h"

#include <algorithm>
#include <bit>
#include <type_traits>

#define XXH_STATIC_LINKING_ONLY  // the hash state lives on the stack
#include <xxhash.h>

#include "core/model/fields.h"
#include "core/model/state.h"

namespace ctpm::recordings {
namespace {

static_assert(std::endian::native == std::endian::little, "values are hashed and stored as they lie in memory");
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Quat) == 4 * sizeof(double), "no padding");

struct Hasher {
  XXH3_state_t& hash;
  std::size_t internal_count;  ///< elements with an internal variable: the last ones of Model::axial

  template <class T>
  void operator()(std::string_view, const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_same_v<T, Vec3> || std::is_same_v<T, Quat>);
    XXH3_64bits_update(&hash, &value, sizeof value);
  }

  template <class T>
  void operator()(std::string_view name, const std::vector<T>& values) {
    static_assert(std::is_arithmetic_v<T>);
    const std::size_t size = values.size();
    if (!is_axial(name)) return array(name, values.data(), size);
    const std::size_t last = std::min(internal_count, size);
    array(name, values.data(), size - last), array(name, values.data() + (size - last), last);
  }

 private:
  /// Arrays over the axial elements are hashed as two, elements without an internal variable and those with one: they
  /// were two arrays when the first sessions were recorded.
  static bool is_axial(std::string_view name) { return name == "axial_severed" || name == "axial_crossing"; }

  /// Arrays added to State after the first sessions were recorded. They are not hashed while empty, so that those
  /// sessions keep their hashes.
  static bool is_newer(std::string_view name) {
    return name == "axial_crossing" || name.starts_with("blade_trail") || name.starts_with("acceleration") ||
           name == "touched" || name.starts_with("grip.") || name == "kelvin_dent" || name == "edge_organ" ||
           name.starts_with("swept");
  }

  /// Rows of the swept surface that the last two follow never change: they were hashed when they were the last.
  static std::uint64_t hashed_of(std::string_view name, std::uint64_t count) {
    return name.starts_with("swept") ? std::min<std::uint64_t>(count, 2 * kEdgeNodes) : count;
  }

  template <class T>
  void array(std::string_view name, const T* values, std::uint64_t count) {
    if (count == 0 && is_newer(name)) return;
    XXH3_64bits_update(&hash, &count, sizeof count);
    values += count - hashed_of(name, count), count = hashed_of(name, count);
    XXH3_64bits_update(&hash, values, count * sizeof(T));
  }
};

}  // namespace

std::uint64_t state_hash(const State& state) {
  XXH3_state_t hash;
  XXH3_INITSTATE(&hash);
  XXH3_64bits_reset(&hash);
  for_each_field(state, Hasher{hash, state.kelvin_elongation.size()});
  return XXH3_64bits_digest(&hash);
}

}  // namespace ctpm::recordings
