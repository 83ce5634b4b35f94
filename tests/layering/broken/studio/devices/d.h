#include <openigtlink/igtl_header.h>
#include "studio/session/s.h"
