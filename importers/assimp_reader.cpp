#include "importers/assimp_reader.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <new>
#include <string>
#include <vector>

#include "core/model/vec3.h"
#include "importers/mesh_file.h"
#include "importers/topology.h"
#include "importers/wire.h"

namespace ctpm::importers {
namespace {

/// All triangles of the requested meshes, with node transforms applied.
struct Collected {
  std::vector<std::string> parts;
  std::vector<Vec3> part_colour;  ///< NaN where the file says none
  std::vector<Vec3> vertex;
  std::vector<std::array<std::int32_t, 3>> triangle;
  std::vector<std::int32_t> part_of_triangle;
};

/// Diffuse colour of a mesh's material; NaN where there is none or only assimp's default grey.
Vec3 colour_of(const aiScene& scene, const aiMesh& mesh) {
  const Vec3 none{NAN, NAN, NAN};
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return none;
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  aiString name;
  if (material.Get(AI_MATKEY_NAME, name) == AI_SUCCESS && std::string(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME)
    return none;
  aiColor3D colour;
  if (material.Get(AI_MATKEY_COLOR_DIFFUSE, colour) != AI_SUCCESS) return none;
  const auto is_share = [](float value) { return value >= 0 && value <= 1; };
  if (!is_share(colour.r) || !is_share(colour.g) || !is_share(colour.b)) return none;
  // What assimp gives formats without materials, as OFF.
  constexpr float kGrey = 0.6F;
  if (colour.r == kGrey && colour.g == kGrey && colour.b == kGrey) return none;
  // White is what formats hold where a texture gives the colour, or nothing does.
  if (std::min({colour.r, colour.g, colour.b}) > 0.99f) return none;
  return {colour.r, colour.g, colour.b};
}

/// Name of a mesh: its own, else its node's, else its number.
std::string part_name(const aiMesh& mesh, const aiNode& node, unsigned index) {
  if (mesh.mName.length > 0) return mesh.mName.C_Str();
  if (node.mName.length > 0) return node.mName.C_Str();
  return "mesh " + std::to_string(index + 1);
}

void append(const aiMesh& mesh, const aiMatrix4x4t<double>& world_from_mesh, std::int32_t part, Collected& out) {
  const std::size_t first = out.vertex.size();
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3t<double> p(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z);
    const aiVector3t<double> q = world_from_mesh * p;
    out.vertex.push_back({q.x, q.y, q.z});
  }
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    std::array<std::int32_t, 3> triangle{};
    bool is_in_range = true;
    for (unsigned c = 0; c < 3; ++c) {
      is_in_range = is_in_range && face.mIndices[c] < mesh.mNumVertices;
      triangle[c] = std::int32_t(first + face.mIndices[c]);
    }
    if (is_in_range) out.triangle.push_back(triangle), out.part_of_triangle.push_back(part);
  }
}

void collect(const aiScene& scene, const aiNode& node, const aiMatrix4x4t<double>& world_from_parent,
             const std::string& part, Collected& out) {
  const aiMatrix4x4& m = node.mTransformation;
  const aiMatrix4x4t<double> parent_from_node(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4,
                                              m.d1, m.d2, m.d3, m.d4);
  const aiMatrix4x4t<double> world_from_node = world_from_parent * parent_from_node;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    if (node.mMeshes[i] >= scene.mNumMeshes) continue;
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    const std::string name = part_name(mesh, node, node.mMeshes[i]);
    const auto known = std::find(out.parts.begin(), out.parts.end(), name);
    const auto index = std::int32_t(known - out.parts.begin());
    if (known == out.parts.end()) out.parts.push_back(name), out.part_colour.push_back(colour_of(scene, mesh));
    const bool is_wanted = part.empty() || part == name || part == node.mName.C_Str();
    if (is_wanted) append(mesh, world_from_node, index, out);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) collect(scene, *node.mChildren[i], world_from_node, part, out);
}

/// Length of one unit [m] if the format states it, else 0. glTF is in metres by definition. assimp scales a DAE file to
/// metres by its <unit>. FBX states centimetres per unit in its header.
double unit_said_by(const aiScene& scene, const std::string& suffix) {
  if (suffix == "gltf" || suffix == "glb" || suffix == "dae") return 1.0;
  if (suffix == "fbx" && scene.mMetaData != nullptr) {
    double centimetres = 0;
    float centimetres_float = 0;
    if (scene.mMetaData->Get("UnitScaleFactor", centimetres)) return 0.01 * centimetres;
    if (scene.mMetaData->Get("UnitScaleFactor", centimetres_float)) return 0.01 * double(centimetres_float);
  }
  return 0;
}

/// assimp rotates 3DS files from z up to y up. This matrix rotates them back to the file's own coordinates.
aiMatrix4x4t<double> file_from_scene(const std::string& suffix) {
  if (suffix != "3ds") return {};
  return {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
}

/// Joins vertices at one place, as assimp repeats one for every face that uses it: what is sent is a sixth of it then.
/// Numbers that are not finite stay as they are, to be named.
void join_repeats(Collected& found) {
  if (!std::all_of(found.vertex.begin(), found.vertex.end(), [](Vec3 p) { return is_finite(p); })) return;
  Soup soup{std::move(found.vertex), std::move(found.triangle)};
  weld(soup, 0);
  found.vertex = std::move(soup.vertex), found.triangle = std::move(soup.triangle);
}

/// Whether assimp's message means a readable file without triangles.
bool means_no_triangles(const std::string& trouble) {
  return trouble.find("mNumMeshes is 0") != std::string::npos ||
         trouble.find("No meshes remaining") != std::string::npos;
}

void send_failure(const Send& send, const std::string& text) {
  wire::Writer message;
  message.put(wire::Kind::failed);
  message.put_text(text);
  send(message.bytes.data(), message.bytes.size());
}

}  // namespace

void send_mesh_file(const std::string& path, const std::string& part, const Send& send) {
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene =
      importer.ReadFile(path, aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_SortByPType);
  const std::string trouble = importer.GetErrorString();
  if (scene == nullptr && trouble.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
  if (scene == nullptr && !means_no_triangles(trouble)) return send_failure(send, trouble);
  Collected found;
  const std::string suffix = suffix_of(path);
  if (scene != nullptr && scene->mRootNode != nullptr)
    collect(*scene, *scene->mRootNode, file_from_scene(suffix), part, found);
  const double unit = scene != nullptr ? unit_said_by(*scene, suffix) : 0.0;
  importer.FreeScene();
  join_repeats(found);

  wire::Writer message;
  const bool misses_part = !part.empty() && found.triangle.empty();
  message.put(misses_part ? wire::Kind::no_such_part : wire::Kind::mesh);
  message.put<std::uint64_t>(found.parts.size());
  for (const std::string& name : found.parts) message.put_text(name);
  if (!misses_part) {
    message.put(unit);
    message.put_list(found.vertex);
    message.put_list(found.triangle);
    message.put_list(found.part_of_triangle);
    message.put_list(found.part_colour);
  }
  send(message.bytes.data(), message.bytes.size());
}

}  // namespace ctpm::importers
