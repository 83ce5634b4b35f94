#pragma once

#include <string>
#include <vector>

#include "studio/commands/command.h"

namespace ctpm::commands {

/// Whether one of `commands` is called so.
bool is_among(const std::vector<Command>& commands, const std::string& name);

/// Says that there is no command of that name, and which one was probably meant; returns exit_bad_input.
int refuse_unknown(const std::vector<Command>& commands, const std::string& name);

}  // namespace ctpm::commands
