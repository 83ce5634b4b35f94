#include "scenes/rewrite_json.h"

#include <algorithm>
#include <vector>

#include "scenes/json_text.h"
#include "scenes/json_words.h"

namespace ctpm::scenes {
namespace {

/// Bytes [begin, end) of a text that become `text`.
struct Edit {
  std::size_t begin = 0, end = 0;
  std::string text;
};

/// Finds the edits that make of a text what two texts of the program's own layout differ by.
class Rewriter {
 public:
  Rewriter(const std::string& before, const std::string& after, const std::string& plain)
      : before_(before), after_(after), plain_(plain) {}

  /// False where a key must go, which this cannot do.
  bool compare(const JsonNode& a, const JsonNode& b, const JsonNode& in_text) {
    if (before_.substr(a.begin, a.end - a.begin) == after_.substr(b.begin, b.end - b.begin)) return true;
    const bool are_objects =
        a.kind == JsonKind::object && b.kind == JsonKind::object && in_text.kind == JsonKind::object;
    const bool are_lists = a.kind == JsonKind::list && b.kind == JsonKind::list && in_text.kind == JsonKind::list &&
                           a.children.size() <= b.children.size() && a.children.size() == in_text.children.size();
    if (are_objects) return compare_members(a, b, in_text);
    if (!are_lists) return edits.push_back({in_text.begin, in_text.end, text_of(b)}), true;
    for (std::size_t i = 0; i < a.children.size(); ++i)
      if (!compare(a.children[i], b.children[i], in_text.children[i])) return false;
    std::vector<std::string> added;
    for (std::size_t i = a.children.size(); i < b.children.size(); ++i) added.push_back(text_of(b.children[i]));
    add_behind(in_text, added);
    return true;
  }

  std::vector<Edit> edits;

 private:
  std::string text_of(const JsonNode& b) const { return after_.substr(b.begin, b.end - b.begin); }

  bool compare_members(const JsonNode& a, const JsonNode& b, const JsonNode& in_text) {
    for (const std::string& key : a.keys)
      if (b.find(key) == nullptr) return false;
    std::vector<std::string> added;
    for (std::size_t i = 0; i < b.keys.size(); ++i) {
      const JsonNode *old = a.find(b.keys[i]), *own = in_text.find(b.keys[i]);
      if (own != nullptr && old != nullptr) {
        if (!compare(*old, b.children[i], *own)) return false;
      } else if (own != nullptr) {
        edits.push_back({own->begin, own->end, text_of(b.children[i])});
      } else if (old == nullptr || before_.substr(old->begin, old->end - old->begin) != text_of(b.children[i])) {
        added.push_back(in_quotes(b.keys[i]) + ": " + text_of(b.children[i]));
      }
    }
    add_behind(in_text, added);
    return true;
  }

  /// Adds members to an object, or items to a list.
  void add_behind(const JsonNode& in_text, const std::vector<std::string>& items) {
    std::string added;
    for (const std::string& item : items) added += (added.empty() ? "" : separator(in_text)) + item;
    if (added.empty()) return;
    if (in_text.children.empty()) {
      const bool is_list = in_text.kind == JsonKind::list;
      return edits.push_back({in_text.begin, in_text.end, (is_list ? "[" : "{") + added + (is_list ? "]" : "}")});
    }
    // A comma where the last one ends; the new ones before the closing bracket, behind a comment that may stand there.
    const std::size_t last = in_text.children.back().end, bracket = in_text.end - 1;
    const std::size_t line = plain_.rfind('\n', bracket);
    const bool has_own_line = plain_.find_first_not_of(" \t", line + 1) == bracket && line >= last;
    if (last == bracket) {
      edits.push_back({last, last, separator(in_text) + added});
    } else if (has_own_line && separator(in_text) != ", ") {
      edits.push_back({line + 1, line + 1, separator(in_text).substr(2) + added + "\n"});
      edits.push_back({last, last, ","});
    } else {
      edits.push_back({bracket, bracket, " " + added});
      edits.push_back({last, last, ","});
    }
  }

  /// Between two members or items: in one line if they are, else as the first one stands.
  std::string separator(const JsonNode& node) const {
    const std::string_view own = std::string_view(plain_).substr(node.begin, node.end - node.begin);
    if (node.children.empty() || own.find('\n') == std::string_view::npos) return ", ";
    const Place first = node.kind == JsonKind::list ? node.children.front().place : node.key_places.front();
    return ",\n" + std::string(std::size_t(first.column - 1), ' ');
  }

  const std::string &before_, &after_, &plain_;
};

}  // namespace

std::optional<std::string> rewrite_json(const std::string& text, const std::string& before, const std::string& after) {
  const Result<JsonNode> a = parse_json(before, ""), b = parse_json(after, ""), in_text = parse_json(text, "");
  if (!a || !b || !in_text) return {};
  const std::size_t mark = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  std::vector<std::size_t> origin;
  const std::string plain = without_comments(std::string_view(text).substr(mark), &origin);
  Rewriter rewriter(before, after, plain);
  if (!rewriter.compare(*a, *b, *in_text)) return {};
  std::stable_sort(rewriter.edits.begin(), rewriter.edits.end(),
                   [](const Edit& x, const Edit& y) { return x.begin > y.begin; });
  std::string changed = text;
  for (const Edit& edit : rewriter.edits) {
    const std::size_t begin = mark + origin[edit.begin],
                      end = mark + (edit.end > edit.begin ? origin[edit.end - 1] + 1 : origin[edit.begin]);
    changed.replace(begin, end - begin, edit.text);
  }
  return changed;
}

}  // namespace ctpm::scenes
