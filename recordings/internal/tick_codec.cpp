#include "recordings/internal/tick_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <sstream>

#include "recordings/internal/block.h"

namespace ctpm::recordings::session_file {
namespace {

/// One column: access to its bits in a record.
struct Column {
  const char* name;
  FieldType type;
  std::uint64_t (*get)(const TickRecord&);
  void (*set)(TickRecord&, std::uint64_t);
};

template <class T>
using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

template <class T>
std::uint64_t bits_of(T value) {
  return std::bit_cast<Bits<T>>(value);
}
template <class T>
void set_bits(T& value, std::uint64_t bits) {
  value = std::bit_cast<T>(static_cast<Bits<T>>(bits));
}

#define CTPM_COLUMN(name, member)                                                                         \
  Column {                                                                                                \
    name, type_of<decltype(TickRecord::member)>(), [](const TickRecord& r) { return bits_of(r.member); }, \
        [](TickRecord& r, std::uint64_t bits) { set_bits(r.member, bits); }                               \
  }
#define CTPM_COLUMN_OF(name, type, member)                                  \
  Column {                                                                  \
    name, type, [](const TickRecord& r) { return bits_of(r.member); },      \
        [](TickRecord& r, std::uint64_t bits) { set_bits(r.member, bits); } \
  }

constexpr double nanoseconds = 1e9;               // in a second
constexpr std::uint64_t millisecond = 1'000'000;  // [ns]

std::uint64_t to_nanoseconds(double seconds) {
  return seconds > 0 ? static_cast<std::uint64_t>(std::llround(std::min(seconds, 1e9) * nanoseconds)) : 0;
}

const std::array columns = {
    CTPM_COLUMN_OF("tool", FieldType::i32, inputs.tool),
    CTPM_COLUMN_OF("buttons", FieldType::u32, inputs.buttons),
    CTPM_COLUMN_OF("position.x", FieldType::f64, inputs.position.x),
    CTPM_COLUMN_OF("position.y", FieldType::f64, inputs.position.y),
    CTPM_COLUMN_OF("position.z", FieldType::f64, inputs.position.z),
    CTPM_COLUMN_OF("rotation.w", FieldType::f64, inputs.world_from_tool.w),
    CTPM_COLUMN_OF("rotation.x", FieldType::f64, inputs.world_from_tool.x),
    CTPM_COLUMN_OF("rotation.y", FieldType::f64, inputs.world_from_tool.y),
    CTPM_COLUMN_OF("rotation.z", FieldType::f64, inputs.world_from_tool.z),
    CTPM_COLUMN_OF("force.x", FieldType::f64, tool_force.x),
    CTPM_COLUMN_OF("force.y", FieldType::f64, tool_force.y),
    CTPM_COLUMN_OF("force.z", FieldType::f64, tool_force.z),
    CTPM_COLUMN("depth", depth),
    CTPM_COLUMN("status", status),
    CTPM_COLUMN("iterations", iterations),
    CTPM_COLUMN("contacts", contacts),
    CTPM_COLUMN("severed", severed),
    Column{"tick_time_ns", FieldType::u64, [](const TickRecord& r) { return to_nanoseconds(r.tick_time); },
           [](TickRecord& r, std::uint64_t ns) { r.tick_time = static_cast<double>(ns) / nanoseconds; }},
    CTPM_COLUMN("state_hash", state_hash),
    Column{"input_age_ns", FieldType::u64, [](const TickRecord& r) { return to_nanoseconds(r.input_age); },
           [](TickRecord& r, std::uint64_t ns) { r.input_age = static_cast<double>(ns) / nanoseconds; }},
    Column{"slip_ms", FieldType::u64, [](const TickRecord& r) { return to_nanoseconds(r.slip) / millisecond; },
           [](TickRecord& r, std::uint64_t ms) { r.slip = static_cast<double>(ms) / 1000; }},
    // From here on, of the second hand: written only of a scene that has one.
    CTPM_COLUMN_OF("second.tool", FieldType::i32, inputs.second.tool),
    CTPM_COLUMN_OF("second.buttons", FieldType::u32, inputs.second.buttons),
    CTPM_COLUMN_OF("second.position.x", FieldType::f64, inputs.second.position.x),
    CTPM_COLUMN_OF("second.position.y", FieldType::f64, inputs.second.position.y),
    CTPM_COLUMN_OF("second.position.z", FieldType::f64, inputs.second.position.z),
    CTPM_COLUMN_OF("second.rotation.w", FieldType::f64, inputs.second.world_from_tool.w),
    CTPM_COLUMN_OF("second.rotation.x", FieldType::f64, inputs.second.world_from_tool.x),
    CTPM_COLUMN_OF("second.rotation.y", FieldType::f64, inputs.second.world_from_tool.y),
    CTPM_COLUMN_OF("second.rotation.z", FieldType::f64, inputs.second.world_from_tool.z),
    CTPM_COLUMN_OF("second.force.x", FieldType::f64, second.tool_force.x),
    CTPM_COLUMN_OF("second.force.y", FieldType::f64, second.tool_force.y),
    CTPM_COLUMN_OF("second.force.z", FieldType::f64, second.tool_force.z),
    CTPM_COLUMN_OF("second.depth", FieldType::f64, second.depth),
    CTPM_COLUMN_OF("second.contacts", FieldType::i32, second.contacts),
};
constexpr std::size_t second_hand_columns = 14;

/// The columns of a session with so many hands.
std::span<const Column> columns_of(std::int32_t hands) {
  return std::span(columns).first(columns.size() - (hands > 1 ? 0 : second_hand_columns));
}

const char* type_name(FieldType type) {
  switch (type) {
    case FieldType::i32:
      return "i32";
    case FieldType::u32:
      return "u32";
    case FieldType::u64:
      return "u64";
    default:
      return "f64";
  }
}

}  // namespace

std::string column_text(std::int32_t hands) {
  std::string text;
  for (const Column& column : columns_of(hands)) text += std::string(column.name) + " " + type_name(column.type) + "\n";
  return text;
}

void put_records(Bytes& out, std::span<const TickRecord> records, std::int32_t hands) {
  std::vector<std::uint64_t> wide(records.size());
  std::vector<std::uint32_t> narrow(records.size());
  for (const Column& column : columns_of(hands)) {
    std::transform(records.begin(), records.end(), wide.begin(), column.get);
    if (width_of(column.type) == 8) {
      put_array<std::uint64_t>(out, wide);
    } else {
      std::transform(wide.begin(), wide.end(), narrow.begin(),
                     [](std::uint64_t bits) { return static_cast<std::uint32_t>(bits); });
      put_array<std::uint32_t>(out, narrow);
    }
  }
}

Result<RecordDecoder> RecordDecoder::create(const std::string& text) {
  RecordDecoder decoder;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& c) {
      return line == std::string(c.name) + " " + type_name(c.type);
    });
    const std::size_t index = found - columns.begin();
    if (found == columns.end())
      return Error{"", "part columns: unknown column '" + line.substr(0, 40) + "', written by a newer program", ""};
    if (std::count(decoder.columns_.begin(), decoder.columns_.end(), index) > 0)
      return Error{"", "part columns: column '" + line + "' stands twice", ""};
    decoder.columns_.push_back(index);
  }
  return decoder;
}

Result<std::vector<TickRecord>> RecordDecoder::decode(ByteView content, std::int64_t count) const {
  ByteReader in(content, max_chunk_size);
  const Error broken{"", "its columns cannot be decoded", ""};
  if (count < 0 || !in.spend(count, sizeof(TickRecord))) return broken;
  std::vector<TickRecord> records(count);
  std::vector<std::uint64_t> wide;
  std::vector<std::uint32_t> narrow;
  for (const std::size_t index : columns_) {
    if (width_of(columns[index].type) == 8) {
      get_array(in, count, wide);
    } else {
      get_array(in, count, narrow);
      wide.assign(narrow.begin(), narrow.end());
    }
    if (in.failed()) return broken;
    for (std::int64_t i = 0; i < count; ++i) columns[index].set(records[i], wide[i]);
  }
  if (!in.at_end()) return broken;
  return records;
}

}  // namespace ctpm::recordings::session_file
