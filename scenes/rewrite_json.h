#pragma once

#include <optional>
#include <string>

// Changes a text that an author wrote. Internal to scenes.
namespace ctpm::scenes {

/// The text changed from what it says, which is `before` in the program's own layout, to `after` in that layout:
/// comments, layout and what stays the same are kept. None where that cannot be done, as where a key must go. Whoever
/// asks reads the result again: it is not checked here.
std::optional<std::string> rewrite_json(const std::string& text, const std::string& before, const std::string& after);

}  // namespace ctpm::scenes
