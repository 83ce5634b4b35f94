#include "recordings/internal/rescue.h"

#include <optional>
#include <set>

#include "recordings/internal/field_codec.h"
#include "recordings/internal/page_scan.h"
#include "recordings/internal/session_database.h"

namespace ctpm::recordings::session_file {
namespace {

template <class T>
const T* value_at(const ScannedRow& row, std::size_t i) {
  return i < row.values.size() ? std::get_if<T>(&row.values[i]) : nullptr;
}

/// The block that ends a row: size, checksum, data.
std::optional<Block> block_of(const ScannedRow& row) {
  const std::size_t n = row.values.size();
  if (n < 4) return {};
  const auto *size = value_at<std::int64_t>(row, n - 3), *checksum = value_at<std::int64_t>(row, n - 2);
  const auto* data = value_at<Bytes>(row, n - 1);
  if (!size || !checksum || !data) return {};
  return Block{*size, *checksum, *data};
}

/// The seed of the session, from its part `session`, the only block whose own seed is 0.
std::optional<std::uint64_t> seed_of(const ScannedRow& row) {
  const std::string* name = value_at<std::string>(row, 0);
  if (!name || *name != "session") return {};
  const auto block = block_of(row);
  if (!block) return {};
  const auto content = unpack(part_name(*name), block->size, block->checksum, block->data, 0, max_chunk_size);
  if (!content) return {};
  SessionIdentity identity;
  std::string problem;
  ByteReader in(*content, max_chunk_size);
  get_fields(in, identity, problem);
  return problem.empty() ? std::optional(identity.seed) : std::nullopt;
}

/// Inserts each sound block once. The shape of a row and the label in its checksum tell its table.
class Rescue {
 public:
  Rescue(SessionTables& tables, std::uint64_t seed) : tables_(tables), seed_(seed) {}

  Result<Done> take(const ScannedRow& row) {
    const auto block = block_of(row);
    if (!block) return Done{};
    if (const std::string* name = value_at<std::string>(row, 0))
      return is_new(part_name(*name), *block, *name == "session" ? 0 : seed_) ? tables_.insert_part(*name, *block)
                                                                              : Done{};
    if (row.values.size() == 4)
      return is_new(keyframe_name(row.key), *block, seed_) ? tables_.insert_keyframe(row.key, *block) : Done{};
    const std::int64_t* count = value_at<std::int64_t>(row, 1);
    if (!count) return Done{};
    if (is_new(chunk_name(row.key, *count), *block, seed_)) return tables_.insert_chunk(row.key, *count, *block);
    if (is_new(event_name(row.key, *count), *block, seed_)) return tables_.insert_events(row.key, *count, *block);
    return Done{};
  }

 private:
  bool is_new(const std::string& name, const Block& block, std::uint64_t seed) {
    return is_intact(name, block.size, block.checksum, block.data, seed) && taken_.insert(name).second;
  }

  SessionTables& tables_;
  std::uint64_t seed_;
  std::set<std::string> taken_;
};

}  // namespace

Result<Done> rescue_rows(const std::string& damaged, const std::string& repaired) {
  std::optional<std::uint64_t> seed;
  const auto look = [&](const ScannedRow& row) {
    if (!seed) seed = seed_of(row);
  };
  if (auto scanned = scan_rows(damaged, look); !scanned) return scanned;
  if (!seed) return Error{damaged, "part session: is on none of its pages", ""};

  auto tables = SessionTables::create(repaired);
  if (!tables) return tables.errors();
  Rescue rescue(*tables, *seed);
  Result<Done> taken = Done{};
  const auto take = [&](const ScannedRow& row) {
    if (taken) taken = rescue.take(row);
  };
  if (auto scanned = scan_rows(damaged, take); !scanned) return scanned;
  if (!taken) return taken;
  if (auto committed = tables->commit(); !committed) return committed;
  return tables->close_new();
}

}  // namespace ctpm::recordings::session_file
