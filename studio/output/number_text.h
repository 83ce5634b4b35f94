#pragma once

#include <string>

namespace ctpm::output {

/// `value` with `digits` digits after the decimal point.
std::string fixed(double value, int digits);

/// A number for people: at most `significant` digits, no trailing zeros.
std::string short_number(double value, int significant = 4);

}  // namespace ctpm::output
