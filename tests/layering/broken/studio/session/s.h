#include "studio/devices/d.h"
