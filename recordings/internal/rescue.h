#pragma once

#include <string>

#include "core/model/result.h"

namespace ctpm::recordings::session_file {

/// Makes a session file `repaired` of every sound block that the pages of the session file `damaged` and of its log
/// still hold. It needs neither the header nor the list of tables nor the inner pages of the tables: a block tells by
/// its checksum that it belongs to this session, and by its label where. Errors: the part `session`, whose seed the
/// checksums have, is on no page; or a file cannot be read or written.
Result<Done> rescue_rows(const std::string& damaged, const std::string& repaired);

}  // namespace ctpm::recordings::session_file
