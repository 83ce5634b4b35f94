#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "recordings/internal/field_codec.h"

namespace ctpm::testing {

/// A field of a stored field set with its values, so that a test can change any of them and write the set again.
struct FieldNode {
  using Type = recordings::session_file::FieldType;

  std::string name;
  Type type = Type::u8;
  std::vector<std::uint64_t> bits;           ///< of the values; of a text, its bytes
  std::vector<std::vector<FieldNode>> list;  ///< of a list
  std::uint64_t declared = 0;                ///< > 0: so many equal values are declared in a few bytes

  bool is_number() const { return type != Type::text && type != Type::list; }
};
using FieldTree = std::vector<FieldNode>;

FieldTree read_tree(recordings::session_file::ByteView content);
recordings::session_file::Bytes write_tree(const FieldTree& tree);

/// All number fields of the tree, at any depth.
void collect_numbers(FieldTree& tree, std::vector<FieldNode*>& numbers);

}  // namespace ctpm::testing
