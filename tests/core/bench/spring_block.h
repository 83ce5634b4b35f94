#pragma once

namespace ctpm::testing {

/// Registers benchmarks of a hanging block of masses and springs, as other engines were measured on it: cubes of
/// 10, 22 and 46 masses of 1.83 g along an edge, 12 mm apart, the top held. Neighbours are joined by 188.5 N/m with
/// dashpots of 0.5 N s/m, second neighbours along the lattice by 251 N/m. For a second, its weight pulls, and 0.13 N at
/// the middle of the bottom. "ns" is processor time of one thread per spring and millisecond, "error" the largest
/// deviation of the loaded mass over its largest displacement from CVODE at rtol 1e-10 (not at 46).
void add_spring_blocks();

}  // namespace ctpm::testing
