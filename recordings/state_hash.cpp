#include "recordings/state_hash.h"

#include <bit>
#include <type_traits>

#define XXH_STATIC_LINKING_ONLY  // the hash state lives on the stack
#include <xxhash.h>

#include "core/model/fields.h"

namespace ctpm {
namespace {

static_assert(std::endian::native == std::endian::little, "values are hashed and stored as they lie in memory");
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Quat) == 4 * sizeof(double), "no padding");

struct Hasher {
  XXH3_state_t& hash;

  template <class T>
  void operator()(std::string_view, const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_same_v<T, Vec3> || std::is_same_v<T, Quat>);
    XXH3_64bits_update(&hash, &value, sizeof value);
  }

  /// Arrays that came into State after the first sessions were recorded: while empty they do not count, so
  /// that the hashes of those sessions stay what they were.
  static bool is_newer(std::string_view name) {
    return name == "edge_crossing" || name == "tpm_crossing" || name.starts_with("blade_trail") ||
           name.starts_with("acceleration");
  }

  template <class T>
  void operator()(std::string_view name, const std::vector<T>& values) {
    static_assert(std::is_arithmetic_v<T>);
    if (values.empty() && is_newer(name)) return;
    const std::uint64_t count = values.size();
    XXH3_64bits_update(&hash, &count, sizeof count);
    XXH3_64bits_update(&hash, values.data(), values.size() * sizeof(T));
  }
};

}  // namespace

std::uint64_t state_hash(const State& state) {
  XXH3_state_t hash;
  XXH3_INITSTATE(&hash);
  XXH3_64bits_reset(&hash);
  for_each_field(state, Hasher{hash});
  return XXH3_64bits_digest(&hash);
}

}  // namespace ctpm
