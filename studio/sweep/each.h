#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/sweep/plan.h"
#include "studio/sweep/task_folder.h"

namespace ctpm::sweep {

/// A plan that runs a command of this program on each of many sessions. `command` is its name and arguments; `{}` among
/// them stands for the session and `{out}` for the folder of its task. Where they are left out, the session comes last,
/// and `export` and `compare` write to that folder. Errors: a command that reads no session; a session that is missing,
/// or there twice.
Result<Plan> plan_each(const std::vector<std::string>& command, const std::vector<std::string>& sessions);

/// Runs the command of a plan for one task as a process of its own, into the claimed folder, whose out.txt and err.txt
/// keep what it printed. The result has the exit code, and of `compare` the trainee's measures. None if a signal ended
/// it. Errors: it cannot be started; the session is not what it was when this was planned.
Result<std::optional<TaskResult>> run_each(const Plan& plan, std::size_t task, const Claim& claim);

}  // namespace ctpm::sweep
