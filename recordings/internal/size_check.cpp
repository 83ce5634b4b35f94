#include "recordings/internal/size_check.h"

#include <algorithm>
#include <string>

namespace ctpm::recordings::session_file {
namespace {

constexpr std::size_t most_things = 1000;       // organs, tools
constexpr std::size_t most_obstacles = 100;     // contacts are reserved for each
constexpr std::size_t longest_name = 1000;      // [bytes]
constexpr std::size_t most_loads = 10'000'000;  // each is added in every step
/// Iterations of one tick times what one iteration passes over: spheres and elements. About 10 s.
constexpr double most_work = 2e9;

}  // namespace

Errors check_sizes(const Model& model) {
  Errors errors;
  const auto at_most = [&](double count, double most, const std::string& what) {
    if (!(count <= most))
      errors.push_back({"model",
                        what + ": " + std::to_string(std::int64_t(std::min(count, 1e18))) + ", at most " +
                            std::to_string(std::int64_t(most)) + " are allowed",
                        ""});
  };
  at_most(double(model.organs.size()), most_things, "organs");
  at_most(double(model.tools.size()), most_things, "tools");
  at_most(double(model.obstacles.size()), most_obstacles, "obstacles");
  at_most(double(model.loads.size()), most_loads, "loads");
  const auto names = [&](const auto& things, const char* what) {
    for (const auto& thing : things) {
      const bool is_plain = std::none_of(thing.name.begin(), thing.name.end(),
                                         [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
      if (!is_plain) errors.push_back({"model", std::string(what) + ": a name holds control characters", ""});
      at_most(double(thing.name.size()), longest_name, std::string("letters in the name of a thing among ") + what);
    }
  };
  names(model.organs, "organs"), names(model.tools, "tools"), names(model.obstacles, "obstacles");
  const double passed = double(model.sphere_count() + model.element_count() + model.tissue_cells.size());
  const bool solves = model.solver.integrator != Integrator::leapfrog;
  const double steps = double(model.solver.substeps) * (solves ? double(model.solver.max_iterations) : 1);
  at_most(passed * steps, most_work, "spheres and elements times solver iterations of a tick");
  return errors;
}

}  // namespace ctpm::recordings::session_file
