#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/result.h"

namespace ctpm::server {

/// The values of one JSON object that a client sent. Each access checks type and range; errors() then has all problems,
/// unknown keys among them. Error places are JSON pointers.
class Parameters {
 public:
  /// Errors: no JSON; not an object.
  static Result<Parameters> parse(std::string_view text);

  std::string text(const char* key);  ///< required
  std::optional<std::string> text_if(const char* key);
  double number(const char* key, double least, double most);  ///< required; a finite number
  std::optional<double> number_if(const char* key, double least, double most);
  bool flag(const char* key, bool otherwise);
  std::vector<double> numbers(const char* key, std::size_t count);     ///< required; `count` finite numbers
  std::vector<double> numbers_if(const char* key, std::size_t count);  ///< the same; empty without it
  std::vector<std::string> texts_if(const char* key);                  ///< a list of texts
  std::optional<Parameters> object_if(const char* key);
  std::vector<Parameters> objects(const char* key);  ///< required: a list of objects

  /// All problems so far, and keys that nobody asked for.
  Errors errors() const;

  /// Adds a problem with a value.
  void refuse(const char* key, const std::string& why);

 private:
  struct Content;
  explicit Parameters(std::shared_ptr<Content> content);
  std::shared_ptr<Content> content_;
};

}  // namespace ctpm::server
