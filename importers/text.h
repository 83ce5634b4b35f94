#pragma once

#include <cstdint>
#include <string>

#include "core/model/vec3.h"

namespace ctpm::importers {

/// Formats a length [m] in millimetres with at most four digits: "12.35 mm".
std::string mm_text(double metres);
/// Formats a position [m]: "(12.35, -4, 0) mm".
std::string place_text(Vec3 metres);
/// A number to two digits, for estimates: "22000".
std::string roughly(double number);
/// "1 hole", "3 holes".
std::string counted(std::int64_t count, const std::string& noun);

}  // namespace ctpm::importers
