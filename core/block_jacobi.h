#pragma once

#include <cstddef>
#include <vector>

namespace ctpm {

/// Preconditioner: the inverse of each sphere's own 3x3 block.
class BlockJacobi {
 public:
  explicit BlockJacobi(std::size_t sphere_count) : inverse_(6 * sphere_count) {}

  /// Inverts symmetric positive definite blocks, given as six arrays xx, xy, xz, yy, yz, zz  (6 x
  /// sphere_count).
  void factorise(const std::vector<double>& blocks);

  /// out = inverse blocks times in  (3 x sphere_count, coordinate by coordinate).
  void apply(const std::vector<double>& in, std::vector<double>& out) const;

 private:
  std::vector<double> inverse_;
};

}  // namespace ctpm
