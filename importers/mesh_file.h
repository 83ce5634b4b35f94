#pragma once

#include <string>

#include "core/model/result.h"
#include "importers/child_process.h"

namespace ctpm::importers {

/// The name's ending in lower case without the dot; "nii.gz" is "nii".
std::string suffix_of(const std::string& path);

/// Checks that need no reader. Errors: no such file, not a file, empty.
Errors check_file(const std::string& path);

/// Sends a refusal: a message of wire::Kind::refused.
void send_refusal(const Error& error, const Send& send);

}  // namespace ctpm::importers
