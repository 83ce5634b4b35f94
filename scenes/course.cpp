#include "scenes/course.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "scenes/course_keys.h"
#include "scenes/field_reader.h"
#include "scenes/json_text.h"

namespace ctpm::scenes {
namespace {

namespace fs = std::filesystem;

void check_mark(Problems& problems, const std::string& at, const MarkSpec& mark,
                const std::vector<std::string>& measures) {
  if (problems.is_good(at + "/measure") && std::ranges::find(measures, mark.measure) == measures.end()) {
    const std::string nearest = nearest_word(mark.measure, measures);
    problems.add_rule(
        at + "/measure", "there is no measure " + in_quotes(mark.measure),
        nearest.empty() ? "the JSON of ctpm compare lists them" : "did you mean " + in_quotes(nearest) + "?");
  }
  const auto in_order = [&](const char* low_key, std::optional<double> low, const char* high_key,
                            std::optional<double> high) {
    if (low && high && problems.are_good(at, {low_key, high_key}) && !(*low < *high))
      problems.add_rule(at + "/" + high_key, std::string("must be above ") + low_key);
  };
  in_order("low", mark.low, "high", mark.high);
  in_order("pass_at_least", mark.pass_at_least, "pass_at_most", mark.pass_at_most);
  for (const auto& [key, pass] : {std::pair("pass_at_least", mark.pass_at_least), {"pass_at_most", mark.pass_at_most}})
    if (pass && problems.are_good(at, {"low", "high"}) && problems.is_good(at + "/" + key) &&
        ((mark.low && *pass < *mark.low) || (mark.high && *pass > *mark.high)))
      problems.add_rule(at + "/" + key, "lies outside the declared range");
}

void check_tasks(Problems& problems, const CourseSpec& course, const std::vector<std::string>& measures) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < course.tasks.size(); ++i) {
    const TaskSpec& task = course.tasks[i];
    const std::string at = "/tasks/" + std::to_string(i);
    if (problems.is_good(at + "/name") && !names.insert(task.name).second)
      problems.add_rule(at + "/name", "got " + in_quotes(task.name) + ", which is taken already");
    std::set<std::string> marked;
    for (std::size_t k = 0; k < task.marks.size(); ++k) {
      const std::string mark = at + "/marks/" + std::to_string(k);
      check_mark(problems, mark, task.marks[k], measures);
      if (problems.is_good(mark + "/measure") && !marked.insert(task.marks[k].measure).second)
        problems.add_rule(mark + "/measure", "got " + in_quotes(task.marks[k].measure) + " twice");
    }
  }
}

struct CourseDraft {
  CourseSpec course;
  Problems problems;
};

Result<CourseDraft> read_draft(std::string_view text, const std::string& file_name,
                               const std::vector<std::string>& measures) {
  Result<JsonNode> parsed = parse_json(text, file_name);
  if (!parsed) return parsed.errors();
  const auto root = std::make_shared<const JsonNode>(*std::move(parsed));
  CourseDraft draft{{}, Problems(TextPlaces(root, file_name))};
  FieldReader::read_record(*root, "", draft.problems, draft.course);
  check_tasks(draft.problems, draft.course, measures);
  const LearningSpec& learning = draft.course.learning;
  if (draft.problems.are_good("/learning", {"acceptable_failures", "unacceptable_failures"}) &&
      !(learning.acceptable < learning.unacceptable))
    draft.problems.add_rule("/learning/unacceptable_failures", "must be above acceptable_failures");
  return draft;
}

/// Finds the files of a course, and makes their paths those of the program.
void find_files(CourseDraft& draft, const fs::path& folder) {
  for (std::size_t i = 0; i < draft.course.tasks.size(); ++i) {
    TaskSpec& task = draft.course.tasks[i];
    const std::string at = "/tasks/" + std::to_string(i);
    const auto find = [&](const char* key, std::string& path, const char* what, bool (*is)(const fs::path&)) {
      if (!draft.problems.is_good(at + "/" + key)) return;
      const fs::path found = (folder / path).lexically_normal();
      if (!is(found))
        draft.problems.add_rule(at + "/" + key, std::string("there is no ") + what + " " + in_quotes(path),
                                "looked for " + found.string());
      path = found.string();
    };
    find("scene", task.scene, "scene file", [](const fs::path& path) {
      std::error_code failure;
      return fs::is_regular_file(path, failure);
    });
    find("experts", task.experts, "folder", [](const fs::path& path) {
      std::error_code failure;
      return fs::is_directory(path, failure);
    });
  }
}

Result<CourseSpec> without_errors(CourseDraft draft) {
  if (!draft.problems.is_empty()) return draft.problems.errors();
  return std::move(draft.course);
}

}  // namespace

Result<CourseSpec> read_course(std::string_view text, const std::string& file_name,
                               const std::vector<std::string>& measures) {
  Result<CourseDraft> draft = read_draft(text, file_name, measures);
  if (!draft) return draft.errors();
  return without_errors(std::move(*draft));
}

Result<CourseSpec> load_course(const std::string& path, const std::vector<std::string>& measures) {
  const Result<std::string> text = text_of_file(path);
  if (!text) return text.errors();
  Result<CourseDraft> draft = read_draft(*text, path, measures);
  if (!draft) return draft.errors();
  find_files(*draft, fs::path(path).parent_path());
  return without_errors(std::move(*draft));
}

bool is_course(const std::string& path) {
  const Result<std::string> text = text_of_file(path);
  if (!text) return false;
  const Result<JsonNode> root = parse_json(*text, path);
  const JsonNode* format = root ? root->find("format") : nullptr;
  return format != nullptr && format->text == course_format_name;
}

}  // namespace ctpm::scenes
