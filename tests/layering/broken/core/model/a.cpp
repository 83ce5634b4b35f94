#include "core/solver/b.h"
#include "studio/render/x.h"
