#include <algorithm>
#include <cctype>

#include "importers/number_source.h"
#include "importers/volume_mesh.h"
#include "importers/vtk_cells.h"

// VTK's legacy format, as "VTK File Formats" describes it, with the layout of cells of version 5.
namespace ctpm::importers {
namespace {

std::string upper(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  return text;
}

class VtkReader {
 public:
  explicit VtkReader(std::string_view text) : from_(text) {}

  VolumeMesh read() {
    const std::string_view head = from_.line();
    if (!head.starts_with("# vtk DataFile Version"))
      throw BrokenMesh{"is not a legacy VTK file: it does not begin with \"# vtk DataFile Version\"", ""};
    is_new_ = head.find("Version 5") != std::string_view::npos;
    from_.line();
    const std::string kind = upper(from_.word());
    if (kind != "ASCII" && kind != "BINARY")
      throw BrokenMesh{"says neither ASCII nor BINARY", "the file may be damaged"};
    from_.line();
    is_binary_ = kind == "BINARY";
    while (true) {
      const std::string section = upper(from_.word());
      if (section.empty() || section == "CELL_DATA" || section == "POINT_DATA") break;
      read_section(section);
    }
    if (!offset_.empty() && type_.size() + 1 != offset_.size())
      throw BrokenMesh{"has cells without types", "the file may be damaged"};
    add_vtk_cells(offset_, corner_, type_, mesh_);
    return std::move(mesh_);
  }

 private:
  std::size_t number() {
    const auto value = NumberSource::parsed<std::int64_t>(from_.word());
    if (value < 0 || std::uint64_t(value) > from_.size())
      throw BrokenMesh{"promises more than it holds: " + std::to_string(value) + " of something",
                       "the file may be damaged"};
    return std::size_t(value);
  }

  void read_section(const std::string& section) {
    if (section == "DATASET") {
      const std::string kind = upper(from_.word());
      is_polygons_ = kind == "POLYDATA";
      if (!is_polygons_ && kind != "UNSTRUCTURED_GRID")
        throw BrokenMesh{"is a data set of kind " + kind + "; UNSTRUCTURED_GRID and POLYDATA are read", ""};
    } else if (section == "FIELD") {
      skip_field();
    } else if (section == "METADATA") {
      from_.line();
      while (!from_.line().empty()) {
      }
    } else if (section == "POINTS") {
      const std::size_t count = number();
      const std::string type(from_.word());
      for_numbers(type, 3 * count, [&](std::size_t n, double value) {
        if (n % 3 == 0) mesh_.point.emplace_back();
        Vec3& p = mesh_.point.back();
        (n % 3 == 0 ? p.x : n % 3 == 1 ? p.y : p.z) = value;
      });
    } else if (section == "CELLS" || section == "POLYGONS") {
      read_cells(offset_, corner_);
      if (is_polygons_) type_.assign(offset_.empty() ? 0 : offset_.size() - 1, kVtkPolygon);
    } else if (section == "VERTICES" || section == "LINES") {
      std::vector<std::int64_t> offset, corner;
      read_cells(offset, corner);
    } else if (section == "CELL_TYPES") {
      const std::size_t count = number();
      for_numbers("int", count, [&](std::size_t, double value) { type_.push_back(std::int64_t(value)); });
    } else {
      throw BrokenMesh{"has a section '" + section.substr(0, 40) + "', which is not read",
                       section == "TRIANGLE_STRIPS" ? "save it with triangles" : "the file may be damaged"};
    }
  }

  /// Calls `take(n, value)` for each number of an array that follows the end of this line.
  template <class Take>
  void for_numbers(const std::string& type, std::size_t count, const Take& take) {
    from_.line();
    from_.is_binary = is_binary_, from_.is_swapped = true;  // always big endian
    const auto all = [&](auto kind) {
      for (std::size_t n = 0; n < count; ++n) take(n, double(from_.get<decltype(kind)>()));
    };
    if (!is_binary_) {
      all(double{});
    } else if (type == "double") {
      all(double{});
    } else if (type == "float") {
      all(float{});
    } else if (type == "int") {
      all(std::int32_t{});
    } else if (type == "vtktypeint64" || type == "long" || type == "vtkIdType") {
      all(std::int64_t{});
    } else if (type == "unsigned_char" || type == "char") {
      all(std::int8_t{});
    } else if (type == "short" || type == "unsigned_short") {
      all(std::int16_t{});
    } else if (type == "unsigned_int") {
      all(std::uint32_t{});
    } else {
      throw BrokenMesh{"has numbers of type '" + type.substr(0, 40) + "', which are not read", ""};
    }
    from_.is_binary = false;
  }

