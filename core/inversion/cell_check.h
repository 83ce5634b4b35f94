#pragma once

#include <cstdint>
#include <vector>

#include "core/elements/kernels/kernels.h"
#include "core/model/model.h"
#include "core/parallel/slabs.h"

namespace ctpm::inversion {

/// Finds the tissue cells whose volume ratio J is below a limit.
///
/// Two passes. The first looks at edges alone: a matrix whose rows are dominated by their diagonal has a determinant of
/// at least the product over the rows of |diagonal| - sum of |others| (Ostrowski, "Sur la determination des bornes
/// inferieures pour une classe des determinants", 1937). Where all edges of a batch keep the cube root of the limit, no
/// determinant is computed. It needs lattice axes along those of the world; other cells always go to the second pass.
class CellCheck {
 public:
  /// `model` must outlive the CellCheck. Each slab has the cells whose first corner is in it.
  CellCheck(const Model& model, const parallel::Slabs& slabs, const elements::Kernels& kernels);

  /// Calls below(cell), a row of Model::tissue_cells, in a fixed order for each cell of a slab that has a corner
  /// tetrahedron with J < `limit`, 0 or the Model's threshold.
  template <class Below>
  void find(int slab, const Vec3Array& position, double limit, Below&& below);

  /// Number of cells in a slab.
  std::size_t size(int slab) const { return of_slab_[std::size_t(slab)].cells; }

 private:
  struct Batch {
    elements::CellBatch cells;
    double rest_volume;  ///< six times that of a corner tetrahedron [m^3]
  };
  struct Row {
    double rest_length;              ///< of its longest edge [m]
    std::int32_t first_user, users;  ///< batches that have its edges: a range of Slab::user
  };
  struct Slab {
    std::vector<Batch> batches;
    std::vector<elements::EdgeRow> edges;
    std::vector<Row> rows;                  ///< of `edges`
    std::vector<std::int32_t> user;         ///< batches, row by row
    std::vector<double> least;              ///< result of each row [m]
    std::vector<std::uint8_t> has_no_rows;  ///< batch has an edge that is not along the world's axis (batch_count)
    std::vector<std::uint8_t> is_suspect;   ///< batch goes to the second pass (batch_count)
    std::size_t cells = 0;
  };

  void add_batches(Slab& slab, std::size_t begin, std::size_t end) const;
  void add_rows(Slab& slab) const;
  void find_suspects(Slab& slab, const elements::Points& points, double limit) const;

  const Model& model_;
  const elements::Kernels& kernels_;
  double edge_threshold_;  ///< cube root of the Model's threshold, rounded up
  std::vector<Slab> of_slab_;
};

template <class Below>
void CellCheck::find(int slab, const Vec3Array& position, double limit, Below&& below) {
  Slab& own = of_slab_[std::size_t(slab)];
  const elements::Points points{position.x.data(), position.y.data(), position.z.data()};
  find_suspects(own, points, limit);
  alignas(64) double least[elements::kBatch];
  for (std::size_t b = 0; b < own.batches.size(); ++b) {
    if (own.is_suspect[b] == 0) continue;
    const Batch& batch = own.batches[b];
    kernels_.least_of_cells(points, batch.cells, least);
    for (std::int32_t i = 0; i < batch.cells.count; ++i)
      if (least[i] < limit * batch.rest_volume) below(std::size_t(batch.cells.cell + i));
  }
}

}  // namespace ctpm::inversion
