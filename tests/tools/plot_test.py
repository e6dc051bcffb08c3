#!/usr/bin/python3
"""tools/plot on small made-up results."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
from plotting import solid, style  # noqa: E402
from plotting.result import ResultError, Snapshot, read_history  # noqa: E402


def write_snapshot(folder, step, faces, geometry="planar", species=("sand",)):
    """A half-filled domain that moves sideways."""
    shape = tuple(len(values) - 1 for values in reversed(list(faces.values())))
    height = np.linspace(0, 1, shape[0]).reshape((-1,) + (1,) * (len(shape) - 1))
    fraction = np.broadcast_to(np.clip(2 - 4 * height, 0, 1), shape)
    velocity = np.zeros(shape + (len(shape),))
    velocity[..., 0] = step * (fraction > 0)
    with h5py.File(pathlib.Path(folder) / f"fields_{step:08d}.h5", "w") as file:
        file.attrs.update(step=step, time=0.1 * step, dt=0.1, units="none", title="Test", geometry=geometry)
        for name, values in faces.items():
            file[f"grid/{name}"] = values
        for name in species:
            file[f"fields/phi_{name}"] = fraction / len(species)
        file["fields/density"] = fraction
        file["fields/velocity"] = velocity


def write_history(folder, lines):
    (pathlib.Path(folder) / "history.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def plot(*arguments):
    return subprocess.run([TOOLS / "plot", *map(str, arguments)], capture_output=True, text=True, check=False)


class PlotTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.flat = {"x": np.linspace(0, 0.5, 9), "z": np.linspace(0, 1, 17)}

    def pictures(self):
        return sorted(path.name for path in (self.folder / "pictures").iterdir())

    def test_draws_frames_and_history(self):
        for step in (0, 5, 10):
            write_snapshot(self.folder, step, self.flat, "axisymmetric", ("sand", "water"))
        write_history(self.folder, ["step,time,dt,volume_sand,kinetic_energy", "1,0.1,0.1,2,0", "2,0.2,0.1,2,1"])
        done = plot(self.folder, "--no-movie")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(str(self.folder / "pictures"), done.stdout)
        self.assertEqual(self.pictures(), ["frame_00000000.png", "frame_00000005.png", "frame_00000010.png",
                                           "frames.png", "history.png"])

    def test_frames_of_an_earlier_call_go(self):
        for step in (0, 1, 2):
            write_snapshot(self.folder, step, self.flat)
        plot(self.folder, "--no-movie")
        self.assertEqual(plot(self.folder, "--no-movie", "--every", 2).returncode, 0)
        self.assertEqual(self.pictures(), ["frame_00000000.png", "frame_00000002.png", "frames.png"])

    def test_draws_three_dimensions(self):
        cube = {axis: np.linspace(0, 1, 6) for axis in "xyz"}
        write_snapshot(self.folder, 3, cube, "cartesian")
        done = plot(self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.pictures(), ["frame_00000003.png", "frames.png"])

    def test_says_what_is_wrong(self):
        done = plot(self.folder / "none")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("there is no folder", done.stderr)
        done = plot(self.folder)
        self.assertIn("neither field files nor a history", done.stderr)


class ReadingTest(unittest.TestCase):
    def test_torn_history_and_broken_files(self):
        with tempfile.TemporaryDirectory() as folder:
            write_history(folder, ["step,time", "1,0.5", "2,nan", "3"])
            history = read_history(folder)
            np.testing.assert_array_equal(history["step"], [1, 2])
            broken = pathlib.Path(folder) / "fields_00000001.h5"
            broken.write_text("no HDF5", encoding="utf-8")
            with self.assertRaises(ResultError):
                Snapshot(broken)


class SurfaceTest(unittest.TestCase):
    def test_sphere_has_the_right_area(self):
        axis = np.linspace(-1, 1, 41)
        z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
        triangles = solid.isosurface(dict(x=axis, y=axis, z=axis), 1 - np.sqrt(x * x + y * y + z * z))
        area = 0.5 * np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]),
                                    axis=1).sum()
        self.assertAlmostEqual(area / (4 * np.pi * 0.25), 1, delta=0.01)


class StyleTest(unittest.TestCase):
    def test_chooses_evenly(self):
        self.assertEqual(style.chosen(list(range(21)), 3), [0, 10, 20])
        self.assertEqual(style.chosen([1, 2], 12), [1, 2])

    def test_species_colours_differ(self):
        colours = style.species_colours(["bed", "water", "silt"])
        self.assertEqual(len({tuple(colour) for colour in colours}), 3)


if __name__ == "__main__":
    unittest.main()
