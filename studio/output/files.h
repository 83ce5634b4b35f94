#pragma once

#include <functional>
#include <string>

#include "core/model/result.h"

namespace ctpm::output {

/// Reads a whole file. Errors: it does not exist, is a folder, cannot be read.
Result<std::string> read_text_file(const std::string& path);

/// Checks that a file can be read, and does not open it: what comes through a pipe is read once. Errors: as above.
Result<Done> check_readable(const std::string& path);

/// Writes `text` to a temporary file beside `path`, then renames it. Removes what killed writers of the same file left
/// there. Errors: the folder is missing or cannot be written, the disk is full. After an error no file is left behind.
Result<Done> write_text_file(const std::string& path, const std::string& text);

/// Checks before long work that a file can be created. Errors: its folder is missing or cannot be written.
Result<Done> check_writable(const std::string& path);

/// As check_writable(), and nothing lies at `path` yet unless `overwrite`. Error names the option `overwrite`.
Result<Done> check_new(const std::string& path, bool overwrite);

}  // namespace ctpm::output
