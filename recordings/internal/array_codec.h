#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "recordings/internal/bytes.h"

namespace ctpm::recordings::session_file {

/// Writes an array as differences and byte planes, FORMAT.md section 3. U: uint8_t, uint32_t or uint64_t, the bits of
/// the values.
template <class U>
void put_array(Bytes& out, std::span<const U> values);

/// Reads an array written by put_array. Takes the memory of `count` values from the reader's budget first. Fails with
/// the reader.
template <class U>
void get_array(ByteReader& in, std::uint64_t count, std::vector<U>& values);

/// Skips an array of `count` values of `width` bytes and returns its bytes.
ByteView skip_array(ByteReader& in, std::uint64_t count, std::size_t width);

}  // namespace ctpm::recordings::session_file
