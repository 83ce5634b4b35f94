#pragma once

#include <string>
#include <vector>

#include "scenes/scene_file.h"
#include "studio/fidelity/body.h"
#include "studio/fidelity/press.h"
#include "studio/fidelity/recipes.h"

// The first organ of an author's scene under its own first ball, at rest and without gravity.
namespace ctpm::fidelity {

/// What a scene says about its first organ.
struct SceneOrgan {
  scenes::SceneSpec scene;                  ///< only this organ and this ball, without anchors, for Pace::slow
  std::vector<scenes::AnchorSpec> anchors;  ///< in the scene's frame
  Vec3 gravity;                             ///< of the scene, by which anchors know what is low [m/s^2]
  importers::RawMesh mesh;                  ///< repaired [m]
  Vec3 middle;                              ///< of the mesh's box; turns are about it [m]
  Vec3 start, direction;                    ///< of the ball's centre before a press [m]; way of the press
  std::vector<double> depths;               ///< to press to [m]
};

/// Reads a scene and its first organ's mesh. The place is that of the press in the scene's default script (`ctpm demo`
/// uses the same). Errors: those of the scene and the mesh; an organ that is a rig; no ball among the tools; a press
/// that misses the organ.
Result<SceneOrgan> read_scene_organ(const std::string& path, const scenes::LoadOptions& options);

/// The organ turned about its middle against the lattice, with its anchors. Errors: those of importers and scenes.
Result<Body> make_body(const SceneOrgan& organ, Quat turn);

/// Where the ball touches the drawn surface on its way, `offset` [m] beside it; none if it misses.
std::optional<PressSite> find_touch(const SceneOrgan& organ, Vec3 offset);

/// An author's organ: forces over turns, forces and first contacts over one lattice cell.
struct SceneResult {
  std::string name;                ///< of the scene, the organ and the ball
  double radius = 0, spacing = 0;  ///< of the filling [m]
  std::size_t spheres = 0;
  std::vector<OrientationResult::Row> turns;   ///< one a depth
  std::vector<OrientationResult::Row> places;  ///< one a depth
  std::vector<double> contacts;                ///< depth below the drawn surface at the first force, one a place [m]
};
/// `should_stop`, if given, ends a measurement with an error; any thread calls it.
using ShouldStop = std::function<bool()>;
Result<SceneResult> measure_scene_turns(const SceneOrgan& organ, std::span<const Quat> turns,
                                        const ShouldStop& should_stop = {});
Result<SceneResult> measure_scene_places(const SceneOrgan& organ, int places, const ShouldStop& should_stop = {});

/// Turns and places along each side of the lattice cell, in the short form.
inline constexpr std::size_t kQuickTurns = 4;
inline constexpr int kQuickPlaces = 2;

/// Chapters of both; `key` and `title` name the recipe.
Chapter turns_chapter(const SceneResult& result, const std::string& key, const std::string& title);
Chapter places_chapter(const SceneResult& result, const std::string& key, const std::string& title);

}  // namespace ctpm::fidelity
