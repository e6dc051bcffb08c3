"""Frames of planar and axisymmetric results in the style of the report's Figs. 5-11.

Lines: total volume fraction 0.1, 0.3, 0.5, 0.7, 0.9. Arrows: velocity in the lower left cell of each 2 x 2 block, of larger
ones on fine grids, where that fraction is at least 0.01. Below the frame: the largest speed there, with the arrow that stands for it, and in parentheses
the largest speed in the liquid, where the fraction is at least 0.9.
"""
import dataclasses

import numpy as np

from . import style

LEVELS = [0.1, 0.3, 0.5, 0.7, 0.9]
SPRAY = 0.01
LIQUID = 0.9
BLOCKS = 36  # blocks of arrows along the shorter side before blocks get larger than 2 x 2
BLOCKS_ON_PAGE = 22  # the same for one frame of many


def to_walls(coordinates, faces, values, axis):
    """Adds the outermost faces with the values of the cells next to them, so that lines reach the walls."""
    width = [(0, 0)] * values.ndim
    width[axis] = (1, 1)
    return np.concatenate([faces[:1], coordinates, faces[-1:]]), np.pad(values, width, mode="edge")


def padded(snapshot, values):
    """x, z and values of a field with its outermost faces."""
    x, values = to_walls(snapshot.centres("x"), snapshot.axes["x"], values, 1)
    z, values = to_walls(snapshot.centres("z"), snapshot.axes["z"], values, 0)
    return x, z, values


def resampled(x, z, values, pixels_x, pixels_z):
    """Bilinear values on a uniform picture."""
    across = np.stack([np.interp(pixels_x, x, row) for row in values])
    return np.stack([np.interp(pixels_z, z, column) for column in across.T], axis=1)


def fill(axes, snapshot):
    """Species as tints, mixed by volume fraction; gas stays white."""
    x_faces, z_faces = snapshot.axes["x"], snapshot.axes["z"]
    size = max(x_faces[-1] - x_faces[0], z_faces[-1] - z_faces[0])
    counts = [max(2, int(420 * (faces[-1] - faces[0]) / size)) for faces in (x_faces, z_faces)]
    pixels = [faces[0] + (np.arange(n) + 0.5) / n * (faces[-1] - faces[0])
              for n, faces in zip(counts, (x_faces, z_faces))]
    picture = np.ones((counts[1], counts[0], 3))
    for name, colour in zip(snapshot.species, style.species_colours(snapshot.species)):
        fraction = resampled(*padded(snapshot, snapshot.fraction(name)), *pixels)
        picture -= np.clip(fraction, 0, 1)[..., None] * (1 - colour)
    axes.imshow(np.clip(picture, 0, 1), origin="lower", extent=[x_faces[0], x_faces[-1], z_faces[0], z_faces[-1]],
                interpolation="bilinear", aspect="equal", zorder=0)


def lines(axes, snapshot, levels):
    """Contours of the total fraction, and the middle line between species."""
    x, z, total = padded(snapshot, snapshot.total_fraction)
    if total.max() > LEVELS[0] and total.min() < LEVELS[-1]:
        widths = [1.2 if level == 0.5 else 0.6 for level in levels]
        axes.contour(x, z, total, levels=levels, colors=style.INK, linewidths=widths, zorder=2)
    for name in snapshot.species[:-1] if len(snapshot.species) > 1 else []:
        share = np.where(total > 0.5, padded(snapshot, snapshot.fraction(name))[2] / np.maximum(total, 0.5), np.nan)
        if np.nanmin(share, initial=1) < 0.5 < np.nanmax(share, initial=0):
            axes.contour(x, z, share, levels=[0.5], colors="#7a5a2c", linewidths=0.9, linestyles="--", zorder=2)


def chosen_cells(faces, low, spacing):
    """The cells at points with that spacing, each once."""
    points = np.arange(low + 1e-6 * spacing, faces[-1], spacing)
    return np.unique(np.clip(np.searchsorted(faces, points, side="right") - 1, 0, len(faces) - 2))


def arrows(axes, snapshot, label_below, blocks):
    """Velocity arrows, their scale arrow and both largest speeds."""
    x_faces, z_faces = snapshot.axes["x"], snapshot.axes["z"]
    (x_low, x_high), (z_low, z_high) = snapshot.extent("x"), snapshot.extent("z")
    width, height = x_high - x_low, z_high - z_low
    speed, liquid_speed = snapshot.max_speed(SPRAY), snapshot.max_speed(LIQUID)
    cell = min(np.diff(x_faces).min(), np.diff(z_faces).min())
    block_size = 2 * cell * max(1, round(min(width, height) / (2 * cell * blocks)))
    length = min(0.2 * min(width, height), 2.2 * block_size)
    label = f"{speed:.3g} ({liquid_speed:.3g})" + (" m/s" if snapshot.si_units else "")
    if speed > 0:
        cells = np.ix_(chosen_cells(z_faces, z_faces[0], block_size), chosen_cells(x_faces, x_faces[0], block_size))
        x, z = np.meshgrid(snapshot.centres("x"), snapshot.centres("z"))
        drawn = snapshot.total_fraction[cells] >= SPRAY
        u = snapshot.velocity[cells][drawn]
        dots = axes.get_window_extent().width / width
        form = dict(angles="xy", scale_units="xy", scale=speed / length, color=style.ARROW, pivot="tail", units="dots",
                    width=np.clip(0.05 * block_size * dots, 0.9, 2.6), headwidth=4, headlength=5, headaxislength=4.5,
                    minlength=0.5)
        axes.quiver(x[cells][drawn], z[cells][drawn], u[:, 0], u[:, 1], zorder=3, **form)
        if label_below:
            axes.quiver([x_low + 0.04 * width], [z_low - label_below], [speed], [0], clip_on=False, zorder=4, **form)
    if label_below:
        axes.text(x_low + 0.07 * width + length, z_low - label_below, label, va="center", ha="left", fontsize="small")


