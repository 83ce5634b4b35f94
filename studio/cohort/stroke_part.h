#pragma once

#include <string>
#include <vector>

#include "studio/cohort/pages.h"

// The part of a trainee's page on where along the stroke the hand is outside the experts' band.
namespace ctpm::cohort {

/// The stretch of the way in which the latest attempt is farthest outside the experts' band.
struct StrokeMoment {
  bool is_of_force = false;  ///< otherwise of the distance from the experts' way
  StrokeExcess excess;
  std::string text;                    ///< where, by how much and what the experts did, in one sentence
  double trainee_s = 0, expert_s = 0;  ///< of the worst place: in the attempt, and in the middle expert's session
};

/// None, one or two.
std::vector<StrokeMoment> moments_of(const TaskResult& task, const Attempt& latest);

/// Adds pictures of the moments and plots along the stroke, whose events lead to them; `part` names them within the
/// page. Error: a picture that cannot be encoded.
Result<Done> add_stroke(reports::Report& report, const std::string& part, const TaskResult& task, const Attempt& latest,
                        const MomentArtist& draw);

}  // namespace ctpm::cohort
