#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <cmath>

#include "studio/exchange/writers.h"

namespace ctpm::exchange {
namespace {

/// sRGB to the linear values that glTF's colours are in (IEC 61966-2-1).
ai_real linear(double c) { return ai_real(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4)); }

/// glTF is y up.
aiVector3D y_up(Vec3 p) { return {ai_real(p.x), ai_real(p.z), ai_real(-p.y)}; }

aiMesh* mesh_of(const OrganShape& shape, unsigned material) {
  auto* mesh = new aiMesh;
  mesh->mName = shape.name;
  mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh->mMaterialIndex = material;
  mesh->mNumVertices = unsigned(shape.vertex.size());
  mesh->mVertices = new aiVector3D[shape.vertex.size()];
  mesh->mNormals = new aiVector3D[shape.vertex.size()];
  std::vector<Vec3> normal(shape.vertex.size());
  for (const auto& t : shape.triangle) {
    const Vec3 a = shape.vertex[std::size_t(t[0])];
    const Vec3 n = cross(shape.vertex[std::size_t(t[1])] - a, shape.vertex[std::size_t(t[2])] - a);
    for (const std::int32_t v : t) normal[std::size_t(v)] += n;
  }
  for (std::size_t v = 0; v < shape.vertex.size(); ++v) {
    const double length = norm(normal[v]);
    mesh->mVertices[v] = y_up(shape.vertex[v]);
    mesh->mNormals[v] = y_up(length > 0 ? normal[v] / length : Vec3{0, 0, 1});
  }
  mesh->mNumFaces = unsigned(shape.triangle.size());
  mesh->mFaces = new aiFace[shape.triangle.size()];
  for (std::size_t t = 0; t < shape.triangle.size(); ++t) {
    mesh->mFaces[t].mNumIndices = 3;
    mesh->mFaces[t].mIndices = new unsigned[3];
    for (std::size_t c = 0; c < 3; ++c) mesh->mFaces[t].mIndices[c] = unsigned(shape.triangle[t][c]);
  }
  return mesh;
}

aiMaterial* material_of(const OrganShape& shape) {
  auto* material = new aiMaterial;
  const aiString name(shape.name);
  material->AddProperty(&name, AI_MATKEY_NAME);
  const aiColor4D colour(linear(shape.colour[0]), linear(shape.colour[1]), linear(shape.colour[2]), 1);
  material->AddProperty(&colour, 1, AI_MATKEY_BASE_COLOR);
  const ai_real metal = 0, rough = ai_real(0.4);
  material->AddProperty(&metal, 1, AI_MATKEY_METALLIC_FACTOR);
  material->AddProperty(&rough, 1, AI_MATKEY_ROUGHNESS_FACTOR);
  return material;
}

}  // namespace

std::string to_glb(const Moment& moment) {
  // The scene owns everything below.
  aiScene scene;
  const std::size_t count = moment.organs.size();
  scene.mNumMeshes = scene.mNumMaterials = unsigned(count);
  scene.mMeshes = new aiMesh*[count];
  scene.mMaterials = new aiMaterial*[count];
  scene.mRootNode = new aiNode("session");
  scene.mRootNode->mNumChildren = unsigned(count);
  scene.mRootNode->mChildren = new aiNode*[count];
  for (std::size_t o = 0; o < count; ++o) {
    scene.mMeshes[o] = mesh_of(moment.organs[o], unsigned(o));
    scene.mMaterials[o] = material_of(moment.organs[o]);
    auto* node = new aiNode(moment.organs[o].name);
    node->mParent = scene.mRootNode;
    node->mNumMeshes = 1;
    node->mMeshes = new unsigned[1]{unsigned(o)};
    scene.mRootNode->mChildren[o] = node;
  }
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(&scene, "glb2");
  return blob == nullptr ? "" : std::string(static_cast<const char*>(blob->data), blob->size);
}

}  // namespace ctpm::exchange
