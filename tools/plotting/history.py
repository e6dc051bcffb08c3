"""Plots over time from history.csv."""
import numpy as np

from . import style

GRID = "#d8dce0"


def panels(history):
    """Title, curves {label: values} and whether logarithmic, for each panel that the columns allow."""
    def pick(*names):
        return {name.replace("_", " "): history[name] for name in names if name in history}

    volumes = [name for name in history if name.startswith("volume_")]
    iterations = [name for name in history if "iterations" in name]
    drift = {name[len("volume_"):]: np.abs(history[name] / history[name][0] - 1) for name in volumes
             if history[name][0] != 0}
    # Round-off at the level of a single number is drawn at the level where it begins.
    drift = {name: np.maximum(values, 1e-16) for name, values in drift.items()}
    energy = pick("kinetic_energy", "potential_energy")
    if len(energy) == 2:
        energy = {"kinetic": history["kinetic_energy"],
                  "potential, change": history["potential_energy"] - history["potential_energy"][0],
                  "total, change": history["kinetic_energy"] + history["potential_energy"]
                  - history["kinetic_energy"][0] - history["potential_energy"][0]}
    result = [
        ("Heights and base radius", pick("height_axis", "height_max", "radius_base"), False),
        ("Largest speed", pick("max_speed", "max_speed_liquid"), False),
        ("Energy", energy, False),
        ("Time step", {"dt": np.where(history["dt"] > 0, history["dt"], np.nan)} if "dt" in history else {}, False),
        ("Iterations per step", {name.replace("iterations", "").replace("_", " ").strip() or "all": history[name]
                                 for name in iterations}, False),
        ("Relative volume change", drift, True),
    ]
    bubbles = history.get("bubbles", np.zeros(1))
    if np.nanmax(bubbles, initial=0) > 0:
        result += [("Bubble volume", pick("bubble_volume"), False), ("Bubble pressure", pick("bubble_pressure"), False),
                   ("Bubble height", pick("bubble_z"), False)]
    return [panel for panel in result if panel[1]]


def draw(pyplot, history, title, si_units, path):
    """Draws all panels on one page. Returns whether there was anything to draw."""
    if "time" not in history:
        return False
    drawn = panels(history)
    if not drawn:
        return False
    columns = min(3, len(drawn))
    rows = -(-len(drawn) // columns)
    figure, grid = pyplot.subplots(rows, columns, figsize=(3.9 * columns, 2.7 * rows + 0.4), dpi=130, squeeze=False,
                                   sharex=True, layout="constrained")
    for axes, (name, curves, logarithmic) in zip(grid.flat, drawn):
        for label, values in curves.items():
            axes.plot(history["time"], values, label=label)
        axes.set_title(name)
        axes.grid(color=GRID, linewidth=0.5)
        axes.margins(x=0)
        if logarithmic:
            axes.set_yscale("log")
            axes.set_ylim(5e-17, max(1e-11, 3 * max(np.nanmax(values) for values in curves.values())))
        else:
            axes.ticklabel_format(axis="y", scilimits=(-3, 4), useOffset=False)
            if name in ("Time step", "Iterations per step"):
                axes.set_ylim(0, 1.15 * max(np.nanmax(values, initial=1e-300) for values in curves.values()))
        if len(curves) > 1:
            axes.legend(fontsize="small" if len(curves) < 5 else "x-small")
    for axes in list(grid.flat)[len(drawn):]:
        axes.set_visible(False)
    for n, axes in enumerate(grid.flat):
        if n + columns >= len(drawn):
            axes.set_xlabel("time (s)" if si_units else "time")
            axes.tick_params(labelbottom=True)
    figure.suptitle(title, fontweight="bold", fontsize=11)
    figure.savefig(path)
    pyplot.close(figure)
    return True
