#pragma once

#include <functional>
#include <string>

#include "core/model/result.h"

namespace ctpm::output {

/// The whole file. Errors: it does not exist, is a folder, cannot be read.
Result<std::string> read_text_file(const std::string& path);

/// Writes `text` to a temporary name beside `path` and renames it when it is whole. Errors: the folder is
/// missing or cannot be written, the disk is full; nothing is left behind then.
Result<Done> write_text_file(const std::string& path, const std::string& text);

/// An error if a file of that name cannot be made: its folder is missing or cannot be written. For checks
/// before long work.
Result<Done> check_writable(const std::string& path);

}  // namespace ctpm::output
