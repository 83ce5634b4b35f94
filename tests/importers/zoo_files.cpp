// The mesh formats as their specifications give them, written without the reader's package.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "zoo.h"

namespace ctpm::zoo {
namespace {

template <class... Values>
std::string line(const char* format, Values... values) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

/// Values as the bytes that little-endian files hold.
template <class... Values>
void put(std::string& bytes, Values... values) {
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
}

void put_point(std::string& bytes, Vec3 p) { put(bytes, float(p.x), float(p.y), float(p.z)); }

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t n = 0; n < 3; ++n) group = group << 8 | (i + n < bytes.size() ? std::uint8_t(bytes[i + n]) : 0u);
    for (std::size_t n = 0; n < 4; ++n) text += i + n > bytes.size() ? '=' : kDigits[group >> (18 - 6 * n) & 63];
  }
  return text;
}

/// Positions, then indices.
std::string gltf_buffer(const importers::RawMesh& mesh) {
  std::string bytes;
  for (const Vec3& p : mesh.vertex) put_point(bytes, p);
  for (const importers::Triangle& t : mesh.triangle) put(bytes, t[0], t[1], t[2]);
  return bytes;
}

std::string gltf_json(const importers::RawMesh& mesh, double scale, const std::string& uri) {
  const std::size_t points = 12 * mesh.vertex.size(), indices = 12 * mesh.triangle.size();
  std::string text = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)";
  text += line(R"("nodes":[{"mesh":0,"name":"organ","scale":[%.9g,%.9g,%.9g]}],)", scale, scale, scale);
  text += R"("meshes":[{"name":"organ","primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)";
  text += line(R"("buffers":[{"byteLength":%zu)", points + indices) + uri + "}],";
  text += line(R"("bufferViews":[{"buffer":0,"byteLength":%zu},{"buffer":0,"byteOffset":%zu,"byteLength":%zu}],)",
               points, points, indices);
  text += line(R"("accessors":[{"bufferView":0,"componentType":5126,"count":%zu,"type":"VEC3"},)", mesh.vertex.size());
  return text +
         line(R"({"bufferView":1,"componentType":5125,"count":%zu,"type":"SCALAR"}]})", 3 * mesh.triangle.size());
}

/// A block of a 3DS file: id, length with its head, content.
std::string block(std::uint16_t id, const std::string& content) {
  std::string bytes;
  put(bytes, id, std::uint32_t(content.size() + 6));
  return bytes + content;
}

}  // namespace

