"""Profiles of a bed over each other, as in the report's Fig. 16, and the crater over time.

Solid lines: the bed's top; dotted ones: its surface below sand that overhangs it; dashed: the undisturbed level.
"""
import numpy as np

from . import history, style
from .result import ResultError, Snapshot, case_value, field_files, mirror_side, read_table

MOST_PROFILES = 8
CHANGED = 0.1  # share of the largest change of a bed from which on it counts as changed
MARGIN = 0.33
# Columns of crater.csv of a panel, drawn solid and dotted, and the power of a length that its unit is.
PANELS = [("Depth", "open_depth", "depth", 1), ("Width", "open_width", "width", 1),
          ("Volume", "open_volume", "volume", None), ("Lip height", "lip_height", None, 1)]


class CraterResult:
    """The crater of a result folder, lengths in `unit`, `factor` of which make one of the case."""

    def __init__(self, folder, label, unit=None):
        self.label = label
        self.history = read_table(folder, "crater.csv")
        profiles = read_table(folder, "crater_profiles.csv")
        if not self.history or not profiles:
            raise ResultError(f"{folder} holds no crater.csv with crater_profiles.csv: give output.crater in the case")
        self.si_units = case_value(folder, "units") != "none"
        self.unit = (unit or "m") if self.si_units else ""
        self.factor = 1 / style.LENGTHS[self.unit] if self.unit else 1
        self.level = self.history["level"][-1] * self.factor
        self.end_time = self.history["time"][-1]
        self.mirror = mirror_side(folder)
        self.axisymmetric = case_value(folder, "grid", "geometry") == "axisymmetric"
        self.three_dimensional = "y" in profiles
        files = field_files(folder)
        self.title = Snapshot(files[-1]).title if files else case_value(folder, "title") or str(folder)
        self._profiles = profiles
        steps, firsts = np.unique(profiles["step"], return_index=True)
        self.times = profiles["time"][firsts]
        self._steps = steps

    def profile(self, number):
        """x, surface and top of the output with that number, with the image beyond a plane of symmetry; in 3-D in the
        plane of columns through the deepest place at the end."""
        rows = self._profiles["step"] == self._steps[number]
        if self.three_dimensional:
            deepest = self.history["open_deepest_y"][-1]
            y = self._profiles["y"]
            rows &= y == y[rows][np.argmin(np.abs(y[rows] - deepest))]
        x, surface, top = (self._profiles[name][rows] * self.factor for name in ("x", "surface", "top"))
        if self.mirror is None or len(x) < 2:
            return x, surface, top
        # The plane lies half a column beyond the outermost centre.
        plane = x[0] - 0.5 * (x[1] - x[0]) if self.mirror == "low" else x[-1] + 0.5 * (x[-1] - x[-2])
        images = 2 * plane - x[::-1]
        order = [(values[::-1], values) if self.mirror == "low" else (values, values[::-1]) for values in (surface, top)]
        across = np.concatenate((images, x) if self.mirror == "low" else (x, images))
        return (across, *(np.concatenate(pair) for pair in order))

    def nearest(self, time):
        return int(np.argmin(np.abs(self.times - time)))


def draw_profile(axes, run, number, **form):
    """Draws a profile. Returns x and how much the bed has changed there."""
    x, surface, top = run.profile(number)
    line, = axes.plot(x, top, **form)
    if np.any(surface < top):
        axes.plot(x, np.where(surface < top, surface, np.nan), color=line.get_color(), linestyle=":", linewidth=1,
                  zorder=line.get_zorder())
    return x, np.maximum(np.abs(surface - run.level), np.abs(top - run.level))


def near_crater(changes, domain):
    """What to show along x: where the bed has changed, and a third more on both sides."""
    least = CHANGED * max(change.max() for _, change in changes)
    changed = np.concatenate([x[change > least] for x, change in changes])
    if len(changed) == 0:
        return domain
    margin = MARGIN * np.ptp(changed)
    return max(changed.min() - margin, domain[0]), min(changed.max() + margin, domain[1])


def draw_profiles(axes, runs, colours, times):
    """One run at several times, or several runs at one."""
    first = runs[0]
    changes = []
    if len(runs) == 1:
        wanted = [first.nearest(time) for time in times] if times else style.chosen(range(len(first.times)), MOST_PROFILES)
        shades = style.times_colours(len(wanted))
        for number, shade in zip(wanted, shades):
            changes.append(draw_profile(axes, first, number, color=shade, linewidth=2 if number == wanted[-1] else 1.2,
                                        label=style.time_label(first.times[number], first.end_time, first.si_units)))
    else:
        for run, colour in zip(runs, colours):
            number = run.nearest(times[0]) if times else len(run.times) - 1
            when = style.time_label(run.times[number], run.end_time, run.si_units)
            changes.append(draw_profile(axes, run, number, color=colour, label=f"{run.label}, t = {when}"))
    for level in {run.level for run in runs}:
        axes.axhline(level, color=style.INK, linewidth=0.8, linestyle=(0, (6, 4)), zorder=2.5)
    axes.plot([], [], color=style.INK, linewidth=1, linestyle=":", label="below sand")
    axes.plot([], [], color=style.INK, linewidth=0.8, linestyle=(0, (6, 4)), label="undisturbed")
    axes.margins(x=0)
    axes.set_xlim(near_crater(changes, axes.get_xlim()))
    axes.set_aspect("equal", adjustable="box")
    across = "r" if first.axisymmetric else "x"
    axes.set_xlabel(style.axis_label(across, first.unit))
    axes.set_ylabel(style.axis_label("z", first.unit))
    axes.grid(color=history.GRID, linewidth=0.5)
    axes.legend(fontsize="small", loc="center left", bbox_to_anchor=(1.01, 0.5))


def draw_histories(grid, runs, colours):
    scale, unit = style.time_scale(max(run.end_time for run in runs), runs[0].si_units)
    for axes, (title, solid, dotted, power) in zip(grid, PANELS):
        for run, colour in zip(runs, colours):
            # An area per unit of depth in planar flows.
            exponent = power or (3 if run.axisymmetric or run.three_dimensional else 2)
            for name, line in ((solid, "-"), (dotted, ":")):
                column = name if name is None or name in run.history else name + "_x"
                if name is not None:
                    axes.plot(run.history["time"] * scale, run.history[column] * run.factor**exponent, color=colour,
                              linestyle=line, linewidth=1.4 if line == "-" else 1.1)
            axes.set_title(style.axis_label(title, run.unit + ("" if exponent == 1 else "²" if exponent == 2 else "³"))
                           if run.unit else title)
        axes.set_xlabel(style.axis_label("time", unit))
        axes.set_ylim(bottom=0)
        axes.margins(x=0)
        axes.grid(color=history.GRID, linewidth=0.5)


def draw(pyplot, runs, path, times=None):
    """Profiles above, depth, width, volume and lip over time below."""
    colours = [style.RC["axes.prop_cycle"].by_key()["color"][n % 8] for n in range(len(runs))]
    figure = pyplot.figure(figsize=(11, 7.2), dpi=130, layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=[1.75, 1])
    draw_profiles(above.subplots(), runs, colours, times)
    draw_histories(below.subplots(1, len(PANELS)), runs, colours)
    title = runs[0].title if len(runs) == 1 else "Craters"
    figure.suptitle(title, fontweight="bold", fontsize=11)
    figure.savefig(path)
    pyplot.close(figure)
