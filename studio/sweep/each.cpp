#include "studio/sweep/each.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/model/errors.h"
#include "recordings/byte_hash.h"
#include "recordings/session.h"
#include "studio/output/files.h"
#include "studio/sweep/process.h"

namespace ctpm::sweep {
namespace {

namespace fs = std::filesystem;

constexpr const char *kSession = "{}", *kFolder = "{out}";

/// Commands that read a session, and what they are given where nothing names the folder.
const std::map<std::string, std::vector<std::string>> kCommands{{"verify", {}},
                                                                {"info", {}},
                                                                {"export", {option_word("output", "{out}/film.mp4")}},
                                                                {"compare", {option_word("output", "{out}/compare")}}};

bool any_holds(const std::vector<std::string>& words, const std::string& part) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return word.find(part) != std::string::npos; });
}

std::string replaced(std::string word, const std::string& part, const std::string& by) {
  for (std::size_t at = 0; (at = word.find(part, at)) != std::string::npos; at += by.size())
    word.replace(at, part.size(), by);
  return word;
}

std::string absolute(const std::string& path) { return fs::absolute(path).lexically_normal().string(); }

/// Names what a task does by its content: the command, the files that it names, the session.
Result<std::string> id_of(const std::vector<std::string>& command, const std::string& session) {
  std::string content = "ctpm-each 1\n" + std::to_string(kPhysicsRevision) + "\n";
  std::vector<std::string> words = command;
  words.push_back(session);
  for (const std::string& word : words) {
    content += std::to_string(word.size()) + ":" + word + "\n";
    std::error_code ignored;
    if (word != session && !fs::is_regular_file(word, ignored)) continue;
    const Result<std::uint64_t> hash = recordings::file_hash(word);
    if (!hash) return hash.errors();
    content += recordings::hash_text(*hash) + "\n";
  }
  recordings::ByteHash hash;
  hash.add(content.data(), content.size());
  return recordings::hash_text(hash.value());
}

/// The trainee's measures of a comparison; none where there is none.
void add_measures(const std::string& file, TaskResult& result) {
  const Result<std::string> text = output::read_text_file(file);
  if (!text) return;
  const auto json = nlohmann::ordered_json::parse(*text, nullptr, false);
  if (!json.is_object() || !json.contains("measures")) return;
  for (const auto& measure : json["measures"])
    if (measure.contains("key") && measure.contains("trainee") && measure["trainee"].is_number())
      result.values.emplace_back(measure["key"], measure["trainee"].get<double>());
}

/// The last line that says something.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n');
  if (end == std::string::npos) return "";
  const std::size_t before = text.rfind('\n', end);
  return text.substr(before == std::string::npos ? 0 : before + 1,
                     end + 1 - (before == std::string::npos ? 0 : before + 1));
}

}  // namespace

Result<Plan> plan_each(const std::vector<std::string>& command, const std::vector<std::string>& sessions) {
  const auto known = command.empty() ? kCommands.end() : kCommands.find(command.front());
  if (known == kCommands.end()) {
    std::string names;
    for (const auto& [name, more] : kCommands) names += (names.empty() ? "" : ", ") + name;
    return Error{command.empty() ? "each" : command.front(), "is no command that is run on each session",
                 "one of " + names};
  }
  Plan plan;
  plan.name = command.front(), plan.columns = {"session_file"}, plan.is_number = {false};
  plan.command = command;
  for (std::string& word : plan.command) {
    std::error_code ignored;
    if (fs::is_regular_file(word, ignored)) word = absolute(word);
  }
  if (!any_holds(plan.command, kFolder))
    plan.command.insert(plan.command.end(), known->second.begin(), known->second.end());
  if (!any_holds(plan.command, kSession) || !std::count(plan.command.begin(), plan.command.end(), kSession))
    plan.command.push_back(kSession);
  Errors errors;
  std::map<std::string, std::string> seen;
  for (const std::string& session : sessions) {
    const Result<std::string> id = id_of(plan.command, absolute(session));
    if (!id)
      append(errors, id);
    else if (!seen.emplace(*id, session).second)
      errors.push_back({session, "is there twice", ""});
    else
      plan.tasks.push_back({*id, {absolute(session)}});
  }
  if (sessions.empty()) errors.push_back({command.front(), "is given no session", ""});
  if (!errors.empty()) return errors;
  return plan;
}

Result<std::optional<TaskResult>> run_each(const Plan& plan, std::size_t task, const Claim& claim) {
  const std::string session = plan.tasks[task].shown.front();
  const Result<std::string> id = id_of(plan.command, session);
  if (!id) return id.errors();
  if (*id != plan.tasks[task].id)
    return Error{session, "or a file that the command names has changed since it was planned", "plan it again"};
  std::vector<std::string> words{own_program()};
  for (const std::string& word : plan.command)
    words.push_back(word == kSession ? session : replaced(word, kFolder, claim.folder()));
  const Result<ProcessOutput> output = run_process(words, claim.lock());
  if (!output) return output.errors();
  if (output->code >= 128) return std::optional<TaskResult>();
  for (const auto& [name, text] : {std::pair("out.txt", &output->out), std::pair("err.txt", &output->err)})
    if (const Result<Done> written = output::write_text_file(claim.folder() + "/" + name, *text); !written)
      return written.errors();
  TaskResult result;
  result.is_good = output->code == 0;
  result.processor_s = output->processor_s;
  if (!result.is_good)
    result.error =
        "exit code " + std::to_string(output->code) + ": " + last_line(output->err.empty() ? output->out : output->err);
  result.values = {{"exit_code", double(output->code)}};
  add_measures(claim.folder() + "/compare/results.json", result);
  return std::optional(std::move(result));
}

}  // namespace ctpm::sweep
