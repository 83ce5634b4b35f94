#include "scenes/field_writer.h"

namespace ctpm::scenes {
namespace {

constexpr std::size_t kLineLength = 100;

/// Items between brackets: on one line if they are short, else one a line, indented for `depth`.
std::string bracketed(const std::vector<std::string>& items, char open, char close, int depth) {
  std::string line(1, open);
  for (std::size_t i = 0; i < items.size(); ++i) line += (i > 0 ? ", " : "") + items[i];
  line += close;
  if (line.size() + std::size_t(2 * depth) <= kLineLength && line.find('\n') == std::string::npos && depth > 0)
    return line;
  std::string block(1, open);
  for (std::size_t i = 0; i < items.size(); ++i)
    block += (i > 0 ? ",\n" : "\n") + std::string(std::size_t(2 * (depth + 1)), ' ') + items[i];
  return block + "\n" + std::string(std::size_t(2 * depth), ' ') + close;
}

}  // namespace

std::string FieldWriter::text() const { return bracketed(members_, '{', '}', depth_); }

std::string FieldWriter::list_text(const std::vector<std::string>& items) const {
  return bracketed(items, '[', ']', depth_ + 1);
}

}  // namespace ctpm::scenes
