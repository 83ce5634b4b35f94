#include <unordered_map>

#include "importers/number_source.h"
#include "importers/volume_mesh.h"

// Gmsh's file format as chapter "MSH file format" of its manual describes it.
namespace ctpm::importers {
namespace {

struct GmshKind {
  ElementKind kind;
  std::size_t nodes;
};

/// Gmsh's element types up to the second order; the corners come first in each.
GmshKind kind_of(std::int64_t type) {
  using K = ElementKind;
  switch (type) {
    case 1:
      return {K::other, 2};
    case 2:
      return {K::triangle, 3};
    case 3:
      return {K::quad, 4};
    case 4:
      return {K::tetrahedron, 4};
    case 5:
      return {K::hexahedron, 8};
    case 6:
      return {K::wedge, 6};
    case 7:
      return {K::pyramid, 5};
    case 8:
      return {K::other, 3};
    case 9:
      return {K::triangle, 6};
    case 10:
      return {K::quad, 9};
    case 11:
      return {K::tetrahedron, 10};
    case 15:
      return {K::other, 1};
    case 16:
      return {K::quad, 8};
    default:
      throw BrokenMesh{"has elements of Gmsh's type " + std::to_string(type) + ", which are not read",
                       "save it with elements of first order"};
  }
}

class MshReader {
 public:
  explicit MshReader(std::string_view text) : from_(text) {}

  VolumeMesh read() {
    while (true) {
      from_.skip_space();
      if (from_.is_at_end()) break;
      const std::string section(from_.line());
      if (section == "$MeshFormat") read_format();
      if (section == "$PhysicalNames") read_names();
      if (section == "$Entities") read_entities();
      if (section == "$Nodes") is_old_ ? read_old_nodes() : read_nodes();
      if (section == "$Elements") is_old_ ? read_old_elements() : read_elements();
      skip_to_end_of(section);
    }
    for (std::int64_t& c : mesh_.corner) {
      const auto found = index_.find(c);
      if (found == index_.end())
        throw BrokenMesh{"has an element that uses node " + std::to_string(c) + ", which it does not hold",
                         "the file may be damaged"};
      c = found->second;
    }
    return std::move(mesh_);
  }

 private:
  void skip_to_end_of(const std::string& section) {
    if (!section.starts_with('$')) throw BrokenMesh{"is not a file of Gmsh", "its sections begin with $"};
    const std::string end = "$End" + section.substr(1);
    while (true) {
      const std::string_view line = from_.line();
      if (line == end) return;
    }
  }

  void read_format() {
    const double version = NumberSource::parsed<double>(from_.word());
    is_old_ = version >= 2 && version < 3;
    if (!is_old_ && version != 4.1)
      throw BrokenMesh{"is of Gmsh's format " + std::to_string(version).substr(0, 3) + "; 2.2 and 4.1 are read",
                       "save it again with a Gmsh of today"};
    from_.is_binary = NumberSource::parsed<int>(from_.word()) == 1;
    if (NumberSource::parsed<int>(from_.word()) != 8) throw BrokenMesh{"has numbers of another size than 8 bytes", ""};
    from_.line();
    if (!from_.is_binary) return;
    const auto one = from_.raw<std::int32_t>();
    from_.is_swapped = one != 1;
  }

  void read_names() {
    const auto count = NumberSource::parsed<std::int64_t>(from_.word());
    for (std::int64_t i = 0; i < count; ++i) {
      const auto dimension = NumberSource::parsed<int>(from_.word());
      const auto tag = NumberSource::parsed<std::int32_t>(from_.word());
      std::string_view name = from_.line();
      const auto open = name.find('"'), close = name.rfind('"');
      if (open == close) throw BrokenMesh{"has a physical group without a name", "the file may be damaged"};
      if (dimension == 3) mesh_.region_name[tag] = std::string(name.substr(open + 1, close - open - 1));
    }
  }

  /// Which physical group each volume belongs to: its first.
  void read_entities() {
    std::size_t counts[4];
    for (std::size_t& count : counts) count = from_.count<std::uint64_t>();
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::size_t i = 0; i < counts[dimension]; ++i) {
        const auto tag = from_.get<std::int32_t>();
        for (int c = 0; c < (dimension == 0 ? 3 : 6); ++c) from_.get<double>();
        const std::size_t groups = from_.count<std::uint64_t>();
        for (std::size_t g = 0; g < groups; ++g) {
          const auto group = from_.get<std::int32_t>();
          if (dimension == 3 && g == 0) group_of_volume_[tag] = group;
        }
        if (dimension == 0) continue;
        const std::size_t bounds = from_.count<std::uint64_t>();
        for (std::size_t b = 0; b < bounds; ++b) from_.get<std::int32_t>();
      }
  }

