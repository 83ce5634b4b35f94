#include <zlib.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <sstream>

#include "importers/number_source.h"
#include "importers/volume_mesh.h"
#include "importers/vtk_cells.h"

// VTK's XML format of unstructured grids, as "VTK File Formats" describes it: arrays as text, as base64 inside the
// element, or appended as base64 or raw bytes; each whole or in blocks of zlib.
namespace ctpm::importers {
namespace {

namespace pt = boost::property_tree;

std::string from_base64(std::string_view text, std::size_t& used) {
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (used = 0; used < text.size(); ++used) {
    const char c = text[used];
    int value = -1;
    if (c >= 'A' && c <= 'Z') value = c - 'A';
    if (c >= 'a' && c <= 'z') value = c - 'a' + 26;
    if (c >= '0' && c <= '9') value = c - '0' + 52;
    if (c == '+') value = 62;
    if (c == '/') value = 63;
    if (value < 0 && (c == '=' || count > 0 || !bytes.empty())) break;
    if (value < 0) continue;
    bits = bits << 6 | unsigned(value), ++count;
    if (count == 4) {
      for (int b = 16; b >= 0; b -= 8) bytes += char(bits >> b & 0xFF);
      bits = 0, count = 0;
    }
  }
  if (count == 2) bytes += char(bits >> 4 & 0xFF);
  if (count == 3) bytes += char(bits >> 10 & 0xFF), bytes += char(bits >> 2 & 0xFF);
  while (used < text.size() && text[used] == '=') ++used;
  return bytes;
}

class VtuReader {
 public:
  explicit VtuReader(std::string_view text) {
    // What is appended is not XML.
    std::string xml(text);
    if (const auto open = text.find("<AppendedData"); open != std::string_view::npos) {
      const auto begin = text.find('_', open), tag = text.find('>', open);
      if (begin == std::string_view::npos || tag == std::string_view::npos)
        throw BrokenMesh{"ends in the middle", "it may not have been copied whole"};
      is_raw_ = text.substr(open, tag - open).find("\"raw\"") != std::string_view::npos;
      appended_ = text.substr(begin + 1);
      xml = std::string(text.substr(0, open)) + "</VTKFile>";
    }
    std::istringstream in(xml);
    try {
      pt::read_xml(in, tree_);
    } catch (const pt::xml_parser_error& trouble) {
      throw BrokenMesh{"is not XML: " + trouble.message() + " in line " + std::to_string(trouble.line()),
                       "the file may be damaged"};
    }
  }

  VolumeMesh read() {
    const auto file = tree_.get_child_optional("VTKFile");
    if (!file || file->get("<xmlattr>.type", "") != "UnstructuredGrid")
      throw BrokenMesh{"is not a VTK file of an unstructured grid", ""};
    is_swapped_ = file->get("<xmlattr>.byte_order", "LittleEndian") == "BigEndian";
    is_wide_ = file->get("<xmlattr>.header_type", "UInt32") == "UInt64";
    const std::string packer = file->get("<xmlattr>.compressor", "");
    is_packed_ = !packer.empty();
    if (is_packed_ && packer != "vtkZLibDataCompressor")
      throw BrokenMesh{"is compressed by " + packer.substr(0, 40) + ", which is not read",
                       "save it with zlib or without compression"};
    VolumeMesh mesh;
    const auto grid = file->get_child_optional("UnstructuredGrid");
    for (const auto& [name, piece] : grid ? *grid : pt::ptree()) {
      if (name != "Piece") continue;
      const auto first = std::int64_t(mesh.point.size());
      const std::vector<double> xyz = array(piece, "Points", "");
      if (xyz.size() % 3 != 0) throw BrokenMesh{"has points that are not three numbers each", ""};
      for (std::size_t n = 0; n < xyz.size(); n += 3) mesh.point.push_back({xyz[n], xyz[n + 1], xyz[n + 2]});
      std::vector<std::int64_t> corner = whole(array(piece, "Cells", "connectivity")), offset{0};
      for (std::int64_t& c : corner) c += first;
      for (const std::int64_t end : whole(array(piece, "Cells", "offsets"))) offset.push_back(end);
      const std::vector<std::int64_t> type = whole(array(piece, "Cells", "types"));
      if (offset.size() != type.size() + 1)
        throw BrokenMesh{"has cells whose sizes do not fit", "the file may be damaged"};
      add_vtk_cells(offset, corner, type, mesh);
    }
    return mesh;
  }

 private:
  static std::vector<std::int64_t> whole(const std::vector<double>& values) {
    std::vector<std::int64_t> numbers;
    for (const double value : values) {
      if (!(std::abs(value) < 1e15)) throw BrokenMesh{"has a number that is no index", "the file may be damaged"};
      numbers.push_back(std::int64_t(value));
    }
    return numbers;
  }

