#pragma once

#include <cstddef>

namespace ctpm::server {

/// The page as studio/page/bundle/page.bundle holds it: a table of "NAME SIZE" lines, an empty line, and the files one
/// after the other, each compressed by gzip. embed_page.cmake makes the definition.
extern const unsigned char kPageBundle[];
extern const std::size_t kPageBundleSize;

}  // namespace ctpm::server
