#define CTPM_KERNELS avx512
#include "core/kernels/loops.h"
