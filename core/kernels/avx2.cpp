#define CTPM_KERNELS avx2
#include "core/kernels/loops.h"
