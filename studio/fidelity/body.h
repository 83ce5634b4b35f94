#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/model/inputs.h"
#include "core/model/organ.h"
#include "core/model/result.h"
#include "core/model/state.h"
#include "core/stepping/step.h"
#include "importers/fill.h"
#include "scenes/scene_spec.h"

// A body of tissue as an author's scene makes it: mesh -> filling -> Model -> ticks.
namespace ctpm::fidelity {

/// How a body is loaded over time.
enum class Pace {
  slow,  ///< no viscosity, long ticks, tight residuals: one state of rest after the other
  live,  ///< the preset's viscosity, ticks of 1 ms, the default settings of a scene
};

/// A body of the paper's liver, in a frame of its own.
struct Specimen {
  importers::RawMesh mesh;  ///< [m]
  double radius = 4e-3;     ///< r of the spheres [m]; the gap is r, so the spacing is 3 r
  Pace pace = Pace::slow;
  scenes::TilingSpec tiling = scenes::TilingSpec::automatic;
  std::optional<scenes::PlaneRegion> clamp;  ///< tissue behind this plane never moves
  Vec3 gravity;                              ///< [m/s^2]
  std::optional<double> density;             ///< [kg/m^3]; unset: the preset\'s
  std::vector<double> balls;                 ///< radii of the tools [m]
  double friction = 0.3;                     ///< of the tools, the default of a scene
  Quat turn;                                 ///< of the body against the lattice
  Vec3 shift;                                ///< of the body against the lattice [m]
};

/// The body in the world: filled, and its Model built.
struct Body {
  FilledOrgan organ;
  Model model;
  importers::FillReport filling;
  Quat turn;
  Vec3 shift;

  Vec3 to_world(Vec3 p) const { return rotate(turn, p) + shift; }
  Vec3 to_body(Vec3 p) const { return rotate({turn.w, -turn.x, -turn.y, -turn.z}, p - shift); }
  double spacing() const { return organ.spacing; }
};

/// The scene of a specimen, without its organ's spheres.
scenes::SceneSpec scene_of(const Specimen& specimen);

/// Gives a scene long ticks and tight residuals, for one state of rest after the other.
void use_slow_pace(scenes::SceneSpec& scene);

/// Checks a mesh in the world [m] and fills it as the organ says. Radius and gap of `options` are those of the organ.
Result<importers::Filling> fill_mesh(const scenes::OrganSpec& organ, const importers::RawMesh& mesh,
                                     importers::FillOptions options = {});

/// Checks the mesh, fills it and builds the Model. Errors: those of importers and scenes.
Result<Body> make_body(const Specimen& specimen);

/// The same for any scene of one organ whose mesh [m] is turned and shifted before it is filled. The scene is in the
/// world's frame. Radius and gap of `options` are those of the scene.
Result<Body> make_body(const scenes::SceneSpec& scene, const importers::RawMesh& mesh, Quat turn, Vec3 shift,
                       importers::FillOptions options = {});

/// The same Model with spheres held along axes (bits 0, 1, 2: x, y, z), which no key of a scene does.
void hold(Model& model, const std::vector<std::int32_t>& spheres, std::uint8_t axes);

/// Ticks until nothing moves any more: no sphere by more than `still` [m] in a tick. `hand` is the input of each.
/// Returns the last report; its status is `not_converged` if the body still moves after `most` ticks.
stepping::StepReport settle(stepping::Stepper& stepper, State& state, const Inputs& hand, std::int64_t most = 400,
                            double still = 1e-8);

/// Ticks without a tool for `time` [s].
void run_for(const Model& model, State& state, double time);

Vec3 centre_of_mass(const Model& model, const Vec3Array& position);

/// Vertices of the drawn surface [m].
std::vector<Vec3> drawn_at(const Body& body, const State& state);

/// Least distance of a point from the drawn surface [m] whose vertices are at `vertex`, unsigned.
double distance_to(const Surface& surface, const std::vector<Vec3>& vertex, Vec3 point);

/// Lattice cells with eight spheres, and how many of them are inside out: a corner whose three edges span no volume, or
/// a negative one.
struct CellCount {
  std::int64_t cells = 0, inside_out = 0;
};
CellCount count_cells(const Body& body, const State& state);

/// Twelve turns of a body, the same in every run: none, about the lattice's axes, and seven spread over all
/// orientations.
std::vector<Quat> twelve_turns();

/// Rotation about an axis of any length by an angle [rad].
Quat turn_about(Vec3 axis, double angle);

/// Calls `work(0) ... work(count - 1)` on all processors; the order does not matter to any result.
void in_parallel(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace ctpm::fidelity