  void add_node(std::int64_t tag, Vec3 place) {
    index_[tag] = std::int64_t(mesh_.point.size());
    mesh_.point.push_back(place);
  }

  Vec3 point() {
    const auto x = from_.get<double>(), y = from_.get<double>(), z = from_.get<double>();
    return {x, y, z};
  }

  void read_nodes() {
    const std::size_t blocks = from_.count<std::uint64_t>();
    for (int i = 0; i < 3; ++i) from_.get<std::uint64_t>();
    for (std::size_t b = 0; b < blocks; ++b) {
      const auto dimension = from_.get<std::int32_t>();
      from_.get<std::int32_t>();
      const bool is_parametric = from_.get<std::int32_t>() != 0;
      std::vector<std::int64_t> tags(from_.count<std::uint64_t>());
      for (std::int64_t& tag : tags) tag = std::int64_t(from_.get<std::uint64_t>());
      for (const std::int64_t tag : tags) {
        add_node(tag, point());
        for (int p = 0; is_parametric && p < dimension; ++p) from_.get<double>();
      }
    }
  }

  void add_element(GmshKind what, std::int32_t region, const std::vector<std::int64_t>& nodes) {
    if (what.kind == ElementKind::other) return;
    mesh_.add(what.kind, nodes.data());
    mesh_.region.push_back(region);
  }

  void read_elements() {
    const std::size_t blocks = from_.count<std::uint64_t>();
    for (int i = 0; i < 3; ++i) from_.get<std::uint64_t>();
    for (std::size_t b = 0; b < blocks; ++b) {
      from_.get<std::int32_t>();
      const auto entity = from_.get<std::int32_t>();
      const GmshKind what = kind_of(from_.get<std::int32_t>());
      const auto group = group_of_volume_.find(entity);
      const std::size_t count = from_.count<std::uint64_t>();
      std::vector<std::int64_t> nodes(what.nodes);
      for (std::size_t e = 0; e < count; ++e) {
        from_.get<std::uint64_t>();
        for (std::int64_t& node : nodes) node = std::int64_t(from_.get<std::uint64_t>());
        add_element(what, group == group_of_volume_.end() ? entity : group->second, nodes);
      }
    }
  }

  void read_old_nodes() {
    const auto count = NumberSource::parsed<std::int64_t>(from_.word());
    if (from_.is_binary) from_.line();
    for (std::int64_t i = 0; i < count; ++i) {
      const auto tag = from_.get<std::int32_t>();
      add_node(tag, point());
    }
  }

  void read_old_elements() {
    const auto count = NumberSource::parsed<std::int64_t>(from_.word());
    if (from_.is_binary) from_.line();
    for (std::int64_t done = 0; done < count;) {
      // Binary elements of a kind share a header; as text, each has its own.
      std::int32_t type = 0, together = 1, tags = 0;
      if (!from_.is_binary) from_.get<std::int32_t>();
      type = from_.get<std::int32_t>();
      if (from_.is_binary) together = from_.get<std::int32_t>();
      tags = from_.get<std::int32_t>();
      if (together < 1) throw BrokenMesh{"has a block of no elements", "the file may be damaged"};
      const GmshKind what = kind_of(type);
      std::vector<std::int64_t> nodes(what.nodes);
      for (std::int32_t e = 0; e < together; ++e, ++done) {
        if (from_.is_binary) from_.get<std::int32_t>();
        std::int32_t region = 0;
        for (std::int32_t t = 0; t < tags; ++t) {
          const auto tag = from_.get<std::int32_t>();
          if (t == 0) region = tag;
        }
        for (std::int64_t& node : nodes) node = from_.get<std::int32_t>();
        add_element(what, region, nodes);
      }
    }
  }

  NumberSource from_;
  bool is_old_ = false;
  VolumeMesh mesh_;
  std::unordered_map<std::int64_t, std::int64_t> index_;  ///< of a node, by its tag
  std::unordered_map<std::int32_t, std::int32_t> group_of_volume_;
};

}  // namespace

VolumeMesh read_msh(std::string_view text) { return MshReader(text).read(); }

}  // namespace ctpm::importers
