#pragma once

#include <array>
#include <cstdint>

namespace ctpm::recordings::session_file {

inline constexpr std::int64_t application_id = 0x4354504D;  ///< "CTPM"
inline constexpr std::int64_t format_version = 1;
inline constexpr std::int32_t chunk_ticks = 100;  ///< largest number of ticks in a chunk
inline constexpr double chunk_age = 0.1;          ///< longest time that a tick waits for its chunk to close [s]

struct Table {
  const char* name;
  const char* sql;
};

/// FORMAT.md section 1, verbatim.
inline constexpr std::array<Table, 4> tables{{
    {"part",
     "CREATE TABLE part(name TEXT PRIMARY KEY NOT NULL, size INTEGER NOT NULL, checksum INTEGER NOT NULL, "
     "data BLOB NOT NULL) WITHOUT ROWID"},
    {"chunk",
     "CREATE TABLE chunk(first INTEGER PRIMARY KEY NOT NULL, count INTEGER NOT NULL, size INTEGER NOT NULL, "
     "checksum INTEGER NOT NULL, data BLOB NOT NULL)"},
    {"keyframe",
     "CREATE TABLE keyframe(tick INTEGER PRIMARY KEY NOT NULL, size INTEGER NOT NULL, checksum INTEGER NOT "
     "NULL, "
     "data BLOB NOT NULL)"},
    {"event",
     "CREATE TABLE event(first INTEGER PRIMARY KEY NOT NULL, count INTEGER NOT NULL, size INTEGER NOT NULL, "
     "checksum INTEGER NOT NULL, data BLOB NOT NULL)"},
}};

}  // namespace ctpm::recordings::session_file
