"""The data of the turnable picture: quantised numbers in one compressed block and a table of contents."""

import gzip
from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rigdesign.base.quantity_kinds import ZERO_CELSIUS
from rigdesign.report.figures.field import MeshViews, magnification
from rigdesign.report.figures.mesh_views import standing_bodies
from rigdesign.report.palette import DISPLACEMENT_COLOURS, TEMPERATURE_COLOURS
from rigdesign.report.viewer.simplify import simplified
from rigdesign.report.viewer.solid import Indices, SolidPicture, shaded_vertices
from rigdesign.results.thermal import TemperatureField
from thermal.fe.mesh import FloatArray

MOST = 65535
"""Of a 16-bit number."""
PLACE_STEPS, VALUE_STEPS = 65535, 8191
"""Between the ends of a quantity: 0.8 m in steps of 12 µm, 150 K of 0.02 K, 350 µm of 0.04 µm."""
MM, UM = 1e3, 1e6


@dataclass
class _Block:
    """Arrays one after the other, each on a multiple of four bytes."""

    data: bytearray = field(default_factory=bytearray)

    def add(self, values: np.ndarray) -> dict[str, Any]:
        """Append an array of unsigned 16- or 32-bit numbers; its place in the block."""
        start = len(self.data)
        self.data += np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<")).tobytes()
        self.data += bytes(-len(self.data) % 4)
        return {"start": start, "count": int(values.size), "bytes": values.dtype.itemsize}

    def indices(self, values: np.ndarray) -> dict[str, Any]:
        """Whole numbers from 0, in two bytes where they fit."""
        small = int(values.max(initial=0)) <= MOST
        return self.add(values.astype(np.uint16 if small else np.uint32))

    def numbers(self, values: FloatArray, steps: int = VALUE_STEPS) -> dict[str, Any]:
        """Numbers rounded to ``steps`` equal parts of what lies between their ends."""
        low, high = float(values.min()), float(values.max())
        step = (high - low) / steps or 1.0
        return {**self.add(np.rint((values - low) / step).astype(np.uint16)), "low": low, "step": step}


def viewer_scene(fields: Sequence[TemperatureField], solids: Mapping[int, SolidPicture]) -> dict[str, Any]:
    """Everything the script of the picture needs, ready for JSON; lengths in mm, temperatures in degC.

    solids : of every mesh, by its identity
    ``meshes`` (points, tetrahedra, skin), ``fields`` (mesh, gearbox, stage, temperature, displacement in um, factor of
    the drawn displacement), ``first`` (number of the field shown first), ``ranges`` and ``colours`` of both quantities,
    ``block``: the arrays, gzip in base64.
    """
    block = _Block()
    pictures: dict[int, _MeshPicture] = {}
    meshes: list[dict[str, Any]] = []
    shown: list[dict[str, Any]] = []
    for item in fields:
        if id(item.mesh) not in pictures:
            picture = _mesh_picture(item, solids[id(item.mesh)], len(meshes))
            pictures[id(item.mesh)] = picture
            meshes.append(_mesh_entry(block, picture))
        shown.append(_field_entry(block, item, pictures[id(item.mesh)]))
    return {
        "meshes": meshes,
        "fields": shown,
        "first": hottest(fields),
        "ranges": {
            "temperature": [
                min(float(item.temperature.min()) for item in fields) - ZERO_CELSIUS,
                max(float(item.temperature.max()) for item in fields) - ZERO_CELSIUS,
            ],
            "displacement": [0.0, UM * max(_largest(item) for item in fields)],
        },
        "colours": {
            "temperature": _colour_scale(TEMPERATURE_COLOURS),
            "displacement": _colour_scale(DISPLACEMENT_COLOURS),
        },
        "block": b64encode(gzip.compress(bytes(block.data), 6, mtime=0)).decode("ascii"),
    }


def hottest(fields: Sequence[TemperatureField]) -> int:
    """Number of the field with the highest temperature, shown first."""
    return max(range(len(fields)), key=lambda number: float(fields[number].temperature.max()))


@dataclass(frozen=True)
class _MeshPicture:
    """A mesh as the page draws it: its number there, whether it is coarser than what was computed."""

    number: int
    solid: SolidPicture
    views: MeshViews
    coarser: bool


def _mesh_picture(item: TemperatureField, whole: SolidPicture, number: int) -> _MeshPicture:
    drawn = simplified(whole, item.mesh.points[whole.nodes])
    return _MeshPicture(number, drawn, MeshViews(item.mesh), drawn is not whole)


def _colour_scale(name: str) -> list[list[Any]]:
    """A map of matplotlib as plotly takes it: place from 0 to 1, colour."""
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    return [[round(place, 4), to_hex(colormaps[name](place))] for place in np.linspace(0.0, 1.0, 21).tolist()]


def _largest(item: TemperatureField) -> float:
    """Largest displacement [m]."""
    return float(np.linalg.norm(item.displacement, axis=1).max())


def _mesh_entry(block: _Block, picture: _MeshPicture) -> dict[str, Any]:
    solid, mesh = picture.solid, picture.views.mesh
    points = mesh.points[solid.nodes]
    vertices, skin = shaded_vertices(solid, points)
    tetrahedra = _sorted_rows(solid.tetrahedron_body, solid.tetrahedra)
    return {
        "bodies": [name.replace("_", " ") for name in solid.bodies],
        "hidden": sorted({*range(len(solid.bodies))} - {*standing_bodies(mesh).tolist()}),
        "surfaces": [name.replace("_", " ") for name in solid.surfaces],
        "points": [block.numbers(MM * points[:, axis], PLACE_STEPS) for axis in range(3)],
        "tetrahedra": block.indices(tetrahedra[:, 1:]),
        "tetrahedron_body": block.indices(tetrahedra[:, 0]),
        "vertices": block.indices(vertices),
        "triangles": block.indices(skin),
        "triangle_body": block.indices(solid.triangle_body),
        "triangle_surface": block.indices(solid.triangle_surface),
        "cut": MM * picture.views.height,
        "simplified": picture.coarser,
    }


def _sorted_rows(body: Indices, tetrahedra: Indices) -> Indices:
    """Body and nodes (t, 5) in ascending order, which a cut does not mind and compression likes."""
    rows = np.column_stack([body, np.sort(tetrahedra, axis=1)])
    return np.asarray(rows[np.lexsort(rows.T[::-1])])


def _field_entry(block: _Block, item: TemperatureField, picture: _MeshPicture) -> dict[str, Any]:
    nodes = picture.solid.nodes
    moved = UM * item.displacement[nodes]
    return {
        "mesh": picture.number,
        "gearbox": item.gearbox,
        "stage": item.stage,
        "temperature": block.numbers(item.temperature[nodes] - ZERO_CELSIUS),
        "displacement": [block.numbers(moved[:, axis]) for axis in range(3)],
        "factor": magnification(item, picture.views) if np.any(item.displacement) else 0.0,
    }
