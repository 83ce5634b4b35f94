#pragma once

#include <string>

namespace ctpm::output {

/// `value` with `digits` digits behind the point.
std::string fixed(double value, int digits);

/// A number as a person writes it: `significant` digits at most, no trailing zeros.
std::string short_number(double value, int significant = 4);

}  // namespace ctpm::output
