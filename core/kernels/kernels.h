#pragma once

#include <cstddef>
#include <cstdint>

namespace ctpm {

/// Vector instructions that the inner loops may use. All give the same bits: every lane does what scalar code does, in
/// the same order, and nothing is contracted.
enum class InstructionSet : std::int32_t { baseline = 0, avx2 = 1, avx512 = 2 };

/// The widest that this machine has.
InstructionSet best_instruction_set();

/// "baseline", "avx2", "avx512".
const char* name_of(InstructionSet set);

/// Most elements of a batch; what a loop keeps of a batch stays in the first cache.
inline constexpr std::int32_t kBatch = 64;

/// What gives an axial element its tension.
enum class AxialLaw : std::int32_t { spring, spring_and_dashpot, two_sphere_tpm };

/// Axial elements of one law whose two ends both advance by one sphere, so that loops need no index gathers.
struct AxialBatch {
  std::int32_t count;       ///< in [1, kBatch]
  std::int32_t first;       ///< element
  std::int32_t a, b;        ///< ends of the first element
  std::int32_t parameters;  ///< where its rows of `count` parameters begin: rest length, k, c; or rest length, K2, K1, v1
  AxialLaw law;
};

/// What the axial loops read and write. Pointers are null where the Model has no such thing.
struct AxialArrays {
  std::size_t spheres;
  const double *x, *y, *z, *vx, *vy, *vz;  ///< (sphere_count)
  const double* parameters;
  const double* softness;     ///< (sphere_count)
  const std::int32_t* third;  ///< (element_count)
  const std::uint8_t *edge_severed, *tpm_severed;
  const double* kelvin_elongation;  ///< (tpm_count)
  std::int32_t edge_count;
  double* force;   ///< (3 x sphere_count)
  double* blocks;  ///< (6 x sphere_count)
  double h;
  double *root_x, *root_y, *root_z, *across;  ///< linearised coupling (element_count)
};

/// Lines of three spheres whose middle is drawn towards the middle of its ends: constraints and angle springs.
struct LineBatch {
  std::int32_t count;    ///< in [1, kBatch]
  std::int32_t first;    ///< line
  std::int32_t a, c, e;  ///< spheres of the first line; a is -1 if the lines' spheres do not all advance by one
};

struct LineArrays {
  std::size_t spheres;
  const double *x, *y, *z;          ///< (sphere_count)
  const std::int32_t *a, *c, *e;    ///< (line_count)
  const double* k;                  ///< (line_count)
  const std::uint8_t* severed;      ///< (line_count) or null
  bool is_constraint;               ///< Eq. 2; if not, an angle spring
  double* softness;                 ///< (sphere_count) or null
  const double* mass;               ///< (sphere_count)
  double* force;                    ///< (3 x sphere_count)
  double* blocks;                   ///< (6 x sphere_count)
  double h;
  double *ux, *uy, *uz, *half;      ///< u and |E - A| / 2 (line_count)
  double *along_x, *along_y, *along_z, *isotropic;  ///< linearised coupling (line_count)
};

/// What the solver's loops read and write; vectors are (3 x sphere_count), `inverse` is (6 x sphere_count).
struct SolverArrays {
  std::size_t spheres;
  const double* mass;  ///< (sphere_count)
  const double* inverse;
  double *solution, *residual, *preconditioned, *direction, *product;
};

/// The inner loops, compiled once for each instruction set. Ranges are of batches or of spheres.
struct Kernels {
  void (*add_axial_forces)(const AxialArrays&, const AxialBatch* first, const AxialBatch* last);
  void (*linearise_axial)(const AxialArrays&, const AxialBatch* first, const AxialBatch* last);
  void (*apply_axial)(const AxialArrays&, const AxialBatch* first, const AxialBatch* last, const double* v,
                      double* result);

  /// u and half length of every line, and the softness of the middle spheres (Eq. 8).
  void (*measure_line)(const LineArrays&, const LineBatch&);
  void (*add_line_forces)(const LineArrays&, const LineBatch&);
  /// False: the coupling is too small to matter.
  bool (*linearise_line)(const LineArrays&, const LineBatch&);
  void (*apply_line)(const LineArrays&, const LineBatch&, const double* v, double* result);

  /// Inverts the symmetric 3x3 blocks of spheres [begin, end).
  void (*invert_blocks)(std::size_t spheres, const double* blocks, double* inverse, std::size_t begin, std::size_t end);
  /// residual = b - product, preconditioned, direction = 0; returns residual . preconditioned.
  double (*begin_solve)(const SolverArrays&, const double* b, std::size_t begin, std::size_t end);
  double (*curvature)(const SolverArrays&, std::size_t begin, std::size_t end);  ///< direction . product
  /// Goes `step` along the direction; returns residual . preconditioned.
  double (*descend)(const SolverArrays&, double step, std::size_t begin, std::size_t end);
  /// direction = preconditioned + turn * direction, product = mass * direction.
  void (*turn)(const SolverArrays&, double turn, std::size_t begin, std::size_t end);
  /// product = mass * v.
  void (*multiply_mass)(const SolverArrays&, const double* v, std::size_t begin, std::size_t end);
  /// Largest squared speed of velocities v (3 x sphere_count), infinity if one is not a number.
  double (*fastest_squared)(std::size_t spheres, const double* v, std::size_t begin, std::size_t end);
};

/// The loops for a set that this machine has; the nearest narrower one if it has not.
const Kernels& kernels_for(InstructionSet set);

}  // namespace ctpm
