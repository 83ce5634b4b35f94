#pragma once

#include <cstddef>
#include <cstdint>

#include "core/model/axial_law.h"

namespace ctpm::elements {

/// Vector instructions that the inner loops may use. All give the same bits: every lane does what scalar code does, in
/// the same order, and multiply-adds are not contracted.
enum class InstructionSet : std::int32_t { baseline = 0, avx2 = 1, avx512 = 2 };

/// The widest set that this machine has.
InstructionSet best_instruction_set();

/// "baseline", "avx2", "avx512".
const char* name_of(InstructionSet set);

/// Capacity of a batch in elements. The scratch memory of one batch fits the first-level cache.
inline constexpr std::int32_t kBatch = 64;

/// Where the loops over one slab's elements add: rows of the slab's own spheres. Slabs keep them apart, since cores
/// that write to neighbouring memory wait for each other (false sharing).
template <class Real>
struct SlabTarget {
  Real* data;
  std::int32_t begin;  ///< first sphere of the slab
  std::size_t stride;  ///< distance between rows
};

/// What a linearisation multiplies with the coupling that it finds, while that is at hand.
struct Multiplied {
  const double* v = nullptr;     ///< (3 x sphere_count); null: nothing
  SlabTarget<double> product{};  ///< three rows, to which coupling times v is added
};

/// Axial elements of one law, or springs among Kelvin units (c = 0). Both ends advance by one sphere from place to
/// place, so that the loops gather no indices. Where a lattice row lacks a few elements, empty places with k = 0 bridge
/// the gap. An element between two slabs has a place in each; each place adds only to the spheres of its slab, so that
/// slabs never wait for each other.
struct AxialBatch {
  std::int32_t count;  ///< in [1, kBatch]
  std::int32_t place;  ///< first place
  std::int32_t a, b;   ///< ends of the first element
  /// Offset of its rows of `count` parameters: rest length, k, and c of Kelvin units.
  std::int32_t parameters;
  std::int32_t internal;  ///< first internal variable, of a batch of two-sphere TPMs
  bool adds_a, adds_b;    ///< whether ends a, b are the slab's own
  AxialLaw law;           ///< loops branch on it once per batch
};

/// What an implicit step needs of each two-sphere TPM, with c' = c over the step or over a share of it, after which an
/// elongation is wanted [N/m] (internal_count each).
struct KelvinStep {
  const double *damping, *sum, *stiffness;  ///< c'; k + kelvin_k + c'; k (kelvin_k + c') / sum
};

/// Arrays that the axial loops read and write. A pointer is null if the Model has no such array.
struct AxialArrays {
  std::size_t spheres;
  const double *x, *y, *z, *vx, *vy, *vz;  ///< (sphere_count)
  const double* parameters;
  const double* softness;            ///< (sphere_count)
  const std::int32_t* third;         ///< (place_count)
  const std::int32_t* element;       ///< row of Model::axial; arbitrary at places without an element (place_count)
  const std::uint8_t* severed;       ///< (axial_count)
  const double* kelvin_elongation;   ///< (internal_count)
  KelvinStep kelvin_step;            ///< of `h`, or of what find_kelvin() finds
  SlabTarget<double> force, blocks;  ///< three and six rows
  Multiplied multiplied;             ///< in a linearisation
  double h;
  bool with_dashpots;                        ///< the forces of a linearisation include those of dashpots
  float *root_x, *root_y, *root_z, *across;  ///< linearised coupling (place_count)
};

/// Lines of three spheres whose middle is pulled towards the midpoint of its ends: constraints and angle springs.
///
/// If the three spheres all advance by one from line to line, the lines form a row. A row ends before its three ranges
/// of spheres overlap. Places without a line (k = 0) may follow its last line, to fill whole vectors.
///
/// Lines with spheres in several slabs are in a batch of each of these slabs, which adds only to the spheres of its
/// slab. These batches have the same places, which the slab of the middle spheres writes.
struct LineBatch {
  std::int32_t count;           ///< lines, in [1, kBatch]
  std::int32_t places;          ///< in [count, kBatch]; `count` if not a row
  std::int32_t place;           ///< first place
  std::int32_t a, c, e;         ///< spheres of the first line; a is -1 if not a row
  bool adds_a, adds_c, adds_e;  ///< whether spheres a, c, e are the slab's own
};

/// How much the coupling of a batch of lines counts beside the masses: too little to be applied, too little for the
/// diagonal blocks, or enough for both.
enum class LineWeight : std::uint8_t { negligible, light, full };

struct LineArrays {
  std::size_t spheres;
  const double *x, *y, *z;           ///< (sphere_count)
  const std::int32_t *a, *c, *e;     ///< (place_count)
  const double* k;                   ///< (place_count)
  const std::int32_t* line;          ///< line of each place (place_count)
  const std::uint8_t* severed;       ///< (line_count) or null
  bool is_constraint;                ///< Eq. 2; otherwise an angle spring
  double* softness;                  ///< (sphere_count) or null
  const double* mass;                ///< (sphere_count)
  SlabTarget<double> force, blocks;  ///< three and six rows
  Multiplied multiplied;             ///< in a linearisation
  double h;
  double* lambda;  ///< of Eq. 2 without Eq. 8, or k of an angle spring [N/m] (place_count)
  float *along_x, *along_y, *along_z, *isotropic;  ///< linearised coupling (place_count)
};

/// Tissue cells all of whose corners advance by one sphere from cell to cell.
struct CellBatch {
  std::int32_t count;      ///< in [1, kBatch]
  std::int32_t cell;       ///< first row of Model::tissue_cells
  std::int32_t corner[8];  ///< corners of the first cell
};

/// Capacity of a row of edges.
inline constexpr std::int32_t kEdges = 32;

/// Lattice edges along one axis of the world. Both ends advance by one sphere from edge to edge.
struct EdgeRow {
  std::int32_t count;  ///< in [1, kEdges]
  std::int32_t axis;   ///< 0, 1, 2: x, y, z
  std::int32_t a, b;   ///< ends of the first edge
};

/// Positions [m] (sphere_count each).
struct Points {
  const double *x, *y, *z;
};

/// Lanes of the sweeps: the most spheres of a chunk.
inline constexpr std::int32_t kLanes = 16;

/// Coupling between the spheres of a chunk, one a lane, and as many consecutive ones of its slab. Lanes outside
/// [begin, end) have none.
struct SweepPiece {
  std::int32_t place;       ///< of lane 0
  std::int32_t across;      ///< sphere across from lane 0
  std::int32_t begin, end;  ///< lanes
};

/// Consecutive spheres of a slab that a sweep treats at once, with what couples them with later chunks, with earlier
/// ones, and with spheres beside them, whose coupling is lagged.
struct SweepChunk {
  std::int32_t first, count;  ///< count in [1, kLanes]
  const SweepPiece *later, *earlier, *beside, *end;
};

/// The chunks of a slab, whose spheres are [begin, end).
struct Sweep {
  const SweepChunk *first, *last;
  std::int32_t begin, end;
};

/// Linearised coupling of the axial elements, as in AxialArrays. Numbers from kLanes before the first place to kLanes
/// after the last one may be read.
struct SweepCoupling {
  const float *root_x, *root_y, *root_z, *across;
};

/// Arrays that the loops of the solver read and write; see solver::ConjugateGradient. Vectors are (3 x sphere_count),
/// and kLanes more numbers may be read. `factor` has L and the inverse of d of the blocks D = L diag(d) L^T, where
/// those have their entries: 1 / dx, lxy, lxz, 1 / dy, lyz, 1 / dz (6 x sphere_count).
template <class Real>
struct SolverArrays {
  std::size_t spheres;
  const Real* factor;
  Real *solution, *residual, *direction, *upward, *downward, *change, *lagged;
};

/// Loops of an iterative solver with vectors of Real, float or double. Ranges are of spheres.
template <class Real>
struct SolverKernels {
  /// As Kernels::apply_axial(), without what acts on a sphere by its own velocity.
  void (*apply_axial_across)(const AxialArrays&, const AxialBatch* first, const AxialBatch* last, const Real* v,
                             SlabTarget<Real> result);
  void (*apply_line)(const LineArrays&, const LineBatch&, const Real* v, SlabTarget<Real> result);
  /// Takes from `result` what acts on a sphere by its own velocity, which linearise_line() added to the blocks.
  void (*take_line_blocks)(const LineArrays&, const LineBatch&, const Real* v, SlabTarget<Real> result);
  /// Factors the symmetric 3x3 blocks of spheres [begin, end).
  void (*factor_blocks)(std::size_t spheres, const double* blocks, Real* factor, std::size_t begin, std::size_t end);
  /// solution = 0, direction = 0, residual = D (D + L)^-1 (scale * `first`); returns residual . D^-1 residual.
  double (*begin_solve)(const SolverArrays<Real>&, const SweepCoupling&, const Sweep&, const double* first,
                        double scale);
  /// direction = residual + turn * direction, upward = (D + U)^-1 direction, change = D upward.
  void (*sweep_up)(const SolverArrays<Real>&, const SweepCoupling&, const Sweep&, Real turn);
  /// downward = (D + L)^-1 (direction - change + N upward), change += D downward, where `lagged` has the part of N
  /// upward that is not of pieces. Returns direction . (upward + downward).
  double (*sweep_down)(const SolverArrays<Real>&, const SweepCoupling&, const Sweep&);
  /// solution += step * upward, residual -= step * change; returns residual . D^-1 residual.
  double (*descend)(const SolverArrays<Real>&, const Sweep&, Real step);
};

/// The inner loops, compiled once for each instruction set. Ranges are of batches or of spheres.
struct Kernels {
  void (*add_axial_forces)(const AxialArrays&, const AxialBatch* first, const AxialBatch* last);
  void (*linearise_axial)(const AxialArrays&, const AxialBatch* first, const AxialBatch* last);
  /// result += coupling times v.
  void (*apply_axial)(const AxialArrays&, const AxialBatch* first, const AxialBatch* last, const double* v,
                      SlabTarget<double> result);
  /// Writes Kelvin elongations [m] (internal_count).
  void (*find_kelvin)(const AxialArrays&, const AxialBatch* first, const AxialBatch* last, double* elongation);

