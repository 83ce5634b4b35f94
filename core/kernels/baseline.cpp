#define CTPM_KERNELS baseline
#include "core/kernels/loops.h"
