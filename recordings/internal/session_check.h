#pragma once

#include <cstdint>
#include <optional>

#include "core/model/result.h"
#include "recordings/internal/session_store.h"
#include "recordings/session.h"

namespace ctpm::recordings::session_file {

/// What SessionReader::open() has already read and checked.
struct OpenedSession {
  const std::string& path;
  const Model& model;
  const std::optional<SessionStatistics>& finish;
  std::int64_t tick_count = 0;
};

/// Checks everything that open() leaves out: the container, every block, that none is missing or out of place, the
/// links of events, and the stored statistics against new ones. Errors: all that was found, each at the file's path.
Result<Done> check_session(SessionStore& store, const OpenedSession& session);

}  // namespace ctpm::recordings::session_file
