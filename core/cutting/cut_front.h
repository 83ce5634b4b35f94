#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/cutting/bearing.h"
#include "core/cutting/cutting.h"
#include "core/cutting/opening.h"
#include "core/cutting/rest_map.h"
#include "core/cutting/swept_surface.h"
#include "core/cutting/tissue_depth.h"
#include "core/model/model.h"
#include "core/model/state.h"
#include "core/model/state_view.h"

namespace ctpm::cutting {

/// The front of a cut: a chain of places in the tissue, one for each node of a blade's edge. While the edge meets no
/// resistance the front is where the edge is. Tissue that resists holds the front back, up to Tool::trail_distance
/// behind the edge, and the blade pulls at it; then the front goes on through the tissue, and what it sweeps is cut.
/// The front's places are kept in the tissue at rest, so that it follows the tissue however that moves.
class CutFront {
 public:
  /// A node of the edge and the tissue that holds it.
  struct Node {
    std::int32_t organ = -1;  ///< that the node is in or near; -1: none, and nothing else is set
    Place place;              ///< of the front
    double depth = 0;         ///< of the front below the surface [m]
    Vec3 edge;                ///< direction of the front along the edge, at rest, of any length
    bool has_tissue = false;  ///< of its organ, between it and a node beside it that is on the same side of the surface
    double length = 0;        ///< of the front at rest that the node stands for and that is in tissue [m]
    double toughness = 0;     ///< of the tissue there [J/m^2]
    double flank_stress = 0;  ///< [Pa]
  };

  /// `model` must outlive the CutFront.
  explicit CutFront(const Model& model);

  /// Whether any tissue resists a blade.
  bool resists() const { return resists_; }
  const std::array<Node, kEdgeNodes>& nodes() const { return nodes_; }

  /// Follows the edge into and out of the organs, at the start of a tick in which it goes `from`-`to`. `is_taken`: the
  /// tool has just been picked up, and has cut nothing yet.
  void begin_tick(const Tool& scalpel, const BladeEdge& from, const BladeEdge& to, bool is_taken, State& state);

  /// Finds what holds the front, at the start of a substep.
  void begin_substep(const State& state);

  /// Largest force with which the tissue holds a node [N] when the edge, along the unit vector `edge`, is drawn from
  /// the front towards the unit vector `way`: toughness times the length that goes through whole tissue across the
  /// edge, and friction of the flanks.
  double hold(std::size_t node, const Tool& scalpel, const StateView& state, Vec3 edge, Vec3 way) const;

  /// Place at rest of a node's front, in the substep.
  Vec3 rest(std::size_t node) const { return front_[node]; }

  /// How far a place at rest is in the tissue of an organ: 0 outside, rising smoothly to 1 at a depth of 2 mm.
  double in_tissue(std::size_t organ, Vec3 rest) const;
  /// How far it is in a cut: 1 near the swept surface, falling to 0 up to SweptIndex::kFar from it.
  double in_cut(std::size_t organ, Vec3 rest) const;

  /// The opening at a place at rest of the cut in which the blade is at `point` [m]: see Openings::find().
  void find_opening(std::size_t organ, Vec3 rest, Vec3 normal, const Vec3Array& position, Vec3 point,
                    Opening& opening) const {
    const BladeAt blade{bearing_, position, point};
    openings_.find(organ, rest, normal, opening, &blade);
  }

  /// Draws the front after the edge at the end of a substep. What it sweeps is added to the swept surface, and elements
  /// that it crosses are severed; they are appended to `crossings`. Returns the number of severed elements, constraints
  /// and angle springs.
  std::int32_t follow(const Tool& scalpel, const BladeEdge& edge, State& state, std::vector<Crossing>& crossings);

 private:
  struct Material {
    double toughness = 0, flank_stress = 0;  ///< [J/m^2], [Pa]
  };
  struct Step {
    Front to;
    /// Whether a node cuts on its way. Outside, the front is where the tissue would be if it went on: what it goes
    /// there because the tissue moves, and not the blade, cuts nothing.
    std::array<bool, kEdgeNodes> cuts;
  };
  void find_materials();
  void track(std::size_t node, Vec3 from, Vec3 to, bool is_taken, State& state) const;
  double newness(std::int32_t organ, Vec3 rest, Vec3 way_at_rest) const;
  Step draw(const Tool& scalpel, const BladeEdge& edge, const State& state) const;
  NewlySwept newly_swept(const Step& step, const State& state) const;
  Front begin_of(const NewlySwept& newly, const State& state) const;
  double rubbed_height(std::size_t node, const Tool& scalpel, const StateView& state, Vec3 edge, Vec3 way) const;
  double opening(const Place& at, const StateView& state, Vec3 across) const;

  const Model& model_;
  RestMap map_;
  TissueDepth depth_;
  SweptIndex swept_;
  RestElements elements_;
  Bearing bearing_;
  Openings openings_;
  bool resists_ = false;
  std::vector<Material> material_;        ///< (sphere_count, or empty)
  std::vector<std::uint8_t> has_volume_;  ///< of each organ: it has a surface or lattice cells, and so an inside
  std::array<Node, kEdgeNodes> nodes_;
  BladeEdge last_edge_;           ///< at the end of the last substep
  Front front_;                   ///< at the start of the substep
  std::vector<double> reach_;     ///< of the spheres that carry the front, in each organ [m]
  std::vector<Box> box_;          ///< around the spheres of each organ, at the start of the tick
  const State* state_ = nullptr;  ///< of the substep, whose swept surface swept_ follows
};

}  // namespace ctpm::cutting
