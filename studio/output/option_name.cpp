#include "studio/output/option_name.h"

namespace ctpm {
namespace {

constexpr std::string_view kBegin = "{option:", kEnd = "}";

}  // namespace

std::string option_name(std::string_view field) { return std::string(kBegin) + std::string(field) + std::string(kEnd); }

Errors name_options(Errors errors, const std::function<std::string(std::string_view field)>& name_of) {
  const auto replace = [&](std::string& text) {
    for (std::size_t at = 0; (at = text.find(kBegin, at)) != std::string::npos;) {
      const std::size_t from = at + kBegin.size(), to = text.find(kEnd, from);
      if (to == std::string::npos) return;
      const std::string name = name_of(std::string_view(text).substr(from, to - from));
      text.replace(at, to + kEnd.size() - at, name);
      at += name.size();
    }
  };
  for (Error& error : errors) replace(error.where), replace(error.message), replace(error.hint);
  return errors;
}

}  // namespace ctpm
