#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

#include "studio/session/time_range.h"
#include "studio/views/look.h"

// Flags that several commands share, and the flags behind the option names in errors of libraries.
namespace ctpm::commands {

/// The flag that sets a field of an option struct: `--camera` for "look.camera". A field without a flag is returned
/// unchanged.
std::string flag_of(std::string_view field);

/// Adds the flags of a look: view, colours, cutaway and camera.
void add_look(CLI::App& app, views::LookRequest& request);

/// Adds the flags of a time range.
void add_time_range(CLI::App& app, session::TimeRange& range);

}  // namespace ctpm::commands
