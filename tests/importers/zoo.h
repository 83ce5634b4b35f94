#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/model/vec3.h"
#include "importers/mesh.h"

namespace ctpm::zoo {

/// A latitude-free sphere: an icosahedron cut `cuts` times, 20 * 4^cuts triangles, vertices on the sphere.
importers::RawMesh sphere(double radius, int cuts, Vec3 centre = {});

/// A ring about the z axis: `around` x `across` vertices on the exact torus.
importers::RawMesh torus(double ring_radius, double tube_radius, int around, int across);

/// A box about the origin with `cuts` squares along each edge; 12 cuts^2 triangles, vertices shared.
importers::RawMesh box(Vec3 size, int cuts = 1, Vec3 centre = {});

/// Both meshes in one, vertices not joined.
importers::RawMesh both(const importers::RawMesh& a, const importers::RawMesh& b);

/// The mesh with every vertex moved.
importers::RawMesh moved(importers::RawMesh mesh, const std::function<Vec3(Vec3)>& where);

/// Every triangle with three vertices of its own.
importers::RawMesh unwelded(const importers::RawMesh& mesh);

/// Every n-th triangle turned round, from the first on.
importers::RawMesh flipped(importers::RawMesh mesh, std::size_t every);

/// Without the triangles for which `goes` is true of their middle.
importers::RawMesh without(importers::RawMesh mesh, const std::function<bool(Vec3)>& goes);

/// The finding of this code, or null.
const importers::Finding* find(const std::vector<importers::Finding>& findings, const std::string& code);

/// "code x count, ..." of all findings in their order: what a report says, in one comparison.
std::string summary(const std::vector<importers::Finding>& findings);

/// All messages of some errors, one a line.
std::string text_of(const Errors& errors);

/// A folder that is made for one test and removed with all it holds.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  /// Writes a file into it and returns its path.
  std::string write(const std::string& name, const std::string& bytes) const;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The bytes of a file cut off at random, or with a few bits of its first `head` bytes turned over.
std::string damaged(std::string bytes, std::mt19937& random, bool is_cut, std::size_t head);

/// The mesh as the bytes of a file; its unit is not said in them except where noted.
std::string to_obj_text(const importers::RawMesh& mesh, const std::string& name = "organ");
std::string to_ascii_stl(const importers::RawMesh& mesh);
std::string to_binary_stl(const importers::RawMesh& mesh);
std::string to_ascii_ply(const importers::RawMesh& mesh);
std::string to_binary_ply(const importers::RawMesh& mesh);
std::string to_off(const importers::RawMesh& mesh);
std::string to_gltf(const importers::RawMesh& mesh, double node_scale = 1);      ///< metres
std::string to_glb(const importers::RawMesh& mesh);                              ///< metres
std::string to_dae(const importers::RawMesh& mesh, double unit_in_metres);       ///< unit as said
std::string to_fbx(const importers::RawMesh& mesh, double unit_in_centimetres);  ///< unit as said; ASCII
std::string to_3ds(const importers::RawMesh& mesh);

}  // namespace ctpm::zoo
