#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <typeindex>
#include <typeinfo>
#include <vector>

#include "core/model/result.h"
#include "core/model/vec3.h"
#include "scenes/json_text.h"
#include "scenes/key_types.h"
#include "scenes/sweep.h"

// The visitor that lists: the tables as data, from which the JSON Schema and the documentation are made.
// Internal to scenes.
namespace ctpm::scenes {

enum class FieldKind { constant, text, preset, number, integer, flag, point, points, values, choice, record, list };

/// One key of a record.
struct FieldRow {
  Key key{};
  FieldKind kind{};
  Unit unit = units::none;
  Range range{};
  std::string standard;            ///< JSON of what holds if the key is not written; empty: see key.otherwise
  std::vector<std::string> words;  ///< JSON of the allowed values of a constant or a choice
  std::string record;              ///< name of the record of a record or a list
  std::size_t least = 0;           ///< fewest items of a list or of points
};

/// One kind of object.
struct RecordRow {
  RecordInfo info{};
  std::type_index type = typeid(void);
  std::vector<FieldRow> fields;
  bool has_exactly_one = false;  ///< of its fields
  std::string beside{};          ///< the field that may be given with it
};

/// Lists the records that can be reached from one, itself first. Visits objects with default values.
class FieldLister {
 public:
  template <class T>
  static std::vector<RecordRow> list_of() {
    std::vector<RecordRow> records;
    add_record<T>(records);
    return records;
  }

  void constant(const Key& key, const char* value) { row(key, FieldKind::constant).words = {in_quotes(value)}; }
  void constant(const Key& key, int value) { row(key, FieldKind::constant).words = {std::to_string(value)}; }
  void text(const Key& key, const std::string&) { row(key, FieldKind::text); }
  void preset(const Key& key, const std::string&) { row(key, FieldKind::preset); }
  void number(const Key& key, double value, const Unit& unit, const Range& range) {
    numeric(key, FieldKind::number, unit, range).standard = double_to_decimal(value, unit.exponent);
  }
  void number(const Key& key, const std::optional<double>&, const Unit& unit, const Range& range) {
    numeric(key, FieldKind::number, unit, range);
  }
  void integer(const Key& key, std::int32_t value, const Range& range) {
    numeric(key, FieldKind::integer, units::none, range).standard = std::to_string(value);
  }
  void integer(const Key& key, const std::optional<std::int32_t>&, const Range& range) {
    numeric(key, FieldKind::integer, units::none, range);
  }
  void flag(const Key& key, bool value) { row(key, FieldKind::flag).standard = value ? "true" : "false"; }
  void flag(const Key& key, const std::optional<bool>&) { row(key, FieldKind::flag); }
  void point(const Key& key, const Vec3& p, const Unit& unit, const Range& range) {
    numeric(key, FieldKind::point, unit, range).standard = "[" + double_to_decimal(p.x, unit.exponent) + ", " +
                                                           double_to_decimal(p.y, unit.exponent) + ", " +
                                                           double_to_decimal(p.z, unit.exponent) + "]";
  }
  void point(const Key& key, const std::optional<Vec3>&, const Unit& unit, const Range& range) {
    numeric(key, FieldKind::point, unit, range);
  }
  void points(const Key& key, const std::vector<Vec3>&, const Unit& unit, const Range& range, std::size_t least) {
    numeric(key, FieldKind::points, unit, range).least = least;
  }
  void values(const Key& key, const std::vector<SweepValue>&, std::size_t least) {
    row(key, FieldKind::values).least = least;
  }
  template <class E>
  void choice(const Key& key, E value) {
    FieldRow& added = row(key, FieldKind::choice);
    for (const auto& choice : choices_of<E>()) {
      added.words.push_back(in_quotes(choice.name));
      if (choice.value == value) added.standard = in_quotes(choice.name);
    }
  }
  template <class T>
  void record(const Key& key, T&) {
    row(key, FieldKind::record).record = info_of(T{}).name;
    add_record<T>(records_);
  }
  template <class T>
  void record(const Key& key, std::optional<T>&) {
    row(key, FieldKind::record).record = info_of(T{}).name;
    add_record<T>(records_);
  }
  template <class T>
  void list(const Key& key, std::vector<T>&, std::size_t least) {
    FieldRow& added = row(key, FieldKind::list);
    added.record = info_of(T{}).name, added.least = least;
    add_record<T>(records_);
  }
  void exactly_one(const char* beside = "") {
    records_[index_].has_exactly_one = true, records_[index_].beside = beside;
  }

 private:
  FieldLister(std::vector<RecordRow>& records, std::size_t index) : records_(records), index_(index) {}

  template <class T>
  static void add_record(std::vector<RecordRow>& records) {
    T value{};
    const RecordInfo info = info_of(value);
    for (const RecordRow& known : records) {
      if (std::string(known.info.name) != info.name) continue;
      CTPM_CHECK(known.type == typeid(T), "two records must not have the same name");
      return;
    }
    records.push_back({info, typeid(T), {}, false});
    FieldLister lister(records, records.size() - 1);
    describe_fields(lister, value);
  }

  FieldRow& row(const Key& key, FieldKind kind) {
    FieldRow& added = records_[index_].fields.emplace_back();
    added.key = key, added.kind = kind;
    return added;
  }
  FieldRow& numeric(const Key& key, FieldKind kind, const Unit& unit, const Range& range) {
    FieldRow& added = row(key, kind);
    added.unit = unit, added.range = range;
    return added;
  }

  std::vector<RecordRow>& records_;
  std::size_t index_;
};

}  // namespace ctpm::scenes
