"""Reading a result folder."""
import csv
import pathlib
import re

import h5py
import numpy as np

FIELD_FILE = re.compile(r"fields_(\d+)\.h5$")


class ResultError(Exception):
    """A result that can't be read; the message is for the user."""


class Snapshot:
    """One field file. Arrays are indexed [z, x] or [z, y, x], velocities [..., component]."""

    def __init__(self, path, end_time=None):
        try:
            with h5py.File(path, "r") as file:
                self.axes = {name: file["grid"][name][...] for name in sorted(file["grid"])}
                self.fields = {name: file["fields"][name][...] for name in file["fields"]}
                self.attributes = dict(file.attrs)
        except (OSError, KeyError) as error:
            raise ResultError(f"{path}: {error}") from error
        self.step = int(self.attributes["step"])
        self.time = float(self.attributes["time"])
        self.end_time = self.time if end_time is None else end_time  # of the run, for the choice of units

    @property
    def dimension(self):
        return len(self.axes)

    @property
    def axisymmetric(self):
        return self._text("geometry") == "axisymmetric"

    @property
    def title(self):
        return self._text("title")

    @property
    def si_units(self):
        return self._text("units") == "SI"

    @property
    def species(self):
        """Names of the species in the order of the fractions below."""
        return [name[len("phi_"):] for name in self.fields if name.startswith("phi_")]

    def fraction(self, species):
        return self.fields["phi_" + species]

    @property
    def total_fraction(self):
        """Sum of all volume fractions: the density of the report's figures."""
        return sum(self.fraction(name) for name in self.species)

    @property
    def velocity(self):
        return self.fields["velocity"]

    def centres(self, axis):
        faces = self.axes[axis]
        return 0.5 * (faces[1:] + faces[:-1])

    def extent(self, axis):
        return self.axes[axis][0], self.axes[axis][-1]

    def max_speed(self, least_fraction):
        """Largest speed where the total fraction is at least that; 0 where there is none."""
        speed = np.linalg.norm(self.velocity, axis=-1)[self.total_fraction >= least_fraction]
        return float(speed.max()) if speed.size else 0.0

    def slice(self, axis, position):
        """The plane of cells at a position along x or y of a 3-D snapshot, as a 2-D snapshot with axes x (across) and z."""
        number = "zyx".index(axis)
        cell = int(np.clip(np.searchsorted(self.axes[axis], position, side="right") - 1, 0, len(self.axes[axis]) - 2))
        across = "y" if axis == "x" else "x"
        plane = Snapshot.__new__(Snapshot)
        plane.axes = {"x": self.axes[across], "z": self.axes["z"]}
        plane.fields = {name: np.take(values, cell, axis=number) for name, values in self.fields.items()}
        plane.fields["velocity"] = plane.fields["velocity"][..., ["xyz".index(across), 2]]
        plane.attributes = self.attributes
        plane.step, plane.time, plane.end_time = self.step, self.time, self.end_time
        return plane

    def _text(self, name):
        value = self.attributes.get(name, "")
        return value.decode() if isinstance(value, bytes) else str(value)


def field_files(folder):
    """Field files of a result folder by step."""
    found = []
    for path in pathlib.Path(folder).glob("fields_*.h5"):
        match = FIELD_FILE.search(path.name)
        if match:
            found.append((int(match[1]), path))
    return [path for _, path in sorted(found)]


def read_history(folder):
    """Columns of history.csv by name; empty where there is no complete line."""
    path = pathlib.Path(folder) / "history.csv"
    if not path.exists():
        return {}
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    if len(rows) < 2:
        return {}
    names = rows[0]
    lines = [row for row in rows[1:] if len(row) == len(names)]
    if not lines:
        return {}
    try:
        table = np.array([[float(cell or "nan") for cell in row] for row in lines])
    except ValueError as error:
        raise ResultError(f"{path}: {error}") from error
    return {name: table[:, n] for n, name in enumerate(names)}
