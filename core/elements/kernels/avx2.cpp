#define CTPM_KERNELS avx2
#include "core/elements/kernels/loops.h"
