#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/session/time_range.h"

namespace ctpm::exchange {

struct ExportOptions {
  std::optional<double> at_s;  ///< moment of a still file [s]; unset: the last
  session::TimeRange range;    ///< part of a series
  double fps = 25;             ///< moments per second of a series, in [1, 1000]
  bool overwrite = false;
  bool allow_diverged = false;  ///< goes on if the replay differs from the recording
  std::function<void(std::int64_t done, std::int64_t total)> progress;
  std::function<bool()> should_stop;  ///< asked at every moment
};

struct ExportOutcome {
  std::vector<std::string> files;  ///< written
  std::int64_t moments = 0;
  std::int64_t first_different_tick = -1;  ///< first tick whose replay differs from the recording; -1: none
};

/// Whether export_shapes() writes files with this ending: .vtp, .vtu, .glb (a moment), .pvd, .usda (a series).
bool is_shape_file(const std::string& path);

/// Replays a session and writes the shape of its tissue for other programs. A `.pvd` names files in a folder of the
/// same name without the ending. Errors: options out of range, a damaged session, a replay that differs (unless
/// allowed), files that exist already or cannot be written, stopped; then no file is left behind.
Result<ExportOutcome> export_shapes(recordings::SessionReader& session, const std::string& path,
                                    const ExportOptions& options);

}  // namespace ctpm::exchange
