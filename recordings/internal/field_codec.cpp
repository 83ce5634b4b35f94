#include "recordings/internal/field_codec.h"

#include <algorithm>

namespace ctpm::recordings::session_file {

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
    FieldView field;
    field.name = text_of(in.take(in.get<std::uint16_t>()));
    field.type = static_cast<FieldType>(in.get<std::uint8_t>());
    field.count = in.get<std::uint64_t>();
    if (in.failed()) break;
    if (find(field.name)) problem = "field " + field.name + " stands twice";
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
  if (in.failed() && problem.empty()) problem = "the fields end too early";
}

FieldView* FieldSet::find(std::string_view name) {
  const auto found = std::find_if(fields_.begin(), fields_.end(), [&](const FieldView& f) { return f.name == name; });
  return found == fields_.end() ? nullptr : &*found;
}

}  // namespace ctpm::recordings::session_file
