#include "studio/output/option_name.h"

namespace ctpm::output {
namespace {

/// Control characters, which texts of users do not have.
constexpr std::string_view kBegin = "\x01option:", kEnd = "\x02", kInField = "abcdefghijklmnopqrstuvwxyz_.";

}  // namespace

std::string option_name(std::string_view field) { return std::string(kBegin) + std::string(field) + std::string(kEnd); }

Errors name_options(Errors errors, const std::function<std::string(std::string_view field)>& name_of) {
  const auto replace = [&](std::string& text) {
    for (std::size_t at = 0; (at = text.find(kBegin, at)) != std::string::npos;) {
      const std::size_t from = at + kBegin.size(), to = text.find_first_not_of(kInField, from);
      const bool is_name = to != std::string::npos && std::string_view(text).substr(to).starts_with(kEnd);
      const std::string name = is_name ? name_of(std::string_view(text).substr(from, to - from)) : "";
      if (is_name) text.replace(at, to + kEnd.size() - at, name);
      at = is_name ? at + name.size() : from;
    }
  };
  for (Error& error : errors) replace(error.where), replace(error.message), replace(error.hint);
  return errors;
}

}  // namespace ctpm::output
