"""Teeth of one mesh for the march in time: own geometry, own stiffness course, gaps and errors of every tooth.

Geometry as in ISO 21771, the stiffness of one pair at the pitch point as in ISO 6336-1 method B. The course of
the stiffness is a parabola over the path, weaker to the ends, and grows a little with the load (Hertz), which no other
part of the project does in this way.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

N_PATH = 161
"""Points of the tables over the path, active part and premature contact."""
MARGIN = 0.12
"""Reach of the tables beyond the active path, in base pitches."""
REFERENCE_LINE_LOAD = 3e5
"""Line load [N/m] at which the stiffness of the sheet counts."""
SLICES = 3


@dataclass(frozen=True, kw_only=True)
class ToothErrors:
    """What one gear has of its own; lengths in metres.

    Teeth are numbered and angles counted where the front flanks touch, also in a mesh whose back flanks carry: tooth k
    is the same steel there, but a tooth that stands ahead gives way, and an eccentricity lies on the other line of
    action. Out of the front flank counts plus. Slopes and reliefs are alike on both flanks.
    """

    run_out: complex = 0j
    """Eccentricity as amplitude times exp(i phase): out by Re(run_out exp(-i rotation)) in front (half of F_r)."""
    place: tuple[float, ...] = ()
    """Cumulative pitch deviation of each tooth, (z,)."""
    stiffness: tuple[float, ...] = ()
    """Stiffness scale of each tooth, (z,)."""
    slope: tuple[float, ...] = ()
    """Profile slope f_Halpha of each tooth, positive where the tip stands out (ISO 1328-1), (z,)."""
    tip_relief: float = 0.0
    """Relief at the tip beyond that of the case."""
    waves: Mapping[int, complex] = field(default_factory=dict)
    """Cumulative pitch waves, order -> amplitude times exp(i phase)."""

    def places(self, teeth: int) -> np.ndarray:
        """Place of each tooth (teeth,) [m]."""
        tooth = 2.0 * math.pi * np.arange(teeth) / teeth
        own = np.array(self.place) if self.place else np.zeros(teeth)
        return own + sum(
            (np.real(a * np.exp(-1j * k * tooth)) for k, a in self.waves.items()), np.zeros(teeth)
        )


@dataclass(frozen=True, kw_only=True)
class Teeth:
    """Geometry of one mesh; path positions count from the pitch point towards the pinion's tip [m]."""

    name: str
    gears: tuple[str, str]
    z: tuple[int, int]
    base_radii: tuple[float, float]
    base_pitch: float
    start: float
    end: float
    rolling_radii: tuple[float, float]
    working_radii: tuple[float, float]
    backlash: float
    """Along the path [m]."""
    back_phase: float
    face_width: float
    face_widths: tuple[float, float]
    masses: tuple[float, float]
    inertias: tuple[float, float]
    peak_stiffness: float
    """One pair in the middle of the path, whole width [N/m]."""
    phase: float
    damping: float
    flanks: tuple[Mapping[str, Any], Mapping[str, Any]]
    tip_radii: tuple[float, float]
    grades: tuple[int, int]
    module: float

    @property
    def contact_ratio(self) -> float:
        return (self.end - self.start) / self.base_pitch

    @property
    def working_angle(self) -> float:
        """Transverse pressure angle at the working pitch circle [rad]."""
        return math.atan2(self.rolling_radii[0], self.base_radii[0])

    def grid(self, margin: float = MARGIN) -> np.ndarray:
        """Path positions of the tables (N_PATH,), ``margin`` base pitches beyond the active path."""
        reach = margin * self.base_pitch
        return np.linspace(self.start - reach, self.end + reach, N_PATH)


