#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ctpm::server {

/// A file of the page as it is sent.
struct PageFile {
  std::string type;        ///< Content-Type
  std::string_view bytes;  ///< compressed by gzip; static storage
};

/// The file of the page at `target` ("/" is its start). None: there is no such file.
std::optional<PageFile> page_file(std::string_view target);

}  // namespace ctpm::server
