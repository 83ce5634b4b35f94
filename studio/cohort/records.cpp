#include "studio/cohort/records.h"

#include <cctype>
#include <cstdio>

#include "recordings/pseudonym.h"
#include "studio/compare/measure_table.h"
#include "studio/output/json_writer.h"
#include "studio/session/session_info.h"

namespace ctpm::cohort {
namespace {

/// Bytes of a name that may stand in an address as they are; the others as %XX (RFC 3986).
std::string in_address(const std::string& name) {
  std::string text;
  for (const char c : name) {
    char code[4];
    std::snprintf(code, sizeof code, "%%%02X", unsigned(static_cast<unsigned char>(c)));
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.' || c == '_' || c == '~';
    text += is_plain ? std::string(1, c) : std::string(code);
  }
  return text;
}

/// JSON in one line: newlines and the spaces behind them are layout, because texts hold none.
std::string in_one_line(const std::string& json) {
  std::string line;
  for (std::size_t i = 0; i < json.size(); ++i) {
    if (json[i] != '\n') {
      line += json[i];
      continue;
    }
    while (i + 1 < json.size() && json[i + 1] == ' ') ++i;
  }
  return line + "\n";
}

struct Verb {
  const char *address, *word;
};

Verb verb_of(const Attempt& attempt) {
  if (!attempt.passed) return {"http://adlnet.gov/expapi/verbs/completed", "completed"};
  if (*attempt.passed) return {"http://adlnet.gov/expapi/verbs/passed", "passed"};
  return {"http://adlnet.gov/expapi/verbs/failed", "failed"};
}

void write_words(output::JsonWriter& json, const char* key, const std::string& words) {
  json.key(key).begin_object().member("en", std::string_view(words)).end_object();
}

std::string statement_of(const Cohort& cohort, const TaskResult& task, const Attempt& attempt,
                         const std::string& home) {
  const std::string activity =
      home + "/courses/" + in_address(cohort.course.name) + "/tasks/" + in_address(task.task.name);
  const Verb verb = verb_of(attempt);
  output::JsonWriter json;
  json.begin_object();
  const std::string id = recordings::name_uuid(activity + "#" + attempt.session.session_id);
  if (!id.empty()) json.member("id", std::string_view(id));
  json.key("actor").begin_object().member("objectType", "Agent").key("account").begin_object();
  json.member("homePage", std::string_view(home)).member("name", std::string_view(attempt.session.person));
  json.end_object().end_object().key("verb").begin_object().member("id", verb.address);
  write_words(json, "display", verb.word);
  json.end_object().key("object").begin_object().member("objectType", "Activity");
  json.member("id", std::string_view(activity)).key("definition").begin_object();
  json.member("type", "http://adlnet.gov/expapi/activities/simulation");
  write_words(json, "name", task.task.name);
  json.end_object().end_object().key("result").begin_object();
  if (attempt.passed) json.member("success", *attempt.passed);
  char duration[40];
  std::snprintf(duration, sizeof duration, "PT%.2fS", attempt.duration_s);
  json.member("completion", true).member("duration", duration).key("extensions").begin_object();
  for (const compare::SessionValue& value : attempt.values)
    if (value.value) json.member(home + "/measures/" + value.measure->key, *value.value);
  json.end_object().end_object().key("context").begin_object().member("platform", "ctpm " CTPM_VERSION);
  json.key("extensions").begin_object();
  json.member(home + "/session", std::string_view(attempt.session.session_id));
  json.member(home + "/attempt", attempt.session.attempt);
  json.member(home + "/validated", !cohort.course.evidence.empty());
  json.end_object().end_object();
  if (!attempt.session.is_elapsed)
    json.member("timestamp", std::string_view(session::utc_text(attempt.session.begun_s)));
  return in_one_line(json.end_object().text());
}

}  // namespace

namespace {

/// The rows of one session: its measures, and those of each organ and forbidden zone.
void add_rows(reports::Table& table, const Cohort& cohort, const TaskResult& task, const Attempt& attempt,
              const char* role) {
  const FoundSession& s = attempt.session;
  const auto add = [&](const compare::Measure& measure, std::optional<double> value, const std::string& note,
                       const std::string& structure) {
    table.rows.push_back({cohort.course.name, task.task.name, std::string(role), s.person, std::int64_t(s.attempt),
                          s.session_id, s.file, s.begun_s, attempt.duration_s, std::string(measure.key),
                          std::string(measure.unit), value ? reports::Cell(*value) : reports::Cell(), note,
                          attempt.passed ? reports::Cell(std::int64_t(*attempt.passed)) : reports::Cell(), structure});
  };
  for (const compare::SessionValue& value : attempt.values)
    add(*value.measure, value.value, value.value ? "" : value.note, "");
  for (const compare::StructureLoad& load : attempt.structures) {
    const std::string name = (load.is_zone ? "zone " : "organ ") + load.name;
    add(compare::kPeakForce, load.peak, "", name);
    add(compare::kImpulse, load.impulse, "", name);
    add(compare::kWork, 1e3 * load.work, "", name);
  }
}

}  // namespace

reports::Table long_table(const Cohort& cohort) {
  reports::Table table;
  table.columns = {{"course", "course"},     {"task", "task"},         {"role", "role"},
                   {"person", "person"},     {"attempt", "attempt"},   {"session_id", "session"},
                   {"session", "file"},      {"begun_s", "begun [s]"}, {"duration_s", "duration [s]"},
                   {"measure", "measure"},   {"unit", "unit"},         {"value", "value"},
                   {"no_value", "no value"}, {"passed", "passed"},     {"structure", "structure"}};
  for (const TaskResult& task : cohort.tasks) {
    for (const Attempt& expert : task.experts) add_rows(table, cohort, task, expert, "expert");
    for (const Attempt& attempt : task.attempts) add_rows(table, cohort, task, attempt, "trainee");
  }
  return table;
}

std::string statements(const Cohort& cohort, const std::string& home) {
  std::string lines;
  for (const TaskResult& task : cohort.tasks)
    for (const Attempt& attempt : task.attempts) lines += statement_of(cohort, task, attempt, home);
  return lines;
}

}  // namespace ctpm::cohort
