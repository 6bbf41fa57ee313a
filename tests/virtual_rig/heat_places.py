"""Temperatures read off a solved gearbox: bodies, surfaces, and points on the outer faces."""

import math

import numpy as np

from tests.virtual_rig.heat_box import Box
from tests.virtual_rig.heat_parts import Face

REACH = 2e-3
"""How far a point may lie off its face [m]."""


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
    for centre_u, centre_v, half, radii, films in face.patches:
        if max(abs(u - centre_u), abs(v - centre_v)) <= half:
            return _polar(surface, u - centre_u, v - centre_v, radii, films)
    return _bilinear(_values(face, surface), face.u, face.v, u, v)


def face_of(box: Box, at: tuple[float, float, float]) -> Face:
    """Outer face a point lies on."""
    margin = {0: (0.0, box.length), 1: (-box.width / 2.0, box.width / 2.0), 2: (0.0, box.height)}
    for name, face in box.faces.items():
        inside = name == "field_top" or all(
            margin[axis][0] - REACH <= at[axis] <= margin[axis][1] + REACH for axis in face.axes
        )
        if abs(at[face.normal] - face.level) <= REACH and inside:
            return face
    raise OffTheRigError(f"{at}: on no outer face of the housing and not on the field")


def scattered(box: Box, at: tuple[float, float, float], rng: np.random.Generator, spread: float = 3e-3,
              ) -> tuple[float, float, float]:  # fmt: skip
    """Where a thermocouple really sits: the point moved on its face by ``spread`` [m] (1 sigma) each way."""
    face = face_of(box, at)
    moved = list(at)
    for axis in face.axes:
        limit = {0: (0.0, box.length), 1: (-box.width / 2.0, box.width / 2.0), 2: (0.0, box.height)}[axis]
        step = moved[axis] + spread * float(np.clip(rng.standard_normal(), -2.5, 2.5))
        moved[axis] = step if face.level == 0.0 and face.normal == 2 else min(max(step, limit[0]), limit[1])
    return moved[0], moved[1], moved[2]


def _values(face: Face, surface: np.ndarray) -> np.ndarray:
    values = np.where(face.films >= 0, surface[np.maximum(face.films, 0)], np.nan)
    for centre_u, centre_v, half, _, films in face.patches:
        inside = (np.abs(face.u - centre_u) < half)[:, None] & (np.abs(face.v - centre_v) < half)[None, :]
        values[inside] = surface[films[-1]].mean()
    if np.isnan(values).any():
        values[np.isnan(values)] = np.nanmean(values)
    return values


def _bilinear(values: np.ndarray, u: np.ndarray, v: np.ndarray, at_u: float, at_v: float) -> float:
    i = int(np.clip(np.searchsorted(u, at_u) - 1, 0, len(u) - 2))
    j = int(np.clip(np.searchsorted(v, at_v) - 1, 0, len(v) - 2))
    a = float(np.clip((at_u - u[i]) / (u[i + 1] - u[i]), 0.0, 1.0))
    b = float(np.clip((at_v - v[j]) / (v[j + 1] - v[j]), 0.0, 1.0))
    low = values[i, j] * (1.0 - b) + values[i, j + 1] * b
    high = values[i + 1, j] * (1.0 - b) + values[i + 1, j + 1] * b
    return float(low * (1.0 - a) + high * a)


def _polar(surface: np.ndarray, du: float, dv: float, radii: np.ndarray, films: np.ndarray) -> float:
    """Linear in ln r over the rings and in angle over the sectors, which count from -45 degrees."""
    rings = surface[films]
    sectors = rings.shape[1]
    position = ((math.atan2(dv, du) + math.pi / 4.0) / (2.0 * math.pi) * sectors - 0.5) % sectors
    first, share = int(position) % sectors, position % 1.0
    ray = rings[:, first] * (1.0 - share) + rings[:, (first + 1) % sectors] * share
    return float(np.interp(math.log(max(math.hypot(du, dv), 1e-6)), np.log(radii), ray))
