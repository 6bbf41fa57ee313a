"""Pictures of a temperature field: the housing from outside and a cut through the shafts."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rigdesign.report.drawing import INK, finish, new_figure
from rigdesign.report.fields import ZERO_CELSIUS
from rigdesign.report.mesh_views import cut_mesh, shaft_axis_height, view_outside
from rigdesign.results import TemperatureField
from thermal.fe.mesh import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap, Normalize
    from matplotlib.figure import Figure

COLOUR_RANGE = (0.07, 0.96)
"""Part of matplotlib's turbo map in use: its ends are too dark to tell apart under shading."""
LEVELS = 15
MM = 1000.0


def temperature_figure(field: TemperatureField) -> "Figure":
    """Surface temperature seen from outside beside the temperature in the plane of the shaft axes [degC]."""
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize
    from matplotlib.ticker import MaxNLocator

    temperature = field.temperature - ZERO_CELSIUS
    levels = np.asarray(MaxNLocator(LEVELS).tick_values(temperature.min(), temperature.max()))
    norm = Normalize(levels[0], levels[-1])
    colours = ListedColormap(colormaps["turbo"](np.linspace(*COLOUR_RANGE, 256)))
    figure = new_figure(3.8)
    outside = figure.add_axes((0.005, 0.03, 0.44, 0.89))
    cut = figure.add_axes((0.52, 0.13, 0.385, 0.79))
    _outside(outside, field, temperature, norm, colours)
    _cut(cut, field, temperature, levels, norm, colours)
    bar = figure.colorbar(ScalarMappable(norm, colours), cax=figure.add_axes((0.925, 0.13, 0.014, 0.79)))
    bar.set_label("temperature, steady [°C]")
    bar.ax.grid(visible=False)
    return figure


def _outside(
    axes: "Axes", field: TemperatureField, temperature: FloatArray, norm: "Normalize", colour_map: "Colormap"
) -> None:
    """Facets from far to near, shaded by their angle to the light; a picture, not lines, to keep it small."""
    from matplotlib.collections import TriMesh
    from matplotlib.tri import Triangulation

    view = view_outside(field.mesh)
    colours = colour_map(norm(temperature[view.nodes]))
    colours[..., :3] *= view.brightness[:, None, None]
    corners = view.corners.reshape(-1, 2)
    triangles = np.arange(len(corners)).reshape(-1, 3)
    collection: Any = TriMesh(Triangulation(corners[:, 0], corners[:, 1], triangles))
    collection.set_facecolor(colours.reshape(-1, 4))
    collection.set_rasterized(True)
    axes.add_collection(collection)
    axes.set_aspect("equal")
    low, high = corners.min(axis=0), corners.max(axis=0)
    pad = 0.02 * float((high - low).max())
    axes.set_xlim(low[0] - pad, high[0] + pad)
    axes.set_ylim(low[1] - pad, high[1] + pad)
    axes.set_axis_off()
    axes.set_title("Surfaces from outside")


def _cut(
    axes: "Axes",
    field: TemperatureField,
    temperature: FloatArray,
    levels: FloatArray,
    norm: "Normalize",
    colour_map: "Colormap",
) -> None:
    from matplotlib.collections import LineCollection
    from matplotlib.tri import Triangulation

    height = shaft_axis_height(field.mesh)
    cut = cut_mesh(field.mesh, 2, height)
    points = cut.points[:, :2] * MM
    triangulation = Triangulation(points[:, 0], points[:, 1], cut.triangles)
    axes.tricontourf(
        triangulation,
        cut.interpolate(temperature),
        levels=levels,
        norm=norm,
        cmap=colour_map,
        rasterized=True,
    )
    axes.add_collection(
        LineCollection(list(points[cut.outlines()]), colors=INK, linewidths=0.5, rasterized=True)
    )
    axes.set_aspect("equal")
    axes.use_sticky_edges = False
    axes.margins(0.03)
    axes.autoscale_view()
    axes.grid(visible=False)
    finish(
        axes,
        "x along the shafts [mm]",
        "y across [mm]",
        f"Cut at z = {MM * height:.0f} mm, plane of the shaft axes",
    )
