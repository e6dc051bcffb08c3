"""Differences between two results: of fields at common times, also on different grids, and of tables."""
import dataclasses

import numpy as np

from . import flat, history, style
from .result import ResultError, Snapshot, field_files, read_table

SAME_TIME = 1e-6  # outputs closer than this, relative to the length of the run, are at the same time
TABLES = ("history.csv", "crater.csv")
# How a run was computed rather than what came out.
NOT_RESULTS = ("step", "dt")


@dataclasses.dataclass
class Difference:
    """The largest difference of a quantity and where it is; relative to the largest value of either result."""
    kind: str
    name: str
    largest: float
    relative: float
    mean: float  # relative too
    time: float

    @property
    def judged(self):
        """Whether it is a result, not a matter of how it was computed."""
        return not (self.name.startswith("iterations_") or self.name in NOT_RESULTS)


def relative_to(value, scale):
    return value / scale if scale > 0 else (0.0 if value == 0 else np.inf)


def overlap(to, origin, radial):
    """Matrix that turns means over cells with faces `origin` into means over cells with faces `to`."""
    weigh = np.square if radial else np.asarray
    low, high = np.maximum(to[:-1, None], origin[None, :-1]), np.minimum(to[1:, None], origin[None, 1:])
    shared = np.where(high > low, weigh(high) - weigh(low), 0)
    whole = shared.sum(axis=1, keepdims=True)
    return np.divide(shared, whole, out=np.zeros_like(shared), where=whole > 0)


class CommonGrid:
    """The cells of one snapshot in which another has values too, and the other's means over them."""

    def __init__(self, snapshot, other):
        if list(snapshot.axes) != list(other.axes):
            raise ResultError("the results have different dimensions")
        self.same = all(np.array_equal(snapshot.axes[name], other.axes[name]) for name in snapshot.axes)
        self._matrices, weights = {}, []
        for name, faces in snapshot.axes.items():
            radial = name == "x" and snapshot.axisymmetric
            self._matrices[name] = overlap(faces, other.axes[name], radial)
            shared = np.minimum(faces[1:], other.axes[name][-1]) - np.maximum(faces[:-1], other.axes[name][0])
            part = np.clip(shared / np.diff(faces), 0, 1)
            weights.append((np.diff(np.square(faces)) if radial else np.diff(faces)) * part)
        self.weight = weights[0]
        for more in weights[1:]:
            self.weight = np.multiply.outer(more, self.weight)
        if self.weight.sum() == 0:
            raise ResultError("the grids of the results have no part in common")

    def means(self, values):
        """Means of the other's values over the cells of the snapshot."""
        if self.same:
            return values
        dimension = len(self._matrices)
        for number, matrix in enumerate(self._matrices.values()):
            axis = dimension - 1 - number
            values = np.moveaxis(np.tensordot(matrix, values, axes=(1, axis)), 0, axis)
        return values


def common_snapshots(first, second):
    """Pairs of field files at the same times."""
    files = [field_files(folder) for folder in (first, second)]
    times = [np.array([Snapshot(path).time for path in paths]) for paths in files]
    if not all(len(t) for t in times):
        return []
    slack = SAME_TIME * max(times[0].max(), times[1].max())
    pairs = []
    for n, time in enumerate(times[0]):
        nearest = int(np.argmin(np.abs(times[1] - time)))
        if abs(times[1][nearest] - time) <= slack:
            pairs.append((files[0][n], files[1][nearest]))
    return pairs


def amount(values, snapshot):
    """Norm of vectors; the velocity counts only where there is liquid."""
    return np.linalg.norm(values, axis=-1) if values.ndim > snapshot.dimension else np.abs(values)