  /// The numbers of the array of that name in a section of a piece; the only one if the name is empty.
  std::vector<double> array(const pt::ptree& piece, const std::string& section, const std::string& name) const {
    const auto list = piece.get_child_optional(section);
    for (const auto& [tag, one] : list ? *list : pt::ptree())
      if (tag == "DataArray" && (name.empty() || one.get("<xmlattr>.Name", "") == name)) return numbers_of(one);
    throw BrokenMesh{"has no array " + section + " " + name, "the file may be damaged"};
  }

  std::vector<double> numbers_of(const pt::ptree& one) const {
    const std::string format = one.get("<xmlattr>.format", "ascii"), type = one.get("<xmlattr>.type", "");
    std::vector<double> values;
    const std::string text = one.data();
    if (format == "ascii") {
      NumberSource from(text);
      for (from.skip_space(); !from.is_at_end(); from.skip_space()) values.push_back(from.get<double>());
      return values;
    }
    std::string bytes;
    if (format == "binary") {
      bytes = unpacked(text, false);
    } else {
      const auto offset = one.get<std::uint64_t>("<xmlattr>.offset", 0);
      if (offset > appended_.size()) throw BrokenMesh{"ends in the middle", "it may not have been copied whole"};
      bytes = unpacked(appended_.substr(offset), is_raw_);
    }
    NumberSource from(bytes);
    from.is_binary = true, from.is_swapped = is_swapped_;
    const auto all = [&](auto kind) {
      while (from.size() >= sizeof kind) values.push_back(double(from.get<decltype(kind)>()));
    };
    if (type == "Float64") {
      all(double{});
    } else if (type == "Float32") {
      all(float{});
    } else if (type == "Int64" || type == "UInt64") {
      all(std::int64_t{});
    } else if (type == "Int32" || type == "UInt32") {
      all(std::int32_t{});
    } else if (type == "UInt8" || type == "Int8") {
      all(std::uint8_t{});
    } else {
      throw BrokenMesh{"has numbers of type '" + type.substr(0, 40) + "', which are not read", ""};
    }
    return values;
  }

  /// The bytes of an array behind its header. Blocks of zlib have a header of their own: how many, their size, the size
  /// of the last, and their packed sizes.
  std::string unpacked(std::string_view from, bool is_raw) const {
    const auto bytes_of = [&](std::string_view& rest) {
      if (is_raw) return std::string(rest);
      std::size_t used = 0;
      std::string bytes = from_base64(rest, used);
      rest.remove_prefix(used);
      return bytes;
    };
    std::string bytes = bytes_of(from);
    NumberSource head(bytes);
    head.is_binary = true, head.is_swapped = is_swapped_;
    const auto size = [&] { return is_wide_ ? head.raw<std::uint64_t>() : std::uint64_t(head.raw<std::uint32_t>()); };
    if (!is_packed_) {
      const std::uint64_t count = size();
      // Without padding the header and its data are encoded as one.
      if (head.is_at_end() && count > 0 && !is_raw) {
        bytes = bytes_of(from);
        head = NumberSource(bytes);
      }
      return std::string(head.take(std::size_t(count)));
    }
    const std::uint64_t blocks = size(), block = size(), last = size();
    std::vector<std::uint64_t> packed;
    for (std::uint64_t b = 0; b < blocks; ++b) packed.push_back(size());
    std::string data;
    if (!is_raw) {
      data = bytes_of(from);
      head = NumberSource(data);
    }
    std::string all;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::string_view part = head.take(std::size_t(packed[b]));
      const std::uint64_t expected = b + 1 == blocks && last != 0 ? last : block;
      constexpr std::uint64_t kDeflate = 1032;  // largest ratio
      if (expected > kDeflate * (part.size() + 64)) throw BrokenMesh{"promises more than it holds", ""};
      std::string plain(std::size_t(expected), '\0');
      uLongf count = uLongf(expected);
      if (uncompress(reinterpret_cast<Bytef*>(plain.data()), &count, reinterpret_cast<const Bytef*>(part.data()),
                     uLong(part.size())) != Z_OK ||
          count != expected)
        throw BrokenMesh{"has a block that cannot be unpacked", "the file may be damaged"};
      all += plain;
    }
    return all;
  }

  pt::ptree tree_;
  std::string_view appended_;
  bool is_raw_ = false, is_swapped_ = false, is_wide_ = false, is_packed_ = false;
};

}  // namespace

VolumeMesh read_vtu(std::string_view text) { return VtuReader(text).read(); }

}  // namespace ctpm::importers
