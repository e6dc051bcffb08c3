"""Reading a result folder."""
import copy
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
        self.length_unit = "m" if self.si_units else ""
        self.window = None  # what is drawn, {axis: (low, high)}; all where None

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
        """Ends of what is drawn along an axis."""
        if self.window is not None:
            return self.window[axis]
        return self.axes[axis][0], self.axes[axis][-1]

    def max_speed(self, least_fraction):
        """Largest speed where the total fraction is at least that; 0 where there is none."""
        speed = np.linalg.norm(self.velocity, axis=-1)[self.total_fraction >= least_fraction]
        return float(speed.max()) if speed.size else 0.0

    def mirrored(self, at_high):
        """A 2-D snapshot with its image beyond the low or high end of x."""
        whole = copy.copy(self)
        x = self.axes["x"]
        image = 2 * x[-1 if at_high else 0] - x[::-1]
        parts = (x, image[1:]) if at_high else (image[:-1], x)
        whole.axes = {**self.axes, "x": np.concatenate(parts)}
        whole.fields = {}
        for name, values in self.fields.items():
            flipped = values[:, ::-1]
            if name == "velocity":
                flipped = flipped * [-1, 1]
            whole.fields[name] = np.concatenate((values, flipped) if at_high else (flipped, values), axis=1)
        return whole

    def scaled(self, factor, unit):
        """The snapshot with lengths in another unit: `factor` of them make one of the case."""
        copied = copy.copy(self)
        copied.axes = {name: values * factor for name, values in self.axes.items()}
        copied.length_unit = unit
        return copied

    def cropped(self, window):
        """A 2-D snapshot of the cells in a window {axis: (low, high)}, which becomes what is drawn."""
        part = copy.copy(self)
        part.window, part.axes, part.fields = window, {}, {}
        cuts = []
        for axis in ("z", "x"):
            faces = self.axes[axis]
            inside = np.flatnonzero((faces[1:] > window[axis][0]) & (faces[:-1] < window[axis][1]))
            if len(inside) == 0:
                raise ResultError(f"the window {window[axis][0]:g} to {window[axis][1]:g} along {axis} is beyond the "
                                  f"grid, {faces[0]:g} to {faces[-1]:g}")
            cuts.append(slice(inside[0], inside[-1] + 1))
            part.axes[axis] = faces[inside[0]:inside[-1] + 2]
        part.fields = {name: values[tuple(cuts)] for name, values in self.fields.items()}
        return part

    def slice(self, axis, position):
        """The plane of cells at a position along x or y of a 3-D snapshot, as a 2-D snapshot with axes x (across) and z."""
        number = "zyx".index(axis)
        cell = int(np.clip(np.searchsorted(self.axes[axis], position, side="right") - 1, 0, len(self.axes[axis]) - 2))
        across = "y" if axis == "x" else "x"
        plane = copy.copy(self)
        plane.axes = {"x": self.axes[across], "z": self.axes["z"]}
        plane.fields = {name: np.take(values, cell, axis=number) for name, values in self.fields.items()}
        plane.fields["velocity"] = plane.fields["velocity"][..., ["xyz".index(across), 2]]
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
    return read_table(folder, "history.csv")


def read_table(folder, name):
    """Columns of a table of numbers by name; empty where there is no complete line."""
    path = pathlib.Path(folder) / name
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


def case_value(folder, *keys):
    """Text of a value in the case.yaml that a run has written, such as ("boundaries", "x_min"); None where there is none.
    For values on a line of their own."""
    path = pathlib.Path(folder) / "case.yaml"
    if not path.exists():
        return None
    level = 0
    for line in path.read_text(encoding="utf-8").splitlines():
        indentation = (len(line) - len(line.lstrip())) // 2
        key, colon, value = line.strip().partition(":")
        if indentation < level:
            return None
        if not colon or indentation > level or key != keys[level]:
            continue
        if level + 1 == len(keys):
            return value.strip().strip("\"'")
        level += 1
    return None


def mirror_side(folder):
    """At which end of x the domain goes on as its image: "low", "high", or None."""
    if case_value(folder, "boundaries", "x_min") in ("axis", "symmetry"):
        return "low"
    return "high" if case_value(folder, "boundaries", "x_max") == "symmetry" else None
