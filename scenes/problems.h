#pragma once

#include <cstddef>
#include <initializer_list>
#include <set>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "scenes/text_places.h"

namespace ctpm::scenes {

/// Collects what every stage finds wrong with one scene or script: reading, rules between values, files, building.
///
/// A value with an error is refused. A later stage asks is_good() for the values that it uses and leaves out what it
/// cannot judge, so that one mistake is reported once and hides no other.
class Problems {
 public:
  Problems() = default;
  explicit Problems(TextPlaces places) : places_(std::move(places)) {}

  /// Reports an error at `place`, and refuses the value at the pointer `refused`.
  void add(const std::string& pointer, Place place, const std::string& message, const std::string& hint,
           const std::string& refused);
  void add(const std::string& pointer, Place place, const std::string& message, const std::string& hint = "") {
    add(pointer, place, message, hint, pointer);
  }

  /// The same, at the place of the value at `pointer`.
  void add(const std::string& pointer, const std::string& message, const std::string& hint, const std::string& refused);

  /// Reports an error at `place` beside which no other means anything: the whole text is refused, and errors before and
  /// after it are dropped.
  void add_only(const std::string& pointer, Place place, const std::string& message, const std::string& hint);

  /// Reports an error that a later stage finds in the value at `pointer`, and refuses the value at `refused`. Does
  /// nothing if that value is refused already.
  void add_rule(const std::string& pointer, const std::string& message, const std::string& hint,
                const std::string& refused);
  void add_rule(const std::string& pointer, const std::string& message, const std::string& hint = "") {
    add_rule(pointer, message, hint, pointer);
  }

  /// Reports something odd about the value at `pointer`; the scene still runs.
  void add_warning(const std::string& pointer, const std::string& message, const std::string& hint = "");

  /// False if the value at `pointer`, anything in it or anything around it is refused. After more errors than are
  /// listed, false for every value.
  bool is_good(const std::string& pointer) const;

  /// True if each of these members of the object at `pointer` is good.
  bool are_good(const std::string& pointer, std::initializer_list<const char*> keys) const;

  bool is_empty() const { return error_count_ == 0; }  ///< no errors; there may be warnings
  bool is_full() const;                                ///< further errors are only counted
  Errors errors() const;    ///< in the order of the text; the first 1000, then the number of the others
  Errors warnings() const;  ///< in the order of the text

 private:
  struct Problem {
    Place place;
    Error error;
  };
  static Errors in_order(std::vector<Problem> problems);

  TextPlaces places_;
  std::vector<Problem> errors_, warnings_;
  bool is_closed_ = false;  ///< add_only() was called
  std::size_t error_count_ = 0;
  std::set<std::string> refused_;         ///< pointers of refused values
  std::set<std::string> around_refused_;  ///< pointers of the objects and lists that hold them
};

}  // namespace ctpm::scenes
