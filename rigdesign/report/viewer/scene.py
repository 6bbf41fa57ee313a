"""The data of the turnable picture: quantised numbers in one compressed block and a table of contents."""

import gzip
from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.report.figures.field import MeshViews, magnification, standing_bodies
from rigdesign.report.palette import DISPLACEMENT_COLOURS, TEMPERATURE_COLOURS
from rigdesign.report.viewer.solid import (
    MOST_TETRAHEDRA,
    MOST_TRIANGLES,
    Indices,
    SolidPicture,
    shaded_vertices,
)
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


# A coarser picture of a fine mesh: nodes of one small cube become one.
#
# Vertex clustering, J. Rossignac and P. Borrel, "Multi-resolution 3D approximations for rendering complex scenes",
# Modeling in Computer Graphics, Springer 1993, here with the tetrahedra behind the skin as well.

FEWEST, FINEST = 4, 512
"""Cubes along the longest side of the mesh, between which the finest picture that is small enough is sought."""


def simplified(picture: SolidPicture, points: FloatArray) -> SolidPicture:
    """The picture itself if it is small enough, else the finest clustering that is.

    points : (n, 3) of ``picture.nodes``. Bodies share no cluster that they do not share a node of, and skin and inside
    are kept apart, so that every body keeps its outline.
    """
    if _small(picture):
        return picture
    groups = _node_groups(picture)
    found, low, high = _clustered(picture, points, groups, FEWEST), FEWEST, FINEST
    while high - low > 1:
        middle = (low + high) // 2
        finer = _clustered(picture, points, groups, middle)
        if _small(finer):
            found, low = finer, middle
        else:
            high = middle
    return found


def _small(picture: SolidPicture) -> bool:
    return len(picture.triangles) <= MOST_TRIANGLES and len(picture.tetrahedra) <= MOST_TETRAHEDRA


def _node_groups(picture: SolidPicture) -> Indices:
    """(n,) number of the set of bodies a node belongs to, and whether it lies in a skin."""
    belongs = np.zeros((len(picture.nodes), len(picture.bodies) + 1), dtype=bool)
    belongs[picture.tetrahedra, picture.tetrahedron_body[:, None]] = True
    belongs[picture.triangles, -1] = True
    return np.unique(belongs, axis=0, return_inverse=True)[1].reshape(-1)


def _clustered(picture: SolidPicture, points: FloatArray, groups: Indices, count: int) -> SolidPicture:
    """Nodes of one group in one of ``count`` cubes along the longest side become the one nearest to their middle."""
    size = float(np.ptp(points, axis=0).max()) / count
    cubes = np.floor((points - points.min(axis=0)) / size).astype(np.int64)
    keys = ((groups * (count + 1) + cubes[:, 0]) * (count + 1) + cubes[:, 1]) * (count + 1) + cubes[:, 2]
    _, cluster, counts = np.unique(keys, return_inverse=True, return_counts=True)
    middles = np.column_stack([np.bincount(cluster, points[:, k]) for k in range(3)]) / counts[:, None]
    away = np.linalg.norm(points - middles[cluster], axis=1)
    order = np.lexsort((away, cluster))
    chosen = order[np.unique(cluster[order], return_index=True)[1]]
    kept = chosen[cluster]
    cells = _with_area(kept[picture.tetrahedra])
    skin = _with_area(kept[picture.triangles])
    cells &= _once(np.column_stack([np.sort(kept[picture.tetrahedra], axis=1), picture.tetrahedron_body]))
    skin &= _once(np.column_stack([np.sort(kept[picture.triangles], axis=1), picture.triangle_body]))
    used, local = np.unique(
        np.concatenate([kept[picture.tetrahedra[cells]].ravel(), kept[picture.triangles[skin]].ravel()]),
        return_inverse=True,
    )
    split = 4 * int(cells.sum())
    return replace(
        picture,
        nodes=picture.nodes[used],
        tetrahedra=local[:split].reshape(-1, 4),
        tetrahedron_body=picture.tetrahedron_body[cells],
        triangles=local[split:].reshape(-1, 3),
        triangle_body=picture.triangle_body[skin],
        triangle_surface=picture.triangle_surface[skin],
    )


def _with_area(corners: Indices) -> NDArray[np.bool_]:
    """(k,) True where no two corners fell together."""
    ordered = np.sort(corners, axis=1)
    return np.asarray((ordered[:, 1:] != ordered[:, :-1]).all(axis=1))


def _once(rows: Indices) -> NDArray[np.bool_]:
    """(k,) True at the first of equal rows."""
    order = np.lexsort(rows.T[::-1])
    first = np.ones(len(rows), dtype=bool)
    first[order[1:]] = (rows[order[1:]] != rows[order[:-1]]).any(axis=1)
    return first
