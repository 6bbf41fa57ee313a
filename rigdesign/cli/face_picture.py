"""A picture of a STEP part with its faces numbered: from outside, and of each half from inside."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rigdesign.report.palette import GRID, INK, SERIES, VERDICT_COLOURS
from thermal.housing.step_file import FaceNames, StepFace

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FloatArray = NDArray[np.float64]

CANDIDATES = 40
"""Triangles of a face at which its number is tried until one is seen."""
LEGEND_ROWS = 46
"""Lines of the list of faces in one column."""
UNNAMED = VERDICT_COLOURS["fail"]


@dataclass(frozen=True)
class _View:
    title: str
    towards: tuple[float, float, float]
    """From the part to the eye."""
    half: float
    """-1 or 1: only the half of lesser or greater y is drawn; 0: all."""


VIEWS = (
    _View("from the front, above", (-1.0, -0.9, 0.8), 0.0),
    _View("from the rear, below", (1.0, 0.9, -0.8), 0.0),
    _View("half of greater y, from inside", (-0.5, -1.0, 0.5), 1.0),
    _View("half of lesser y, from inside", (0.5, 1.0, 0.5), -1.0),
)


def draw_faces(
    file: Path, title: str, faces: tuple[StepFace, ...], names: FaceNames, triangles: Mapping[int, FloatArray]
) -> None:
    """Write a PNG of a part: every face with its number, in the colour of its surface, red without a name.

    triangles : face number -> (n, 3, 3) corners [m]. Raises OSError where the file cannot be written.
    """
    from matplotlib.figure import Figure

    surface = {number: name for name, numbers in names.surfaces.items() for number in numbers}
    order = {name: count for count, name in enumerate(names.surfaces)}
    colours = {
        face.number: SERIES[order[surface[face.number]] % len(SERIES)] if face.number in surface else UNNAMED
        for face in faces
    }
    columns = 1 + (len(faces) - 1) // LEGEND_ROWS
    figure = Figure(figsize=(13.0 + 3.2 * columns, 10.0), dpi=110, layout="constrained")
    grid = figure.add_gridspec(2, 2 + columns, width_ratios=[5.0, 5.0, *[2.4] * columns])
    seen: set[int] = set()
    for place, view in enumerate(VIEWS):
        seen |= _draw_view(figure.add_subplot(grid[divmod(place, 2)]), view, triangles, colours)
    for column in range(columns):
        axes = figure.add_subplot(grid[:, 2 + column])
        axes.axis("off")
        for row, face in enumerate(faces[column * LEGEND_ROWS : (column + 1) * LEGEND_ROWS]):
            hidden = "" if face.number in seen else "  (hidden)"
            text = f"{face.number}  {surface.get(face.number, _unnamed(face, names))}{hidden}"
            axes.text(
                0.0, 1.0 - (row + 1) / (LEGEND_ROWS + 1), text, color=colours[face.number], fontsize=8.5,
                transform=axes.transAxes,
            )  # fmt: skip
    figure.suptitle(title, color=INK)
    figure.savefig(file)


def _unnamed(face: StepFace, names: FaceNames) -> str:
    return "no name" if any(one.number == face.number for one in names.unnamed) else "two names"


def _draw_view(
    axes: "Axes", view: _View, triangles: Mapping[int, FloatArray], colours: Mapping[int, str]
) -> set[int]:
    """Draw one view; the faces whose number is in it."""
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import to_rgb

    eye = np.asarray(view.towards) / np.linalg.norm(view.towards)
    right = np.cross((0.0, 0.0, 1.0), eye)
    right /= np.linalg.norm(right)
    up = np.cross(eye, right)
    everything = np.concatenate(list(triangles.values()))
    middle = 0.5 * (everything[..., 1].min() + everything[..., 1].max())
    drawn = {
        number: corners[view.half * (corners[..., 1].mean(axis=1) - middle) >= 0.0]
        for number, corners in triangles.items()
    }
    shown = np.concatenate(list(drawn.values()))
    tint = np.concatenate([np.tile(to_rgb(colours[n]), (len(own), 1)) for n, own in drawn.items()])
    normal = np.cross(shown[:, 1] - shown[:, 0], shown[:, 2] - shown[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-30)[:, None]
    bright = (0.35 + 0.65 * np.abs(normal @ eye))[:, None]
    flat = np.stack([shown @ right, shown @ up], axis=-1)
    back = np.argsort((shown @ eye).mean(axis=1))
    strong = np.concatenate(
        [np.full(len(own), 0.9 if colours[n] == UNNAMED else 0.45) for n, own in drawn.items()]
    )
    painted = (1.0 - (1.0 - tint) * strong[:, None]) * (0.55 + 0.45 * bright)
    axes.add_collection(
        PolyCollection(list(flat[back]), facecolors=painted[back], edgecolors=painted[back], linewidths=0.3)
    )
    places = {number: _seen(own, shown, eye) for number, own in drawn.items()}
    for number, place in places.items():
        if place is not None:
            axes.text(
                float(place @ right), float(place @ up), str(number), color=colours[number], fontsize=9,
                ha="center", va="center",
                bbox={"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": GRID, "alpha": 0.9},
            )  # fmt: skip
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.set_title(view.title, fontsize=10, color=INK)
    axes.axis("off")
    return {number for number, place in places.items() if place is not None}


def _seen(own: FloatArray, shown: FloatArray, eye: FloatArray) -> FloatArray | None:
    """A point of a face that nothing hides: of the triangles near its middle, the first one in sight."""
    if not len(own):
        return None
    centres = own.mean(axis=1)
    nearest = np.argsort(np.linalg.norm(centres - centres.mean(axis=0), axis=1))
    step = max(1, len(nearest) // CANDIDATES)
    size = float(np.ptp(shown.reshape(-1, 3), axis=0).max())
    for candidate in nearest[::step]:
        if not _hidden(centres[candidate] + 1e-4 * size * eye, eye, shown):
            return np.asarray(centres[candidate])
    return None


def _hidden(point: FloatArray, eye: FloatArray, shown: FloatArray) -> bool:
    """Whether a triangle lies between a point and the eye.

    Source: Moeller and Trumbore, J. Graphics Tools 2 (1997) 21.
    """
    first, second = shown[:, 1] - shown[:, 0], shown[:, 2] - shown[:, 0]
    across = np.cross(eye, second)
    determinant = np.einsum("ij,ij->i", first, across)
    safe = np.where(np.abs(determinant) > 1e-18, determinant, np.inf)
    away = point - shown[:, 0]
    u = np.einsum("ij,ij->i", away, across) / safe
    turned = np.cross(away, first)
    v = turned @ eye / safe
    depth = np.einsum("ij,ij->i", second, turned) / safe
    return bool(np.any((u > 0.0) & (v > 0.0) & (u + v < 1.0) & (depth > 0.0)))
