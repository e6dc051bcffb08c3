"""How runs ended: figures of a result folder in one line, and the histories of several over each other."""
import json
import pathlib

import numpy as np

from . import history, style
from .result import ResultError, read_history, read_table

# Columns of history.csv that end up in no table: how it was computed.
LEFT_OUT = ("step", "time", "dt", "bubbles", "bubble_volume", "bubble_pressure", "bubble_z")
PANELS = ("height_axis", "height_max", "radius_base", "kinetic_energy", "max_speed", "bubble_volume")


def read_summary(folder):
    """summary.json; empty where there is none."""
    path = pathlib.Path(folder) / "summary.json"
    if not path.exists():
        return {}
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ResultError(f"{path}: {error}") from error


def figures(folder):
    """Figures of how a run ended, by name: of the run, the last values of history.csv, the largest bubble, the crater."""
    summary = read_summary(folder)
    found = {name: summary.get(name) for name in ("status", "time", "steps", "cells", "wall_seconds")}
    found["status"] = found["status"] or "none"
    table = read_history(folder)
    for name, values in table.items():
        if name not in LEFT_OUT and not name.startswith("iterations_"):
            found[name] = values[-1]
    if np.max(table.get("bubble_volume", [0])) > 0:
        largest = int(np.argmax(table["bubble_volume"]))
        found["largest_bubble_volume"] = table["bubble_volume"][largest]
        found["largest_bubble_time"] = table["time"][largest]
    for name, values in read_table(folder, "crater.csv").items():
        if name not in ("step", "time"):
            found["crater_" + name] = values[-1]
    return found


def draw_histories(pyplot, folders, labels, path):
    """Histories of all results over each other. Returns whether there was anything to draw."""
    tables = [read_history(folder) for folder in folders]
    shown = [name for name in PANELS if any(np.ptp(table[name]) > 0 for table in tables if name in table)]
    if not shown:
        return False
    rows = -(-len(shown) // 3)
    figure, panels = pyplot.subplots(rows, min(3, len(shown)), figsize=(11.5, 2.8 * rows + 0.5), dpi=130, squeeze=False,
                                     layout="constrained")
    for axes, name in zip(panels.flat, shown):
        for number, (table, label) in enumerate(zip(tables, labels)):
            if name in table:
                axes.plot(table["time"], table[name], label=label, linestyle="-" if number < 8 else "--")
        axes.set_title(name.replace("_", " "))
        axes.set_xlabel("time")
        axes.margins(x=0)
        axes.grid(color=history.GRID, linewidth=0.5)
    for axes in list(panels.flat)[len(shown):]:
        axes.set_visible(False)
    panels[0, 0].legend(fontsize="x-small")
    figure.savefig(path)
    pyplot.close(figure)
    return True
