#include "scenes/sweep.h"

#include <cmath>
#include <memory>
#include <set>

#include "scenes/field_reader.h"
#include "scenes/json_text.h"
#include "scenes/sweep_keys.h"

namespace ctpm::scenes {
namespace {

/// Columns that results have beside those of the axes.
const std::set<std::string> kOwnColumns{"task", "id", "state", "error", "session", "seed", "ticks_hash"};

void check_range(Problems& problems, const std::string& at, const SweepAxis& axis, SweepMethod method) {
  if (!problems.are_good(at, {"values", "from", "to", "steps", "scale"})) return;
  const bool has_range = axis.from || axis.to;
  if (axis.values.empty() != has_range)
    problems.add_rule(at, has_range ? "has values and a range" : "has neither values nor a range",
                      "give values, or from and to");
  else if (has_range && !(axis.from && axis.to))
    problems.add_rule(at, "a range needs from and to");
  else if (has_range && *axis.from >= *axis.to)
    problems.add_rule(at + "/to", "must be more than from");
  else if (has_range && axis.scale == SweepScale::logarithmic && *axis.from <= 0)
    problems.add_rule(at + "/from", "must be more than 0 on a logarithmic scale");
  if (has_range && method == SweepMethod::list)
    problems.add_rule(at, "a list takes values, not a range", "\"method\": \"grid\" or \"latin-hypercube\"");
  if (has_range && method == SweepMethod::grid && !axis.steps) problems.add_rule(at, "a range of a grid needs steps");
  if (axis.steps && (!has_range || method != SweepMethod::grid))
    problems.add_rule(at + "/steps", "belongs to a range of a grid");
}

void check_axis(Problems& problems, const std::string& at, const SweepAxis& axis, const SweepSpec& sweep) {
  check_range(problems, at, axis, sweep.method);
  if (!axis.key.empty() && axis.key.front() != '/')
    problems.add_rule(at + "/key", "got " + in_quotes(axis.key) + ", must begin with /",
                      "a JSON pointer, as /organs/0/fill/radius_mm");
  if (axis.key.empty() && (axis.from || axis.to))
    problems.add_rule(at, "files have values, not a range", "a range needs a key");
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    const std::string value = at + "/values/" + std::to_string(i);
    if (axis.key.empty() && axis.values[i].json.front() != '"')
      problems.add_rule(value, "got " + axis.values[i].json + ", must be the path of a file", "or give a key");
    for (std::size_t j = 0; j < i; ++j)
      if (axis.values[j] == axis.values[i] && sweep.method != SweepMethod::list) {
        problems.add_rule(value, "got " + axis.values[i].json + ", which is there already");
        break;
      }
  }
  if (axis.of == SweepTarget::script && !axis.key.empty() && sweep.script.empty())
    problems.add_rule(at + "/key", "the sweep has no script", "name one in \"script\"");
}

void check_method(Problems& problems, const SweepSpec& sweep) {
  const bool is_hypercube = sweep.method == SweepMethod::latin_hypercube;
  if (is_hypercube && !sweep.samples) problems.add_rule("/samples", "a Latin hypercube needs the number of samples");
  if (!is_hypercube && sweep.samples) problems.add_rule("/samples", "belongs to a Latin hypercube");
  if (!is_hypercube && !sweep.seeds.empty()) problems.add_rule("/seeds", "belong to a Latin hypercube");
  std::set<std::string> seen;
  for (std::size_t i = 0; i < sweep.seeds.size(); ++i) {
    const SweepValue& seed = sweep.seeds[i];
    const bool is_whole =
        seed.number && *seed.number >= 0 && *seed.number <= 9e15 && seed.json.find_first_of(".eE") == std::string::npos;
    if (!is_whole || !seen.insert(seed.json).second)
      problems.add_rule("/seeds/" + std::to_string(i),
                        "got " + seed.json + ", must be a whole number, 0 or more, that is there once");
  }
  const std::size_t length = sweep.vary.empty() ? 0 : sweep.vary.front().values.size();
  for (std::size_t i = 1; sweep.method == SweepMethod::list && i < sweep.vary.size(); ++i)
    if (sweep.vary[i].values.size() != length)
      problems.add_rule(
          "/vary/" + std::to_string(i),
          "has " + std::to_string(sweep.vary[i].values.size()) + " values, the first one " + std::to_string(length),
          "a list takes as many of each");
}

void check_count(Problems& problems, const SweepSpec& sweep) {
  double count = 1;
  for (const SweepAxis& axis : sweep.vary)
    if (sweep.method == SweepMethod::grid) count *= axis.steps ? double(*axis.steps) : double(axis.values.size());
  if (sweep.method == SweepMethod::latin_hypercube)
    count = double(sweep.samples.value_or(1)) * double(std::max<std::size_t>(1, sweep.seeds.size()));
  if (count > kMostTasks)
    problems.add_rule("/vary", "gives " + double_to_decimal(count, 0) + " sessions, must be at most " +
                                   double_to_decimal(kMostTasks, 0));
}

void check_sweep(Problems& problems, const SweepSpec& sweep) {
  check_method(problems, sweep);
  std::set<std::string> names;
  for (std::size_t i = 0; i < sweep.vary.size(); ++i) {
    const std::string at = "/vary/" + std::to_string(i), column = sweep.vary[i].column();
    check_axis(problems, at, sweep.vary[i], sweep);
    if (!problems.are_good(at, {"name", "of", "key"})) continue;
    if (!names.insert(column).second || kOwnColumns.contains(column))
      problems.add_rule(at, "its column would be " + in_quotes(column) + ", which is taken",
                        "give it a \"name\" of its own");
  }
  check_count(problems, sweep);
}

}  // namespace

