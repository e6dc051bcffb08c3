"""Opens results as a user of ParaView does; run by pvbatch.

usage: pvbatch paraview_view.py FIELDS.XDMF FRACTION FOLDER

Writes what each of ParaView's three XDMF readers finds at every time into FOLDER/READER.npz, and FOLDER/picture.png: the
fraction in the plane, or in space its surface, at the last time.
"""
import pathlib
import sys

import numpy as np
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

READERS = {"Xdmf2": lambda path: simple.XDMFReader(FileNames=[path]),
           "Xdmf3S": lambda path: simple.Xdmf3ReaderS(FileName=[path]),
           "Xdmf3T": lambda path: simple.Xdmf3ReaderT(FileName=[path])}


def copy(array):
    return vtk_to_numpy(array).copy()  # the reader uses its memory again


def content(reader):
    """Times, coordinates and arrays, by names such as 0/faces/x and 0/fields/density."""
    found = {"times": np.array(reader.TimestepValues)}
    for number, moment in enumerate(reader.TimestepValues):
        reader.UpdatePipeline(moment)
        grid = reader.GetClientSideObject().GetOutputDataObject(0)  # Fetch() of ParaView 5.11 spoils coordinates
        found[f"{number}/bounds"] = np.array(reader.GetDataInformation().GetBounds())
        found[f"{number}/cells"] = np.array(grid.GetNumberOfCells())
        for axis in "XYZ":
            found[f"{number}/faces/{axis.lower()}"] = copy(getattr(grid, f"Get{axis}Coordinates")())
        data = grid.GetCellData()
        for k in range(data.GetNumberOfArrays()):
            found[f"{number}/fields/{data.GetArrayName(k)}"] = copy(data.GetArray(k))
    return found


def draw(reader, fraction, path):
    reader.UpdatePipeline(reader.TimestepValues[-1])
    view = simple.CreateRenderView(ViewSize=[480, 480])
    view.ViewTime = reader.TimestepValues[-1]
    view.OrientationAxesVisibility = 0
    bounds = reader.GetDataInformation().GetBounds()
    shown = reader
    if bounds[5] > bounds[4]:
        points = simple.CellDatatoPointData(Input=reader)
        shown = simple.Contour(Input=points, ContourBy=["POINTS", fraction], Isosurfaces=[0.5])
    display = simple.Show(shown, view)
    if shown is reader:
        display.Representation = "Surface"
        simple.ColorBy(display, ("CELLS", fraction))
    else:
        simple.ColorBy(display, ("POINTS", "velocity", "Magnitude"))
    display.RescaleTransferFunctionToDataRange(False)
    simple.ResetCamera(view)
    if shown is not reader:
        view.CameraViewUp = [0, 0, 1]
        view.CameraPosition = [at + away for at, away in zip(view.CameraFocalPoint, (1, 2, 1))]
        simple.ResetCamera(view)
    simple.Render(view)
    simple.SaveScreenshot(path, view)


def main():
    path, fraction, folder = sys.argv[1:4]
    folder = pathlib.Path(folder)
    for name, read in READERS.items():
        np.savez(folder / f"{name}.npz", **content(read(path)))
    draw(simple.OpenDataFile(path), fraction, str(folder / "picture.png"))


main()
