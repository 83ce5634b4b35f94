#include "recordings/internal/block.h"

#include <zstd.h>
#include <memory>

#define XXH_STATIC_LINKING_ONLY  // the hash state lives on the stack
#include <xxhash.h>

namespace ctpm::recordings::session_file {
namespace {

std::int64_t checksum_of(const std::string& name, std::int64_t size, ByteView data, std::uint64_t seed) {
  const std::string label = name + " " + std::to_string(size);
  XXH3_state_t hash;
  XXH3_INITSTATE(&hash);
  XXH3_64bits_reset_withSeed(&hash, seed);
  XXH3_64bits_update(&hash, label.data(), label.size());
  XXH3_64bits_update(&hash, data.data(), data.size());
  return static_cast<std::int64_t>(XXH3_64bits_digest(&hash));
}

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

}  // namespace

Block pack(const std::string& name, ByteView content, std::uint64_t seed, int level) {
  thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  CTPM_CHECK(context, "out of memory for a compressor");
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, level);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);

  Block block;
  block.size = static_cast<std::int64_t>(content.size());
  block.data.resize(ZSTD_compressBound(content.size()));
  const std::size_t written =
      ZSTD_compress2(context.get(), block.data.data(), block.data.size(), content.data(), content.size());
  CTPM_CHECK(!ZSTD_isError(written), "compression into a large enough buffer");
  block.data.resize(written);
  block.checksum = checksum_of(name, block.size, block.data, seed);
  return block;
}

bool is_intact(const std::string& name, std::int64_t size, std::int64_t checksum, ByteView data, std::uint64_t seed) {
  return checksum == checksum_of(name, size, data, seed);
}

Result<Bytes> unpack(const std::string& name, std::int64_t size, std::int64_t checksum, ByteView data,
                     std::uint64_t seed, std::uint64_t max_size) {
  if (!is_intact(name, size, checksum, data, seed)) return Error{"", name + ": the checksum does not match", ""};
  if (size < 0 || static_cast<std::uint64_t>(size) > max_size)
    return Error{
        "", name + ": states " + std::to_string(size) + " bytes, at most " + std::to_string(max_size) + " are allowed",
        ""};
  if (ZSTD_getFrameContentSize(data.data(), data.size()) != static_cast<unsigned long long>(size))
    return Error{"", name + ": states another size than its compressed data", ""};
  Bytes content(static_cast<std::size_t>(size));
  const std::size_t got = ZSTD_decompress(content.data(), content.size(), data.data(), data.size());
  if (ZSTD_isError(got) || got != content.size())
    return Error{"", name + ": cannot be decompressed: " + (ZSTD_isError(got) ? ZSTD_getErrorName(got) : "too short"),
                 ""};
  return content;
}

}  // namespace ctpm::recordings::session_file
