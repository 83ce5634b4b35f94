#include "studio/server/page.h"

#include <charconv>

#include "studio/server/page_bytes.h"

namespace ctpm::server {
namespace {

/// Reads the line of the bundle's table that begins at `at`: "NAME SIZE". An empty line ends the table.
struct BundleRow {
  std::string_view name;
  std::size_t size = 0;
};

std::optional<BundleRow> next_row(std::string_view bundle, std::size_t& at) {
  const std::size_t end = bundle.find('\n', at);
  if (end == std::string_view::npos || end == at) return std::nullopt;
  const std::string_view line = bundle.substr(at, end - at);
  at = end + 1;
  const std::size_t space = line.find(' ');
  if (space == std::string_view::npos) return std::nullopt;
  BundleRow row{line.substr(0, space)};
  std::from_chars(line.data() + space + 1, line.data() + line.size(), row.size);
  return row;
}

std::string type_of(std::string_view name) {
  if (name.ends_with(".html")) return "text/html; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  if (name.ends_with(".js")) return "text/javascript; charset=utf-8";
  if (name.ends_with(".svg")) return "image/svg+xml";
  return "application/octet-stream";
}

}  // namespace

std::optional<PageFile> page_file(std::string_view target) {
  target = target.substr(0, target.find('?'));
  if (!target.starts_with('/')) return std::nullopt;
  const std::string_view wanted = target == "/" ? "index.html" : target.substr(1);
  const std::string_view bundle(reinterpret_cast<const char*>(kPageBundle), kPageBundleSize);
  std::size_t at = 0, offset = 0, size = 0;
  bool found = false;
  while (const std::optional<BundleRow> row = next_row(bundle, at)) {
    if (row->name == wanted)
      found = true, size = row->size;
    else if (!found)
      offset += row->size;
  }
  const std::size_t begin = at + 1 + offset;  // behind the empty line
  if (!found || begin + size > bundle.size()) return std::nullopt;
  return PageFile{type_of(wanted), bundle.substr(begin, size)};
}

}  // namespace ctpm::server
