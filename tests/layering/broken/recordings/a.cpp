#include "scenes/x.h"
