#pragma once

#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/model/fields.h"
#include "recordings/internal/array_codec.h"
#include "recordings/internal/bytes.h"
#include "recordings/session.h"

namespace ctpm::recordings::session_file {

/// Field lists of stored structures that core/model/fields.h does not cover.
template <class S, class Visit>
requires std::is_same_v<std::remove_const_t<S>, Surface>
void for_each_field(S& s, Visit&& visit) {
  visit("vertex", s.vertex);
  visit("triangle", s.triangle);
  visit("binding.first", s.binding.first);
  visit("binding.sphere", s.binding.sphere);
  visit("binding.weight", s.binding.weight);
}

template <class E, class Visit>
requires std::is_same_v<std::remove_const_t<E>, Event>
void for_each_field(E& e, Visit&& visit) {
  visit("tick", e.tick);
  visit("kind", e.kind);
  for_each_value(e, visit);
  // Written only if not empty, and read from every file.
  if (!std::is_const_v<E> || !e.text.empty()) visit("text", e.text);
  if (!std::is_const_v<E> || !e.values.empty()) visit("values", e.values);
}

enum class FieldType : std::uint8_t { u8 = 1, i32 = 2, u32 = 3, i64 = 4, u64 = 5, f64 = 6, text = 7, list = 8 };

/// Bytes of one value; 0 for texts and lists.
std::size_t width_of(FieldType type);

template <class T>
constexpr FieldType type_of() {
  if constexpr (std::is_enum_v<T>)
    return type_of<std::underlying_type_t<T>>();
  else if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::uint8_t>)
    return FieldType::u8;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return FieldType::i32;
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    return FieldType::u32;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return FieldType::i64;
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    return FieldType::u64;
  else {
    static_assert(std::is_same_v<T, double> || std::is_same_v<T, Vec3> || std::is_same_v<T, Quat> ||
                  std::is_same_v<T, std::array<std::int32_t, 3>>);
    return std::is_same_v<T, std::array<std::int32_t, 3>> ? FieldType::i32 : FieldType::f64;
  }
}

/// Count of numbers in one T: 3 for a vector.
template <class T>
constexpr std::size_t numbers_in() {
  return sizeof(T) / (type_of<T>() == FieldType::u8                                      ? 1
                      : type_of<T>() == FieldType::i32 || type_of<T>() == FieldType::u32 ? 4
                                                                                         : 8);
}

template <class T>
using BitsOf = std::conditional_t<sizeof(T) / numbers_in<T>() == 1, std::uint8_t,
                                  std::conditional_t<sizeof(T) / numbers_in<T>() == 4, std::uint32_t, std::uint64_t>>;

template <class S>
concept Structure_ = requires(S& s) {
  for_each_field(s, [](std::string_view, auto&) {});
};

template <class S>
void put_fields(Bytes& out, const S& structure);

/// Writes each visited member as one field.
class FieldWriter {
 public:
  explicit FieldWriter(Bytes& out) : out_(out) {}
  std::uint32_t count() const { return count_; }

  template <class T>
  void operator()(std::string_view name, const T& value) {
    head(name, type_of<T>(), numbers_in<T>());
    numbers(&value, 1);
  }

  void operator()(std::string_view name, const std::string& text) {
    head(name, FieldType::text, text.size());
    put_raw(out_, text.data(), text.size());
  }

  template <class T>
  void operator()(std::string_view name, const std::vector<T>& values) {
    if constexpr (Structure_<const T>) {
      head(name, FieldType::list, values.size());
      list(values);
    } else {
      head(name, type_of<T>(), values.size() * numbers_in<T>());
      numbers(values.data(), values.size());
    }
  }

 private:
  void head(std::string_view name, FieldType type, std::uint64_t count) {
    put(out_, static_cast<std::uint16_t>(name.size()));
    put_raw(out_, name.data(), name.size());
    put(out_, static_cast<std::uint8_t>(type));
    put(out_, count);
    ++count_;
  }

  template <class T>
  void numbers(const T* values, std::size_t count) {
    std::vector<BitsOf<T>> bits(count * numbers_in<T>());
    if (count > 0) std::memcpy(bits.data(), values, count * sizeof(T));
    put_array<BitsOf<T>>(out_, bits);
  }

  template <class T>
  void list(const std::vector<T>& structures) {
    Bytes body;
    for (const T& structure : structures) {
      Bytes one;
      put_fields(one, structure);
      put(body, static_cast<std::uint32_t>(one.size()));
      put_raw(body, one.data(), one.size());
    }
    put(out_, static_cast<std::uint64_t>(body.size()));
    put_raw(out_, body.data(), body.size());
  }

  Bytes& out_;
  std::uint32_t count_ = 0;
};

/// Writes everything that `give` visits as a field set.
template <class Give>
void put_field_set(Bytes& out, Give&& give) {
  const std::size_t place = out.size();
  put(out, std::uint32_t{0});
  FieldWriter writer(out);
  give(writer);
  const std::uint32_t count = writer.count();
  std::memcpy(out.data() + place, &count, sizeof count);
}

