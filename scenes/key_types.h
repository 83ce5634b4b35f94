#pragma once

#include <limits>
#include <span>
#include <string>

// Types of the tables in scene_keys.h and script_keys.h. A table has one function `describe_fields(visitor, object)`
// per struct; the reader, the writer, the JSON Schema and the documentation are its visitors. Internal to scenes.
namespace ctpm::scenes {

/// A unit of the text form. SI value = value in the text times 10^exponent.
struct Unit {
  const char* suffix;  ///< last part of the key; empty if the number has no unit
  const char* name;    ///< as it is printed
  int exponent;
};

namespace units {
inline constexpr Unit none{"", "", 0};
inline constexpr Unit millimetre{"mm", "mm", -3};
inline constexpr Unit second{"s", "s", 0};
inline constexpr Unit degree{"deg", "degrees", 0};
inline constexpr Unit newton{"n", "N", 0};
inline constexpr Unit millimetre_per_second{"mm_per_s", "mm/s", -3};
inline constexpr Unit metre_per_second2{"m_per_s2", "m/s^2", 0};
inline constexpr Unit kilogram_per_metre3{"kg_per_m3", "kg/m^3", 0};
inline constexpr Unit second_per_metre{"s_per_m", "s/m", 0};
inline constexpr Unit newton_per_metre{"n_per_m", "N/m", 0};
inline constexpr Unit kilopascal{"kpa", "kPa", 3};
inline constexpr Unit joule_per_metre2{"j_per_m2", "J/m^2", 0};
inline constexpr Unit kilopascal_per_millimetre{"kpa_per_mm", "kPa/mm", 6};
inline constexpr Unit kilopascal_second_per_millimetre{"kpa_s_per_mm", "kPa s/mm", 6};
}  // namespace units

/// Allowed values, in the unit of the text.
struct Range {
  double low, high;
  bool is_low_open = false, is_high_open = false;

  bool contains(double x) const { return (is_low_open ? x > low : x >= low) && (is_high_open ? x < high : x <= high); }
};
constexpr Range within(double low, double high) { return {low, high, false, false}; }
constexpr Range above(double low, double high) { return {low, high, true, false}; }
constexpr Range between(double low, double high) { return {low, high, true, true}; }
/// "(0, 100]"
std::string to_string(const Range& range);

/// One row of the table.
struct Key {
  const char* name;
  const char* meaning;  ///< one sentence, with capital and full stop
  bool is_required = false;
  const char* otherwise = "";  ///< what holds if an optional value is not written; empty: nothing
};
constexpr Key required(const char* name, const char* meaning) { return {name, meaning, true, ""}; }

/// How the documentation calls a struct, and what it says about it.
struct RecordInfo {
  const char* name;
  const char* meaning;
};

/// One allowed word of a choice.
template <class E>
struct Choice {
  const char* name;
  E value;
};

/// The words that a key of enumeration E takes, in their documented order. scene_keys.h holds them.
template <class E>
std::span<const Choice<E>> choices_of();

}  // namespace ctpm::scenes
