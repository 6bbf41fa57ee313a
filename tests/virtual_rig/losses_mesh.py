"""Sliding loss of a mesh: friction along the path of contact with a load that ramps where two pairs carry."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True, kw_only=True)
class Path:
    """Path of contact of a pair, transverse section, lengths [m] from the pitch point along the line of action."""

    start: float
    end: float
    pitch: float
    """Transverse base pitch."""
    base_radius: float
    """Of the pinion."""
    pitch_radius: float
    """Working pitch radius of the pinion."""
    tip_radii: tuple[float, float]
    depths: tuple[float, float]
    """Tip less root radius of pinion and wheel."""
    angle: float
    """Working transverse pressure angle [rad]."""
    ratio: float
    """Teeth of the wheel over those of the pinion."""
    width: float
    """Face width that carries."""
    helical: bool

    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio."""
        return (self.end - self.start) / self.pitch


def path_of_contact(box: Mapping[str, Any], mesh: Mapping[str, Any]) -> Path:
    """Path of contact from the gear data of a case (section a of the gear sheet)."""
    gears = box["gears"][mesh["pinion"]], box["gears"][mesh["wheel"]]
    z1, z2 = gears[0]["teeth"], gears[1]["teeth"]
    module, beta = mesh["normal_module"], mesh.get("helix_angle", 0.0)
    alpha_n = mesh.get("pressure_angle", math.radians(20.0))
    alpha = math.atan(math.tan(alpha_n) / math.cos(beta))
    m_t = module / math.cos(beta)
    a = mesh["centre_distance"]
    working = math.acos(m_t * (z1 + z2) / 2.0 * math.cos(alpha) / a)
    total = (_inv(working) - _inv(alpha)) * (z1 + z2) / (2.0 * math.tan(alpha_n))
    first = gears[0].get("profile_shift")
    x1 = first if first is not None else total / 2.0
    if "profile_shift" in gears[1] and first is None:
        x1 = total - gears[1]["profile_shift"]
    shifts = x1, total - x1
    head = mesh.get("rack", {}).get("addendum", 1.0)
    base = [m_t * z * math.cos(alpha) / 2.0 for z in (z1, z2)]
    tips = [m_t * z / 2.0 + module * (head + x) for z, x in zip((z1, z2), shifts, strict=True)]
    for index, gear in enumerate(gears):
        if "tip_diameter" in gear:
            tips[index] = gear["tip_diameter"] / 2.0
    pitch = math.pi * m_t * math.cos(alpha)
    line = a * math.sin(working)
    if "contact_ratio" in mesh:
        tips = _cut(tips, base, line, pitch * mesh["contact_ratio"], mesh.get("tip_cut", "both"))
    centre = base[0] * math.tan(working)
    dedendum = mesh.get("rack", {}).get("dedendum", 1.25)
    roots = [m_t * z / 2.0 - module * (dedendum - x) for z, x in zip((z1, z2), shifts, strict=True)]
    return Path(
        start=line - math.sqrt(tips[1] ** 2 - base[1] ** 2) - centre,
        end=math.sqrt(tips[0] ** 2 - base[0] ** 2) - centre, pitch=pitch, base_radius=base[0],
        pitch_radius=a * z1 / (z1 + z2), tip_radii=(tips[0], tips[1]),
        depths=(tips[0] - roots[0], tips[1] - roots[1]), angle=working, ratio=z2 / z1,
        width=min(gear["face_width"] for gear in gears), helical=beta > 0.0,
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Friction:
    """mu = factor 0.048 (w / (v rho))^load (v / v_ref)^speed eta^-viscosity Ra^0.25 X, in the units of the formula."""

    factor: float
    load: float
    speed: float
    viscosity: float

    def coefficient(self, line_load: float, v_sum: float, radius: float, eta: float, roughness: float,
                    lubricant: float) -> float:  # fmt: skip
        """Mean coefficient of friction; N/m, m/s, m, Pa s, m."""
        wedge = line_load * 1e-3 / (max(v_sum, 0.5) * radius * 1e3)
        smooth = (eta * 1e3) ** -self.viscosity * (roughness * 1e6) ** 0.25
        return (
            self.factor
            * 0.048
            * wedge**self.load
            * (max(v_sum, 0.5) / 20.0) ** self.speed
            * smooth
            * lubricant
        )


def mesh_power(path: Path, torque: float, speed: float, eta: float, roughness: float, lubricant: float,
               friction: Friction, points: int = 200) -> float:  # fmt: skip
    """Mean sliding loss [W]: integral of mu F v_g over the path, local curvature and speeds."""
    force = abs(torque) / path.base_radius
    s = np.linspace(path.start, path.end, points)
    share = load_share(path, s)
    sliding = np.abs(s) * speed * (1.0 + 1.0 / path.ratio)
    v_sum = 2.0 * speed * path.pitch_radius * math.sin(path.angle)
    line = path.pitch_radius * math.sin(path.angle)
    radius = line * line * path.ratio / (line * (1.0 + path.ratio))
    mu = friction.coefficient(
        max(force / path.width, 1.5e5), min(v_sum, 2.0 * 50.0), radius, eta, roughness, lubricant
    )
    return float(mu * force * np.trapezoid(share * sliding, s) / path.pitch)


def load_share(path: Path, s: np.ndarray) -> np.ndarray:
    """Share of the load on a pair at s: 1 alone, from 0.36 to 0.64 across the zones of two pairs; flat if helical."""
    if path.helical or path.contact_ratio >= 2.0:
        return np.full_like(s, 1.0 / path.contact_ratio)
    alone_from, alone_to = path.end - path.pitch, path.start + path.pitch
    rising = 0.36 + 0.28 * (s - path.start) / max(alone_from - path.start, 1e-12)
    falling = 0.36 + 0.28 * (path.end - s) / max(path.end - alone_to, 1e-12)
    return np.where(s < alone_from, rising, np.where(s > alone_to, falling, 1.0))


def _inv(angle: float) -> float:
    return math.tan(angle) - angle


def _cut(tips: list[float], base: list[float], line: float, wanted: float, which: str) -> list[float]:
    """Tip radii shortened until the path has the wanted length (bisection)."""
    both = {"pinion": (1.0, 0.0), "wheel": (0.0, 1.0)}.get(which, (1.0, 1.0))

    def cut(depth: float) -> list[float]:
        return [tip - depth * share for tip, share in zip(tips, both, strict=True)]

    def length(depth: float) -> float:
        return sum(math.sqrt(max(t * t - b * b, 0.0)) for t, b in zip(cut(depth), base, strict=True)) - line

    low, high = -0.01, 0.03
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if length(middle) > wanted else (low, middle)
    return cut(low)
