"""Outlines of the bubbles of several runs when they are largest, as in the report's Fig. 17."""
import numpy as np

from . import flat, history, style
from .result import ResultError, Snapshot, field_files, read_history, read_table


def largest_bubble(folder):
    """The field file nearest to the time of the largest bubble."""
    history, files = read_history(folder), field_files(folder)
    if not files or np.max(history.get("bubble_volume", [0])) <= 0:
        raise ResultError(f"{folder} holds no bubble: neither in history.csv nor in a field file")
    time = history["time"][np.argmax(history["bubble_volume"])]
    times = [Snapshot(path).time for path in files]
    nearest = int(np.argmin(np.abs(np.array(times) - time)))
    return Snapshot(files[nearest], max(times))


def outline(axes, snapshot, **form):
    """Draws the surface of all gas that is not at the ambient pressure. Returns its extents along x and z."""
    gas = snapshot.fields["gas_region"] >= 2
    near = gas.copy()  # with the cells next to it, where the surface lies
    near[1:] |= gas[:-1]
    near[:-1] |= gas[1:]
    near[:, 1:] |= gas[:, :-1]
    near[:, :-1] |= gas[:, 1:]
    x, z, total = flat.padded(snapshot, np.where(near, snapshot.total_fraction, 1))
    axes.contour(x, z, total, levels=[0.5], **form)
    z_cells, x_cells = np.nonzero(gas)
    return [(faces[cells.min()], faces[cells.max() + 1])
            for faces, cells in ((snapshot.axes["x"], x_cells), (snapshot.axes["z"], z_cells))]


def draw(pyplot, folders, labels, prepared, path):
    """All outlines in one picture. `prepared`: turns a folder and a snapshot into what is drawn of it."""
    figure, axes = pyplot.subplots(figsize=(8.6, 6), dpi=130, layout="constrained")
    colours = style.RC["axes.prop_cycle"].by_key()["color"]
    handles, extents = [], []
    for n, (folder, label) in enumerate(zip(folders, labels)):
        whole = largest_bubble(folder)
        if whole.dimension != 2:
            raise ResultError(f"{folder}: outlines of bubbles are drawn of two-dimensional results only")
        snapshot = prepared(folder, whole)
        colour = colours[n % len(colours)]
        if not np.any(snapshot.fields["gas_region"] >= 2):
            raise ResultError(f"{folder}: no field file near the time of the largest bubble shows it")
        extents.append(outline(axes, snapshot, colors=colour, linewidths=1.8))
        handles += axes.plot([], [], color=colour, linewidth=1.8, label=f"{label}, {style.time_text(snapshot)}")
        level = read_table(folder, "crater.csv").get("level")
        if level is not None:
            factor = np.ptp(snapshot.axes["z"]) / np.ptp(whole.axes["z"])
            axes.axhline(level[0] * factor, color=style.INK, linewidth=0.8, linestyle=(0, (6, 4)), zorder=2.5)
    low, high = np.min(extents, axis=0)[:, 0], np.max(extents, axis=0)[:, 1]
    margin = 0.12 * max(high - low)
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal", adjustable="box")
    names = flat.axis_names(snapshot)
    axes.set_xlabel(names[0])
    axes.set_ylabel(names[1])
    axes.grid(color=history.GRID, linewidth=0.5)
    axes.legend(handles=handles, fontsize="small", loc="upper left", bbox_to_anchor=(1.02, 1))
    axes.set_title("Bubbles at their largest volume")
    figure.savefig(path)
    pyplot.close(figure)