def compare_fields(pairs):
    """Differences of all fields that both have, the largest over all times."""
    found, scales = {}, {}
    for path_a, path_b in pairs:
        a, b = Snapshot(path_a), Snapshot(path_b)
        grid = CommonGrid(a, b)
        for name in a.fields:
            if name not in b.fields:
                continue
            one, other = a.fields[name], b.fields[name]
            if name == "velocity":  # meaningless in gas: compare the momentum per volume of mixture, with mass 1
                one, other = one * a.total_fraction[..., None], other * b.total_fraction[..., None]
            inside = grid.weight > 0
            apart = amount(grid.means(other) - one, a)[inside]
            weight = grid.weight[inside]
            scales[name] = max(scales.get(name, 0.0), amount(one, a).max(), amount(other, b).max())
            mean = float((apart * weight).sum() / weight.sum())
            before = found.get(name)
            if before is None or apart.max() > before[0]:
                found[name] = (float(apart.max()), max(mean, before[1] if before else 0), a.time)
            else:
                found[name] = (before[0], max(mean, before[1]), before[2])
    return [Difference("field", name, largest, relative_to(largest, scales[name]), relative_to(mean, scales[name]), time)
            for name, (largest, mean, time) in found.items()]


def compare_tables(first, second):
    """Differences of the columns of tables that both have, at the times of the first, between lines of the second."""
    differences = []
    for table in TABLES:
        a, b = read_table(first, table), read_table(second, table)
        if "time" not in a or "time" not in b:
            continue
        inside = (a["time"] >= b["time"][0]) & (a["time"] <= b["time"][-1])
        if not inside.any():
            continue
        time = a["time"][inside]
        for name in a:
            if name == "time" or name not in b:
                continue
            apart = np.abs(np.interp(time, b["time"], b[name]) - a[name][inside])
            scale = max(np.abs(a[name]).max(), np.abs(b[name]).max())
            worst = int(np.argmax(apart))
            differences.append(Difference(table.removesuffix(".csv"), name, float(apart[worst]),
                                          relative_to(apart[worst], scale), relative_to(apart.mean(), scale), time[worst]))
    return differences


def draw(pyplot, folders, pairs, differences, path):
    """Above, frames at the last common time and their difference where they are flat; below, columns that differ most."""
    shown = [d for d in differences if d.kind != "field" and d.judged and np.isfinite(d.relative) and d.largest > 0]
    shown = sorted(shown, key=lambda d: -d.relative)[:6]
    snapshots = [Snapshot(path_of) for path_of in pairs[-1]] if pairs else []
    frames = snapshots and snapshots[0].dimension == 2
    rows = -(-len(shown) // 3)
    if not frames and not rows:
        return False
    figure = pyplot.figure(figsize=(11, (4.4 if frames else 0.3) + 2.5 * rows), dpi=130, layout="constrained")
    parts = figure.subfigures(2, 1, height_ratios=[4.4, 2.5 * rows]) if frames and rows else [figure, figure]
    names = [folder.resolve().name for folder in folders]
    if frames:
        draw_frames(parts[0].subplots(1, 3), snapshots, names)
    if rows:
        panels = parts[1].subplots(rows, 3, squeeze=False).flat
        for axes, difference in zip(panels, shown):
            for folder, name, line in zip(folders, names, ("-", "--")):
                table = read_table(folder, difference.kind + ".csv")
                axes.plot(table["time"], table[difference.name], line, label=name)
            axes.set_title(difference.name.replace("_", " "))
            axes.margins(x=0)
            axes.grid(color=history.GRID, linewidth=0.5)
        panels[0].legend(fontsize="small")
        for axes in list(parts[1].axes)[len(shown):]:
            axes.set_visible(False)
    figure.savefig(path)
    pyplot.close(figure)
    return True


def draw_frames(panels, snapshots, names):
    for axes, snapshot, name in zip(panels, snapshots, names):
        flat.frame(axes, snapshot, label_below=0, look=flat.Look(contours=False, arrows=False))
        axes.set_title(f"{name}, {style.time_text(snapshot)}")
    a, b = snapshots
    apart = CommonGrid(a, b).means(b.total_fraction) - a.total_fraction
    image = panels[2].pcolormesh(a.axes["x"], a.axes["z"], apart, cmap="RdBu_r", vmin=-1, vmax=1)
    panels[2].set_aspect("equal")
    panels[2].set_title("volume fraction, second less first")
    panels[2].figure.colorbar(image, ax=panels[2], shrink=0.8)
