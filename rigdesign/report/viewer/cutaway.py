"""The still picture of the turnable one: a gearbox opened in the plane of its shafts, seen from above."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.report.figures.drawing import new_figure
from rigdesign.report.figures.field import (
    Indices,
    Picture,
    camera,
    cut_mesh,
    shaft_axis_height,
    standing_bodies,
)
from rigdesign.report.palette import INK, TEMPERATURE_COLOURS
from rigdesign.report.viewer.solid import SolidPicture, triangle_normals
from rigdesign.results.thermal import TemperatureField
from thermal.fe.mesh import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AZIMUTH, ELEVATION = -60.0, 40.0
"""Direction from which the picture is taken [deg]."""
MM = 1e3


def cutaway_picture(field: TemperatureField, solid: SolidPicture) -> Picture:
    """Temperature on the skin below the plane of the shafts and in the cut, without the clamping field.

    solid : of the mesh of ``field``
    """
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    height = shaft_axis_height(field.mesh)
    values = field.temperature - ZERO_CELSIUS
    corners, shade, bright = _below(field, solid, height)
    cut = cut_mesh(field.mesh, 2, height)
    standing = np.isin(cut.bodies, standing_bodies(field.mesh))
    face, edges = cut.points[cut.triangles[standing]], cut.points[cut.outlines(standing)]
    corners = np.concatenate([corners, face])
    shade = np.concatenate([shade, cut.interpolate(values)[cut.triangles[standing]]])
    bright = np.concatenate([bright, np.ones(len(face))])
    norm = Normalize(float(values.min()), float(values.max()))
    colours = colormaps[TEMPERATURE_COLOURS]
    figure = new_figure(4.6)
    axes = figure.add_axes((0.08, 0.02, 0.74, 0.96))
    painted = np.asarray(colours(norm(shade)))
    painted[..., :3] *= bright[:, None, None]
    _paint(axes, corners, painted, edges)
    bar = figure.colorbar(ScalarMappable(norm, colours), cax=figure.add_axes((0.84, 0.12, 0.014, 0.76)))
    bar.set_label("temperature, steady [°C]")
    bar.ax.grid(visible=False)
    stage = field.stage.replace("_", " ")
    caption = (
        f"Gearbox {field.gearbox}, stage {stage}, opened at z = {MM * height:.0f} mm, the plane of "
        "the shaft axes, and seen from above; shape as drawn, clamping field left out."
    )
    return Picture("Temperature, opened", figure, caption)


def _below(
    field: TemperatureField, solid: SolidPicture, height: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Skin below the plane: corners (k, 3, 3) [m], values at them (k, 3), brightness (k,)."""
    values = field.temperature - ZERO_CELSIUS
    standing = np.isin(solid.triangle_body, standing_bodies(field.mesh))
    triangles = solid.nodes[solid.triangles[standing]]
    corners, shade = clipped(field.mesh.points[triangles], values[triangles], height)
    normals = triangle_normals(corners)
    right, up, towards = camera(np.radians(AZIMUTH), np.radians(ELEVATION))
    facing = np.flatnonzero(normals @ towards > 0.0)
    light = towards + 0.6 * up - 0.4 * right
    bright = 0.62 + 0.38 * np.clip(normals[facing] @ (light / np.linalg.norm(light)), 0.0, 1.0)
    return corners[facing], shade[facing], bright


def clipped(corners: FloatArray, values: FloatArray, height: float) -> tuple[FloatArray, FloatArray]:
    """What lies below z = height of triangles: corners (k, 3, 3), values (k, 3), both of any length k.

    A triangle that the plane meets leaves one or two.
    """
    whole = np.concatenate([corners, values[..., None]], axis=2)
    above = corners[..., 2] >= height
    count = above.sum(axis=1)
    parts = [whole[count == 0]]
    met = np.flatnonzero((count == 1) | (count == 2))
    alone = np.where(count[met, None] == 1, above[met], ~above[met]).argmax(axis=1)
    turned = np.take_along_axis(
        whole[met], ((alone[:, None] + np.arange(3)) % 3)[..., None], axis=1
    )  # the corner that is alone on its side stands first
    tip, left, right = turned[:, 0], turned[:, 1], turned[:, 2]
    to_left, to_right = (_in_plane(tip, other, height) for other in (left, right))
    lone = count[met] == 2
    parts.append(np.stack([tip, to_left, to_right], axis=1)[lone])
    parts.append(np.stack([to_left, left, right], axis=1)[~lone])
    parts.append(np.stack([to_left, right, to_right], axis=1)[~lone])
    found = np.concatenate(parts)
    return found[..., :3], found[..., 3]


def _in_plane(first: FloatArray, second: FloatArray, height: float) -> FloatArray:
    """Points (k, 4) on the edges between two ends where z = height."""
    share = (height - first[:, 2]) / (second[:, 2] - first[:, 2])
    return np.asarray(first + share[:, None] * (second - first))


def _paint(axes: "Axes", corners: FloatArray, colours: FloatArray, edges: FloatArray) -> None:
    """Triangles from far to near, then the outlines of the cut, which nothing hides from above."""
    from matplotlib.collections import LineCollection, TriMesh
    from matplotlib.tri import Triangulation

    right, up, towards = camera(np.radians(AZIMUTH), np.radians(ELEVATION))
    plane = np.column_stack([right, up])
    order = np.argsort(corners.mean(axis=1) @ towards, kind="stable")
    places = (corners[order] @ plane).reshape(-1, 2)
    triangles: Indices = np.arange(len(places)).reshape(-1, 3)
    mesh: Any = TriMesh(Triangulation(places[:, 0], places[:, 1], triangles))
    mesh.set_facecolor(colours[order].reshape(-1, 4))
    mesh.set_rasterized(True)
    axes.add_collection(mesh, autolim=False)
    lines = LineCollection(list(edges @ plane), colors=INK, linewidths=0.5, rasterized=True)
    axes.add_collection(lines, autolim=False)
    low, high = places.min(axis=0), places.max(axis=0)
    pad = 0.01 * float((high - low).max())
    axes.set_aspect("equal")
    axes.set_xlim(low[0] - pad, high[0] + pad)
    axes.set_ylim(low[1] - pad, high[1] + pad)
    axes.set_axis_off()
