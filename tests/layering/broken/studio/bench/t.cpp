#include <gtest/gtest.h>
#include "tests/x.h"
