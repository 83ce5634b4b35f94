#pragma once

#include "studio/authoring/import_scene.h"

namespace ctpm::authoring {

/// The request with lengths as their author wrote them: millimetres become metres with an error in the last place, and
/// the scene would show it.
ImportRequest as_written(ImportRequest request);

}  // namespace ctpm::authoring
