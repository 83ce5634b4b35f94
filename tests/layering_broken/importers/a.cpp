#include "core/eigen.h"
