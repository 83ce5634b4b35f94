#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "core/model/result.h"

namespace ctpm::output {

/// Names a field of an option struct in the text of an error, for example option_name("look.camera"). A library knows
/// only the field. Its caller knows the user's name for it, for example `--camera`, and substitutes that with
/// name_options().
std::string option_name(std::string_view field);

/// The errors with every option_name() in place, message and hint replaced by `name_of(field)`.
Errors name_options(Errors errors, const std::function<std::string(std::string_view field)>& name_of);

}  // namespace ctpm::output
