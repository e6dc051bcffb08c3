"""Frames of 3-D results: the surface where the total volume fraction is one half, and slices through the middle."""
import numpy as np

from . import flat, style

MOST_CELLS = 72  # cells along the longest axis of a drawn surface; finer grids are thinned out
VIEW = (-58.0, 22.0)  # azimuth and elevation of the viewer, in degrees
LIGHT = np.array([-0.35, -0.65, 0.7]) / np.linalg.norm([-0.35, -0.65, 0.7])

# Corners of a cell block as (z, y, x) bits and its six tetrahedra around the diagonal 0-7.
TETRAHEDRA = np.array([[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]])
EDGES = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])


def closed_volume(snapshot):
    """Coordinates and total fraction, thinned out and closed by a layer of gas beyond the walls."""
    values = snapshot.total_fraction
    step = max(1, -(-max(values.shape) // MOST_CELLS))
    values = values[::step, ::step, ::step]
    coordinates = {}
    for number, axis in enumerate("zyx"):
        faces = snapshot.axes[axis]
        centres, values = flat.to_walls(snapshot.centres(axis)[::step], faces, values, number)
        margin = 1e-4 * (faces[-1] - faces[0])
        coordinates[axis] = np.concatenate([centres[:1] - margin, centres, centres[-1:] + margin])
    return coordinates, np.pad(values, 1)


def isosurface(coordinates, values, level=0.5):
    """Triangles [n, corner, (x, y, z)] of the surface values = level, by marching tetrahedra."""
    shape = np.array(values.shape) - 1
    inside = values >= level
    corner_bits = np.array([[(n >> 2) & 1, (n >> 1) & 1, n & 1] for n in range(8)])
    windows = [inside[b[0]:b[0] + shape[0], b[1]:b[1] + shape[1], b[2]:b[2] + shape[2]] for b in corner_bits]
    some = np.logical_or.reduce(windows) & ~np.logical_and.reduce(windows)
    blocks = np.argwhere(some)
    if len(blocks) == 0:
        return np.zeros((0, 3, 3))
    corners = blocks[:, None, :] + corner_bits[None]
    corner_values = values[tuple(np.moveaxis(corners, -1, 0))]
    points = np.stack([coordinates[axis][corners[..., "zyx".index(axis)]] for axis in "xyz"], axis=-1)

    tetra_values = corner_values[:, TETRAHEDRA].reshape(-1, 4)
    tetra_points = points[:, TETRAHEDRA].reshape(-1, 4, 3)
    low, high = tetra_values[:, EDGES[:, 0]], tetra_values[:, EDGES[:, 1]]
    crossed = (low >= level) != (high >= level)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(crossed, (level - low) / (high - low), 0)[..., None]
    cuts = tetra_points[:, EDGES[:, 0]] * (1 - share) + tetra_points[:, EDGES[:, 1]] * share

    triangles = []
    count = crossed.sum(axis=1)
    three = count == 3
    triangles.append(cuts[three][crossed[three]].reshape(-1, 3, 3))
    four = count == 4
    # The first and last of the four cut edges, in the order of EDGES, lie opposite each other.
    quads = cuts[four][crossed[four]].reshape(-1, 4, 3)
    triangles += [quads[:, [0, 1, 2]], quads[:, [1, 2, 3]]]
    return np.concatenate(triangles)


def interpolated(coordinates, values, points):
    """Trilinear values at points [n, (x, y, z)]; beyond the coordinates the outermost value."""
    result = 0.0
    low, share = [], []
    for axis in "zyx":
        at, grid = points[:, "xyz".index(axis)], coordinates[axis]
        index = np.clip(np.searchsorted(grid, at) - 1, 0, len(grid) - 2)
        low.append(index)
        share.append(np.clip((at - grid[index]) / (grid[index + 1] - grid[index]), 0, 1))
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod([s if bit else 1 - s for s, bit in zip(share, corner)], axis=0)
        result = result + weight * values[tuple(index + bit for index, bit in zip(low, corner))]
    return result


def normals(coordinates, values, triangles):
    """Unit normals of the triangles: the gradient of the fraction, or on the walls the triangle's own normal."""
    inner = {axis: coordinates[axis][1:-1] for axis in "zyx"}
    gradient = np.gradient(values[1:-1, 1:-1, 1:-1], *(inner[axis] for axis in "zyx"))
    middle = triangles.mean(axis=1)
    smooth = np.stack([interpolated(inner, gradient["zyx".index(axis)], middle) for axis in "xyz"], axis=-1)
    own = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    on_wall = np.any([(middle[:, n] < inner[axis][0]) | (middle[:, n] > inner[axis][-1])
                      for n, axis in enumerate("xyz")], axis=0)
    result = np.where((on_wall | (np.linalg.norm(smooth, axis=1) == 0))[:, None], own, smooth)
    return result / np.maximum(np.linalg.norm(result, axis=1), 1e-300)[:, None]


def projector():
    """Screen axes (right, up) and the direction towards the viewer."""
    azimuth, elevation = np.radians(VIEW)
    towards = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0])
    return right, np.cross(towards, right), towards


