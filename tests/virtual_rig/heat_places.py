"""Temperatures read off a solved gearbox: bodies, surfaces, and points on the outer faces."""

import math

import numpy as np

from tests.virtual_rig.heat_box import Box
from tests.virtual_rig.heat_parts import Face

REACH = 2e-3
"""How far a point may lie off its face [m]."""


BORE = 0.86
"""Radius of a bore over that of the middle of the first ring round it, coarse cells."""


class OffTheRigError(ValueError):
    """A point that is on no outer face."""


def body_temperatures(box: Box, temperature: np.ndarray, surface: np.ndarray) -> dict[str, float]:
    """Means by heat capacity of bodies, by area of surfaces [K]; partitions count half to warm, half to cold."""
    net = box.net
    found = {
        body: float(np.average(temperature[cells], weights=net.c_cell[cells]))
        for body, cells in box.bodies.items()
    }
    weights: dict[str, list[tuple[list[int], float]]] = {}
    for name, films in box.films.items():
        if name.startswith("outer_partition"):
            side = name.rsplit("_", 1)[1]
            weights.setdefault("outer_warm", []).append((films, 0.5))
            weights.setdefault(f"outer_cold_{side}", []).append((films, 0.5))
        elif name not in ("gallery", "barrier"):
            weights.setdefault(name, []).append((films, 1.0))
    for name, parts in weights.items():
        area = sum(share * net.fa[films].sum() for films, share in parts)
        found[name] = float(
            sum(share * (net.fa[films] * surface[films]).sum() for films, share in parts) / area
        )
    return found


def temperature_at(box: Box, surface: np.ndarray, at: tuple[float, float, float]) -> float:
    """Temperature of the outer face at a point [K]; OffTheRigError (ValueError) away from every face."""
    face = face_of(box, at)
    u, v = at[face.axes[0]], at[face.axes[1]]
    values = _values(face, surface)
    for centre_u, centre_v, half, radii, films in face.patches:
        du, dv = u - centre_u, v - centre_v
        if max(abs(du), abs(dv)) < half:
            to_edge = half / max(abs(du), abs(dv), 1e-6)
            edge = _bilinear(values, face.u, face.v, centre_u + du * to_edge, centre_v + dv * to_edge)
            return _polar(surface, du, dv, radii, films, to_edge, edge)
    return _bilinear(values, face.u, face.v, u, v)


def face_of(box: Box, at: tuple[float, float, float]) -> Face:
    """Outer face a point lies on."""
    margin = {0: (0.0, box.length), 1: (-box.width / 2.0, box.width / 2.0), 2: (0.0, box.height)}
    for name, face in box.faces.items():
        inside = all(margin[axis][0] - REACH <= at[axis] <= margin[axis][1] + REACH for axis in face.axes)
        if name == "field_top":
            field, x = box.house["field"], at[0] - box.length / 2.0
            inside = not inside and abs(x) <= field["length"] / 2.0 and abs(at[1]) <= field["width"] / 2.0
        if abs(at[face.normal] - face.level) <= REACH and inside:
            for u, v, _, radii, _ in face.patches:
                if math.hypot(at[face.axes[0]] - u, at[face.axes[1]] - v) < BORE * radii[0]:
                    raise OffTheRigError(f"{at}: in the bore of a bearing, not on the wall")
            return face
    raise OffTheRigError(f"{at}: on no outer face of the housing and not on the field")


def scattered(box: Box, at: tuple[float, float, float], rng: np.random.Generator, spread: float = 3e-3,
              ) -> tuple[float, float, float]:  # fmt: skip
    """Where a thermocouple really sits: the point moved on its face by ``spread`` [m] (1 sigma) each way."""
    face = face_of(box, at)
    while True:
        moved = list(at)
        for axis in face.axes:
            moved[axis] += spread * float(np.clip(rng.standard_normal(), -2.5, 2.5))
        point = (moved[0], moved[1], moved[2])
        try:
            if face_of(box, point) is face:
                return point
        except OffTheRigError:
            continue


def _values(face: Face, surface: np.ndarray) -> np.ndarray:
    values = np.where(face.films >= 0, surface[np.maximum(face.films, 0)], np.nan)
    for centre_u, centre_v, half, _, films in face.patches:
        inside = (np.abs(face.u - centre_u) < half)[:, None] & (np.abs(face.v - centre_v) < half)[None, :]
        values[inside] = surface[films[-1]].mean()
    known = np.argwhere(~np.isnan(values))
    for i, j in np.argwhere(np.isnan(values)):  # under the box: the nearest free cell
        far = np.hypot(face.u[known[:, 0]] - face.u[i], face.v[known[:, 1]] - face.v[j])
        values[i, j] = values[tuple(known[far.argmin()])]
    return values


def _bilinear(values: np.ndarray, u: np.ndarray, v: np.ndarray, at_u: float, at_v: float) -> float:
    """Between cell centres, and on to the edge of the face."""
    i = int(np.clip(np.searchsorted(u, at_u) - 1, 0, len(u) - 2))
    j = int(np.clip(np.searchsorted(v, at_v) - 1, 0, len(v) - 2))
    a = float(np.clip((at_u - u[i]) / (u[i + 1] - u[i]), -1.2, 2.2))
    b = float(np.clip((at_v - v[j]) / (v[j + 1] - v[j]), -1.2, 2.2))
    low = values[i, j] * (1.0 - b) + values[i, j + 1] * b
    high = values[i + 1, j] * (1.0 - b) + values[i + 1, j + 1] * b
    return float(low * (1.0 - a) + high * a)


def _polar(surface: np.ndarray, du: float, dv: float, radii: np.ndarray, films: np.ndarray, to_edge: float,
           edge: float) -> float:  # fmt: skip
    """Linear in ln r over the rings and on to the edge of the square, in angle over sectors from -45 degrees."""
    rings = surface[films]
    sectors = rings.shape[1]
    position = ((math.atan2(dv, du) + math.pi / 4.0) / (2.0 * math.pi) * sectors - 0.5) % sectors
    first, share = int(position) % sectors, position % 1.0
    ray = rings[:, first] * (1.0 - share) + rings[:, (first + 1) % sectors] * share
    radius = max(math.hypot(du, dv), 1e-6)
    known = np.append(radii, max(radius * to_edge, 1.001 * radii[-1]))
    return float(np.interp(math.log(radius), np.log(known), np.append(ray, edge)))
