"""The two gear pairs of P2's prototype (Figure 7), with profile shift 1 of zero."""

from math import radians
from typing import Any

from dynamics.gear.pair import GearPair
from dynamics.gear.pair_geometry import TipShortening

ALLOWANCES = {"thickness_allowances": (40e-6, 60e-6)}
"""Backlash of the shipped case."""


def spur_pair(profile_shift_1: float = 0.0, **bodies: Any) -> GearPair:
    """Test gear: z 99/102, m 1 mm, face widths 7 and 15 mm, wheel tips cut to a contact ratio of 1.26."""
    return GearPair.from_centre_distance(
        normal_module=1e-3,
        teeth=(99, 102),
        centre_distance=99.5e-3,
        face_widths=(7e-3, 15e-3),
        profile_shift_1=profile_shift_1,
        tips=TipShortening(contact_ratio=1.26, cut_gear="wheel"),
        **bodies,
    )


def helical_pair(**bodies: Any) -> GearPair:
    """Reference gear: z 99/102, m 0.95 mm, 18 degrees, face width 40 mm, tips cut to a contact ratio of 1.448."""
    return GearPair.from_centre_distance(
        normal_module=0.95e-3,
        teeth=(99, 102),
        centre_distance=99.5e-3,
        helix_angle=radians(18.0),
        face_widths=(40e-3, 40e-3),
        profile_shift_1=0.0,
        tips=TipShortening(contact_ratio=1.448),
        **bodies,
    )
