"""Axial forces of two angular contact or tapered roller bearings that are set against each other.

A radial load on a bearing with a contact angle induces an axial force, which only its partner can take up. The shaft
is in balance: the axial forces of both bearings differ by the external force. Of all pairs of forces that do, the
smallest counts that gives either bearing at least what its own radial load induces,

    F_aA = max(F_iA, F_iB + K_a) ,  F_aB = max(F_iB, F_iA - K_a) ,  F_aA - F_aB = K_a

with K_a positive where it presses A. These are the six load cases of the catalogues in one (SKF General Catalogue
6000, tables on single row angular contact and tapered roller bearings), for bearings set to no play without preload.
A bearing that induces nothing but holds the shaft axially (deep groove ball bearing, thrust face) is a partner with
F_i = 0.
"""

from typing import Literal

Arrangement = Literal["back_to_back", "face_to_face"]
"""Back to back (O): pressure lines meet the axis outside of the pair; face to face (X): between the bearings."""


def pair_axial_loads(induced: tuple[float, float], external: float) -> tuple[float, float]:
    """Axial forces [N] inside bearings A and B of a shaft.

    induced : by the radial loads of A and B, not negative [N]
    external : axial force on the shaft [N], positive where it presses A, negative where it presses B
    """
    first, second = induced
    return max(first, second + external), max(second, first - external)


def force_on_first(arrangement: Arrangement, force: float) -> float:
    """External force as `pair_axial_loads` counts it [N], A the bearing at the lower end of the axis.

    force : on the shaft along the axis from A to B [N]

    Back to back the shaft pulls the inner ring of A against its outer ring, face to face it pushes that of B.
    """
    return force if arrangement == "back_to_back" else -force
