"""Small made-up result folders."""
import json
import pathlib

import h5py
import numpy as np

CASE = """title: Test
units: SI
grid:
  dimension: 2
  geometry: planar
boundaries:
  x_min: symmetry
  x_max: free_slip
"""


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


def write_crater(folder, depth=0.1):
    """A half crater at two times, in a case whose domain ends at a plane of symmetry x = 0."""
    folder = pathlib.Path(folder)
    folder.mkdir(exist_ok=True)
    (folder / "case.yaml").write_text(CASE, encoding="utf-8")
    names = ["level", "depth", "deepest_x", "width", "volume", "open_depth", "open_deepest_x", "open_width", "open_volume",
             "lip_height", "lip_x", "volume_of_lip"]
    lines, profiles = [",".join(["step", "time", *names])], ["step,time,x,surface,top"]
    for step, time, share in ((0, 0, 0), (8, 0.5, 1)):
        values = dict.fromkeys(names, share * depth) | {"level": 0.5}
        lines.append(",".join([str(step), str(time), *(str(values[name]) for name in names)]))
        for x in np.arange(0.05, 1, 0.1):
            z = 0.5 - share * depth * max(0, 1 - 2 * x)
            profiles.append(f"{step},{time},{x},{z - 0.01 * share},{z}")
    (folder / "crater.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "crater_profiles.csv").write_text("\n".join(profiles) + "\n", encoding="utf-8")


def write_summary(folder, **values):
    summary = {"status": "finished", "time": 1.0, "steps": 10, "cells": 128, "wall_seconds": 2.5, "step_seconds": 2.0,
               "volume_error": {"sand": 1e-15}, "energy_increase": {"redistribution": 0, "projection": 0},
               "phases": {"diffusion": {"seconds": 1.5, "iterations": 20, "fallbacks": 2}}, **values}
    (pathlib.Path(folder) / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
