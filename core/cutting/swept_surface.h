#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/cutting/blade_geometry.h"
#include "core/cutting/extent.h"
#include "core/model/model.h"
#include "core/model/state.h"
#include "core/model/vec3.h"

namespace ctpm::cutting {

/// The front of a cut: where each node of a blade's edge is in the tissue at rest [m].
using Front = std::array<Vec3, kEdgeNodes>;
/// 1 + organ of the tissue that the front newly went through, between each node and the next; 0: none.
using NewlySwept = std::array<std::uint8_t, kEdgeNodes>;

/// Rows that State::swept holds at most. What is swept beyond them is cut, but not remembered as a surface.
inline constexpr std::size_t kMostSweptRows = 4096;

/// A part of the swept surface: what the edge between two nodes swept between two rows.
struct SweptQuad {
  std::int32_t organ;
  Vec3 from, to, from2, to2;  ///< of both nodes, in the row before and in this one, at rest [m]
  friend bool operator==(const SweptQuad&, const SweptQuad&) = default;
};

inline std::size_t swept_rows(const State& state) { return state.swept.size() / kEdgeNodes; }

/// The part of row `row` from node `node` to the next; its organ is -1 where nothing was swept.
SweptQuad swept_quad(const State& state, std::size_t row, std::size_t node);

/// What the edge swept in a row: where it came from, where it went, and what of it was newly swept.
struct SweptRow {
  Front from, to;
  NewlySwept newly;
};

/// `row` >= 1.
SweptRow swept_row(const State& state, std::size_t row);

/// Whether the swept surfaces of two States are the same in an organ.
bool sweeps_same(const State& a, const State& b, std::int32_t organ);

/// Calls `visit(quad)` for all parts of the swept surface, in the order in which they were swept.
template <class Visit>
void for_each_swept(const State& state, Visit&& visit) {
  for (std::size_t row = 1; row < swept_rows(state); ++row)
    for (std::size_t node = 0; node + 1 < kEdgeNodes; ++node)
      if (const SweptQuad quad = swept_quad(state, row, node); quad.organ >= 0) visit(quad);
}

/// A place as State::swept holds it: to some micrometres, so that sessions stay small.
Vec3 stored_place(Vec3 rest);

/// Adds what the front swept while it went `from`-`to`. Where the last row and the new one lie in line, the row is
/// moved instead of adding another: rows are at most 1 mm apart, and leave out nothing that is farther than some
/// hundredths of a millimetre from the surface between them. Rows that are open, or will be, stay as they are.
void add_swept(State& state, const Front& from, const Front& to, const NewlySwept& newly);

/// Boxes around what was newly swept in each row but the last one, which may still move [m]; none where nothing was.
using SweptBoxes = std::vector<std::optional<Box>>;
SweptBoxes boxes_of_rows(const State& state);

/// Whether the swept surface in an organ is within `reach` of a place at rest [m]. `boxes`: boxes_of_rows().
bool is_near_swept(const State& state, const SweptBoxes& boxes, std::int32_t organ, Vec3 rest, double reach);

/// The point of the swept surface in an organ that is nearest to a place at rest [m]; none within `reach` [m]. `boxes`:
/// boxes_of_rows().
std::optional<Vec3> nearest_swept(const State& state, const SweptBoxes& boxes, std::int32_t organ, Vec3 rest,
                                  double reach);

/// Whether the swept surface in an organ crosses the line between two places at rest [m]; touching counts. `boxes`:
/// boxes_of_rows().
bool is_crossed(const State& state, const SweptBoxes& boxes, std::int32_t organ, Vec3 p, Vec3 q);

/// Finds the part of the swept surface near a place.
class SweptIndex {
 public:
  /// Distances from here on count as far [m].
  static constexpr double kFar = 0.6e-3;

  explicit SweptIndex(const Model& model);

  /// Follows the swept surface of `state`. Fast where the State goes on from that of the last call.
  void update(const State& state);

  /// Distance of a place at rest from the surface of `state`, as of update(), in an organ [m], kFar at most. Where it
  /// is less than `enough` [m], some distance less than that.
  double distance(const State& state, std::int32_t organ, Vec3 rest, double enough = 0) const;

 private:
  static constexpr double kBucket = kRestCell;  ///< [m]
  std::int64_t bucket_of(Vec3 rest) const;
  void insert(const State& state, std::size_t row);
  bool goes_on_from(const State& state) const;

  Vec3 low_;
  std::array<std::int64_t, 3> extent_{};
  struct Entry {
    std::int32_t row, node, next;
  };
  std::vector<std::int32_t> head_;  ///< first entry of a bucket; -1: none
  std::vector<Entry> entries_;
  std::size_t rows_ = 0;  ///< that are in the index; the last row of a State never is, since it may still move
  Front last_{};          ///< the last of these [m]
  NewlySwept last_organ_{};
};

}  // namespace ctpm::cutting
