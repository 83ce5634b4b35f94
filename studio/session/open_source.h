#pragma once

#include <map>
#include <memory>
#include <string>

#include "core/model.h"
#include "core/result.h"
#include "studio/session/input_source.h"

namespace ctpm {

/// Which source a user asks for: at most one of the names is set.
struct SourceRequest {
  std::string script;  ///< file of a script
  std::string motion;  ///< file of a motion
};

/// A source that is ready, and what a session remembers of it.
struct OpenedSource {
  std::unique_ptr<InputSource> source;
  std::map<std::string, std::string> metadata;
};

/// How many sources are asked for.
int count_of(const SourceRequest& request);

/// Opens the one source that is asked for. Errors: its file cannot be read or is wrong, with places.
Result<OpenedSource> open_source(const SourceRequest& request, const Model& model);

}  // namespace ctpm
