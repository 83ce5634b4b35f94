#pragma once

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/film/captions.h"
#include "studio/render/strip.h"

namespace ctpm::film {

/// A session's strip: forces as recorded, moments as told, `limit` [N]. What cannot be read because it is damaged has
/// no force; a replay says so where it comes there.
render::Strip strip_of(recordings::SessionReader& session, const std::vector<Moment>& moments, double limit);

/// Its height below a picture of this height [pixels], even as videos need it.
int strip_height(int picture_height);

}  // namespace ctpm::film