  /// Computes lambda of lines whose middle spheres are in the slab, and the softness of those spheres (Eq. 8).
  void (*measure_line)(const LineArrays&, const LineBatch&);
  void (*add_line_forces)(const LineArrays&, const LineBatch&);
  LineWeight (*linearise_line)(const LineArrays&, const LineBatch&);

  SolverKernels<float> single;
  SolverKernels<double> full;
  /// product = mass * v; returns v . product.
  double (*multiply_mass)(std::size_t spheres, const double* mass, const double* v, double* product, std::size_t begin,
                          std::size_t end);
  /// product = b - product; returns product . product.
  double (*residual_from)(std::size_t spheres, const double* b, double* product, std::size_t begin, std::size_t end);
  /// Smallest squared distance of spheres [begin, end) from `centre`, infinity without spheres.
  double (*nearest_squared)(const double* x, const double* y, const double* z, const double* centre, std::size_t begin,
                            std::size_t end);
  /// Largest squared speed of spheres [begin, end) with velocities x, y, z, infinity if one is not a number.
  double (*fastest_squared)(const double* x, const double* y, const double* z, std::size_t begin, std::size_t end);
  /// least[row] = the least d - |d'| - |d''| [m] of a row's edges: d along its axis, d' and d'' along the others.
  void (*least_of_edges)(const Points&, const EdgeRow* first, const EdgeRow* last, double* least);
  /// least[i] = six times the least signed volume [m^3] of a cell's eight corner tetrahedra.
  void (*least_of_cells)(const Points&, const CellBatch&, double* least);
};

template <class Real>
const SolverKernels<Real>& solver_kernels(const Kernels& kernels) {
  if constexpr (sizeof(Real) == sizeof(float))
    return kernels.single;
  else
    return kernels.full;
}

/// The loops for `set`, or for the widest narrower set that this machine has.
const Kernels& kernels_for(InstructionSet set);

}  // namespace ctpm::elements
