#!/usr/bin/env python3
"""Writes the files of this folder with writers that are not ctpm's: nibabel, teem's unu, Gmsh and meshio.

Debian 12: python3-nibabel python3-meshio gmsh teem-apps. Run it in this folder; the files are kept in the repository, so
that the tests need none of these.
"""

import math
import subprocess
import sys
import tempfile

import meshio
import nibabel
import numpy as np

# The ellipsoid of every file: half axes 30, 20 and 15 mm along x, y, z of the world (RAS in a label map).
HALF = np.array([30.0, 20.0, 15.0])


# A ball of 8 mm inside the ellipsoid, as two physical groups.
GEOMETRY = """
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 1};
Dilate {{0, 0, 0}, {30, 20, 15}} { Volume{1}; }
Sphere(2) = {0, 0, 0, 8};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Physical Volume("core", 11) = {2};
Physical Volume("shell", 12) = {3};
Mesh.MeshSizeMax = 7;
"""


def turned(axis, degrees):
    a = np.asarray(axis, float) / np.linalg.norm(axis)
    k = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    t = math.radians(degrees)
    return np.eye(3) + math.sin(t) * k + (1 - math.cos(t)) * k @ k


def labels_in(affine, shape):
    """1 in the ellipsoid about (50, -40, 30), 7 in a ball of 8 mm about (80, -75, 30), RAS millimetres."""
    grid = np.stack(np.meshgrid(*[np.arange(n) for n in shape], indexing="ij"), axis=-1)
    world = grid @ affine[:3, :3].T + affine[:3, 3]
    values = np.zeros(shape, np.uint8)
    values[(((world - [50, -40, 30]) / HALF) ** 2).sum(-1) <= 1] = 1
    values[((world - [80, -75, 30]) ** 2).sum(-1) <= 64] = 7
    return values


def oblique(spacing, shape, rotation):
    affine = np.eye(4)
    affine[:3, :3] = rotation @ np.diag(spacing)
    affine[:3, 3] = np.array([55, -52, 30]) - affine[:3, :3] @ (np.array(shape) - 1) / 2
    return affine


def write_nifti():
    shape, affine = (88, 92, 26), oblique([1.1, 1.0, 3.0], (88, 92, 26), turned([1, 2, 3], 25))
    nibabel.save(nibabel.Nifti1Image(labels_in(affine, shape), affine), "oblique.nii.gz")
    # A left-handed lattice, as scanners write it, with labels as floats.
    mirror = np.diag([-1.5, 1.5, 1.5, 1.0])
    mirror[:3, 3] = [100, -100, 5]
    nibabel.save(nibabel.Nifti1Image(labels_in(mirror, (56, 60, 34)).astype(np.float32), mirror), "mirrored.nii.gz")
    sheared = affine.copy()
    sheared[0, 1] += 0.5
    nibabel.save(nibabel.Nifti1Image(labels_in(sheared, shape), sheared), "sheared.nii.gz")
    nibabel.save(nibabel.Nifti1Image(labels_in(affine, shape)[::4, ::4, ::2], affine @ np.diag([4, 4, 2, 1.0])), "plain.nii")
    noise = np.arange(20 * 20 * 20, dtype=np.int16).reshape(20, 20, 20)
    nibabel.save(nibabel.Nifti1Image(noise, np.eye(4)), "image.nii.gz")


def write_nrrd():
    # The same world in LPS, as 3D Slicer saves segmentations, with its keys for names.
    shape = (45, 47, 36)
    affine = oblique([2.0, 2.0, 2.0], shape, turned([3, 1, 1], -20))
    values = labels_in(affine, shape)
    lps = np.diag([-1, -1, 1]) @ affine[:3, :3]
    origin = np.diag([-1, -1, 1]) @ affine[:3, 3]
    vector = lambda v: "(" + ",".join(repr(float(x)) for x in v) + ")"
    make = ["teem-unu", "make", "-i", "-", "-t", "uchar", "-s", *map(str, shape), "-spc", "left-posterior-superior",
            "-orig", vector(origin), "-dirs", " ".join(vector(lps[:, d]) for d in range(3)), "-k", "space", "space", "space",
            "-kv", "Segment0_Name:=left_kidney", "Segment0_LabelValue:=1", "Segment0_Layer:=0",
            "Segment1_Name:=stone", "Segment1_LabelValue:=7", "Segment1_Layer:=0", "-e", "raw"]
    nrrd = subprocess.run(make, input=values.tobytes(order="F"), stdout=subprocess.PIPE, check=True).stdout
    packed = subprocess.run(["teem-unu", "save", "-f", "nrrd", "-e", "gzip", "-i", "-", "-o", "names.seg.nrrd"], input=nrrd)
    packed.check_returncode()


def write_volume_meshes():
    with tempfile.NamedTemporaryFile("w", suffix=".geo") as geometry:
        geometry.write(GEOMETRY)
        geometry.flush()
        for version, name in [("msh41", "41.msh"), ("msh22", "22.msh")]:
            for binary, kind in [([], "text"), (["-bin"], "binary")]:
                subprocess.run(["gmsh", "-3", "-v", "0", "-format", version, *binary, "-o", kind + name, geometry.name], check=True)
    mesh = meshio.read("text22.msh")
    tetrahedra = meshio.Mesh(mesh.points, [("tetra", mesh.cells_dict["tetra"])])
    meshio.write("text42.vtk", tetrahedra, "vtk42", binary=False)
    meshio.write("binary42.vtk", tetrahedra, "vtk42", binary=True)
    meshio.write("text.vtu", tetrahedra, binary=False)
    meshio.write("plain.vtu", tetrahedra, binary=True, compression=None)
    meshio.write("zlib.vtu", tetrahedra, binary=True, compression="zlib")
    # What the tests expect.
    for name, group in [("all", None), ("core", 11), ("shell", 12)]:
        own = np.concatenate([c.data if group is None else c.data[d == group]
                              for c, d in zip(mesh.cells, mesh.cell_data["gmsh:physical"]) if c.type == "tetra"])
        a, b, c, d = (mesh.points[own[:, i]] for i in range(4))
        print(name, abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)).sum() / 6)


def write_vtk():
    """With VTK itself (python3-vtk9): appended bytes, and polygons as 3D Slicer saves models."""
    import vtk

    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName("text.vtu")
    reader.Update()
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetInputData(reader.GetOutput())
    writer.SetFileName("appended.vtu")
    writer.Write()
    writer.EncodeAppendedDataOff()
    writer.SetHeaderTypeToUInt64()
    writer.SetFileName("raw.vtu")
    writer.Write()
    legacy = vtk.vtkUnstructuredGridWriter()
    legacy.SetInputData(reader.GetOutput())
    legacy.SetFileTypeToBinary()
    legacy.SetFileName("binary51.vtk")
    legacy.Write()
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(reader.GetOutput())
    surface.Update()
    polygons = vtk.vtkPolyDataWriter()
    polygons.SetInputData(surface.GetOutput())
    polygons.SetHeader("3D Slicer output. SPACE=LPS")
    polygons.SetFileTypeToBinary()
    polygons.SetFileName("slicer51.vtk")
    polygons.Write()
    polygons.SetFileVersion(42)
    polygons.SetFileTypeToASCII()
    polygons.SetFileName("slicer42.vtk")
    polygons.Write()


if __name__ == "__main__":
    write_nifti()
    write_nrrd()
    write_volume_meshes()
    write_vtk()
    sys.exit(0)