def box_edges(axes, snapshot, right, up, towards, front):
    """Draws the edges of the domain: those that meet at the far corner behind the liquid, the others before it."""
    bounds = np.array([snapshot.extent(axis) for axis in "xyz"])
    far = tuple(0 if component > 0 else 1 for component in towards)
    for d in range(3):
        others = [e for e in range(3) if e != d]
        for ends in np.ndindex(2, 2):
            at_back = all(ends[n] == far[e] for n, e in enumerate(others))
            in_front = all(ends[n] != far[e] for n, e in enumerate(others))
            if in_front != front:
                continue
            line = np.empty((2, 3))
            line[:, others] = [bounds[e][ends[n]] for n, e in enumerate(others)]
            line[:, d] = bounds[d]
            axes.plot(line @ right, line @ up, color=style.INK, linewidth=0.5 if at_back or in_front else 0.8,
                      alpha=0.35 if at_back or in_front else 0.8, zorder=1 if not front else 5)


def surface(axes, snapshot):
    """The surface of the liquid, shaded and tinted by species, in its box."""
    from matplotlib.collections import PolyCollection
    right, up, towards = projector()
    coordinates, values = closed_volume(snapshot)
    triangles = isosurface(coordinates, values)
    box_edges(axes, snapshot, right, up, towards, front=False)
    if len(triangles):
        middle = triangles.mean(axis=1)
        normal = normals(coordinates, values, triangles)
        # Seen from the viewer's side: what faces away lies behind something that faces here.
        normal *= np.where(normal @ towards < 0, -1.0, 1.0)[:, None]
        shade = 0.45 + 0.55 * np.clip(normal @ LIGHT, 0, 1) + 0.08 * np.clip(normal @ LIGHT, 0, 1) ** 12
        colour = np.clip(tint(snapshot, middle) * shade[:, None], 0, 1)
        order = np.argsort(middle @ towards)
        flat_triangles = np.stack([triangles @ right, triangles @ up], axis=-1)[order]
        axes.add_collection(PolyCollection(flat_triangles, facecolors=colour[order], edgecolors=colour[order],
                                           linewidths=0.25, zorder=2))
    box_edges(axes, snapshot, right, up, towards, front=True)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_axis_off()


def around(values):
    """Sum over each cell and its neighbours."""
    padded = np.pad(values, 1)
    return sum(padded[k:k + values.shape[0], j:j + values.shape[1], i:i + values.shape[2]] for k, j, i in np.ndindex(3, 3, 3))


def tint(snapshot, points):
    """Colour of the mixture at each point of the surface: of its cell where that is at least half full, else of the fuller
    cells around it, since what a cell with next to nothing holds says little."""
    cell = tuple(np.clip(np.searchsorted(snapshot.axes[axis], points[:, "xyz".index(axis)]) - 1, 0,
                         len(snapshot.axes[axis]) - 2) for axis in "zyx")
    full = snapshot.total_fraction >= 0.5
    neighbours = around(full.astype(float))[cell]
    mixed, total = np.zeros((len(points), 3)), np.zeros(len(points))
    for name, colour in zip(snapshot.species, style.species_colours(snapshot.species)):
        fraction = snapshot.fraction(name)
        amount = np.where(full[cell] | (neighbours == 0), fraction[cell], around(np.where(full, fraction, 0))[cell])
        mixed += amount[:, None] * colour
        total += amount
    return mixed / np.maximum(total, 1e-300)[:, None]


def height_to_width(snapshot):
    """Shape of the domain as the viewer sees it."""
    right, up, _ = projector()
    corners = np.array([[snapshot.extent(axis)[end] for axis, end in zip("xyz", ends)] for ends in np.ndindex(2, 2, 2)])
    return np.ptp(corners @ up) / np.ptp(corners @ right)


def single(pyplot, snapshot, path):
    """The surface beside two slices through the middle."""
    figure = pyplot.figure(figsize=(11, 6.2), dpi=130)
    surface(figure.add_axes([0.02, 0.04, 0.56, 0.86]), snapshot)
    for n, axis in enumerate("yx"):
        plane = snapshot.slice(axis, np.mean(snapshot.extent(axis)))
        axes = figure.add_axes([0.64, 0.565 - 0.475 * n, 0.33, 0.345])
        width, height = flat.size_of(plane)
        scale = min(0.33 * 11 / width, 0.345 * 6.2 / height)
        flat.frame(axes, plane, label_below=0.34 / scale)
        axes.set_title(f"slice {axis} = {np.mean(snapshot.extent(axis)):.3g}", pad=3, fontsize="small")
        axes.set_ylabel("z", rotation=0)
        axes.tick_params(labelsize="x-small")
    figure.text(0.03, 0.95, style.time_text(snapshot), fontsize=12, va="center")
    flat.legend(figure, snapshot)
    figure.savefig(path)
    pyplot.close(figure)


def overview(pyplot, snapshots, path):
    """A page of surfaces."""
    aspect = height_to_width(snapshots[0])
    columns = style.page_columns(len(snapshots), aspect)
    rows = -(-len(snapshots) // columns)
    figure, grid = pyplot.subplots(rows, columns, figsize=(12, 12 / columns * rows * aspect + 0.3 * rows + 0.4), dpi=130,
                                   squeeze=False, layout="constrained")
    for axes in grid.flat:
        axes.set_axis_off()
    for axes, snapshot in zip(grid.flat, snapshots):
        surface(axes, snapshot)
        axes.set_title(style.time_text(snapshot))
    figure.suptitle(snapshots[-1].title, fontweight="bold", fontsize=11)
    flat.legend(figure, snapshots[-1])
    figure.savefig(path)
    pyplot.close(figure)
