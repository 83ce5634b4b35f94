#pragma once

#include <string>

#include "studio/bench/bench.h"

// A press that every filling and structure of an organ can be put to.
namespace ctpm::bench {

/// The organ's own radius and its refinements, each by kRefinement: those that are compared, then what the reference
/// has beyond the finest of them.
inline constexpr double kRefinement = 1.4142135623730951;
inline constexpr int kReferenceRefinements = 2;

/// The first organ of a scene, pressed by the scene's first ball, which comes down 6 mm at 60 mm/s on its highest
/// vertex and stays.
struct PressedOrgan {
  double radius = 0;  ///< of its spheres [m]
  std::int64_t layers = 0, spheres = 0;
  BenchRun run;  ///< its positions: vertices of the surface at rest, moved as the press moves them
};

/// Whether the first organ of a scene can be filled anew and pressed: it has a mesh, and the scene has a ball.
bool can_press(const loading::LoadedScene& scene);

/// Presses the first organ of `scene`, whose Model has been changed to `model`. Errors: the press was refused.
Result<PressedOrgan> press_organ(const loading::LoadedScene& scene, const Model& model);

/// The scene at `path`, without gravity and loads, its first organ filled with spheres whose radius is `factor` times
/// its own; contacts as stiff as those of its own filling. Errors: those of the scene.
Result<loading::LoadedScene> load_refilled(const loading::LoadedScene& own, double factor);

/// Says why spheres `factor` times as large as the scene's own cannot be studied: the first of `errors`, those of a
/// scene from a file or of one in memory, in the same words.
std::string left_out_sentence(const loading::LoadedScene& own, double factor, const Errors& errors);

/// Lines of results.csv that are common to presses.
std::vector<reports::Cell> row_of(const std::string& study, const std::string& scene, const std::string& model,
                                  const PressedOrgan& organ, double tick, reports::Cell position_error,
                                  double force_error);

}  // namespace ctpm::bench
