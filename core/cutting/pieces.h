#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/cutting/cutting.h"
#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::cutting {

/// The pieces that a scene's tissue has come to: spheres that unsevered axial elements join.
class Pieces {
 public:
  explicit Pieces(const Model& model) : model_(model) {}

  /// Room for every sphere, so that find() never allocates.
  void reserve() { piece_.reserve(model_.sphere_count()); }

  /// Finds the pieces of `state` and returns how many there are.
  std::int32_t find(const State& state);

  /// Joins what the elements of `crossings` held together, and returns how many pieces fewer that makes:
  /// those that came loose when they were severed, if find() came after it.
  std::int32_t rejoin(std::span<const Crossing> crossings);

  /// Of each sphere, as found last: the first sphere of its piece (sphere_count).
  const std::vector<std::int32_t>& piece() const { return piece_; }

 private:
  std::int32_t root(std::int32_t sphere);
  bool join(std::int32_t p, std::int32_t q);

  const Model& model_;
  std::vector<std::int32_t> piece_;
};

}  // namespace ctpm::cutting
