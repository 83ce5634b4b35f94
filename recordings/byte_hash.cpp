#include "recordings/byte_hash.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#define XXH_STATIC_LINKING_ONLY  // the hash state is a member
#include <xxhash.h>

namespace ctpm::recordings {

struct ByteHash::Parts {
  XXH3_state_t state;
};

ByteHash::ByteHash() : parts_(std::make_unique<Parts>()) {
  XXH3_INITSTATE(&parts_->state);
  XXH3_64bits_reset(&parts_->state);
}
ByteHash::ByteHash(ByteHash&&) noexcept = default;
ByteHash& ByteHash::operator=(ByteHash&&) noexcept = default;
ByteHash::~ByteHash() = default;

void ByteHash::add(const void* bytes, std::size_t count) { XXH3_64bits_update(&parts_->state, bytes, count); }
std::uint64_t ByteHash::value() const { return XXH3_64bits_digest(&parts_->state); }

std::string hash_text(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

Result<std::uint64_t> file_hash(const std::string& path) {
  std::error_code ignored;
  const std::filesystem::file_status what = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(what)) return Error{path, "does not exist", ""};
  if (std::filesystem::is_directory(what)) return Error{path, "is a folder, not a file", ""};
  std::ifstream in(path, std::ios::binary);
  if (!in) return Error{path, "cannot be read", ""};
  ByteHash hash;
  std::vector<char> buffer(1 << 16);
  while (in.read(buffer.data(), std::streamsize(buffer.size())) || in.gcount() > 0)
    hash.add(buffer.data(), std::size_t(in.gcount()));
  return hash.value();
}

}  // namespace ctpm::recordings