def read_teeth(tree: Mapping[str, Any], box: str, mesh: str) -> Teeth:
    """Mesh ``box.mesh`` of a case tree in SI units, cold."""
    gearbox = tree["gearboxes"][box]
    entry = gearbox["meshes"][mesh]
    gears = [gearbox["gears"][entry[side]] for side in ("pinion", "wheel")]
    z = gears[0]["teeth"], gears[1]["teeth"]
    m, a = entry["normal_module"], entry["centre_distance"]
    alpha, beta = entry["pressure_angle"], entry.get("helix_angle", 0.0)
    alpha_t = math.atan(math.tan(alpha) / math.cos(beta))
    m_t = m / math.cos(beta)
    radii = [0.5 * m_t * n for n in z]
    base = [r * math.cos(alpha_t) for r in radii]
    alpha_w = math.acos(sum(base) / a)
    shift_sum = (_inv(alpha_w) - _inv(alpha_t)) * sum(z) / (2.0 * math.tan(alpha))
    shifts = _shifts(gears, entry, shift_sum)
    rack = {"addendum": 1.0, "dedendum": 1.25, "tip_radius": 0.38, **entry.get("rack", {})}
    tips = [
        r + m * (rack["addendum"] + x) - g.get("tip_shortening", 0.0) for r, x, g in zip(radii, shifts, gears)
    ]
    pitch = math.pi * m_t * math.cos(alpha_t)
    cut = entry.get("tip_cut")
    if entry.get("contact_ratio") is not None:
        tips = _shortened(tips, base, a, alpha_w, pitch, entry["contact_ratio"], cut)
    rolling = [r * math.tan(alpha_w) for r in base]
    end = math.sqrt(tips[0] ** 2 - base[0] ** 2) - rolling[0]
    start = rolling[1] - math.sqrt(tips[1] ** 2 - base[1] ** 2)
    working = [a * r / sum(base) for r in base]
    inv_w = _inv(alpha_w)
    thinner = [0.5 * g.get("tooth_thinning", 0.0) / (math.cos(beta) * r) for g, r in zip(gears, radii)]
    thick = [
        2.0 * w * (_half_angle(n, x, alpha, alpha_t) - thin - inv_w)
        for w, n, x, thin in zip(working, z, shifts, thinner)
    ]
    backlash = pitch - sum(thick) * math.cos(alpha_w)
    width = min(g["face_width"] for g in gears)
    bodies = [_body(g, r, m, rack["dedendum"], x, t) for g, r, x, t in zip(gears, radii, shifts, tips)]
    return Teeth(
        name=f"{box}.{mesh}",
        gears=(f"{box}.{entry['pinion']}", f"{box}.{entry['wheel']}"),
        z=z,
        base_radii=(base[0], base[1]),
        base_pitch=pitch,
        start=start,
        end=end,
        rolling_radii=(rolling[0], rolling[1]),
        working_radii=(working[0], working[1]),
        backlash=max(backlash, 0.0),
        back_phase=thick[0] * base[0] / working[0],
        face_width=width,
        face_widths=(gears[0]["face_width"], gears[1]["face_width"]),
        masses=(bodies[0][0], bodies[1][0]),
        inertias=(bodies[0][1], bodies[1][1]),
        peak_stiffness=0.8 * pair_stiffness(z, shifts, beta, alpha) * width,
        phase=entry.get("phase", 0.0) * pitch,
        damping=entry["damping"],
        flanks=(gears[0].get("flank", {}), gears[1].get("flank", {})),
        tip_radii=(tips[0], tips[1]),
        grades=(gears[0]["quality_grade"], gears[1]["quality_grade"]),
        module=m,
    )


def pair_stiffness(z: Sequence[int], x: Sequence[float], beta: float, alpha: float) -> float:
    """c'_th of one pair, the nine-term regression of ISO 6336-1 method B [N/m per m face width]."""
    base = math.asin(math.sin(beta) * math.cos(alpha))
    n = [k / (math.cos(base) ** 2 * math.cos(beta)) for k in z]
    c = (0.04723, 0.15551, 0.25791, -0.00635, -0.11654, -0.00193, -0.24188, 0.00529, 0.00182)
    q = c[0] + c[1] / n[0] + c[2] / n[1] + c[3] * x[0] + c[4] * x[0] / n[0] + c[5] * x[1] + c[6] * x[1] / n[1]
    return 1e9 / (q + c[7] * x[0] ** 2 + c[8] * x[1] ** 2)


def stiffness_course(teeth: Teeth, curvature: float, margin: float = MARGIN) -> np.ndarray:
    """Share of the peak stiffness over the grid: 1 - curvature of the parabola at the ends of the path."""
    middle, half = 0.5 * (teeth.start + teeth.end), 0.5 * (teeth.end - teeth.start)
    share = (teeth.grid(margin) - middle) / half
    return 1.0 - curvature * np.minimum(share**2, 1.3)


def path_gaps(
    teeth: Teeth, relief_scale: float = 1.0, relief: Sequence[float] = (0.0, 0.0), margin: float = MARGIN
) -> np.ndarray:
    """Gap of ideal-pitch pairs, (SLICES, N_PATH) [m]: reliefs, crownings, slopes, and the corner beyond the path.

    relief : tip relief beyond that of the case, pinion and wheel [m]
    """
    s = teeth.grid(margin)
    inside = np.clip(s, teeth.start, teeth.end)
    outside = s - inside
    corner = np.where(outside < 0.0, corner_gap(teeth, 1), corner_gap(teeth, 0))
    face = ((np.arange(SLICES) + 0.5) / SLICES - 0.5)[:, None] * teeth.face_width
    gap = np.repeat((corner * outside**2)[None, :], SLICES, axis=0)
    half, middle = 0.5 * (teeth.end - teeth.start), 0.5 * (teeth.start + teeth.end)
    for index, flank in enumerate(teeth.flanks):
        sign = 1.0 if index == 0 else -1.0
        share = sign * (inside - middle) / half
        gap = gap + relief_scale * flank.get("profile_crowning", 0.0) * share**2
        gap = gap - 0.5 * flank.get("profile_slope", 0.0) * share
        across = 2.0 * face / teeth.face_widths[index]
        gap = gap + flank.get("lead_crowning", 0.0) * across**2 + 0.5 * flank.get("helix_slope", 0.0) * across
        amount = relief_scale * flank.get("tip_relief", 0.0) + relief[index]
        if amount:
            length = relief_length(teeth, index)
            from_tip = teeth.end - inside if index == 0 else inside - teeth.start
            gap = gap + amount * np.maximum(1.0 - from_tip / length, 0.0)
    return gap


