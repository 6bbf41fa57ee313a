"""Pictures of a gearbox from outside and in a cut through its shafts: temperature, heat flux, displacement."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rigdesign.base.quantity_kinds import ZERO_CELSIUS
from rigdesign.report.figures.drawing import finish, new_figure
from rigdesign.report.figures.mesh_views import (
    OutsideView,
    PlaneCut,
    cut_mesh,
    shaft_axis_height,
    view_outside,
)
from rigdesign.report.numbers import number_text
from rigdesign.report.palette import DISPLACEMENT_COLOURS, HEAT_FLUX_COLOURS, INK, MUTED, TEMPERATURE_COLOURS
from rigdesign.results.thermal import TemperatureField
from thermal.fe.mesh import FloatArray, NamedMesh

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap, Normalize
    from matplotlib.figure import Figure

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
