"""Half outline of one tooth with its trochoidal fillet, in the virtual spur gear of the normal section."""

from dataclasses import dataclass
from functools import lru_cache
from math import cos, hypot, pi

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.cylindrical_gear import CylindricalGear
from dynamics.standards.iso6336_3_2006 import ToothRoot, root_section

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class ToothOutline:
    """Right half of a tooth; y is the tooth axis from the gear centre. Lengths [m], angles [rad].

    x, y : (n,) points from the root circle over the fillet and the involute to the tip, y growing
    n_fillet : points that belong to the fillet
    base_radius, root_radius, tip_radius : of the virtual spur gear; ``root_radius`` is generated
    root_chord, root_height : thickness of the tooth between its 30 degree tangents and their height y
    """

    x: Array
    y: Array
    n_fillet: int
    base_radius: float
    root_radius: float
    tip_radius: float
    root_chord: float
    root_height: float


@lru_cache(maxsize=64)
def tooth_outline(gear: CylindricalGear, n_fillet: int = 160, n_flank: int = 240) -> ToothOutline:
    """Outline of a tooth of ``gear`` with ``n_fillet`` and ``n_flank`` points (ISO 21771 rack generation).

    A spur gear is its own virtual gear. An undercut tooth keeps the fillet up to its crossing with the flank.
    """
    module = gear.normal_module
    reference = 0.5 * module * gear.virtual_teeth
    base = reference * cos(gear.pressure_angle)
    tip = reference + gear.tip_radius - gear.reference_radius
    form = hypot(base, gear.roll_length(gear.form_radius) / cos(gear.base_helix_angle))
    fillet = np.array(
        [gear.trochoid_point(angle) for angle in np.linspace(0.5 * pi, gear.pressure_angle, n_fillet)]
    )
    keep = np.hypot(fillet[:, 0], fillet[:, 1]) < form
    keep &= np.concatenate(([True], np.diff(fillet[:, 1]) > 0.0))
    fillet = fillet[keep]
    radii = np.linspace(form, tip, n_flank)
    half = np.array([gear.virtual_half_angle(radius) for radius in radii])
    section = root_section(_root(gear))
    return ToothOutline(
        x=np.concatenate((fillet[:, 0], radii * np.sin(half))),
        y=np.concatenate((fillet[:, 1], radii * np.cos(half))),
        n_fillet=len(fillet),
        base_radius=base,
        root_radius=float(np.hypot(fillet[0, 0], fillet[0, 1])),
        tip_radius=tip,
        root_chord=section.s_Fn * module,
        root_height=section.y_F * module,
    )


def _root(gear: CylindricalGear) -> ToothRoot:
    return ToothRoot(
        z=gear.teeth,
        m_n=gear.normal_module * 1e3,
        alpha_n=float(np.degrees(gear.pressure_angle)),
        beta=float(np.degrees(gear.helix_angle)),
        x=gear.generating_profile_shift,
        h_fP=gear.rack.dedendum,
        rho_fP=gear.rack.tip_radius,
        d_a=gear.tip_diameter * 1e3,
    )
