#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/cutting/cutting.h"
#include "core/cutting/pieces.h"
#include "core/cutting/swept_surface.h"
#include "core/cutting/tissue_depth.h"
#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::cutbody {

class CutGrid;

/// Where tissue comes apart because nothing holds it: cuts may sever every element between neighbouring spheres and yet
/// leave a bridge of tissue in which no element runs. It tears in the middle between them, unless they are still joined
/// by a short way around it. The severed elements are those that the rows of the swept surface cross, and those that
/// the State has severed: a row holds the front to some micrometres, and may have been moved since. A State without
/// elements stands for its rows alone.
class TornTissue {
 public:
  struct Edge {
    std::int32_t node;  ///< of the grid
    int direction;
    friend auto operator<=>(const Edge&, const Edge&) = default;
  };

  /// `model` must outlive the TornTissue.
  TornTissue(const Model& model, std::size_t organ, const cutting::TissueDepth& depth);

  /// Severs the elements that a row crosses. What a row crosses that may still move is taken back by take_back().
  void sever(const cutting::Front& from, const cutting::Front& to, const cutting::NewlySwept& newly, bool may_move);
  void take_back();
  /// Nothing is severed.
  void reset();

  struct Tear {
    std::vector<Edge> edge;  ///< of the grid, in whole tissue, across which it is torn; ascending
    struct Stray {
      std::int32_t sphere, node;
    };
    /// Spheres outside the tissue of which the nearest tissue belongs to another piece than they do, counted within the
    /// organ, and the node at which the tissue begins that they carry; -1: they carry none.
    std::vector<Stray> stray;
  };
  /// `state`: of the swept surface.
  Tear find(const CutGrid& grid, const State& state);
  /// Whether the last find() was of a State with the same severed elements.
  bool knows_severed(const State& state) const { return by_state_ == state.axial_severed; }

 private:
  void take_severed(const State& state);
  std::vector<std::uint8_t> blocks_at_cut(const CutGrid& grid) const;
  struct Carried {
    std::vector<std::int32_t> by;     ///< sphere that carries each node of the grid; -1: none, or it is not asked for
    std::vector<std::int32_t> first;  ///< node at which what a sphere carries begins; -1: it carries none (organ.count)
  };
  Carried carry(const CutGrid& grid, const State& state, const std::vector<std::uint8_t>& blocks) const;
  std::optional<int> elements_between(std::int32_t from, std::int32_t to, int most, bool by_whole);
  bool came_apart(std::int32_t p, std::int32_t q);

  const Model& model_;
  std::size_t organ_;
  cutting::RestElements elements_;
  std::vector<std::uint8_t> by_rows_;   ///< elements that the rows sever (axial_count)
  std::vector<std::uint8_t> by_state_;  ///< that the State had severed in the last find()
  State network_;                       ///< only the severed elements, of the rows and of the State
  cutting::Pieces pieces_;
  std::vector<std::int32_t> whole_;  ///< the first sphere of the piece of each sphere before any cut (sphere_count)
  std::vector<cutting::Crossing> by_last_;                       ///< what the last row severed, which may still move
  std::map<std::pair<std::int32_t, std::int32_t>, bool> apart_;  ///< pairs of spheres that were asked for
  std::vector<std::uint32_t> reached_in_;                        ///< the last search that reached each sphere
  std::uint32_t search_ = 0;
};

}  // namespace ctpm::cutbody