template <class S>
void put_fields(Bytes& out, const S& structure) {
  put_field_set(out, [&](FieldWriter& writer) { for_each_field(structure, writer); });
}

/// One field of a parsed field set, not yet decoded.
struct FieldView {
  std::string name;
  FieldType type;
  std::uint64_t count;
  ByteView body;
  bool used = false;
};

/// A field set read from untrusted bytes.
class FieldSet {
 public:
  /// The reader must be at the set's first byte. Takes the memory of the views from its budget. Fails with the reader
  /// and sets `problem`.
  FieldSet(ByteReader& in, std::string& problem);

  const std::vector<FieldView>& fields() const { return fields_; }
  FieldView* find(std::string_view name);

 private:
  std::vector<FieldView> fields_;
  std::vector<std::uint32_t> by_name_;  ///< indices of the fields in the order of their names
};

template <class S>
void get_fields(ByteReader& in, S& structure, std::string& problem);

/// Fills each visited member from the field of its name; members without a field keep their value.
class FieldReader {
 public:
  FieldReader(FieldSet& set, std::uint64_t budget, std::string& problem)
      : set_(set), budget_(budget), problem_(problem) {}
  std::uint64_t budget() const { return budget_; }

  template <class T>
  void operator()(std::string_view name, T& value) {
    FieldView* field = open(name, type_of<T>());
    if (!field) return;
    if (field->count != numbers_in<T>()) return complain(name, "has the wrong number of values");
    std::vector<BitsOf<T>> bits;
    if (!numbers(*field, bits)) return;
    if constexpr (std::is_same_v<T, bool>) {
      if (bits[0] > 1) return complain(name, "must be 0 or 1");
      value = bits[0] == 1;
    } else {
      std::memcpy(static_cast<void*>(&value), bits.data(), sizeof value);
    }
  }

  void operator()(std::string_view name, std::string& text) {
    FieldView* field = open(name, FieldType::text);
    if (field) text = text_of(field->body);
  }

  template <class T>
  void operator()(std::string_view name, std::vector<T>& values) {
    if constexpr (Structure_<T>) {
      FieldView* field = open(name, FieldType::list);
      if (field) list(*field, values);
    } else {
      FieldView* field = open(name, type_of<T>());
      if (!field) return;
      if (field->count % numbers_in<T>() != 0) return complain(name, "has the wrong number of values");
      std::vector<BitsOf<T>> bits;
      if (!numbers(*field, bits)) return;
      values.resize(bits.size() / numbers_in<T>());
      if (!bits.empty()) std::memcpy(static_cast<void*>(values.data()), bits.data(), bits.size() * sizeof bits[0]);
    }
  }

 private:
  FieldView* open(std::string_view name, FieldType type) {
    FieldView* field = problem_.empty() ? set_.find(name) : nullptr;
    if (!field) return nullptr;
    field->used = true;
    if (field->type == type) return field;
    complain(name, "has the wrong type");
    return nullptr;
  }

  void complain(std::string_view name, std::string_view what) {
    if (problem_.empty()) problem_ = "field " + std::string(name) + " " + std::string(what);
  }

  template <class U>
  bool numbers(const FieldView& field, std::vector<U>& bits) {
    ByteReader in(field.body, budget_);
    get_array(in, field.count, bits);
    if (in.failed() || !in.at_end()) {
      complain(field.name, "cannot be decoded");
      return false;
    }
    budget_ = in.budget();
    return true;
  }

  template <class T>
  void list(const FieldView& field, std::vector<T>& structures) {
    ByteReader in(field.body, budget_);
    structures.clear();
    if (!in.spend(field.count, sizeof(T)) || field.count > in.left())
      return complain(field.name, "has too many entries");
    for (std::uint64_t i = 0; i < field.count && !in.failed() && problem_.empty(); ++i) {
      ByteReader one(in.take(in.get<std::uint32_t>()), in.budget());
      get_fields(one, structures.emplace_back(), problem_);
      in.set_budget(one.budget());
    }
    if (in.failed() || !in.at_end()) complain(field.name, "cannot be decoded");
    budget_ = in.budget();
  }

  FieldSet& set_;
  std::uint64_t budget_;
  std::string& problem_;
};

/// Runs take(set, reader) on the field set at the reader. A field not taken is unknown. `problem` describes the error;
/// empty if none.
template <class Take>
void take_field_set(ByteReader& in, std::string& problem, Take&& take) {
  FieldSet set(in, problem);
  FieldReader reader(set, in.budget(), problem);
  if (problem.empty()) take(set, reader);
  in.set_budget(reader.budget());
  for (const FieldView& field : set.fields())
    if (problem.empty() && !field.used) problem = "unknown field " + field.name + ", written by a newer program";
  if (problem.empty() && !in.at_end()) problem = "bytes are left over";
}

/// Fills `structure` from the field set at the reader. `problem` describes the error; empty if none.
template <class S>
void get_fields(ByteReader& in, S& structure, std::string& problem) {
  take_field_set(in, problem, [&](FieldSet&, FieldReader& reader) { for_each_field(structure, reader); });
}

}  // namespace ctpm::recordings::session_file
