#define CTPM_KERNELS avx512
#include "core/elements/kernels/loops.h"
