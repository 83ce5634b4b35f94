#include "recordings/internal/field_codec.h"

#include <algorithm>
#include <numeric>

namespace ctpm::recordings::session_file {

namespace {
/// Memory that a field costs beside its values: its view, its name and an entry of a map [bytes].
constexpr std::uint64_t view_memory = 256;
}  // namespace

std::size_t width_of(FieldType type) {
  switch (type) {
    case FieldType::u8:
      return 1;
    case FieldType::i32:
    case FieldType::u32:
      return 4;
    case FieldType::i64:
    case FieldType::u64:
    case FieldType::f64:
      return 8;
    default:
      return 0;
  }
}

FieldSet::FieldSet(ByteReader& in, std::string& problem) {
  const auto count = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && !in.failed() && problem.empty(); ++i) {
    if (!in.spend(1, view_memory)) break;
    FieldView field;
    field.name = text_of(in.take(in.get<std::uint16_t>()));
    field.type = static_cast<FieldType>(in.get<std::uint8_t>());
    field.count = in.get<std::uint64_t>();
    if (in.failed()) break;
    if (field.type == FieldType::text)
      field.body = in.take(field.count);
    else if (field.type == FieldType::list)
      field.body = in.take(in.get<std::uint64_t>());
    else if (const std::size_t width = width_of(field.type))
      field.body = skip_array(in, field.count, width);
    else
      problem = "field " + field.name + " has an unknown type";
    fields_.push_back(std::move(field));
  }
  if (in.failed() && problem.empty())
    problem = "the fields end too early, or need more memory than the file's size explains";
  by_name_.resize(fields_.size());
  std::iota(by_name_.begin(), by_name_.end(), 0);
  std::sort(by_name_.begin(), by_name_.end(), [&](auto a, auto b) { return fields_[a].name < fields_[b].name; });
  const auto twice = std::adjacent_find(by_name_.begin(), by_name_.end(),
                                        [&](auto a, auto b) { return fields_[a].name == fields_[b].name; });
  if (twice != by_name_.end() && problem.empty()) problem = "field " + fields_[*twice].name + " stands twice";
}

FieldView* FieldSet::find(std::string_view name) {
  const auto found = std::lower_bound(by_name_.begin(), by_name_.end(), name,
                                      [&](std::uint32_t i, std::string_view n) { return fields_[i].name < n; });
  return found == by_name_.end() || fields_[*found].name != name ? nullptr : &fields_[*found];
}

}  // namespace ctpm::recordings::session_file
