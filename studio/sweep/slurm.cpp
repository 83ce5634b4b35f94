#include "studio/sweep/slurm.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "studio/output/files.h"
#include "studio/output/option_name.h"
#include "studio/output/printable.h"
#include "studio/sweep/plan.h"
#include "studio/sweep/process.h"
#include "studio/sweep/task_folder.h"

namespace ctpm::sweep {
namespace {

namespace fs = std::filesystem;

/// Output of a program of Slurm. Errors: it is not there; what it said.
Result<std::string> ask_slurm(const std::vector<std::string>& command) {
  const Result<ProcessOutput> output = run_process(command);
  if (!output)
    return Error{command.front(), output.errors().front().message, "Slurm must be installed where this is submitted"};
  if (output->code == 0) return output->out;
  const std::string said = output->err.substr(0, output->err.find_last_not_of("\n ") + 1);
  return Error{command.front(), "exit code " + std::to_string(output->code) + (said.empty() ? "" : ": " + said), ""};
}

/// One more than the largest index of an array.
Result<std::size_t> most_elements() {
  const Result<std::string> settings = ask_slurm({"scontrol", "show", "config"});
  if (!settings) return settings.errors();
  const std::string key = "MaxArraySize";
  const std::size_t at = settings->find(key);
  const std::size_t digits = at == std::string::npos ? at : settings->find_first_of("0123456789", at + key.size());
  std::size_t size = 0;
  if (digits != std::string::npos)
    std::from_chars(settings->data() + digits, settings->data() + settings->size(), size);
  if (size == 0) return Error{"scontrol", "says no MaxArraySize, or that arrays are not allowed", ""};
  return size;
}

/// The script of an element: a slice of the plan on as many processes as it has processors.
std::string job_script(const std::string& folder, std::size_t per_element) {
  const std::string count = std::to_string(per_element);
  return "#!/bin/sh\n# Written by ctpm sweep run: one element of a job array.\nexec " +
         output::shell_word(own_program()) + " sweep run " + output::shell_word(folder) + " " +
         option_word("from", "$((SLURM_ARRAY_TASK_ID * " + count + " + 1))") + " " +
         option_word("to", "$(((SLURM_ARRAY_TASK_ID + 1) * " + count + "))") + " " +
         option_word("jobs", "${SLURM_CPUS_PER_TASK:-1}") + "\n";
}

std::vector<std::string> sbatch_command(const SlurmRequest& request, const std::string& name, const std::string& folder,
                                        const std::string& array) {
  std::vector<std::string> command{"sbatch",
                                   option_word("parsable"),
                                   option_word("requeue"),
                                   option_word("open-mode", "append"),
                                   option_word("job-name", name),
                                   option_word("array", array),
                                   option_word("output", folder + "/slurm/%A_%a.log")};
  if (!request.partition.empty()) command.push_back(option_word("partition", request.partition));
  if (!request.time.empty()) command.push_back(option_word("time", request.time));
  if (!request.memory.empty()) command.push_back(option_word("mem", request.memory));
  command.insert(command.end(), request.options.begin(), request.options.end());
  command.push_back(folder + "/slurm/job.sh");
  return command;
}

/// Sessions of one element.
Result<std::size_t> slice_size(const SlurmRequest& request, std::size_t tasks, std::size_t most) {
  const std::size_t least = (tasks + most - 1) / most;
  const std::size_t asked = std::size_t(request.tasks_per_element);
  if (asked == 0) return least;
  if (asked < least)
    return Error{output::option_name("slurm.tasks_per_element"),
                 "got " + std::to_string(asked) + ", which makes more elements than Slurm's MaxArraySize of " +
                     std::to_string(most),
                 "take at least " + std::to_string(least)};
  return asked;
}

}  // namespace

std::string array_text(const std::vector<std::size_t>& indices) {
  std::string text;
  for (std::size_t first = 0; first < indices.size();) {
    std::size_t last = first;
    while (last + 1 < indices.size() && indices[last + 1] == indices[last] + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(indices[first]);
    if (last > first) text += "-" + std::to_string(indices[last]);
    first = last + 1;
  }
  return text;
}

Result<Submission> submit_to_slurm(const SlurmRequest& request) {
  const Result<Plan> plan = read_plan(request.folder);
  if (!plan) return plan.errors();
  const Result<std::size_t> most = most_elements();
  if (!most) return most.errors();
  const Result<std::size_t> size = slice_size(request, plan->tasks.size(), *most);
  if (!size) return size.errors();
  Submission submission;
  submission.tasks_per_element = *size;
  std::vector<std::size_t> elements;
  for (std::size_t task = 0; task < plan->tasks.size(); ++task) {
    if (is_finished(request.folder, plan->tasks[task].id)) continue;
    ++submission.waiting;
    if (elements.empty() || elements.back() != task / *size) elements.push_back(task / *size);
  }
  submission.elements = elements.size();
  if (elements.empty()) return submission;
  const std::string folder = fs::absolute(request.folder).lexically_normal().string();
  std::error_code failure;
  fs::create_directories(folder + "/slurm", failure);
  if (Result<Done> written = output::write_text_file(folder + "/slurm/job.sh", job_script(folder, *size)); !written)
    return written.errors();
  const Result<std::string> job = ask_slurm(sbatch_command(request, plan->name, folder, array_text(elements)));
  if (!job) return job.errors();
  submission.job = job->substr(0, job->find_first_of(";\n"));
  return submission;
}

}  // namespace ctpm::sweep
