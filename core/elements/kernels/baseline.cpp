#define CTPM_KERNELS baseline
#include "core/elements/kernels/loops.h"
