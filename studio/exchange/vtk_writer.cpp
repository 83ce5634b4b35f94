#include <cstdio>
#include <cstring>

#include "studio/exchange/writers.h"

// VTK's XML format, as "VTK File Formats" describes it: each array as base64 of its size and its bytes.
namespace ctpm::exchange {
namespace {

constexpr double kMillimetre = 1e3;

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t b = 0; b < 3; ++b)
      bits = bits << 8 | (i + b < bytes.size() ? static_cast<unsigned char>(bytes[i + b]) : 0u);
    for (std::size_t d = 0; d < 4; ++d) text += i + d > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * d) & 63];
  }
  return text;
}

template <class T>
constexpr const char* type_name();
template <>
constexpr const char* type_name<float>() {
  return "Float32";
}
template <>
constexpr const char* type_name<double>() {
  return "Float64";
}
template <>
constexpr const char* type_name<std::int64_t>() {
  return "Int64";
}
template <>
constexpr const char* type_name<std::uint8_t>() {
  return "UInt8";
}
template <>
constexpr const char* type_name<std::int32_t>() {
  return "Int32";
}

/// An XML element DataArray.
template <class T>
std::string array(const std::string& name, int components, const std::vector<T>& values, bool is_field = false) {
  const std::uint64_t count = values.size() * sizeof(T);
  std::string bytes(sizeof count + count, '\0');
  std::memcpy(bytes.data(), &count, sizeof count);
  if (count > 0) std::memcpy(bytes.data() + sizeof count, values.data(), count);
  return "<DataArray type=\"" + std::string(type_name<T>()) + "\" Name=\"" + name + "\"" +
         (components > 1 ? " NumberOfComponents=\"" + std::to_string(components) + "\"" : "") +
         (is_field ? " NumberOfTuples=\"" + std::to_string(values.size() / std::size_t(components)) + "\"" : "") +
         " format=\"binary\">" + base64(bytes) + "</DataArray>\n";
}

void add_mm(std::vector<float>& into, Vec3 p) {
  for (const double x : {p.x, p.y, p.z}) into.push_back(float(kMillimetre * x));
}

std::string in_file(const std::string& type, const std::string& content) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type +
         "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n" + content + "</VTKFile>\n";
}

std::string field_data(const Moment& moment) {
  std::string text = "<FieldData>\n" + array<double>("TimeValue", 1, {moment.time}, true);
  const Inputs& in = moment.state.last_inputs;
  if (in.tool >= 0) {
    const Vec3 p = kMillimetre * in.position, f = moment.tool_force;
    text += array<double>("tool_position_mm", 3, {p.x, p.y, p.z}, true) +
            array<double>("tool_force_n", 3, {f.x, f.y, f.z}, true);
  }
  return text + "</FieldData>\n";
}

std::string count_of(const char* what, std::size_t count) {
  return std::string(" NumberOf") + what + "=\"" + std::to_string(count) + "\"";
}

}  // namespace

std::string to_vtp(const Model& model, const Moment& moment) {
  std::vector<float> points, displacement;
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::int32_t> organ;
  std::vector<std::uint8_t> is_wall;
  for (const OrganShape& shape : moment.organs) {
    const auto first = std::int64_t(points.size() / 3);
    std::int32_t index = 0;
    while (model.organs[std::size_t(index)].name != shape.name) ++index;
    for (std::size_t v = 0; v < shape.vertex.size(); ++v)
      add_mm(points, shape.vertex[v]), add_mm(displacement, shape.vertex[v] - shape.rest[v]);
    for (std::size_t t = 0; t < shape.triangle.size(); ++t) {
      for (const std::int32_t v : shape.triangle[t]) connectivity.push_back(first + v);
      offsets.push_back(std::int64_t(connectivity.size()));
      organ.push_back(index), is_wall.push_back(t >= shape.outer_triangles);
    }
  }
  return in_file("PolyData", "<PolyData>\n" + field_data(moment) + "<Piece" + count_of("Points", points.size() / 3) +
                                 count_of("Polys", offsets.size()) + ">\n<PointData>\n" +
                                 array("displacement_mm", 3, displacement) + "</PointData>\n<CellData>\n" +
                                 array("organ", 1, organ) + array("is_wall", 1, is_wall) + "</CellData>\n<Points>\n" +
                                 array("Points", 3, points) + "</Points>\n<Polys>\n" +
                                 array("connectivity", 1, connectivity) + array("offsets", 1, offsets) +
                                 "</Polys>\n</Piece>\n</PolyData>\n");
}

std::string to_vtu(const Model& model, const Moment& moment) {
  const State& state = moment.state;
  std::vector<float> points, displacement, speed, stretch;
  std::vector<std::int32_t> layer(model.layer.begin(), model.layer.end()), organ(model.sphere_count());
  std::vector<std::uint8_t> is_anchored, is_severed, types;
  for (std::size_t n = 0; n < model.sphere_count(); ++n) {
    add_mm(points, state.position[n]), add_mm(displacement, state.position[n] - model.rest_position[n]);
    speed.push_back(float(kMillimetre * norm(state.velocity[n])));
    is_anchored.push_back((model.held_axes[n] & 7) == 7);
  }
  for (std::size_t o = 0; o < model.organs.size(); ++o)
    for (std::int32_t n = 0; n < model.organs[o].count; ++n)
      organ[std::size_t(model.organs[o].first + n)] = std::int32_t(o);
  std::vector<std::int64_t> connectivity, offsets;
  constexpr std::uint8_t kLine = 3;
  for (std::size_t e = 0; e < model.axial.size(); ++e) {
    const auto a = std::size_t(model.axial.a[e]), b = std::size_t(model.axial.b[e]);
    connectivity.push_back(std::int64_t(a)), connectivity.push_back(std::int64_t(b));
    offsets.push_back(std::int64_t(connectivity.size()));
    types.push_back(kLine);
    stretch.push_back(float(norm(state.position[b] - state.position[a]) / model.axial.rest_length[e] - 1));
    is_severed.push_back(state.axial_severed.empty() ? 0 : state.axial_severed[e]);
  }
  return in_file("UnstructuredGrid",
                 "<UnstructuredGrid>\n" + field_data(moment) + "<Piece" + count_of("Points", points.size() / 3) +
                     count_of("Cells", offsets.size()) + ">\n<PointData>\n" +
                     array("displacement_mm", 3, displacement) + array("speed_mm_per_s", 1, speed) +
                     array("layer", 1, layer) + array("organ", 1, organ) + array("is_anchored", 1, is_anchored) +
                     "</PointData>\n<CellData>\n" + array("stretch", 1, stretch) + array("is_severed", 1, is_severed) +
                     "</CellData>\n<Points>\n" + array("Points", 3, points) + "</Points>\n<Cells>\n" +
                     array("connectivity", 1, connectivity) + array("offsets", 1, offsets) + array("types", 1, types) +
                     "</Cells>\n</Piece>\n</UnstructuredGrid>\n");
}

std::string to_pvd(const std::vector<SeriesMember>& members) {
  std::string text;
  for (const SeriesMember& member : members) {
    char time[32];
    std::snprintf(time, sizeof time, "%.9g", member.time);
    text += "<DataSet timestep=\"" + std::string(time) + "\" part=\"" + std::to_string(member.part) + "\" file=\"" +
            member.file + "\"/>\n";
  }
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
         "<Collection>\n" +
         text + "</Collection>\n</VTKFile>\n";
}

}  // namespace ctpm::exchange
