#!/usr/bin/python3
"""tools/compare on small made-up results."""
import pathlib
import tempfile
import unittest

import h5py
import numpy as np

import tool
from plotting import comparison
from plotting.result import Snapshot
from results import write_crater, write_history, write_snapshot


def compare(*arguments):
    return tool.run("compare", *arguments)


class CompareTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.a, self.b = (pathlib.Path(folder.name) / name for name in "ab")
        for result in (self.a, self.b):
            write_crater(result)
            for step in (0, 5):
                write_snapshot(result, step, {"x": np.linspace(0, 1, 9), "z": np.linspace(0, 1, 17)})
            write_history(result, ["step,time,dt,height_axis,iterations_projection", "1,0,0.1,2,5", "2,1,0.1,4,6"])

    def test_the_same(self):
        done = compare(self.a, self.b)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 common times of fields\nthe same within 1e-09", done.stdout)

    def test_how_it_was_computed_is_not_judged(self):
        write_history(self.b, ["step,time,dt,height_axis,iterations_projection", "1,0,0.1,2,9", "2,0.5,0.1,3,5", "7,1,0.5,4,6"])
        self.assertEqual(compare(self.a, self.b).returncode, 0)
        self.assertIn("iterations_projection", compare(self.a, self.b, "--all").stdout)

    def test_differences(self):
        write_crater(self.b, depth=0.2)
        with h5py.File(self.b / "fields_00000005.h5", "r+") as file:
            file["fields/density"][3, 4] += 0.5
        done = compare(self.a, self.b, "--picture", self.a / "apart.png")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stdout, r"field +density +0\.5 +3\.33e-01 +2\.6\de-03 +0\.5")
        self.assertRegex(done.stdout, r"crater +depth +0\.1 +5\.00e-01")
        self.assertTrue((self.a / "apart.png").exists())
        self.assertEqual(compare(self.a, self.b, "--tolerance", 0.6).returncode, 0)

    def test_what_can_not_be_compared(self):
        self.assertEqual(compare(self.a, self.a / "none").returncode, 2)
        empty = self.a / "empty"
        empty.mkdir()
        done = compare(self.a, empty)
        self.assertEqual(done.returncode, 2)
        self.assertIn("nothing in common", done.stderr)


class CommonGridTest(unittest.TestCase):
    def test_means_on_other_grids_are_conservative(self):
        with tempfile.TemporaryDirectory() as folder:
            coarse = {"x": np.linspace(0, 1, 5), "z": np.array([0, 0.3, 1.0])}
            fine = {"x": np.linspace(0, 1, 33), "z": np.linspace(0, 2, 21)}
            for step, faces in enumerate((coarse, fine)):
                write_snapshot(folder, step, faces, "axisymmetric")
            a, b = (Snapshot(pathlib.Path(folder) / f"fields_0000000{n}.h5") for n in (0, 1))
            grid = comparison.CommonGrid(a, b)
            values = np.random.default_rng(1).random((20, 32))
            means = grid.means(values)
            self.assertEqual(means.shape, (2, 4))
            inside = np.diff(b.axes["z"])[:10, None] * np.diff(b.axes["x"]**2)
            self.assertAlmostEqual((means * grid.weight).sum(), (values[:10] * inside).sum(), places=12)
            np.testing.assert_allclose(grid.means(np.ones((20, 32, 2))), 1)


if __name__ == "__main__":
    unittest.main()
