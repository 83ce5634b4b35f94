#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/cutting/cutting.h"
#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::cutting {

/// The pieces of tissue: connected components of the spheres, joined by unsevered axial elements.
class Pieces {
 public:
  explicit Pieces(const Model& model) : model_(model) {}

  /// Reserves capacity for every sphere, so that find() never allocates.
  void reserve() { piece_.reserve(model_.sphere_count()); }

  /// Finds the pieces and returns their number. `axial_severed`: as in State; empty: nothing is severed.
  std::int32_t find(const std::vector<std::uint8_t>& axial_severed);
  std::int32_t find(const State& state) { return find(state.axial_severed); }

  /// Joins what the elements of `crossings` held together, and returns by how much that reduces the number of pieces.
  /// After find(), this is the number of pieces that came loose when those elements were severed.
  std::int32_t rejoin(std::span<const Crossing> crossings);

  /// The first sphere of the piece of each sphere, as of the last find() (sphere_count).
  const std::vector<std::int32_t>& piece() const { return piece_; }

 private:
  std::int32_t root(std::int32_t sphere);
  bool join(std::int32_t p, std::int32_t q);

  const Model& model_;
  std::vector<std::int32_t> piece_;
};

}  // namespace ctpm::cutting
