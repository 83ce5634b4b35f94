#include "core/step.h"
