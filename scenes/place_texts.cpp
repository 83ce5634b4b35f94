#include "scenes/place_texts.h"

#include <algorithm>

#include "scenes/json_words.h"

namespace ctpm::scenes {
namespace {

class TextFinder {
 public:
  TextFinder(bool is_script, PlaceFinder* finder, Problems& problems)
      : is_script_(is_script), finder_(finder), problems_(problems) {}

  void walk(JsonNode& node, const std::string& pointer, const std::string& record) {
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      JsonNode& child = node.children[i];
      const std::string key = node.kind == JsonKind::object ? node.keys[i] : "";
      const std::string at = key.empty() ? child_pointer(pointer, i) : child_pointer(pointer, key);
      if (child.kind == JsonKind::text && takes_place(record, key))
        replace(child, at, false);
      else if (child.kind == JsonKind::text && takes_direction(record, key))
        replace(child, at, true);
      else if (child.kind == JsonKind::list && key == "path_mm" && is_script_)
        walk_path(child, at);
      else
        walk(child, at, key.empty() ? record : key);
    }
  }

  PlaceTexts texts;

 private:
  void walk_path(JsonNode& list, const std::string& pointer) {
    for (std::size_t i = 0; i < list.children.size(); ++i)
      if (list.children[i].kind == JsonKind::text) replace(list.children[i], child_pointer(pointer, i), false);
  }

  void replace(JsonNode& node, const std::string& pointer, bool is_direction) {
    const Result<PlacePhrase> phrase = parse_place(node.text, is_direction);
    std::optional<Vec3> found;
    if (!phrase) {
      problems_.add(pointer, node.place, phrase.errors().front().message, phrase.errors().front().hint);
    } else if (finder_ != nullptr) {
      const Result<std::optional<Vec3>> place = finder_->find(*phrase);
      if (place)
        found = *place;
      else
        problems_.add(pointer, node.place, place.errors().front().message, place.errors().front().hint);
    }
    const int exponent = is_direction ? 0 : -3;
    // What stands for nothing differs from other points, so that no rule between them speaks.
    const double n = double(texts.open.size() + 1);
    const Vec3 value = found                         ? *found
                       : !is_direction               ? Vec3{0.001 * n, 0.002 * n * n, 0.003 * n}
                       : pointer.ends_with("facing") ? Vec3{1, 0, 0}
                                                     : Vec3{0, 0, -1};
    JsonNode list;
    list.kind = JsonKind::list, list.place = node.place, list.begin = node.begin, list.end = node.end;
    std::string coordinates;
    for (const double x : {value.x, value.y, value.z}) {
      JsonNode number;
      number.kind = JsonKind::number, number.place = node.place, number.raw = double_to_decimal(x, exponent);
      coordinates += (coordinates.empty() ? "" : ", ") + number.raw;
      list.children.push_back(std::move(number));
    }
    if (found)
      texts.found.push_back({node.begin, node.end, node.text, "[" + coordinates + "]"});
    else
      texts.open.push_back(pointer);
    node = std::move(list);
  }

  const bool is_script_;
  PlaceFinder* finder_;
  Problems& problems_;
};

/// The point that a node holds [m], if it holds one.
std::optional<Vec3> point_in(const JsonNode& node) {
  if (node.kind != JsonKind::list || node.children.size() != 3) return std::nullopt;
  double value[3];
  for (std::size_t i = 0; i < 3; ++i) {
    if (node.children[i].kind != JsonKind::number) return std::nullopt;
    value[i] = decimal_to_double(node.children[i].raw, -3);
  }
  return Vec3{value[0], value[1], value[2]};
}

/// The names of the organs in a scene's tree.
PlaceFinder names_of(const JsonNode& root) {
  std::vector<PlaceFinder::Organ> organs;
  if (const JsonNode* list = root.find("organs"))
    for (const JsonNode& organ : list->children)
      if (const JsonNode* name = organ.find("name")) organs.push_back({name->text, nullptr});
  return PlaceFinder(std::move(organs), {});
}

}  // namespace

bool takes_place(std::string_view record, std::string_view key) {
  if (key == "at_mm") return record == "tools" || record == "probes" || record == "loads" || record == "take";
  for (const std::string_view own : {"eye_mm", "target_mm", "holds_mm", "to_mm"})
    if (key == own) return true;
  return (key == "centre_mm" && record == "sphere") || (key == "point_mm" && record == "plane");
}

bool takes_direction(std::string_view record, std::string_view key) {
  return key == "pointing" || key == "facing" || key == "direction" || (key == "normal" && record == "plane");
}

PlaceTexts find_places(JsonNode& root, bool is_script, PlaceFinder* finder, Problems& problems) {
  PlaceFinder names({}, {});
  if (finder == nullptr && !is_script) {
    names = names_of(root);
    finder = &names;
  }
  TextFinder texts(is_script, finder, problems);
  // Probes come first: other places may name them.
  for (std::size_t i = 0; !is_script && i < root.keys.size(); ++i) {
    if (root.keys[i] != "probes") continue;
    texts.walk(root.children[i], "/probes", "probes");
    for (const JsonNode& probe : root.children[i].children) {
      const JsonNode *name = probe.find("name"), *at = probe.find("at_mm");
      if (name != nullptr)
        finder->add_probe(name->text, at == nullptr || finder == &names ? std::nullopt : point_in(*at));
    }
  }
  texts.walk(root, "", "");
  return std::move(texts.texts);
}

std::string with_coordinates(std::string_view text, const std::vector<FoundPlace>& found) {
  std::string changed(text);
  const std::size_t mark = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  std::vector<std::size_t> origin;
  (void)without_comments(text.substr(mark), &origin);
  std::vector<FoundPlace> last_first = found;
  std::sort(last_first.begin(), last_first.end(),
            [](const FoundPlace& a, const FoundPlace& b) { return a.begin > b.begin; });
  for (const FoundPlace& place : last_first) {
    const std::size_t begin = mark + origin[place.begin], end = mark + origin[place.end - 1] + 1;
    const bool can_stay = place.phrase.find("*/") == std::string::npos;
    changed.replace(begin, end - begin, place.coordinates + (can_stay ? " /* " + place.phrase + " */" : ""));
  }
  return changed;
}

}  // namespace ctpm::scenes
