"""Pictures of a gearbox from outside and in a cut through its shafts: temperature, heat flux, displacement."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.report.figures.drawing import finish, new_figure
from rigdesign.report.numbers import number_text
from rigdesign.report.palette import DISPLACEMENT_COLOURS, HEAT_FLUX_COLOURS, INK, MUTED, TEMPERATURE_COLOURS
from rigdesign.results.thermal import TemperatureField
from thermal.fe.mesh import FloatArray, NamedMesh

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap, Normalize
    from matplotlib.figure import Figure

# Geometry of pictures: what is seen of a mesh from outside and in a plane cut. No drawing.

Indices = NDArray[np.int64]

SUB_TETRAHEDRA = np.array(
    [
        (0, 4, 6, 7),
        (1, 5, 4, 8),
        (2, 6, 5, 9),
        (3, 7, 8, 9),
        (4, 9, 5, 6),
        (4, 9, 6, 7),
        (4, 9, 7, 8),
        (4, 9, 8, 5),
    ]
)
"""Eight linear tetrahedra that fill a 10-node one (VTK order), the inner octahedron split along 01-23."""

HEX_TETRAHEDRA = np.array(
    [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
)
"""Six tetrahedra round a diagonal that fill a hexahedron, from its corners alone."""

EDGE_ON = 1e-9
"""Cosine to the viewer below which a facet is only a line."""

SUB_TRIANGLES = np.array([(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)])
"""Four linear triangles that fill a 6-node one (corners first, mid-sides 01 12 20)."""

SUB_QUADRILATERAL = np.array([(0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 6), (4, 6, 7)])
"""Six linear triangles that fill a quadrilateral of 8 or 9 nodes (corners first, then mid-sides)."""

FINE = 40_000
"""Facets from which their corners alone are drawn: smaller than what a picture resolves."""


@dataclass(frozen=True)
class PlaneCut:
    """Triangles of a plane through a mesh; every point lies on an edge between two nodes.

    points : (m, 3) coordinates [m]
    triangles : (k, 3) indices into ``points``
    bodies : (k,) number of the body, in the order of ``mesh.bodies``
    nodes : (m, 2) mesh nodes at the ends of the edge
    weights : (m,) position on the edge, 0 at the first node
    """

    points: FloatArray
    triangles: Indices
    bodies: Indices
    nodes: Indices
    weights: FloatArray

    def interpolate(self, values: FloatArray) -> FloatArray:
        """Nodal values, shape (n_nodes,), at the points of the cut, shape (m,)."""
        start, end = values[self.nodes[:, 0]], values[self.nodes[:, 1]]
        return np.asarray(start + self.weights * (end - start))

    def outlines(self, shown: NDArray[np.bool_] | slice = slice(None)) -> Indices:
        """(e, 2) point pairs of the edges where a body ends; shown : (k,) which triangles count, all if left out."""
        triangles, bodies = self.triangles[shown], self.bodies[shown]
        sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        size = len(self.points)
        pairs = np.sort(sides, axis=1) @ np.array([size, 1]) + size**2 * np.tile(bodies, 3)
        found, counts = np.unique(pairs, return_counts=True)
        first, second = np.divmod(found[counts == 1] % size**2, size)
        return np.column_stack([first, second])


def cut_mesh(mesh: NamedMesh, axis: int, position: float) -> PlaneCut:
    """Cut a mesh by the plane where coordinate ``axis`` (0, 1, 2) equals ``position`` [m].

    A node in the plane counts as beyond it, so no cell is met twice.
    """
    distance = mesh.points[:, axis] - position
    beyond = distance >= 0
    sides = beyond[mesh.cells]
    met = np.flatnonzero(sides.any(axis=1) & ~sides.all(axis=1))
    body_of_cell = np.zeros(len(mesh.cells), dtype=np.int64)
    for number, cells in enumerate(mesh.bodies.values()):
        body_of_cell[cells] = number
    parts = SUB_TETRAHEDRA if mesh.cells.shape[1] == 10 else HEX_TETRAHEDRA
    tetrahedra = mesh.cells[met][:, parts].reshape(-1, 4).astype(np.int64)
    bodies = np.repeat(body_of_cell[met], len(parts))
    edges, owners = _crossed_edges(tetrahedra, bodies, beyond)
    ends = np.sort(edges.reshape(-1, 2), axis=1)
    pairs, inverse = np.unique(ends @ np.array([len(mesh.points), 1]), return_inverse=True)
    nodes = np.column_stack(np.divmod(pairs, len(mesh.points)))
    first, second = distance[nodes[:, 0]], distance[nodes[:, 1]]
    weights = first / (first - second)
    points = mesh.points[nodes[:, 0]] + weights[:, None] * (
        mesh.points[nodes[:, 1]] - mesh.points[nodes[:, 0]]
    )
    return PlaneCut(points, inverse.reshape(-1, 3), owners, nodes, weights)


def _crossed_edges(
    tetrahedra: Indices, bodies: Indices, beyond: NDArray[np.bool_]
) -> tuple[Indices, Indices]:
    """(k, 3, 2) node pairs of the triangle corners in the plane, and the body of each triangle."""
    order = np.argsort(~beyond[tetrahedra], axis=1, kind="stable")
    nodes = np.take_along_axis(tetrahedra, order, axis=1)
    count = beyond[tetrahedra].sum(axis=1)
    triangles, owners = [], []
    for beyond_count, patterns in {
        1: [[(0, 1), (0, 2), (0, 3)]],
        2: [[(0, 2), (0, 3), (1, 3)], [(0, 2), (1, 3), (1, 2)]],
        3: [[(3, 0), (3, 1), (3, 2)]],
    }.items():
        chosen = np.flatnonzero(count == beyond_count)
        for pattern in patterns:
            triangles.append(nodes[chosen][:, np.array(pattern)])
            owners.append(bodies[chosen])
    return np.concatenate(triangles), np.concatenate(owners)


@dataclass(frozen=True)
class OutsideView:
    """Facets that face the viewer, farthest first, in the picture plane.

    corners : (k, 3, 2) picture coordinates [m]
    nodes : (k, 3) mesh nodes of the corners
    brightness : (k,) 0 to 1 from the angle to the light
    focus : (2, 2) lowest and highest picture coordinates of everything but the field [m]
    """

    corners: FloatArray
    nodes: Indices
    brightness: FloatArray
    focus: FloatArray


def view_outside(
    mesh: NamedMesh,
    azimuth_deg: float = -60.0,
    elevation_deg: float = 28.0,
    points: FloatArray | None = None,
) -> OutsideView:
    """Parallel projection of the named surfaces, x along the shafts, z up.

    azimuth_deg, elevation_deg : direction from which the viewer looks, azimuth from the x axis about z
    points : (n_nodes, 3) places of the nodes [m], those of the mesh when left out
    """
    places = mesh.points if points is None else points
    right, up, towards = camera(np.radians(azimuth_deg), np.radians(elevation_deg))
    facets = surface_triangles(mesh)
    corners = places[facets]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    normals /= np.where(lengths > 0, lengths, 1.0)[:, None]
    facing = np.flatnonzero(normals @ towards > EDGE_ON)
    facing = facing[np.argsort(corners[facing].mean(axis=1) @ towards, kind="stable")]
    light = towards + 0.6 * up - 0.4 * right
    brightness = 0.7 + 0.3 * np.clip(normals[facing] @ (light / np.linalg.norm(light)), 0.0, 1.0)
    plane = np.column_stack([right, up])
    standing = _standing_nodes(mesh)
    seen = places[standing] @ plane
    focus = np.array([seen.min(axis=0), seen.max(axis=0)])
    return OutsideView(corners[facing] @ plane, facets[facing], brightness, focus)


def surface_triangles(mesh: NamedMesh) -> Indices:
    """(k, 3) nodes of linear triangles that cover all named surfaces."""
    facets = np.concatenate(list(mesh.surfaces.values()))
    if facets.shape[1] == 6:
        parts = SUB_TRIANGLES if len(facets) < FINE else np.array([(0, 1, 2)])
    else:
        parts = SUB_QUADRILATERAL if len(facets) < FINE else np.array([(0, 1, 2), (0, 2, 3)])
    return np.asarray(facets[:, parts].reshape(-1, 3), dtype=np.int64)


def _standing_nodes(mesh: NamedMesh) -> Indices:
    """Nodes of all bodies but the field under them; of all where there is nothing else."""
    bodies = list(mesh.bodies.values())
    held = np.zeros(len(mesh.points), dtype=bool)
    held[mesh.cells[np.concatenate([bodies[number] for number in standing_bodies(mesh)])]] = True
    return np.flatnonzero(held).astype(np.int64)


def standing_bodies(mesh: NamedMesh) -> Indices:
    """Numbers of all bodies but the clamping field, which is several times as large as what stands on it."""
    names = list(mesh.bodies)
    standing = [number for number, name in enumerate(names) if "field" not in name and len(mesh.bodies[name])]
    return np.array(standing or range(len(names)), dtype=np.int64)


def camera(azimuth: float, elevation: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Unit vectors to the right, up, and towards the viewer."""
    towards = np.array(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    )
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    return right, np.cross(towards, right), towards


