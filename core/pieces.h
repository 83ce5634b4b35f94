#pragma once

#include <cstdint>
#include <vector>

#include "core/model.h"
#include "core/state.h"

namespace ctpm {

/// The pieces that a scene's tissue has come to: spheres that unsevered edges and two-sphere TPMs join.
class Pieces {
 public:
  explicit Pieces(const Model& model) : model_(model) {}

  /// Room for every sphere, so that find() never allocates.
  void reserve() { piece_.reserve(model_.sphere_count()); }

  /// Finds the pieces of `state` and returns how many there are.
  std::int32_t find(const State& state);

  /// Of each sphere, as found last: the first sphere of its piece (sphere_count).
  const std::vector<std::int32_t>& piece() const { return piece_; }

 private:
  std::int32_t root(std::int32_t sphere);
  const Model& model_;
  std::vector<std::int32_t> piece_;
};

}  // namespace ctpm
