#pragma once

namespace ctpm::render {

#if defined(__x86_64__)
template <class Loop>
__attribute__((target("avx2"))) inline void run_in_avx2(Loop loop) {
  loop();
}
inline bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2");
  return has;
}
#endif

/// Runs a loop over pixels, compiled once more for the processor's wide instructions where it has them. `loop` is a
/// lambda marked CTPM_WIDE_LOOP that captures by value, so that what it writes cannot change what it captured. The
/// results are the same to the bit, since nothing is contracted.
template <class Loop>
inline void run_wide(Loop loop) {
#if defined(__x86_64__)
  if (has_avx2()) return run_in_avx2(loop);
#endif
  loop();
}

}  // namespace ctpm::render

#define CTPM_WIDE_LOOP __attribute__((always_inline))
