#pragma once

#include <compare>
#include <memory>
#include <string>

#include "core/model/result.h"

namespace ctpm::scenes {

struct JsonNode;

/// Line and column in a text, both from 1; a column is a character, not a byte.
struct Place {
  int line = 1, column = 1;
  friend auto operator<=>(const Place&, const Place&) = default;
};

/// The place in a file of every value of a scene or script, by JSON pointer. Copies share the text's tree.
///
/// Default constructed, it belongs to no text: a scene that a program made. Its errors name the pointer alone.
class TextPlaces {
 public:
  TextPlaces() = default;
  TextPlaces(std::shared_ptr<const JsonNode> root, std::string file_name);

  /// Place of the value at `pointer`; of the object or list around it if the value is not written.
  Place find(const std::string& pointer) const;

  /// The error as it is printed: `file:line:col` in `where`, the pointer at the front of `message`.
  Error error_at(const std::string& pointer, Place place, const std::string& message, const std::string& hint) const;
  Error error_at(const std::string& pointer, const std::string& message, const std::string& hint = "") const;

  const std::string& file_name() const { return file_name_; }

 private:
  std::shared_ptr<const JsonNode> root_;  ///< null: no text
  std::string file_name_;
};

}  // namespace ctpm::scenes
