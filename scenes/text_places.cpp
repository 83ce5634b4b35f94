#include "scenes/text_places.h"

#include <algorithm>

#include "scenes/json_text.h"

namespace ctpm::scenes {
TextPlaces::TextPlaces(std::shared_ptr<const JsonNode> root, std::string file_name)
    : root_(std::move(root)), file_name_(std::move(file_name)) {}

Place TextPlaces::find(const std::string& pointer) const {
  if (!root_) return {};
  const JsonNode* node = root_.get();
  for (std::size_t start = 0; start < pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', start + 1), pointer.size());
    const JsonNode* next = node->child(pointer.substr(start + 1, end - start - 1));
    if (next == nullptr) break;
    node = next, start = end;
  }
  return node->place;
}

Error TextPlaces::error_at(const std::string& pointer, Place place, const std::string& message,
                           const std::string& hint) const {
  const std::string shown = pointer.empty() ? "/" : pointer;
  if (!root_) return {shown, message, hint};
  const std::string where = file_name_ + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
  return {where, shown + ": " + message, hint};
}

Error TextPlaces::error_at(const std::string& pointer, const std::string& message, const std::string& hint) const {
  return error_at(pointer, find(pointer), message, hint);
}

}  // namespace ctpm::scenes
