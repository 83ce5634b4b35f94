#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/cutbody/cut_body.h"
#include "core/model/model.h"
#include "core/model/state.h"
#include "scenes/scene_spec.h"

namespace ctpm::exchange {

/// The surface of one organ at a moment.
struct OrganShape {
  std::string name;
  std::array<double, 3> colour{};                     ///< of its surface, sRGB in [0, 1]
  std::int32_t revision = 0;                          ///< shapes of the same revision have the same triangles
  std::vector<Vec3> vertex;                           ///< where it is [m]                             (vertex_count)
  std::vector<Vec3> rest;                             ///< where it is at rest [m]                     (vertex_count)
  std::vector<std::array<std::int32_t, 3>> triangle;  ///< outer ones first, then those of cut faces   (triangle_count)
  std::size_t outer_triangles = 0;
};

/// A moment of a session.
struct Moment {
  double time = 0;                 ///< [s]
  std::vector<OrganShape> organs;  ///< those with a surface
  State state;
  Vec3 tool_force;  ///< of the tissue on the tool [N]
};

/// Makes moments of States. The States may come in any order.
class Shaper {
 public:
  /// `model` must outlive the Shaper. `scene` gives the colours.
  Shaper(const Model& model, const scenes::SceneSpec& scene);

  std::vector<OrganShape> shapes(const State& state);

 private:
  struct Organ {
    std::size_t index;
    std::unique_ptr<cutbody::CutBody> body;  ///< null: nothing in the scene cuts
    std::array<double, 3> colour;
    std::int32_t revision = 0;
  };
  const Model& model_;
  std::vector<Organ> organs_;
};

}  // namespace ctpm::exchange
