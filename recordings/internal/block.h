#pragma once

#include <cstdint>
#include <string>

#include "core/model/result.h"
#include "recordings/internal/bytes.h"

namespace ctpm::recordings::session_file {

inline constexpr std::uint64_t max_part_size = 1ull << 30;  ///< of a part or a keyframe before compression [bytes]
inline constexpr std::uint64_t max_chunk_size = 64ull
                                                << 20;  ///< of a chunk or a run of events before compression [bytes]

/// A compressed payload with its checksum. FORMAT.md section 2.
struct Block {
  std::int64_t size = 0;  ///< before compression [bytes]
  std::int64_t checksum = 0;
  Bytes data;
};

/// `name` is the label without the size, such as "chunk 300 100".
Block pack(const std::string& name, ByteView content, std::uint64_t seed, int level);

/// Whether an untrusted block has the checksum of its label and its stored bytes.
bool is_intact(const std::string& name, std::int64_t size, std::int64_t checksum, ByteView data, std::uint64_t seed);

/// Verifies and decompresses an untrusted block. Errors, each with `name`: wrong checksum, size above `max_size`, or
/// not decompressible.
Result<Bytes> unpack(const std::string& name, std::int64_t size, std::int64_t checksum, ByteView data,
                     std::uint64_t seed, std::uint64_t max_size);

}  // namespace ctpm::recordings::session_file
