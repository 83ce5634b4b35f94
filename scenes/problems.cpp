#include "scenes/problems.h"

#include <algorithm>

namespace ctpm::scenes {
namespace {

/// Nobody reads more; a hostile text with more is not searched for hints any further.
constexpr std::size_t kMostListed = 1000;

/// The pointer of the object or list around a value; empty for the whole text.
std::string around(const std::string& pointer) { return pointer.substr(0, pointer.rfind('/')); }

}  // namespace

bool Problems::is_full() const { return error_count_ > kMostListed; }

void Problems::add(const std::string& pointer, Place place, const std::string& message, const std::string& hint,
                   const std::string& refused) {
  if (is_closed_) return;
  ++error_count_;
  if (is_full()) return;
  errors_.push_back({place, places_.error_at(pointer, place, message, hint)});
  refused_.insert(refused);
  for (std::string outer = refused; !outer.empty();) {
    outer = around(outer);
    around_refused_.insert(outer);
  }
}

void Problems::add(const std::string& pointer, const std::string& message, const std::string& hint,
                   const std::string& refused) {
  add(pointer, places_.find(pointer), message, hint, refused);
}

void Problems::add_only(const std::string& pointer, Place place, const std::string& message, const std::string& hint) {
  errors_.clear(), error_count_ = 0;
  add(pointer, place, message, hint, "");
  is_closed_ = true;
}

void Problems::add_rule(const std::string& pointer, const std::string& message, const std::string& hint,
                        const std::string& refused) {
  if (is_good(refused)) add(pointer, message, hint, refused);
}

void Problems::add_warning(const std::string& pointer, const std::string& message, const std::string& hint) {
  const Place place = places_.find(pointer);
  warnings_.push_back({place, places_.error_at(pointer, place, message, hint)});
}

bool Problems::is_good(const std::string& pointer) const {
  if (is_empty()) return true;
  if (is_full() || around_refused_.contains(pointer) || refused_.contains("")) return false;
  for (std::string at = pointer; !at.empty(); at = around(at))
    if (refused_.contains(at)) return false;
  return true;
}

bool Problems::are_good(const std::string& pointer, std::initializer_list<const char*> keys) const {
  return std::all_of(keys.begin(), keys.end(), [&](const char* key) { return is_good(pointer + "/" + key); });
}

Errors Problems::in_order(std::vector<Problem> problems) {
  std::stable_sort(problems.begin(), problems.end(),
                   [](const Problem& a, const Problem& b) { return a.place < b.place; });
  Errors errors;
  for (Problem& problem : problems) errors.push_back(std::move(problem.error));
  return errors;
}

Errors Problems::errors() const {
  Errors errors = in_order(errors_);
  if (is_full())
    errors.push_back({places_.file_name(), std::to_string(error_count_ - kMostListed) + " more errors are not listed",
                      "mend these first"});
  return errors;
}

Errors Problems::warnings() const { return in_order(warnings_); }

}  // namespace ctpm::scenes
