#include "core/surface/eigen.h"