def shaft_axis_height(mesh: NamedMesh) -> float:
    """Height z [m] of a horizontal cut that shows the most: through the shafts, else through the middle."""
    shafts = [cells for name, cells in mesh.bodies.items() if "shaft" in name.lower() and len(cells)]
    heights = mesh.points[mesh.cells[np.concatenate(shafts)], 2] if shafts else mesh.points[:, 2]
    return float(heights.min() + heights.max()) / 2


LEVELS = 15
MM, UM, KW = 1e3, 1e6, 1e-3
DRAWN = 0.06
"""Largest displacement in a picture as a share of the gearbox's size."""
DECADES = 3.0
"""Of heat flux that the colours resolve; what is less has the lowest colour."""
ROOM = 0.12
"""Of the clamping field round the gearbox in the outer view, as a share of its size."""


@dataclass(frozen=True)
class MeshViews:
    """What is seen of a mesh, found once for all its fields."""

    mesh: NamedMesh

    @cached_property
    def outside(self) -> OutsideView:
        """From outside, as drawn."""
        return view_outside(self.mesh)

    @cached_property
    def height(self) -> float:
        """Of the cut [m]."""
        return shaft_axis_height(self.mesh)

    @cached_property
    def cut(self) -> PlaneCut:
        """Plane of the shaft axes."""
        return cut_mesh(self.mesh, 2, self.height)

    @cached_property
    def outlines(self) -> FloatArray:
        """(e, 2, 2) borders of the bodies in the cut, x and y [mm]."""
        return np.asarray(MM * self.cut.points[self.cut.outlines(), :2])

    @cached_property
    def size(self) -> float:
        """Largest measure of everything but the field in the outer view [m]."""
        return float(np.ptp(self.outside.focus, axis=0).max())


