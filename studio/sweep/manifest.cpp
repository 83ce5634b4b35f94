#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "studio/output/files.h"
#include "studio/output/json_writer.h"
#include "studio/reports/report.h"
#include "studio/sweep/plan.h"

namespace ctpm::sweep {
namespace {

constexpr const char* kFormat = "ctpm-sweep-manifest";

std::string manifest_json(const Plan& plan) {
  output::JsonWriter json;
  json.begin_object().member("format", kFormat).member("version", 1);
  json.member("sweep", std::string_view(plan.file)).member("name", std::string_view(plan.name));
  json.key("command").begin_list();
  for (const std::string& word : plan.command) json.value(std::string_view(word));
  json.end_list().key("columns").begin_list();
  for (std::size_t i = 0; i < plan.columns.size(); ++i)
    json.begin_object()
        .member("name", std::string_view(plan.columns[i]))
        .member("is_number", bool(plan.is_number[i]))
        .end_object();
  json.end_list().key("tasks").begin_list();
  for (const Task& task : plan.tasks) {
    json.begin_object().member("id", std::string_view(task.id)).key("values").begin_list();
    for (const std::string& value : task.shown) json.value(std::string_view(value));
    json.end_list().end_object();
  }
  return json.end_list().end_object().text();
}

reports::Table manifest_table(const Plan& plan) {
  reports::Table table;
  table.columns = {{"task", "task"}, {"id", "id"}};
  for (const std::string& column : plan.columns) table.columns.push_back({column, column});
  for (std::size_t i = 0; i < plan.tasks.size(); ++i) {
    std::vector<reports::Cell> row{std::int64_t(i + 1), plan.tasks[i].id};
    for (const std::string& value : plan.tasks[i].shown) row.emplace_back(value);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

Result<Done> write_plan(const Plan& plan, const std::string& folder) {
  if (const Result<Plan> before = read_plan(folder);
      before && (before->file != plan.file || before->command != plan.command))
    return Error{folder, "holds another plan: " + (before->file.empty() ? before->name : before->file),
                 "choose another folder"};
  if (Result<Done> ready = reports::prepare_folder(folder); !ready) return ready;
  return reports::write_report(
      folder, {{"manifest.csv", reports::to_csv(manifest_table(plan))}, {"manifest.json", manifest_json(plan)}});
}

Result<Plan> read_plan(const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / "manifest.json").string();
  const Result<std::string> text = output::read_text_file(path);
  std::error_code ignored;
  if (!text)
    return Error{folder, std::filesystem::exists(folder, ignored) ? "holds no plan" : "does not exist",
                 "ctpm sweep plan writes one"};
  const nlohmann::json json = nlohmann::json::parse(*text, nullptr, false);
  try {
    if (json.at("format") != kFormat || json.at("version") != 1) return Error{path, "is no plan of this program", ""};
    Plan plan;
    plan.file = json.at("sweep"), plan.name = json.at("name");
    plan.command = json.at("command").get<std::vector<std::string>>();
    for (const nlohmann::json& column : json.at("columns"))
      plan.columns.push_back(column.at("name")), plan.is_number.push_back(column.at("is_number"));
    for (const nlohmann::json& task : json.at("tasks"))
      plan.tasks.push_back({task.at("id"), task.at("values").get<std::vector<std::string>>()});
    return plan;
  } catch (const nlohmann::json::exception&) {
    return Error{path, "is damaged", "plan the sweep again: what is done stays"};
  }
}

}  // namespace ctpm::sweep