std::string SweepAxis::column() const {
  if (!name.empty()) return name;
  if (key.empty()) return of == SweepTarget::scene ? "scene" : "script";
  return key.substr(key.rfind('/') + 1);
}

void FieldReader::values(const Key& key, std::vector<SweepValue>& value, std::size_t least) {
  const JsonNode* list = take_list(key, least);
  if (list == nullptr) return;
  const std::string pointer = child_pointer(pointer_, key.name);
  for (std::size_t i = 0; i < list->children.size(); ++i) {
    const JsonNode& node = list->children[i];
    SweepValue& added = value.emplace_back();
    bool is_value = node.kind == JsonKind::number || node.kind == JsonKind::boolean ||
                    (node.kind == JsonKind::text && !node.text.empty());
    if (node.kind == JsonKind::number) added.number = decimal_to_double(node.raw, 0);
    added.json = node.kind == JsonKind::text ? in_quotes(node.text) : node.raw;
    added.shown = node.kind == JsonKind::text ? node.text : node.raw;
    if (node.kind == JsonKind::list && !node.children.empty()) {
      is_value = true;
      for (const JsonNode& part : node.children) {
        is_value = is_value && part.kind == JsonKind::number;
        added.json += (added.json.empty() ? "[" : ", ") + part.raw;
        added.shown += (added.shown.empty() ? "" : " ") + part.raw;
      }
      added.json += "]";
    }
    if (is_value) continue;
    problems_.add(child_pointer(pointer, i), node.place,
                  "got " + describe(node) + ", must be a number, a text, true, false or a list of numbers");
  }
}

Result<SweepDraft> read_sweep_draft(std::string_view text, const std::string& file_name) {
  Result<JsonNode> parsed = parse_json(text, file_name);
  if (!parsed) return parsed.errors();
  const auto root = std::make_shared<const JsonNode>(*std::move(parsed));
  const TextPlaces places(root, file_name);
  SweepDraft draft{{{}, places}, Problems(places)};
  FieldReader::read_record(*root, "", draft.problems, draft.sweep.spec);
  check_sweep(draft.problems, draft.sweep.spec);
  return draft;
}

Result<SweepText> read_sweep(std::string_view text, const std::string& file_name) {
  const Result<SweepDraft> draft = read_sweep_draft(text, file_name);
  if (!draft) return draft.errors();
  if (!draft->problems.is_empty()) return draft->problems.errors();
  return draft->sweep;
}

}  // namespace ctpm::scenes