@dataclass(frozen=True)
class Shade:
    """Values and their colours: values (n_nodes,), levels of the cut, label of the colour bar."""

    values: FloatArray
    levels: FloatArray
    norm: "Normalize"
    colours: "Colormap"
    label: str


@dataclass(frozen=True)
class Picture:
    """A figure with what it shows and its caption."""

    title: str
    figure: "Figure"
    caption: str


def field_pictures(field: TemperatureField, views: MeshViews) -> Iterator[Picture]:
    """Temperature, heat flux and displacement of a gearbox at a stage; what it has not is left out."""
    yield Picture(
        "Temperature",
        _figure(views, _temperature(field)),
        "Steady temperature. Left: seen from outside, the clamping field cut off. Right: plane of the shaft axes, "
        "bodies outlined.",
    )
    if field.heat_flux is not None and np.abs(field.heat_flux).max() > 0.0:
        yield Picture(
            "Heat flux",
            _figure(views, _heat_flux(field.heat_flux)),
            "Size of the heat flux in the solids, logarithmic; at a node the mean of the adjacent elements.",
        )
    if np.abs(field.displacement).max() > 0.0:
        factor = magnification(field, views)
        yield Picture(
            "Displacement",
            _figure(views, _displacement(field), factor * field.displacement, factor),
            f"Thermal displacement relative to the mean of the foot, shafts placed in their bearings, drawn "
            f"{number_text(factor)} times as large. Grey in the cut: the outlines as drawn.",
        )


def magnification(field: TemperatureField, views: MeshViews) -> float:
    """Factor 1, 2 or 5 times a power of ten at which the largest displacement is well seen."""
    wanted = DRAWN * views.size / float(np.linalg.norm(field.displacement, axis=1).max())
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(power * max(step for step in (1.0, 2.0, 5.0) if step * power <= wanted * (1.0 + 1e-9)))


def _temperature(field: TemperatureField) -> Shade:
    from matplotlib import colormaps

    colours = colormaps[TEMPERATURE_COLOURS]
    return _linear(field.temperature - ZERO_CELSIUS, colours, "temperature, steady [°C]")


def _displacement(field: TemperatureField) -> Shade:
    from matplotlib import colormaps

    return _linear(
        UM * np.linalg.norm(field.displacement, axis=1),
        colormaps[DISPLACEMENT_COLOURS],
        "displacement, size [µm]",
    )


def _linear(values: FloatArray, colours: "Colormap", label: str) -> Shade:
    from matplotlib.colors import Normalize
    from matplotlib.ticker import MaxNLocator

    levels = np.asarray(MaxNLocator(LEVELS).tick_values(values.min(), values.max()))
    return Shade(values, levels, Normalize(levels[0], levels[-1]), colours, label)


def _heat_flux(flux: FloatArray) -> Shade:
    """Decimal logarithm of the size in kW/m2, the upper end at its 99.9th per cent."""
    from matplotlib import colormaps
    from matplotlib.colors import Normalize

    size = KW * np.linalg.norm(flux, axis=1)
    top = float(np.log10(np.quantile(size, 0.999)))
    low = top - DECADES
    values = np.log10(np.clip(size, 10.0**low, 10.0**top))
    levels = np.linspace(low, top, 2 * LEVELS)
    return Shade(values, levels, Normalize(low, top), colormaps[HEAT_FLUX_COLOURS], "heat flux, size [kW/m²]")