  void skip_field() {
    from_.word();
    const std::size_t arrays = number();
    for (std::size_t a = 0; a < arrays; ++a) {
      while (upper(from_.word()) == "METADATA") {
        from_.line();
        while (!from_.line().empty()) {
        }
      }
      const std::size_t components = number(), tuples = number();
      const std::string type(from_.word());
      if (type == "string") {
        from_.line();
        throw BrokenMesh{"has texts as field data, which are not read", "save it without field data"};
      }
      if (components != 0 && tuples > from_.size() / components) throw BrokenMesh{"ends in the middle", ""};
      for_numbers(type, components * tuples, [](std::size_t, double) {});
    }
  }

  void read_cells(std::vector<std::int64_t>& offset, std::vector<std::int64_t>& corner) {
    const std::size_t first = number(), second = number();
    if (is_new_) {
      if (first == 0) return;
      const auto array = [&](const char* name, std::size_t count, std::vector<std::int64_t>& into) {
        if (upper(from_.word()) != name) throw BrokenMesh{std::string("has cells without ") + name, ""};
        const std::string type(from_.word());
        for_numbers(type, count, [&](std::size_t, double value) { into.push_back(std::int64_t(value)); });
      };
      array("OFFSETS", first, offset);
      array("CONNECTIVITY", second, corner);
      return;
    }
    offset.assign(1, 0);
    std::int64_t left = 0;
    for_numbers("int", second, [&](std::size_t, double value) {
      if (left > 0)
        corner.push_back(std::int64_t(value)), --left;
      else
        left = std::int64_t(value), offset.push_back(offset.back() + left);
    });
    if (left != 0 || offset.size() != first + 1)
      throw BrokenMesh{"has cells whose sizes do not fit", "the file may be damaged"};
  }

  NumberSource from_;
  bool is_binary_ = false, is_new_ = false, is_polygons_ = false;
  VolumeMesh mesh_;
  std::vector<std::int64_t> offset_, corner_, type_;
};

ElementKind kind_of(std::int64_t type) {
  using K = ElementKind;
  switch (type) {
    case 5:
    case 22:
      return K::triangle;
    case 9:
    case 23:
      return K::quad;
    case 10:
    case 24:
      return K::tetrahedron;
    case 12:
    case 25:
      return K::hexahedron;
    case 13:
    case 26:
      return K::wedge;
    case 14:
    case 27:
      return K::pyramid;
    case 1:
    case 2:
    case 3:
    case 4:
    case 21:
      return K::other;
    default:
      throw BrokenMesh{"has cells of VTK's type " + std::to_string(type) + ", which are not read",
                       "save it with tetrahedra, hexahedra, wedges, pyramids or polygons"};
  }
}

}  // namespace

void add_vtk_cells(const std::vector<std::int64_t>& offset, const std::vector<std::int64_t>& corner,
                   const std::vector<std::int64_t>& type, VolumeMesh& mesh) {
  const BrokenMesh broken{"has cells whose sizes do not fit", "the file may be damaged"};
  for (std::size_t n = 0; n < type.size(); ++n) {
    const std::int64_t begin = offset[n], end = offset[n + 1];
    if (begin < 0 || begin > end || end > std::int64_t(corner.size())) throw broken;
    const std::int64_t* const own = corner.data() + begin;
    if (type[n] == kVtkPolygon) {
      // A fan, as of the convex polygons that such files hold.
      for (std::int64_t c = 2; c < end - begin; ++c) {
        const std::int64_t fan[3] = {own[0], own[c - 1], own[c]};
        mesh.add(ElementKind::triangle, fan);
      }
      continue;
    }
    const ElementKind kind = kind_of(type[n]);
    if (kind == ElementKind::other) continue;
    if (end - begin < std::int64_t(corners_of(kind))) throw broken;
    mesh.add(kind, own);
  }
}

VolumeMesh read_vtk(std::string_view text) { return VtkReader(text).read(); }

}  // namespace ctpm::importers
