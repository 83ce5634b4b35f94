#include "recordings/internal/event_check.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace ctpm::recordings::session_file {
namespace {

/// Checks each number of an event; texts may hold anything.
struct EventCheck {
  const Model& model;
  std::string& problem;

  void operator()(std::string_view name, std::int64_t value) const { count(name, value); }
  void operator()(std::string_view name, double value) const {
    if (!std::isfinite(value)) complain(name, "is not finite");
  }
  void operator()(std::string_view, const std::string&) const {}

  void operator()(std::string_view name, std::int32_t value) const {
    if (name == "tool") return link(name, value, model.tools.size());
    if (name == "hand") return link(name, value, kMostHands);
    if (name == "organ") return link(name, value, model.organs.size());
    if (name == "sphere") return link(name, value, model.sphere_count());
    count(name, value);
  }

 private:
  void count(std::string_view name, std::int64_t value) const {
    if (value < 0) complain(name, "is below 0");
  }
  /// -1 names none.
  void link(std::string_view name, std::int64_t value, std::size_t end) const {
    if (value < -1 || value >= static_cast<std::int64_t>(end))
      complain(name, "is " + std::to_string(value) + ", of " + std::to_string(end));
  }
  void complain(std::string_view name, const std::string& what) const {
    if (problem.empty()) problem = std::string(name) + " " + what;
  }
};

}  // namespace

std::string problem_of(const Event& event, const Model& model, std::int64_t last_tick) {
  if (event.tick < 0 || event.tick > last_tick) return "tick " + std::to_string(event.tick) + " is not in the session";
  std::string problem;
  // Of a kind that this program does not know, no number has a known range.
  if (std::string_view(name_of(event.kind)) != "unknown") for_each_value(event, EventCheck{model, problem});
  return problem;
}

}  // namespace ctpm::recordings::session_file
