#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "core/model/result.h"

namespace ctpm::recordings {

/// Incremental XXH3-64 hash of a byte stream. Equal hashes mean equal bytes, up to a chance of 2^-64.
class ByteHash {
 public:
  ByteHash();
  ByteHash(ByteHash&&) noexcept;
  ByteHash& operator=(ByteHash&&) noexcept;
  ~ByteHash();

  void add(const void* bytes, std::size_t count);
  std::uint64_t value() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// 16 hexadecimal digits, as `xxhsum -H3` prints them.
std::string hash_text(std::uint64_t hash);

/// XXH3-64 of a file's bytes. Error: the file cannot be read.
Result<std::uint64_t> file_hash(const std::string& path);

}  // namespace ctpm::recordings
