#!/usr/bin/python3
"""tools/plot on small made-up results."""
import pathlib
import sys
import tempfile
import unittest

import h5py
import numpy as np

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
import tool  # noqa: E402
from plotting import crater, flat, solid, style  # noqa: E402
from plotting.result import ResultError, Snapshot, case_value, mirror_side, read_history  # noqa: E402
from results import CASE, write_crater, write_history, write_snapshot  # noqa: E402


def plot(*arguments):
    return tool.run("plot", *arguments)


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

    def test_draws_a_crater_on_grids_that_change(self):
        write_crater(self.folder)
        write_snapshot(self.folder, 0, {"x": np.linspace(0, 0.2, 9), "z": np.linspace(0, 0.3, 9)}, species=("sand", "water"))
        write_snapshot(self.folder, 8, {"x": np.geomspace(1, 2, 9) - 1, "z": np.linspace(0, 1, 17)}, species=("sand", "water"))
        done = plot(self.folder, "--unit", "cm", "--times", "0,0.8", "--window=-0.3,0.3,0,0.9", "--no-contours",
                    "--every", 2)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.pictures(), ["crater.png", "frame_00000000.png", "frames.png"])

    def test_compares_craters_and_bubbles(self):
        for name in ("a", "b"):
            write_crater(self.folder / name)
            write_snapshot(self.folder / name, 8, self.flat)
            write_history(self.folder / name, ["step,time,bubble_volume", "8,0.8,0.1"])
            with h5py.File(self.folder / name / "fields_00000008.h5", "r+") as file:
                file["fields/gas_region"] = np.where(file["fields/density"][...] < 0.5, 2, 0)
        both = (self.folder / "a", self.folder / "b", "--out", self.folder / "out")
        for option, picture in (("--crater", "crater.png"), ("--bubbles", "bubbles.png")):
            done = plot(option, *both, "--labels", "one,two")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(picture, done.stdout)
            self.assertTrue((self.folder / "out" / picture).exists())

    def test_says_what_is_wrong(self):
        write_snapshot(self.folder, 1, self.flat)
        for arguments, words in (
                ((self.folder / "none",), "there is no folder"),
                ((TOOLS,), "neither field files nor a history"),
                ((self.folder, "--window=2,3,0,1"), "beyond the grid"),
                ((self.folder, "--window=1,0,0,1"), "X0 < X1"),
                ((self.folder, "--crater"), "give output.crater"),
                ((self.folder, "--bubbles"), "holds no bubble"),
                ((self.folder, "--crater", "--labels", "a,b"), "names 2 results, but there are 1")):
            done = plot(*arguments)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)


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


    def test_case_values(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "case.yaml").write_text(CASE, encoding="utf-8")
            self.assertEqual(case_value(folder, "grid", "geometry"), "planar")
            self.assertEqual(case_value(folder, "boundaries", "x_max"), "free_slip")
            self.assertIsNone(case_value(folder, "grid", "x_max"))
            self.assertIsNone(case_value(folder, "gravity"))
            self.assertEqual(mirror_side(folder), "low")

    def test_images_beyond_a_plane_of_symmetry(self):
        with tempfile.TemporaryDirectory() as folder:
            write_snapshot(folder, 1, {"x": np.array([1.0, 2.0, 4.0]), "z": np.linspace(0, 1, 4)})
            half = Snapshot(pathlib.Path(folder) / "fields_00000001.h5")
            whole = half.mirrored(at_high=False)
            np.testing.assert_array_equal(whole.axes["x"], [-2, 0, 1, 2, 4])
            np.testing.assert_array_equal(whole.velocity[:, 1], half.velocity[:, 0] * [-1, 1])
            np.testing.assert_array_equal(half.mirrored(at_high=True).axes["x"], [1, 2, 4, 6, 7])
            part = whole.cropped({"x": (-1, 1.5), "z": (0, 0.5)})
            np.testing.assert_array_equal(part.axes["x"], [-2, 0, 1, 2])
            self.assertEqual(part.velocity.shape, (2, 3, 2))

            write_crater(folder)
            x, surface, top = crater.CraterResult(pathlib.Path(folder), "", "cm").profile(1)
            np.testing.assert_allclose(x, np.arange(-95, 100, 10))
            np.testing.assert_allclose(top, top[::-1])
            np.testing.assert_allclose(top.min(), 41)
            np.testing.assert_allclose(surface, top - 1)


class ArrowTest(unittest.TestCase):
    def test_every_second_cell_of_equal_ones(self):
        np.testing.assert_array_equal(flat.chosen_cells(np.linspace(0, 0.7, 8), 0, 0.2), [0, 2, 4, 6])
        np.testing.assert_array_equal(flat.chosen_cells(np.array([0, 1, 2, 4, 8.0]), 0, 2), [0, 2, 3])


class SurfaceTest(unittest.TestCase):
    def test_surface_has_the_colour_of_fuller_cells(self):
        class Layer:
            """Water below z = 0.5, under a row of cells with specks of sand only."""
            axes = {axis: np.linspace(0, 1, 5) for axis in "xyz"}
            species = ["sand", "water"]

            def fraction(self, name):
                values = np.zeros((4, 4, 4))
                values[:2] = name == "water"
                values[2] = 1e-3 * (name == "sand")
                return values

            total_fraction = property(lambda self: self.fraction("sand") + self.fraction("water"))

        colours = solid.tint(Layer(), np.array([[0.4, 0.6, 0.45], [0.4, 0.6, 0.55]]))
        water = style.species_colours(["sand", "water"])[1]
        np.testing.assert_allclose(colours, [water, water])

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
