#include "core/elements/kernels/kernels.h"

namespace ctpm::elements {

namespace baseline {
extern const Kernels kernels;
}
#ifdef CTPM_HAS_AVX
namespace avx2 {
extern const Kernels kernels;
}
namespace avx512 {
extern const Kernels kernels;
}
#endif

InstructionSet best_instruction_set() {
#ifdef CTPM_HAS_AVX
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq"))
    return InstructionSet::avx512;
  if (__builtin_cpu_supports("avx2")) return InstructionSet::avx2;
#endif
  return InstructionSet::baseline;
}

const char* name_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return "avx512";
    case InstructionSet::avx2:
      return "avx2";
    default:
      return "baseline";
  }
}

const Kernels& kernels_for(InstructionSet set) {
#ifdef CTPM_HAS_AVX
  const InstructionSet best = best_instruction_set();
  const InstructionSet chosen = set < best ? set : best;
  if (chosen == InstructionSet::avx512) return avx512::kernels;
  if (chosen == InstructionSet::avx2) return avx2::kernels;
#else
  (void)set;
#endif
  return baseline::kernels;
}

}  // namespace ctpm::elements
