#include "recordings/internal/page_scan.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <utility>

namespace ctpm::recordings::session_file {
namespace {

constexpr std::uint64_t page_size = 4096;               // FORMAT.md section 1
constexpr std::uint64_t overflow_size = page_size - 4;  // content of an overflow page
constexpr std::uint64_t log_header_size = 32, frame_header_size = 24;
// Each byte of a sound file belongs to one row, and to a few more of which only a part is left.
constexpr std::uint64_t reads_per_byte = 4;

using Page = std::array<std::uint8_t, page_size>;

std::uint64_t big_endian(const std::uint8_t* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | bytes[i];
  return value;
}

/// SQLite's integer of 1 to 9 bytes.
std::optional<std::uint64_t> take_varint(ByteView& bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < 9 && !bytes.empty(); ++i) {
    const std::uint8_t byte = bytes.front();
    bytes = bytes.subspan(1);
    if (i == 8) return value << 8 | byte;
    value = value << 7 | (byte & 0x7f);
    if (byte < 0x80) return value;
  }
  return {};
}

/// The pages of a file, the newest of each number: that of the log, if it holds one.
class Pages {
 public:
  Result<Done> open(const std::string& path) {
    // A folder opens like a file, and its end is told to be where no file ends.
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return Error{path, "is not a regular file", ""};
    file_.open(path, std::ios::binary | std::ios::ate);
    if (!file_) return Error{path, "cannot be opened", ""};
    const auto size = static_cast<std::uint64_t>(file_.tellg());
    for (std::uint64_t at = 0; at + page_size <= size; at += page_size) places_.push_back(std::pair{false, at});
    if (!std::filesystem::is_regular_file(path + "-wal", ignored)) return Done{};
    log_.open(path + "-wal", std::ios::binary | std::ios::ate);
    if (log_) read_log(static_cast<std::uint64_t>(log_.tellg()));
    return Done{};
  }

  std::uint64_t count() const { return places_.size(); }

  /// Page `number`, from 1. False if it is not there.
  bool read(std::uint64_t number, Page& page) {
    if (number < 1 || number > places_.size() || !places_[number - 1]) return false;
    const auto [in_log, at] = *places_[number - 1];
    return read_at(in_log ? log_ : file_, at, page.data(), page_size);
  }

 private:
  static bool read_at(std::ifstream& from, std::uint64_t at, std::uint8_t* bytes, std::uint64_t size) {
    from.clear();
    from.seekg(static_cast<std::streamoff>(at));
    return bool(from.read(reinterpret_cast<char*>(bytes), static_cast<std::streamsize>(size)));
  }

  /// A frame is of this log, and not of an earlier one in the same file, if it carries the salt of the header.
  void read_log(std::uint64_t size) {
    std::array<std::uint8_t, log_header_size> header{};
    if (!read_at(log_, 0, header.data(), log_header_size)) return;
    std::array<std::uint8_t, frame_header_size> frame{};
    const std::uint64_t most = places_.size() + size / page_size;
    for (std::uint64_t at = log_header_size; at + frame_header_size + page_size <= size;
         at += frame_header_size + page_size) {
      if (!read_at(log_, at, frame.data(), frame_header_size)) return;
      const std::uint64_t number = big_endian(frame.data(), 4);
      if (number < 1 || number > most || !std::equal(frame.begin() + 8, frame.begin() + 16, header.begin() + 16))
        continue;
      if (number > places_.size()) places_.resize(number);
      places_[number - 1] = std::pair{true, at + frame_header_size};
    }
  }

  std::ifstream file_, log_;
  std::vector<std::optional<std::pair<bool, std::uint64_t>>> places_;  ///< in the log?, offset [bytes]
};

/// The kinds of pages that hold rows: the first byte of each.
enum class PageKind : std::uint8_t { inner_index = 0x02, index_leaf = 0x0a, table_leaf = 0x0d };

class Scan {
 public:
  Scan(Pages& pages, const std::function<void(const ScannedRow&)>& visit)
      : pages_(pages), visit_(visit), budget_(reads_per_byte * page_size * pages.count()) {}

  void run() {
    for (std::uint64_t number = 1; number <= pages_.count(); ++number)
      if (pages_.read(number, page_)) scan_page(number == 1 ? 100 : 0);  // the file's header comes first
  }

