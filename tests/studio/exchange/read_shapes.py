#!/usr/bin/python3
"""Reads exported files with readers that are not ctpm's, and prints what they hold, one "key value" a line.

read_shapes.py meshio FILE.vtu | vtk FILE.vtp|FILE.vtu|FILE.glb | series FILE.pvd. Exits with 77 where the reader is missing.
"""

import os
import sys
import xml.etree.ElementTree


def missing(name):
    print("no", name, file=sys.stderr)
    sys.exit(77)


def by_meshio(path):
    try:
        import meshio
        import numpy as np
    except ImportError:
        missing("meshio")
    mesh = meshio.read(path)
    (cells,) = mesh.cells
    stretch, severed = mesh.cell_data["stretch"][0], mesh.cell_data["is_severed"][0]
    rest = mesh.points - mesh.point_data["displacement_mm"]
    a, b = cells.data[:, 0], cells.data[:, 1]
    length = np.linalg.norm(mesh.points[a] - mesh.points[b], axis=1)
    at_rest = np.linalg.norm(rest[a] - rest[b], axis=1)
    print("points", len(mesh.points))
    print("cells", len(cells.data), cells.type)
    print("severed", int(severed.sum()))
    print("anchored", int(mesh.point_data["is_anchored"].sum()))
    print("layers", int(mesh.point_data["layer"].max()))
    # The length without force over that in the lattice, which prestrain makes another.
    without_force = length / (1 + stretch) / at_rest
    print("without_force", float(without_force.min()), float(without_force.max()))
    print("moved_mm", float(np.linalg.norm(mesh.point_data["displacement_mm"], axis=1).max()))


def by_vtk(path):
    try:
        import vtk
        from vtk.util.numpy_support import vtk_to_numpy
    except ImportError:
        missing("vtk")
    ending = os.path.splitext(path)[1]
    reader = {".vtp": vtk.vtkXMLPolyDataReader, ".vtu": vtk.vtkXMLUnstructuredGridReader, ".glb": vtk.vtkGLTFReader}[ending]()
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    if ending == ".glb":
        merge = vtk.vtkCompositeDataGeometryFilter()
        merge.SetInputConnection(reader.GetOutputPort())
        merge.Update()
        data = merge.GetOutput()
    print("points", data.GetNumberOfPoints())
    print("cells", data.GetNumberOfCells())
    bounds = data.GetBounds()
    print("bounds", *[f"{b:.6g}" for b in bounds])
    if ending != ".vtu":
        weld = vtk.vtkCleanPolyData()
        weld.PointMergingOn()
        weld.SetInputData(data)
        weld.Update()
        mass = vtk.vtkMassProperties()
        mass.SetInputData(weld.GetOutput())
        mass.Update()
        print("volume", mass.GetVolume())
    field = data.GetFieldData().GetArray("TimeValue")
    if field:
        print("time", field.GetValue(0))
    if ending == ".vtp":
        print("wall", int(vtk_to_numpy(data.GetCellData().GetArray("is_wall")).sum()))
        print("tool", *[f"{x:.6g}" for x in data.GetFieldData().GetArray("tool_position_mm").GetTuple(0)])


def by_series(path):
    try:
        import vtk
    except ImportError:
        missing("vtk")
    root = xml.etree.ElementTree.parse(path).getroot()
    assert root.get("type") == "Collection"
    for data in root.iter("DataSet"):
        file = os.path.join(os.path.dirname(path), data.get("file"))
        reader = vtk.vtkXMLGenericDataObjectReader()
        reader.SetFileName(file)
        reader.Update()
        value = reader.GetOutput().GetFieldData().GetArray("TimeValue").GetValue(0)
        assert abs(value - float(data.get("timestep"))) < 1e-9
        print("member", data.get("timestep"), data.get("part"), reader.GetOutput().GetNumberOfPoints())


{"meshio": by_meshio, "vtk": by_vtk, "series": by_series}[sys.argv[1]](sys.argv[2])
