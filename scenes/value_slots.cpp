#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/errors.h"
#include "scenes/json_text.h"
#include "scenes/json_words.h"
#include "scenes/sweep.h"

namespace ctpm::scenes {
namespace {

/// How far a pointer leads.
struct Way {
  const JsonNode* node;  ///< the last value on it
  std::size_t done = 0;  ///< bytes of the pointer up to there
};

Way follow(const JsonNode& root, const std::string& pointer) {
  Way way{&root};
  while (way.done < pointer.size()) {
    const std::size_t end = std::min(pointer.find('/', way.done + 1), pointer.size());
    const JsonNode* next = way.node->child(pointer.substr(way.done + 1, end - way.done - 1));
    if (next == nullptr) break;
    way = {next, end};
  }
  return way;
}

/// A text, its tree, and where the tree's bytes are in it.
struct Parsed {
  JsonNode root;
  std::size_t mark = 0;
  std::vector<std::size_t> origin;

  std::size_t begin(const JsonNode& node) const { return mark + origin[node.begin]; }
  std::size_t end(const JsonNode& node) const { return mark + origin[node.end - 1] + 1; }
};

Result<Parsed> parse(const std::string& text, const std::string& file_name) {
  Result<JsonNode> root = parse_json(text, file_name);
  if (!root) return root.errors();
  Parsed parsed{*std::move(root), text.starts_with("\xEF\xBB\xBF") ? std::size_t(3) : 0, {}};
  (void)without_comments(std::string_view(text).substr(parsed.mark), &parsed.origin);
  return parsed;
}

/// The text with the key of a pointer added if it is not there.
Result<std::string> with_key(std::string text, const std::string& file_name, const std::string& pointer) {
  const Result<Parsed> parsed = parse(text, file_name);
  if (!parsed) return parsed.errors();
  const auto [node, done] = follow(parsed->root, pointer);
  if (done == pointer.size()) return text;
  if (node->kind != JsonKind::object)
    return Error{file_name + ":" + std::to_string(node->place.line) + ":" + std::to_string(node->place.column),
                 (done == 0 ? "/" : pointer.substr(0, done)) + ": there is no " + pointer.substr(done), ""};
  std::string added = "null";
  for (std::size_t end = pointer.size(); end > done;) {
    const std::size_t slash = pointer.rfind('/', end - 1);
    added = in_quotes(pointer.substr(slash + 1, end - slash - 1)) + ": " + added;
    end = slash;
    if (end > done) added = "{" + added + "}";
  }
  if (node->children.empty()) return text.insert(parsed->begin(*node) + 1, added);
  return text.insert(parsed->end(node->children.back()), ", " + added);
}

}  // namespace

Result<ValueSlots> ValueSlots::find(const std::string& text, const std::string& file_name,
                                    const std::vector<std::string>& pointers) {
  Result<std::string> whole = text;
  Errors errors;
  for (const std::string& pointer : pointers) {
    Result<std::string> added = with_key(*whole, file_name, pointer);
    if (added)
      whole = std::move(added);
    else
      append(errors, added);
  }
  if (!errors.empty()) return errors;
  const Result<Parsed> parsed = parse(*whole, file_name);
  if (!parsed) return parsed.errors();
  std::vector<std::pair<std::size_t, std::size_t>> places;  // begin, and whose
  for (std::size_t i = 0; i < pointers.size(); ++i)
    places.emplace_back(parsed->begin(*follow(parsed->root, pointers[i]).node), i);
  std::sort(places.begin(), places.end());
  ValueSlots slots("");
  Result<JsonNode> written = parse_json(text, file_name);
  if (written) slots.places_ = TextPlaces(std::make_shared<const JsonNode>(*std::move(written)), file_name);
  slots.between_.clear();
  std::size_t from = 0;
  for (const auto& [begin, i] : places) {
    if (begin < from) return Error{file_name, pointers[i] + ": lies within another value that varies", ""};
    slots.between_.push_back(whole->substr(from, begin - from));
    slots.pointer_.push_back(i);
    from = parsed->end(*follow(parsed->root, pointers[i]).node);
  }
  slots.between_.push_back(whole->substr(from));
  return slots;
}

std::string ValueSlots::with(const std::vector<std::string>& values) const {
  std::string text = between_.front();
  for (std::size_t i = 0; i < pointer_.size(); ++i) text += values[pointer_[i]] + between_[i + 1];
  return text;
}

}  // namespace ctpm::scenes
