"""Colours and small helpers that all pictures share."""
import matplotlib
import numpy as np

INK = "#20262e"
ARROW = "#17456b"
BY_NAME = {"water": "#86b8de", "sand": "#e0c08a", "slurry": "#e0c08a", "mud": "#b08e6c", "clay": "#c98f6b", "oil": "#8a8f5a"}
OTHERS = ["#e0c08a", "#86b8de", "#a5c08a", "#c58fa8", "#9d94c7"]

RC = {
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.8,
    "axes.titlesize": 9,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "axes.prop_cycle": matplotlib.cycler(color=["#17456b", "#d08a3c", "#4d8f5c", "#8d5a97", "#7d8790", "#b5483f", "#3fa3a8",
                                               "#a89a2f"]),
}


def species_colours(names):
    """RGB of each species: by its name where that says something, else the next free colour."""
    free = [colour for colour in OTHERS if colour not in [BY_NAME.get(name) for name in names]] or OTHERS
    colours = []
    for name in names:
        colour = BY_NAME.get(name)
        if colour is None:
            colour = free[0]
            free = free[1:] + free[:1]
        colours.append(np.array([int(colour[n:n + 2], 16) / 255 for n in (1, 3, 5)]))
    return colours


LENGTHS = {"m": 1, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}


def time_text(snapshot):
    """Time with its unit."""
    return "t = " + time_label(snapshot.time, snapshot.end_time, snapshot.si_units)


def time_label(time, end_time, si_units):
    """A time with its unit, in ms where the whole run takes no more than two seconds."""
    scale, unit = time_scale(end_time, si_units)
    return f"{time * scale:.4g} {unit}".rstrip()


def time_scale(end_time, si_units):
    """Factor and unit for times of a run."""
    if not si_units:
        return 1, ""
    return (1e3, "ms") if end_time <= 2 else (1, "s")


def axis_label(name, unit):
    return f"{name} ({unit})" if unit else name


def chosen(items, most):
    """At most that many items, evenly spread, first and last among them."""
    if len(items) <= most:
        return list(items)
    return [items[n] for n in np.unique(np.linspace(0, len(items) - 1, most).round().astype(int))]


def page_columns(count, aspect):
    """Columns for panels of a height-to-width ratio such that the page gets about 4:3 with few empty places."""
    ideal = round(np.sqrt(count * aspect * 4 / 3))
    candidates = [n for n in (ideal, ideal + 1, ideal - 1) if 1 <= n <= count] or [min(count, max(1, ideal))]
    return min(candidates, key=lambda n: -(-count // n) * n - count)


def times_colours(count):
    """Colours from early to late."""
    return [matplotlib.colormaps["viridis_r"](share) for share in np.linspace(0.12, 1, max(count, 2))[-count:]]
