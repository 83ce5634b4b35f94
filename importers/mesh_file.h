#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"
#include "importers/child_process.h"
#include "importers/topology.h"

namespace ctpm::importers {

/// A file's name in lower case: endings mean the same in capitals.
std::string in_lower_case(std::string name);

/// The name's ending in lower case without the dot; "nii.gz" is "nii".
std::string suffix_of(const std::string& path);

/// Checks that need no reader. Errors: no such file, not a file, empty.
Errors check_file(const std::string& path);

/// Sends a mesh that counts as one of `parts`, or as none in particular if `part` is -1: a message of wire::Kind::mesh.
/// `unit_in_metres`: 0 if the file does not say it.
void send_soup(const std::vector<std::string>& parts, std::ptrdiff_t part, double unit_in_metres, const Soup& soup,
               const Send& send);

/// Sends that the file has no part of the requested name: a message of wire::Kind::no_such_part.
void send_no_such_part(const std::vector<std::string>& parts, const Send& send);

/// Sends a refusal: a message of wire::Kind::refused.
void send_refusal(const Error& error, const Send& send);

}  // namespace ctpm::importers