def corner_gap(teeth: Teeth, index: int) -> float:
    """Gap under the tip corner of gear ``index`` over the square of the path beyond its end [1/m].

    Where involutes would still touch, the point of contact has left the tip by rho / r_b times that path; both flanks
    part from there by half the sum of their curvatures times the distance squared.
    """
    at = teeth.end if index == 0 else teeth.start
    radii = teeth.rolling_radii[0] + at, teeth.rolling_radii[1] - at
    return 0.5 * (radii[index] / teeth.base_radii[index]) ** 2 * sum(1.0 / r for r in radii)


def relief_length(teeth: Teeth, index: int) -> float:
    """Path length over which tip relief fades [m]: of the case, else half of the double contact zone."""
    height = teeth.flanks[index].get("tip_relief_length", 0.0)
    if not height:
        return 0.5 * max(teeth.end - teeth.start - teeth.base_pitch, 0.2 * teeth.base_pitch)
    tip, base = teeth.tip_radii[index], teeth.base_radii[index]
    return math.sqrt(tip**2 - base**2) - math.sqrt(max((tip - height) ** 2 - base**2, 0.0))


def tolerances(teeth: Teeth, index: int) -> tuple[float, float, float]:
    """f_p, F_p and f_Halpha of a gear of its grade, ISO 1328-1:2013 [m]."""
    d, m = 1e3 * 2.0 * teeth.base_radii[index] / 0.94, 1e3 * teeth.module
    grade = math.sqrt(2.0) ** (teeth.grades[index] - 5)
    single = 0.001 * d + 0.4 * m + 5.0
    total = 0.002 * d + 0.55 * math.sqrt(d) + 0.7 * m + 12.0
    slope = 0.4 * m + 0.001 * d + 4.0
    return 1e-6 * single * grade, 1e-6 * total * grade, 1e-6 * slope * grade


def _inv(angle: float) -> float:
    return math.tan(angle) - angle


def _half_angle(z: int, x: float, alpha: float, alpha_t: float) -> float:
    return (0.5 * math.pi + 2.0 * x * math.tan(alpha)) / z + _inv(alpha_t)


def _shifts(gears: Sequence[Mapping[str, Any]], mesh: Mapping[str, Any], total: float) -> tuple[float, float]:
    if mesh.get("profile_shift_split") == "equal":
        return 0.5 * total, 0.5 * total
    first, second = (gear.get("profile_shift") for gear in gears)
    if first is None:
        first = total - second if second is not None else 0.5 * total
    return first, total - first


def _shortened(
    tips: Sequence[float],
    base: Sequence[float],
    a: float,
    alpha_w: float,
    pitch: float,
    ratio: float,
    cut: str | None,
) -> list[float]:
    """Tip radii cut on one or both gears until the contact ratio is met (bisection)."""
    which = {"pinion": (1.0, 0.0), "wheel": (0.0, 1.0)}.get(cut or "both", (1.0, 1.0))
    low, high = 0.0, 0.5 * min(tips[i] - base[i] for i in (0, 1) if which[i])
    for _ in range(80):
        middle = 0.5 * (low + high)
        new = [t - w * middle for t, w in zip(tips, which)]
        length = sum(math.sqrt(max(t**2 - r**2, 0.0)) for t, r in zip(new, base)) - a * math.sin(alpha_w)
        low, high = (middle, high) if length / pitch > ratio else (low, middle)
    return [t - w * low for t, w in zip(tips, which)]


def _body(
    gear: Mapping[str, Any], radius: float, module: float, dedendum: float, shift: float, tip: float
) -> tuple[float, float]:
    """Mass [kg] and inertia [kg m2] of the bored steel disc with the mean tooth diameter."""
    outer = 0.5 * (tip + radius - module * (dedendum - shift))
    bore = 0.5 * gear.get("bore_diameter", 0.0)
    mass = math.pi * 7850.0 * gear["face_width"] * (outer**2 - bore**2)
    return mass, 0.5 * mass * (outer**2 + bore**2)
