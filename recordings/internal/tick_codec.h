#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/internal/bytes.h"
#include "recordings/internal/field_codec.h"
#include "recordings/session.h"

namespace ctpm::recordings::session_file {

/// Content of the part `columns`: the columns that this program writes of a session with so many hands (Model::hands).
std::string column_text(std::int32_t hands);

/// A chunk's content: all these columns, FORMAT.md section 5.
void put_records(Bytes& out, std::span<const TickRecord> records, std::int32_t hands);

/// Reads chunks with the columns that a file names.
class RecordDecoder {
 public:
  /// `columns` is the part `columns` of a file. Errors: not a list of columns, or a column that is unknown or has
  /// another type.
  static Result<RecordDecoder> create(const std::string& columns);

  /// The `count` records of a chunk's content. Error: the content does not decode to exactly `count` records.
  Result<std::vector<TickRecord>> decode(ByteView content, std::int64_t count) const;

 private:
  std::vector<std::size_t> columns_;  ///< indices into the program's own list, in the file's order
};

}  // namespace ctpm::recordings::session_file
