#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "recordings/internal/field_codec.h"
#include "recordings/internal/session_store.h"
#include "tests/recordings/sessions.h"

namespace ctpm::testing {

namespace session_file = recordings::session_file;

/// Changes the content of a session file and makes every checksum right again, as somebody would who wants to deceive.
class Forge {
 public:
  explicit Forge(const std::string& path) {
    const auto store = session_file::SessionStore::open(path, false);
    CTPM_CHECK(bool(store), "a session to forge");
    seed_ = store->identity().seed;
    auto database = session_file::Database::open(path, session_file::Database::Access::write);
    CTPM_CHECK(bool(database), "a session to forge");
    database_ = std::move(*database);
  }

  /// Runs SQL as it is; checksums stay.
  void run(const std::string& sql) {
    const auto done = database_.run(sql);
    CTPM_CHECK(bool(done), "SQL of a forgery");
  }

  /// The first column of a query.
  std::vector<std::int64_t> integers(const std::string& sql) {
    std::vector<std::int64_t> all;
    auto row = database_.prepare(sql);
    CTPM_CHECK(bool(row), "a query of a forgery");
    while (row->step() == session_file::Statement::Outcome::row) all.push_back(row->integer(0));
    return all;
  }

  /// Replaces the content of the block in `table` with the key `key` by `change(content)`. False if there is no such
  /// block, or none with a good checksum.
  bool change(const std::string& table, const std::string& key,
              const std::function<void(session_file::Bytes&)>& change) {
    const std::string column = table == "part" ? "name" : table == "keyframe" ? "tick" : "first";
    const std::string quoted = table == "part" ? "'" + key + "'" : key;
    const bool has_count = table == "chunk" || table == "event";
    auto row = database_.prepare("SELECT size, checksum, data" + std::string(has_count ? ", count" : "") + " FROM " +
                                 table + " WHERE " + column + " = " + quoted);
    if (!row || row->step() != session_file::Statement::Outcome::row) return false;
    const std::string label = table + " " + key + (has_count ? " " + std::to_string(row->integer(3)) : "");
    const std::uint64_t seed = label == "part session" ? 0 : seed_;
    auto content = session_file::unpack(label, row->integer(0), row->integer(1), row->blob(2), seed, 1ull << 30);
    if (!content) return false;
    row->reset();
    change(*content);
    const session_file::Block block = session_file::pack(label, *content, seed, 3);
    auto update = database_.prepare("UPDATE " + table + " SET size = ?1, checksum = ?2, data = ?3 WHERE " + column +
                                    " = " + quoted);
    CTPM_CHECK(bool(update), "a block to forge");
    update->bind(1, block.size).bind(2, block.checksum).bind(3, session_file::ByteView(block.data));
    CTPM_CHECK(update->step() == session_file::Statement::Outcome::done, "a forged block");
    return true;
  }

  /// Adds a part with a right checksum.
  void add_part(const std::string& name, const std::string& content) {
    const session_file::Block block = session_file::pack("part " + name, session_file::view(content), seed_, 3);
    auto insert = database_.prepare("INSERT INTO part VALUES(?1, ?2, ?3, ?4)");
    CTPM_CHECK(bool(insert), "a part to add");
    insert->bind(1, name).bind(2, block.size).bind(3, block.checksum).bind(4, session_file::ByteView(block.data));
    CTPM_CHECK(insert->step() == session_file::Statement::Outcome::done, "a part that is added");
  }

  /// Moves a keyframe to another tick, with the checksum that it has there.
  void move_keyframe(std::int64_t from, std::int64_t to) {
    auto row = database_.prepare("SELECT size, checksum, data FROM keyframe WHERE tick = " + std::to_string(from));
    CTPM_CHECK(row && row->step() == session_file::Statement::Outcome::row, "a keyframe to forge");
    const auto content = session_file::unpack("keyframe " + std::to_string(from), row->integer(0), row->integer(1),
                                              row->blob(2), seed_, 1ull << 30);
    CTPM_CHECK(bool(content), "a good keyframe to forge");
    row->reset();
    run("UPDATE keyframe SET tick = " + std::to_string(to) + " WHERE tick = " + std::to_string(from));
    const session_file::Block block = session_file::pack("keyframe " + std::to_string(to), *content, seed_, 3);
    auto update = database_.prepare("UPDATE keyframe SET checksum = ?1, data = ?2 WHERE tick = ?3");
    update->bind(1, block.checksum).bind(2, session_file::ByteView(block.data)).bind(3, to);
    CTPM_CHECK(update->step() == session_file::Statement::Outcome::done, "a forged keyframe");
  }

  /// Gives the run of events at `first` another count, with the checksum that it has then.
  void recount_events(std::int64_t first, std::int64_t count) {
    const std::string at = " WHERE first = " + std::to_string(first);
    auto row = database_.prepare("SELECT size, checksum, data, count FROM event" + at);
    CTPM_CHECK(row && row->step() == session_file::Statement::Outcome::row, "events to forge");
    const std::string name = "event " + std::to_string(first) + " ";
    const auto content = session_file::unpack(name + std::to_string(row->integer(3)), row->integer(0), row->integer(1),
                                              row->blob(2), seed_, 1ull << 30);
    CTPM_CHECK(bool(content), "good events to forge");
    row->reset();
    const session_file::Block block = session_file::pack(name + std::to_string(count), *content, seed_, 3);
    auto update = database_.prepare("UPDATE event SET count = ?1, checksum = ?2, data = ?3" + at);
    update->bind(1, count).bind(2, block.checksum).bind(3, session_file::ByteView(block.data));
    CTPM_CHECK(update->step() == session_file::Statement::Outcome::done, "forged events");
  }

 private:
  std::uint64_t seed_ = 0;
  session_file::Database database_;
};

}  // namespace ctpm::testing
