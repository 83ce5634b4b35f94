#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/model/organ.h"
#include "core/model/result.h"
#include "scenes/scene_spec.h"
#include "studio/loading/standing.h"

namespace ctpm::authoring {

/// Anchors, how an organ stands on them, and the Model that stood.
struct AnchorChoice {
  std::vector<scenes::AnchorSpec> anchors;
  std::size_t held = 0;  ///< spheres
  loading::Standing standing;
  Model model;
};

/// The first anchor that choose_anchors() tries: an eighth of the spheres, at the bottom.
scenes::AnchorSpec usual_anchor(const FilledOrgan& organ);

/// Lets the only organ of `scene` settle on its own anchors, or, if it has none, on the first of several that hold it:
/// an eighth of its spheres at the bottom, more of them, a side, the top, at most half of them. If none does, the one
/// under which it sags least. Errors: those of build_model(); an anchor without spheres; `should_stop` ended it.
Result<AnchorChoice> choose_anchors(scenes::SceneSpec scene, const FilledOrgan& organ,
                                    const std::function<bool()>& should_stop);

}  // namespace ctpm::authoring