@dataclasses.dataclass
class Look:
    """What a frame shows besides the species."""
    contours: bool = True
    arrows: bool = True
    blocks: int = BLOCKS


def frame(axes, snapshot, label_below, look=Look()):
    """Draws one frame. `label_below`: distance of the speeds from the lower side, in the unit of the axes; 0 for none."""
    fill(axes, snapshot)
    lines(axes, snapshot, LEVELS if look.contours else [0.5])
    axes.set_xlim(snapshot.extent("x"))
    axes.set_ylim(snapshot.extent("z"))
    if look.arrows:
        arrows(axes, snapshot, label_below, look.blocks)


def size_of(snapshot):
    return [high - low for low, high in (snapshot.extent("x"), snapshot.extent("z"))]


def axis_names(snapshot):
    across = "r" if snapshot.axisymmetric else "x"
    return style.axis_label(across, snapshot.length_unit), style.axis_label("z", snapshot.length_unit)


def legend(figure, snapshot):
    """Names the tints where there is more than one species."""
    if len(snapshot.species) < 2:
        return
    from matplotlib.patches import Patch
    patches = [Patch(facecolor=colour, edgecolor=style.INK, linewidth=0.6, label=name)
               for name, colour in zip(snapshot.species, style.species_colours(snapshot.species))]
    figure.legend(handles=patches, loc="upper right", ncol=len(patches), fontsize="small", borderaxespad=0.4)


def single(pyplot, snapshot, path, look=Look()):
    """One frame as a picture of its own."""
    width, height = size_of(snapshot)
    scale = min(7.2 / width, 6.2 / height)
    figure_size = (max(3.6, scale * width + 1.2), scale * height + 1.2)
    figure = pyplot.figure(figsize=figure_size, dpi=150)
    axes_width = scale * width / figure_size[0]
    axes = figure.add_axes([0.5 - axes_width / 2 + 0.12 / figure_size[0], 0.8 / figure_size[1], axes_width,
                            scale * height / figure_size[1]])
    frame(axes, snapshot, label_below=0.55 / scale, look=look)
    names = axis_names(snapshot)
    axes.set_xlabel(names[0], labelpad=1)
    axes.set_ylabel(names[1])
    axes.set_title(style.time_text(snapshot))
    legend(figure, snapshot)
    figure.savefig(path)
    pyplot.close(figure)


def overview(pyplot, snapshots, path, look=Look()):
    """A page of frames."""
    width, height = size_of(snapshots[-1])
    columns = style.page_columns(len(snapshots), (height / width) + 0.15)
    rows = -(-len(snapshots) // columns)
    panel = 11.0 / columns - 0.25
    scale = panel / width
    row_height = scale * height + 0.75
    figure_size = (11.6, rows * row_height + 0.5)
    figure = pyplot.figure(figsize=figure_size, dpi=130)
    for n, snapshot in enumerate(snapshots):
        column, row = n % columns, n // columns
        left = 0.42 + column * (panel + 0.25)
        bottom = figure_size[1] - 0.42 - (row + 1) * row_height + 0.5
        axes = figure.add_axes([left / figure_size[0], bottom / figure_size[1], panel / figure_size[0],
                                scale * height / figure_size[1]])
        own_width, own_height = size_of(snapshot)
        own_scale = min(panel / own_width, scale * height / own_height)
        frame(axes, snapshot, label_below=0.17 / own_scale,
              look=dataclasses.replace(look, blocks=BLOCKS_ON_PAGE))
        axes.set_title(style.time_text(snapshot), pad=3)
        axes.set_xticks([])
        if column == 0:
            axes.tick_params(labelsize="x-small")
        else:
            axes.set_yticks([])
    title = figure.text(0.42 / figure_size[0], 1 - 0.12 / figure_size[1], snapshots[-1].title, fontsize=11, va="top",
                        fontweight="bold")
    if snapshots[-1].length_unit:
        title_end = title.get_window_extent().x1 / figure.bbox.width
        figure.text(title_end + 0.12 / figure_size[0], 1 - 0.14 / figure_size[1],
                    f"lengths in {snapshots[-1].length_unit}", fontsize="small", va="top")
    legend(figure, snapshots[-1])
    figure.savefig(path)
    pyplot.close(figure)
