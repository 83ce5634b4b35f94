#include "tests/recordings/field_tree.h"

#include <algorithm>

#include "core/model/result.h"

namespace ctpm::testing {

using namespace recordings::session_file;

namespace {

constexpr std::uint64_t budget = 64 << 20;  // [bytes]; an array beyond it stays declared

template <class U>
std::vector<std::uint64_t> numbers_of(const FieldView& field) {
  ByteReader in(field.body, budget);
  std::vector<U> values;
  get_array(in, field.count, values);
  return {values.begin(), values.end()};
}

template <class U>
void put_numbers(Bytes& out, const FieldNode& node) {
  if (node.declared > 0) {  // order 1 without planes: the first value, again and again
    put(out, std::uint8_t{1});
    put(out, static_cast<U>(node.bits.empty() ? 0 : node.bits.front()));
    put(out, std::uint8_t{0});
    return;
  }
  std::vector<U> values(node.bits.size());
  std::transform(node.bits.begin(), node.bits.end(), values.begin(), [](std::uint64_t bits) { return U(bits); });
  put_array<U>(out, values);
}

void put_node(Bytes& out, const FieldNode& node) {
  put(out, static_cast<std::uint16_t>(node.name.size()));
  put_raw(out, node.name.data(), node.name.size());
  put(out, static_cast<std::uint8_t>(node.type));
  const std::size_t count = node.type == FieldType::list ? node.list.size() : node.bits.size();
  put(out, node.declared > 0 ? node.declared : std::uint64_t{count});
  if (node.type == FieldType::text) {
    for (const std::uint64_t letter : node.bits) put(out, static_cast<std::uint8_t>(letter));
  } else if (node.type == FieldType::list) {
    Bytes body;
    for (const FieldTree& one : node.list) {
      const Bytes bytes = write_tree(one);
      put(body, static_cast<std::uint32_t>(bytes.size()));
      put_raw(body, bytes.data(), bytes.size());
    }
    put(out, static_cast<std::uint64_t>(body.size()));
    put_raw(out, body.data(), body.size());
  } else if (width_of(node.type) == 1) {
    put_numbers<std::uint8_t>(out, node);
  } else if (width_of(node.type) == 4) {
    put_numbers<std::uint32_t>(out, node);
  } else {
    put_numbers<std::uint64_t>(out, node);
  }
}

}  // namespace

FieldTree read_tree(ByteView content) {
  ByteReader in(content, budget);
  std::string problem;
  const FieldSet set(in, problem);
  CTPM_CHECK(problem.empty(), "a field set of a good file");
  FieldTree tree;
  for (const FieldView& field : set.fields()) {
    FieldNode node{field.name, field.type, {}, {}, 0};
    if (field.type == FieldType::text) {
      node.bits.assign(field.body.begin(), field.body.end());
    } else if (field.type == FieldType::list) {
      ByteReader entries(field.body, budget);
      for (std::uint64_t i = 0; i < field.count; ++i) {
        const auto size = entries.get<std::uint32_t>();
        node.list.push_back(read_tree(entries.take(size)));
      }
    } else {
      const std::size_t width = width_of(field.type);
      node.bits = width == 1   ? numbers_of<std::uint8_t>(field)
                  : width == 4 ? numbers_of<std::uint32_t>(field)
                               : numbers_of<std::uint64_t>(field);
      if (node.bits.size() < field.count) node.declared = field.count;
    }
    tree.push_back(std::move(node));
  }
  return tree;
}

Bytes write_tree(const FieldTree& tree) {
  Bytes out;
  put(out, static_cast<std::uint32_t>(tree.size()));
  for (const FieldNode& node : tree) put_node(out, node);
  return out;
}

void collect_numbers(FieldTree& tree, std::vector<FieldNode*>& numbers) {
  for (FieldNode& node : tree) {
    if (node.is_number()) numbers.push_back(&node);
    for (FieldTree& one : node.list) collect_numbers(one, numbers);
  }
}

}  // namespace ctpm::testing
