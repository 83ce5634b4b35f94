#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studio/compare/measures.h"
#include "studio/compare/session_track.h"

namespace ctpm::compare {

/// The value of a measure of one session.
struct SessionValue {
  const Measure* measure = nullptr;
  std::optional<double> value = {};  ///< in the measure's unit
  std::string note = {};             ///< why there is no value, where that can be said
};

inline constexpr const char* kNoForceLimit = "no limit is known";

/// The measures of one session by itself, always the same ones in the same order. `force_limit` [N]: unset, none is
/// known; `damage_depth` [m]: 0, no organ has one.
std::vector<SessionValue> measure_session(const SessionTrack& track, std::optional<double> force_limit,
                                          double damage_depth);

/// What a tool did to a part of the scene: an organ, or a forbidden zone.
struct StructureLoad {
  std::string name;
  bool is_zone = false;
  double seconds = 0;            ///< with a force on the organ, or in the zone
  double peak = 0;               ///< force [N]
  double impulse = 0, work = 0;  ///< [N s], of the tool on the tissue [J]
};

/// Of every organ and forbidden zone. None where it is not known what the tool touched: several organs, and the session
/// was not replayed whole.
std::optional<std::vector<StructureLoad>> loads_of(const SessionTrack& track, const Model& model);

/// The measures of the cuts of two sessions of one scene: which elements they have in common, and how far their paths
/// lie apart. Both were replayed.
std::vector<SessionValue> measure_cut_pair(const SessionTrack& expert, const SessionTrack& trainee);

/// How far two aligned ways lie apart.
std::vector<SessionValue> measure_aligned(const Alignment& alignment);

/// Takes back the measures that depend on time where a session lacks real time, with the reason in their notes.
void refuse_times(std::vector<SessionValue>& values, const SessionTrack& track);

/// The smallest damage depth of the organs [m]; 0: none has one.
double damage_depth_of(const Model& model);

}  // namespace ctpm::compare