 private:
  void scan_page(std::uint64_t header) {
    const PageKind kind{page_[header]};
    const bool is_inner = kind == PageKind::inner_index;
    if (!is_inner && kind != PageKind::index_leaf && kind != PageKind::table_leaf) return;
    const std::uint64_t cells = big_endian(&page_[header + 3], 2), pointers = header + (is_inner ? 12 : 8);
    for (std::uint64_t cell = 0; cell < cells && pointers + 2 * cell + 2 <= page_size; ++cell) {
      const std::uint64_t place = big_endian(&page_[pointers + 2 * cell], 2) + (is_inner ? 4 : 0);
      if (place < page_size) scan_cell(ByteView(page_).subspan(place), kind == PageKind::table_leaf);
    }
  }

  void scan_cell(ByteView cell, bool is_table) {
    const auto size = take_varint(cell);
    const auto key = is_table ? take_varint(cell) : 0;
    if (!size || !key || *size > page_size * pages_.count()) return;
    const auto payload = payload_of(cell, *size, is_table);
    if (!payload) return;
    ScannedRow row{static_cast<std::int64_t>(*key), {}};
    if (decode(*payload, row)) visit_(row);
  }

  /// Joins what lies on the page with its overflow pages: section 1.6 of SQLite's format.
  std::optional<Bytes> payload_of(ByteView cell, std::uint64_t size, bool is_table) {
    const std::uint64_t largest = is_table ? page_size - 35 : (page_size - 12) * 64 / 255 - 23;
    const std::uint64_t smallest = (page_size - 12) * 32 / 255 - 23;
    std::uint64_t local = size;
    if (size > largest) {
      local = smallest + (size - smallest) % overflow_size;
      if (local > largest) local = smallest;
    }
    if (cell.size() < local + (local < size ? 4 : 0)) return {};
    Bytes payload(cell.begin(), cell.begin() + static_cast<std::ptrdiff_t>(local));
    std::uint64_t next = local < size ? big_endian(&cell[local], 4) : 0;
    Page page;
    while (payload.size() < size) {
      if (budget_ < page_size || !pages_.read(next, page)) return {};
      budget_ -= page_size;
      const std::uint64_t part = std::min(overflow_size, size - payload.size());
      payload.insert(payload.end(), page.begin() + 4, page.begin() + 4 + static_cast<std::ptrdiff_t>(part));
      next = big_endian(page.data(), 4);
    }
    return payload;
  }

  static bool decode(ByteView payload, ScannedRow& row) {
    ByteView types = payload;
    const auto header = take_varint(types);
    const std::size_t taken = payload.size() - types.size();
    if (!header || *header < taken || *header > payload.size()) return false;
    types = types.first(*header - taken);
    ByteView content = payload.subspan(*header);
    while (!types.empty()) {
      const auto type = take_varint(types);
      if (!type || !take_value(*type, content, row)) return false;
    }
    return content.empty();
  }

  static bool take_value(std::uint64_t type, ByteView& content, ScannedRow& row) {
    static constexpr std::array<int, 7> width{0, 1, 2, 3, 4, 6, 8};
    const std::uint64_t size = type < width.size() ? std::uint64_t(width[type])
                               : type < 10         ? 0
                                                   : (type - 12) / 2;  // text or blob
    if (type == 7 || type == 10 || type == 11 || size > content.size()) return false;
    const ByteView bytes = content.first(size);
    content = content.subspan(size);
    if (type == 0) {
      row.values.emplace_back();
    } else if (type < width.size()) {
      const int unused = 64 - 8 * width[type];
      const std::uint64_t value = big_endian(bytes.data(), width[type]) << unused;
      row.values.emplace_back(static_cast<std::int64_t>(value) >> unused);  // the sign is that of the first byte
    } else if (type < 10) {
      row.values.emplace_back(static_cast<std::int64_t>(type - 8));  // the constants 0 and 1
    } else if (type % 2 == 1) {
      row.values.emplace_back(text_of(bytes));
    } else {
      row.values.emplace_back(Bytes(bytes.begin(), bytes.end()));
    }
    return true;
  }

  Pages& pages_;
  const std::function<void(const ScannedRow&)>& visit_;
  Page page_;
  std::uint64_t budget_;  ///< bytes of overflow pages that may still be read
};

}  // namespace

Result<Done> scan_rows(const std::string& path, const std::function<void(const ScannedRow&)>& visit) {
  Pages pages;
  if (auto opened = pages.open(path); !opened) return opened;
  Scan(pages, visit).run();
  return Done{};
}

}  // namespace ctpm::recordings::session_file
