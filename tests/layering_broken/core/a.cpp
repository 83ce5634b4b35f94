#include "studio/x.h"
