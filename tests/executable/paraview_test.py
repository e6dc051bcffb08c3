#!/usr/bin/python3
"""Results opened through fields.xdmf and drawn by ParaView: what it finds is what the run wrote.

usage: paraview_test.py PROGRAM CONFIGS [PICTURES]

PICTURES is a folder that keeps the pictures. Exits with 77 where ParaView is missing, or Xvfb: Debian's ParaView draws
nothing without an X server.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import matplotlib.image
import numpy as np

VIEW = pathlib.Path(__file__).with_name("paraview_view.py")
SKIPPED = 77

# Case, its species, what is set beside the output.
CASES = {
    "plane": ("dam_break/martin_moyce", "water", ["time={end: 1, cfl: 0.3, max_step: 0.05}"]),
    "axisymmetric": ("slug/case_d", "slurry", ["time={end: 1, cfl: 0.3, max_step: 0.02}"]),
    "space": ("slug/case_b_3d", "slurry", ["time={end: 0.4, cfl: 0.3, max_step: 0.02}"]),
    "stages": ("bubbles/free_ball", "water", [
        "time={end: 1, cfl: 0.5, max_step: 0.05}",
        "stages=[{until: 0.4, grid: {x: {from: 0, to: 6.25, cells: 30}, z: {from: 0, to: 6.25, cells: 30}}}]"]),
}


class ParaviewTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """Starts an X server that picks a free display and says which when it is ready."""
        server = subprocess.Popen(["Xvfb", "-displayfd", "1", "-noreset", "-screen", "0", "640x640x24"], stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL, text=True)
        cls.addClassCleanup(server.communicate)
        cls.addClassCleanup(server.terminate)
        cls.display = f":{server.stdout.readline().strip()}"

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def view(self, name):
        """Runs a case, has ParaView look at it; returns the result folder."""
        case, species, settings = CASES[name]
        end = float(settings[0].split("end: ")[1].split(",")[0])
        settings = [*settings, f"output={{directory: R, fields: {{every: {end / 2}}}}}"]
        environment = {**os.environ, "OMP_NUM_THREADS": "1", "DISPLAY": self.display}
        for command in ([PROGRAM, "run", f"{CONFIGS}/{case}.yaml", "--quiet", *(f"--set={s}" for s in settings)],
                        ["pvbatch", "--force-offscreen-rendering", VIEW, "R/fields.xdmf", f"phi_{species}", "."]):
            done = subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        if PICTURES:
            shutil.copy(self.folder / "picture.png", PICTURES / f"{name}.png")
        return self.folder / "R"

    def expect_content(self, found, result):
        """Coordinates and values of every cell, bit by bit."""
        files = sorted(result.glob("fields_*.h5"))
        self.assertEqual(len(files), 3)
        self.assertEqual(len(found["times"]), len(files))
        for number, path in enumerate(files):
            with h5py.File(path) as file:
                self.assertEqual(found["times"][number], file.attrs["time"])
                faces = [file[f"grid/{axis}"][:] for axis in sorted(file["grid"])]
                self.assertEqual(found[f"{number}/cells"], np.prod([len(values) - 1 for values in faces]))
                # The viewer knows no planes: (x, z) is its (x, y).
                for axis, values in zip("xyz", faces):
                    np.testing.assert_array_equal(found[f"{number}/faces/{axis}"], values)
                bounds = [end for values in faces for end in (values[0], values[-1])]
                np.testing.assert_array_equal(found[f"{number}/bounds"], bounds + [0, 0] * (3 - len(faces)))
                prefix = f"{number}/fields/"
                self.assertEqual(sorted(name[len(prefix):] for name in found if name.startswith(prefix)),
                                 sorted(file["fields"]))
                for field, values in file["fields"].items():
                    vector = values.ndim > len(faces)
                    expected = values[:].reshape((-1, values.shape[-1]) if vector else -1)
                    seen = found[prefix + field]
                    if vector and len(faces) == 2:
                        np.testing.assert_array_equal(seen[:, 2], 0)
                        seen = seen[:, :2]
                    np.testing.assert_array_equal(seen, expected, err_msg=field)

    def expect_picture(self):
        """Background and body in the picture, and a body of many shades."""
        pixels = matplotlib.image.imread(self.folder / "picture.png")[..., :3]
        colours, counts = np.unique(np.round(pixels * 255).astype(int).reshape(-1, 3), axis=0, return_counts=True)
        self.assertGreater(len(colours), 10)
        self.assertGreater(counts.max(), 0.02 * counts.sum())
        self.assertLess(counts.max(), 0.95 * counts.sum())

    def expect_same_in_paraview(self, name, readers=("Xdmf2", "Xdmf3S", "Xdmf3T")):
        result = self.view(name)
        for reader in readers:
            with self.subTest(reader=reader):
                self.expect_content(np.load(self.folder / f"{reader}.npz"), result)
        self.expect_picture()

    def test_plane(self):
        self.expect_same_in_paraview("plane")

    def test_axisymmetric(self):
        self.expect_same_in_paraview("axisymmetric")

    def test_space(self):
        self.expect_same_in_paraview("space")

    def test_grid_that_changes(self):
        # The old reader, Xdmf2, goes on asking for as many cells as it first found.
        self.expect_same_in_paraview("stages", ["Xdmf3S", "Xdmf3T"])
        found = np.load(self.folder / "Xdmf3S.npz")
        self.assertNotEqual(found["0/cells"], found["2/cells"])


if __name__ == "__main__":
    for program in ("pvbatch", "Xvfb"):
        if not shutil.which(program):
            print(f"skipped: there is no {program} here; `tools/setup --all` installs it")
            sys.exit(SKIPPED)
    PROGRAM, CONFIGS = sys.argv[1:3]
    PICTURES = pathlib.Path(sys.argv[3]) if sys.argv[3:] else None
    unittest.main(argv=[sys.argv[0]])
