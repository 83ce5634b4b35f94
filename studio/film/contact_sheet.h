#pragma once

#include <string>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/film/export_video.h"

namespace ctpm::film {

/// Columns and rows of a contact sheet.
inline constexpr int kSheetColumns = 4, kSheetRows = 3;

/// Draws a session on one page: moments at equal intervals through ExportOptions::range, to its end, each with its time
/// and what has happened since the one before. `path` ends in .png; ExportOptions::size is that of the page. Errors: a
/// file that exists already, a look that the scene does not have, a damaged session, a replay that differs (unless
/// allowed), stopped. After an error no file is left behind.
Result<Done> write_contact_sheet(recordings::SessionReader& session, const std::string& path,
                                 const ExportOptions& options);

}  // namespace ctpm::film
