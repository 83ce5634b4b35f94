#include "studio/commands/unknown_command.h"

#include <algorithm>

#include "scenes/field_reader.h"
#include "studio/commands/console.h"

namespace ctpm::commands {

bool is_among(const std::vector<Command>& commands, const std::string& name) {
  return std::ranges::any_of(commands, [&](const Command& command) { return command.app->get_name() == name; });
}

int refuse_unknown(const std::vector<Command>& commands, const std::string& name) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.app->get_name());
  const std::string nearest = scenes::nearest_word(name, names);
  return print_errors({{name, "there is no such command",
                        nearest.empty() ? "ctpm --help lists them" : "did you mean ctpm " + nearest + "?"}});
}

}  // namespace ctpm::commands