Folder::Folder() {
  static std::atomic<int> count{0};
  const auto path = std::filesystem::temp_directory_path() / line("ctpm_zoo_%d_%d", int(getpid()), ++count);
  std::filesystem::create_directories(path);
  path_ = path.string();
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string Folder::write(const std::string& name, const std::string& bytes) const {
  const std::string path = path_ + "/" + name;
  std::ofstream(path, std::ios::binary | std::ios::trunc).write(bytes.data(), std::streamsize(bytes.size()));
  return path;
}

std::string damaged(std::string bytes, std::mt19937& random, bool is_cut, std::size_t head) {
  if (is_cut) {
    bytes.resize(random() % bytes.size() + 1);
    return bytes;
  }
  for (unsigned n = 1 + random() % 8; n > 0; --n)
    bytes[random() % std::min(bytes.size(), head)] ^= char(1 << random() % 8);
  return bytes;
}

std::string to_obj_text(const importers::RawMesh& mesh, const std::string& name) {
  std::string text = "o " + name + "\n";
  for (const Vec3& p : mesh.vertex) text += line("v %.9g %.9g %.9g\n", p.x, p.y, p.z);
  for (const importers::Triangle& t : mesh.triangle) text += line("f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

std::string to_ascii_stl(const importers::RawMesh& mesh) {
  std::string text = "solid organ\n";
  for (const importers::Triangle& t : mesh.triangle) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::int32_t v : t) {
      const Vec3 p = mesh.vertex[std::size_t(v)];
      text += line("vertex %.9g %.9g %.9g\n", p.x, p.y, p.z);
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid organ\n";
}

std::string to_binary_stl(const importers::RawMesh& mesh) {
  std::string bytes(80, ' ');
  put(bytes, std::uint32_t(mesh.triangle.size()));
  for (const importers::Triangle& t : mesh.triangle) {
    put_point(bytes, {});
    for (const std::int32_t v : t) put_point(bytes, mesh.vertex[std::size_t(v)]);
    put(bytes, std::uint16_t(0));
  }
  return bytes;
}

static std::string ply_head(const importers::RawMesh& mesh, const char* kind) {
  return line("ply\nformat %s 1.0\nelement vertex %zu\n", kind, mesh.vertex.size()) +
         "property float x\nproperty float y\nproperty float z\n" +
         line("element face %zu\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangle.size());
}

std::string to_ascii_ply(const importers::RawMesh& mesh) {
  std::string text = ply_head(mesh, "ascii");
  for (const Vec3& p : mesh.vertex) text += line("%.9g %.9g %.9g\n", p.x, p.y, p.z);
  for (const importers::Triangle& t : mesh.triangle) text += line("3 %d %d %d\n", t[0], t[1], t[2]);
  return text;
}

std::string to_binary_ply(const importers::RawMesh& mesh) {
  std::string bytes = ply_head(mesh, "binary_little_endian");
  for (const Vec3& p : mesh.vertex) put_point(bytes, p);
  for (const importers::Triangle& t : mesh.triangle) put(bytes, std::uint8_t(3), t[0], t[1], t[2]);
  return bytes;
}

std::string to_off(const importers::RawMesh& mesh) {
  std::string text = line("OFF\n%zu %zu 0\n", mesh.vertex.size(), mesh.triangle.size());
  for (const Vec3& p : mesh.vertex) text += line("%.9g %.9g %.9g\n", p.x, p.y, p.z);
  for (const importers::Triangle& t : mesh.triangle) text += line("3 %d %d %d\n", t[0], t[1], t[2]);
  return text;
}

std::string to_gltf(const importers::RawMesh& mesh, double node_scale) {
  return gltf_json(mesh, node_scale,
                   R"(,"uri":"data:application/octet-stream;base64,)" + base64(gltf_buffer(mesh)) + '"');
}

std::string to_glb(const importers::RawMesh& mesh) {
  std::string json = gltf_json(mesh, 1, ""), buffer = gltf_buffer(mesh), bytes = "glTF";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  put(bytes, std::uint32_t(2), std::uint32_t(28 + json.size() + buffer.size()));
  put(bytes, std::uint32_t(json.size()));
  bytes += "JSON" + json;
  put(bytes, std::uint32_t(buffer.size()));
  return bytes + std::string("BIN\0", 4) + buffer;
}

std::string to_dae(const importers::RawMesh& mesh, double unit_in_metres) {
  std::string points, indices;
  for (const Vec3& p : mesh.vertex) points += line("%.9g %.9g %.9g ", p.x, p.y, p.z);
  for (const importers::Triangle& t : mesh.triangle) indices += line("%d %d %d ", t[0], t[1], t[2]);
  const std::size_t count = mesh.vertex.size();
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
         line(R"(<unit name="u" meter="%.9g"/><up_axis>Z_UP</up_axis></asset>)", unit_in_metres) +
         R"(<library_geometries><geometry id="g" name="organ"><mesh><source id="p">)" +
         line(R"(<float_array id="a" count="%zu">)", 3 * count) + points + "</float_array><technique_common>" +
         line(R"(<accessor source="#a" count="%zu" stride="3">)", count) +
         R"(<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>)" +
         R"(</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)" +
         line(R"(<triangles count="%zu">)", mesh.triangle.size()) +
         R"(<input semantic="VERTEX" source="#v" offset="0"/><p>)" + indices + "</p></triangles></mesh></geometry>" +
         R"(</library_geometries><library_visual_scenes><visual_scene id="s"><node id="n" name="organ">)" +
         R"(<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>)" +
         R"(<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string to_fbx(const importers::RawMesh& mesh, double unit_in_centimetres) {
  std::string points, indices;
  for (const Vec3& p : mesh.vertex) points += line("%s%.9g,%.9g,%.9g", points.empty() ? "" : ",", p.x, p.y, p.z);
  for (const importers::Triangle& t : mesh.triangle)
    indices += line("%s%d,%d,%d", indices.empty() ? "" : ",", t[0], t[1], -t[2] - 1);
  return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}\n"
         "GlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n" +
         line("\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",%.9g\n\t}\n}\n", unit_in_centimetres) +
         "Objects:  {\n\tGeometry: 1001, \"Geometry::organ\", \"Mesh\" {\n" +
         line("\t\tVertices: *%zu {\n\t\t\ta: ", 3 * mesh.vertex.size()) + points +
         line("\n\t\t}\n\t\tPolygonVertexIndex: *%zu {\n\t\t\ta: ", 3 * mesh.triangle.size()) + indices +
         "\n\t\t}\n\t\tGeometryVersion: 124\n\t}\n\tModel: 1002, \"Model::organ\", \"Mesh\" {\n\t\tVersion: "
         "232\n\t}\n}\n"
         "Connections:  {\n\tC: \"OO\",1001,1002\n\tC: \"OO\",1002,0\n}\n";
}

std::string to_3ds(const importers::RawMesh& mesh) {
  std::string points, faces;
  put(points, std::uint16_t(mesh.vertex.size()));
  for (const Vec3& p : mesh.vertex) put_point(points, p);
  put(faces, std::uint16_t(mesh.triangle.size()));
  for (const importers::Triangle& t : mesh.triangle)
    put(faces, std::uint16_t(t[0]), std::uint16_t(t[1]), std::uint16_t(t[2]), std::uint16_t(0));
  const std::string object = std::string("organ\0", 6) + block(0x4100, block(0x4110, points) + block(0x4120, faces));
  return block(0x4D4D, block(0x3D3D, block(0x4000, object)));
}

}  // namespace ctpm::zoo
