#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <type_traits>

namespace ctpm {

/// What the entries of an array of a Model or a State belong to.
enum class EntryOf : std::int32_t {
  none,  ///< not an array, or an array of any length
  sphere,
  axial,              ///< axial element
  internal_variable,  ///< of a two-sphere TPM
  constraint,
  angle_spring,
  load,
  tool,
  blade_end,  ///< tip and heel
  touchable,  ///< numbers in State::touched
  tissue_cell,
};

/// Shape and range of one field of a Model or a State. Built from the constants below: `positive.per(EntryOf::sphere)`.
struct FieldMeaning {
  enum class Range : std::int32_t {
    any,     ///< every bit pattern, NaN included
    number,  ///< finite and between `lowest` and `highest`
    index,   ///< of an `indexed` entry, not below `lowest`
    bits,    ///< a set of bits within `mask`
    one_of,  ///< a number whose bit is set in `mask`: an enumeration
  };
  Range range = Range::any;
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool is_open = false;  ///< the range excludes lowest and highest
  EntryOf indexed = EntryOf::none;
  std::uint64_t mask = 0;
  EntryOf shape = EntryOf::none;
  bool may_be_empty = false;  ///< the array is empty if the scene does not need it

  constexpr FieldMeaning per(EntryOf entry) const {
    FieldMeaning meaning = *this;
    meaning.shape = entry;
    return meaning;
  }
  constexpr FieldMeaning or_empty() const {
    FieldMeaning meaning = *this;
    meaning.may_be_empty = true;
    return meaning;
  }
};

namespace meaning {

inline constexpr FieldMeaning any{};

/// In [lowest, highest].
constexpr FieldMeaning within(double lowest, double highest) {
  return {.range = FieldMeaning::Range::number, .lowest = lowest, .highest = highest};
}

// In SI units, wider than every scene. Numbers beyond are damage or deceit, and their products would overflow.
inline constexpr double kLargest = 1e18, kSmallest = 1e-18;
inline constexpr FieldMeaning finite = within(-kLargest, kLargest);
inline constexpr FieldMeaning positive = within(kSmallest, kLargest);
inline constexpr FieldMeaning not_negative = within(0, kLargest);
inline constexpr FieldMeaning place = within(-1e3, 1e3);        ///< of what rests [m]
inline constexpr FieldMeaning moved_place = within(-1e6, 1e6);  ///< of what moves [m]
inline constexpr FieldMeaning speed = within(-1e6, 1e6);        ///< [m/s]; a step beyond 10^4 m/s is refused
inline constexpr FieldMeaning length = within(1e-9, 1e3);       ///< [m]
inline constexpr FieldMeaning length_or_none = within(0, 1e3);  ///< [m]
inline constexpr FieldMeaning time = within(0, 1e9);            ///< [s]: 30 years

/// In (lowest, highest).
constexpr FieldMeaning between(double lowest, double highest) {
  return {.range = FieldMeaning::Range::number, .lowest = lowest, .highest = highest, .is_open = true};
}
/// Index of an entry; -1 means none, if `lowest` allows it.
constexpr FieldMeaning index(EntryOf indexed, std::int32_t lowest = 0) {
  return {.range = FieldMeaning::Range::index, .lowest = double(lowest), .indexed = indexed};
}
constexpr FieldMeaning bits(std::uint64_t mask) { return {.range = FieldMeaning::Range::bits, .mask = mask}; }
template <class E>
constexpr FieldMeaning one_of(std::initializer_list<E> known) {
  FieldMeaning meaning{.range = FieldMeaning::Range::one_of};
  for (const E value : known) meaning.mask |= std::uint64_t{1} << int(value);
  return meaning;
}

}  // namespace meaning

/// Calls `visit(name, member, meaning)`, or `visit(name, member)` if the visitor takes no meaning.
template <class Visit>
auto with_meaning(Visit& visit) {
  return [&visit](std::string_view name, auto& member, const FieldMeaning& meaning) {
    if constexpr (std::is_invocable_v<Visit&, std::string_view, decltype(member), const FieldMeaning&>)
      visit(name, member, meaning);
    else
      visit(name, member);
  };
}

}  // namespace ctpm
