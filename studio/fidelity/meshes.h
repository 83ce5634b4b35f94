#pragma once

#include "core/model/vec3.h"
#include "importers/mesh.h"

// Closed meshes of simple bodies, made here so that a report needs no files. Coordinates in metres.
namespace ctpm::fidelity {

/// A box between two corners, its faces divided into squares of at most `edge`, each two triangles.
importers::RawMesh box_mesh(Vec3 least, Vec3 most, double edge);

/// A ball about the origin: a subdivided icosahedron with edges of at most `edge`, its vertices on the sphere. Its
/// volume is that of the inscribed polyhedron.
importers::RawMesh ball_mesh(double radius, double edge);

}  // namespace ctpm::fidelity
