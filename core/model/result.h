#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace ctpm {

/// One problem in the user's input: where it is, what is wrong and how to mend it.
struct Error {
  std::string where;    ///< `file`, `file:line:col` or the name of a thing; empty if it has none
  std::string message;  ///< what is wrong, with the value found and the values allowed
  std::string hint;     ///< what to do about it; may be empty

  friend bool operator==(const Error&, const Error&) = default;
};

/// All problems found in one run; readers collect them instead of stopping at the first.
using Errors = std::vector<Error>;

/// "where: error: message (hint)", as a compiler prints it.
inline std::string to_string(const Error& error) {
  std::string text = error.where.empty() ? "" : error.where + ": ";
  text += "error: " + error.message;
  if (!error.hint.empty()) text += " (" + error.hint + ")";
  return text;
}

/// Aborts on a bug of our own, never on bad input.
[[noreturn]] inline void fail_check(const char* file, int line, const char* what) {
  std::fprintf(stderr, "%s:%d: internal error: %s\n", file, line, what);
  std::abort();
}

/// `CTPM_CHECK(condition, "what")`: for our own bugs only; bad input is a Result.
#define CTPM_CHECK(condition, what)                                 \
  do {                                                              \
    if (!(condition)) ::ctpm::fail_check(__FILE__, __LINE__, what); \
  } while (false)

/// Either a value or all the errors that prevented it.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}
  Result(Error error) : content_(Errors{std::move(error)}) {}
  Result(Errors errors) : content_(std::move(errors)) {
    CTPM_CHECK(!std::get<Errors>(content_).empty(), "a failed Result needs an error");
  }

  explicit operator bool() const { return std::holds_alternative<T>(content_); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(value()); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Errors& errors() const {
    CTPM_CHECK(!*this, "errors() of a Result that holds a value");
    return std::get<Errors>(content_);
  }

 private:
  T& value() {
    CTPM_CHECK(bool(*this), "value of a Result that holds errors");
    return std::get<T>(content_);
  }
  const T& value() const { return const_cast<Result*>(this)->value(); }

  std::variant<T, Errors> content_;
};

/// The Result of an action that returns nothing.
struct Done {};

}  // namespace ctpm