def _figure(views: MeshViews, shade: Shade, moved: FloatArray | None = None, factor: float = 0.0) -> "Figure":
    """The outer view next to the cut; moved : (n_nodes, 3) displacement as drawn [m]."""
    from matplotlib.cm import ScalarMappable

    figure = new_figure(3.8)
    outside = figure.add_axes((0.01, 0.05, 0.43, 0.86))
    cut = figure.add_axes((0.52, 0.13, 0.385, 0.79))
    _outside(outside, views, shade, moved)
    _cut(cut, views, shade, moved)
    if moved is not None:
        outside.set_title(f"Surfaces from outside, displacement × {number_text(factor)}")
    bar = figure.colorbar(
        ScalarMappable(shade.norm, shade.colours), cax=figure.add_axes((0.925, 0.13, 0.014, 0.79))
    )
    bar.set_label(shade.label)
    bar.ax.grid(visible=False)
    if shade.label.startswith("heat flux"):
        ticks = _decade_ticks(shade.levels[0], shade.levels[-1])
        bar.set_ticks([np.log10(tick) for tick in ticks], labels=[number_text(tick, 1) for tick in ticks])
    return figure


def _decade_ticks(low: float, high: float) -> list[float]:
    """1, 2 and 5 times powers of ten between two logarithms."""
    powers = range(int(np.floor(low)), int(np.ceil(high)) + 1)
    ticks = [step * 10.0**power for power in powers for step in (1.0, 2.0, 5.0)]
    return [tick for tick in ticks if low <= np.log10(tick) <= high]


def _outside(axes: "Axes", views: MeshViews, shade: Shade, moved: FloatArray | None) -> None:
    """Facets from far to near, shaded by their angle to the light; a picture, not lines, to keep it small."""
    from matplotlib.collections import TriMesh
    from matplotlib.tri import Triangulation

    view = views.outside if moved is None else view_outside(views.mesh, points=views.mesh.points + moved)
    colours = shade.colours(shade.norm(shade.values[view.nodes]))
    colours[..., :3] *= view.brightness[:, None, None]
    corners = view.corners.reshape(-1, 2)
    triangles = np.arange(len(corners)).reshape(-1, 3)
    collection: Any = TriMesh(Triangulation(corners[:, 0], corners[:, 1], triangles))
    collection.set_facecolor(colours.reshape(-1, 4))
    collection.set_rasterized(True)
    axes.add_collection(collection, autolim=False)
    axes.set_aspect("equal")
    low, high = views.outside.focus
    low, high = low - ROOM * views.size, high + ROOM * views.size
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_axis_off()
    axes.set_title("Surfaces from outside")


def _cut(axes: "Axes", views: MeshViews, shade: Shade, moved: FloatArray | None) -> None:
    from matplotlib.tri import Triangulation

    cut = views.cut
    points, outlines = MM * cut.points[:, :2], views.outlines
    low, high = points.min(axis=0), points.max(axis=0)
    if moved is not None:
        _outlined(axes, outlines, MUTED)
        points = points + MM * np.column_stack([cut.interpolate(moved[:, axis]) for axis in (0, 1)])
        outlines = points[cut.outlines()]
        low, high = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
    axes.tricontourf(
        Triangulation(points[:, 0], points[:, 1], cut.triangles),
        cut.interpolate(shade.values),
        levels=shade.levels,
        norm=shade.norm,
        cmap=shade.colours,
        rasterized=True,
    )
    _outlined(axes, outlines, INK)
    axes.set_aspect("equal")
    pad = 0.03 * float((high - low).max())
    axes.set_xlim(low[0] - pad, high[0] + pad)
    axes.set_ylim(low[1] - pad, high[1] + pad)
    axes.grid(visible=False)
    finish(
        axes,
        "x along the shafts [mm]",
        "y across [mm]",
        f"Cut at z = {MM * views.height:.0f} mm, plane of the shaft axes",
    )


def _outlined(axes: "Axes", sides: FloatArray, colour: str) -> None:
    """Straight pieces (e, 2, 2) as one broken line: thousands of separate ones take a second."""
    broken = np.concatenate([sides, np.full((len(sides), 1, 2), np.nan)], axis=1).reshape(-1, 2)
    axes.plot(
        broken[:, 0],
        broken[:, 1],
        color=colour,
        linewidth=0.5,
        rasterized=True,
        snap=False,
        solid_capstyle="butt",
    )
