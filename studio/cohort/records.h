#pragma once

#include <string>

#include "studio/cohort/cohort.h"
#include "studio/reports/table.h"

namespace ctpm::cohort {

/// One row for each measure of each session, experts first: the long table.
reports::Table long_table(const Cohort& cohort);

/// xAPI 1.0.3 statements of all attempts, one in a line: that somebody passed, failed or completed a task, with its
/// measures as extensions. People are accounts below the address `home`, without mail; sessions without wall-clock
/// times have no timestamp. Statements of the same sessions have the same ids.
std::string statements(const Cohort& cohort, const std::string& home);

}  // namespace ctpm::cohort
