#pragma once

// Sessions that were never simulated, made of straight ways.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "studio/compare/measure_table.h"
#include "studio/compare/measures.h"
#include "studio/compare/session_measures.h"
#include "tests/recordings/sessions.h"

namespace ctpm {

/// A hand that has moved `seconds` from one place to another, at a steady pace, with a tool.
inline void go(compare::SessionTrack& track, Vec3 from, Vec3 to, double seconds) {
  const int ticks = int(std::lround(seconds / track.tick));
  for (int i = 1; i <= ticks; ++i) {
    track.tool.push_back(0);
    track.tip.push_back(from + (double(i) / ticks) * (to - from));
    track.force.push_back(0), track.depth.push_back(0), track.severed.push_back(0);
  }
}

/// Fills in what a reader would have found.
inline compare::SessionTrack finished(compare::SessionTrack track, const Model& model) {
  track.strokes = {{0, track.tick_count()}};
  if (track.severed_at.empty()) track.severed_at.assign(compare::ElementPlaces(model).count, -1);
  return track;
}

inline compare::SessionTrack new_track() {
  compare::SessionTrack track;
  track.path = "made.ctpm", track.tick = 1e-3;
  return track;
}

class Measures : public ::testing::Test {
 protected:
  const recordings::SessionStart scene_ = [] {
    recordings::SessionStart start = testing::small_start();
    start.model.organs.at(0).damage_depth = 0.01;
    return start;
  }();

  /// The way of a press that takes 1 s down, `hold_s` of rest, and 1 s up.
  compare::SessionTrack press(double hold_s = 0) const {
    compare::SessionTrack track = new_track();
    go(track, {0, 0, 0.1}, {0, 0, 0.05}, 1);
    go(track, {0, 0, 0.05}, {0, 0, 0.05}, hold_s);
    go(track, {0, 0, 0.05}, {0, 0, 0.1}, 1);
    return finished(track, scene_.model);
  }

  static const compare::MeasuredValue& find(const compare::Comparison& comparison, const std::string& key) {
    const auto it = std::find_if(comparison.values.begin(), comparison.values.end(),
                                 [&](const compare::MeasuredValue& v) { return key == v.measure->key; });
    CTPM_CHECK(it != comparison.values.end(), "a measure of that name");
    return *it;
  }
  static double trainee(const compare::Comparison& comparison, const std::string& key) {
    return find(comparison, key).trainee.value();
  }
};

}  // namespace ctpm
