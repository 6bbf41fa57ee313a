"""Approach of the teeth behind the compliance of the gear bodies that all pairs of a mesh share.

With the elastic force ``P = sum k d`` of the front less that of the back flank, the teeth see the approach

    y = x - c_b P(y)

``P`` grows with ``y`` in straight pieces: for a given set of closed contacts
``y = (x + c_b sum k g) / (1 + c_b sum k)``, and the set is found by stepping from piece to piece (Newton, kept within
the bounds found so far, which two flanks pressed at once may need). It ends when a step leaves the set as it is: then
``y`` is exact.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, Flank, inlined
from dynamics.kernels.mesh_tables import BACKLASH, BODY, POSITIVE, ROW_E, VECTOR

# compiled from sources 815a2749
Array = NDArray[np.float64]

MOST_SETS = 64
"""Sets of closed contacts that are tried; four are many."""


class Flanks(NamedTuple):
    """Contacts of both flanks of a mesh in one table; none of a flank that cannot touch."""

    front: Flank
    back: Flank


class ToothApproach(NamedTuple):
    """What the teeth see of an approach of the gears."""

    approach: float
    """Approach behind the body [m]."""
    share: float
    """Its derivative over the approach of the gears: the share that the teeth take [-]."""


@inlined
def no_contacts() -> Flank:
    """Return a flank that cannot touch."""
    return Flank(0, 1, 0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0)


@inlined
def _contact(table: Array, c: int, stride: int, f: float, reach: float) -> tuple[float, float]:
    """Return stiffness and elastic force of the contact in column ``c``, none where it is open."""
    k_1, k_2, k_3 = table[c + stride], table[c + 2 * stride], table[c + 3 * stride]
    e_1, e_2, e_3 = table[c + 5 * stride], table[c + 6 * stride], table[c + 7 * stride]
    depth = reach - (table[c + ROW_E * stride] + f * (e_1 + f * (e_2 + f * e_3)))
    k = table[c] + f * (k_1 + f * (k_2 + f * k_3))
    k = k if depth > 0.0 else 0.0
    return k, k * depth


@inlined
def _carried(table: Array, flank: Flank, reach: float) -> tuple[float, float]:
    """Return stiffness and elastic force of the closed contacts of a flank."""
    first, stride = flank.first & POSITIVE, flank.stride & POSITIVE
    stiffness, force = 0.0, 0.0
    if flank.n == 1:
        stiffness, force = _contact(table, first, stride, flank.place, reach)
    else:
        for i in range(flank.n // VECTOR * VECTOR):
            k, more = _contact(table, first + i, stride, flank.place, reach)
            stiffness += k
            force += more
    return stiffness, force


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def tooth_approach(
    table: Array, flanks: Flanks, space: Array, at: int, approach: float, start: float
) -> ToothApproach:
    """Return what the teeth of a mesh see of an approach of the gears [m].

    ``space`` holds the numbers of the law, the columns of ``PackedMeshes.values``, from ``at`` on; ``start`` is a
    guess, best the answer at a state nearby.
    """
    body, backlash = space[at + BODY], space[at + BACKLASH]
    y, lowest, highest = start, -np.inf, np.inf
    before, share = -1.0, 1.0
    for _ in range(MOST_SETS):
        stiffness, force = _carried(table, flanks.front, y)
        on_back, pushed_back = _carried(table, flanks.back, -y - backlash)
        stiffness += on_back
        force -= pushed_back
        off = y + body * force - approach
        share = 1.0 / (1.0 + body * stiffness)
        if off > 0.0:
            highest = y
        else:
            lowest = y
        y -= off * share
        if stiffness == before:
            break
        before = stiffness
        if not lowest <= y <= highest:
            y = 0.5 * (lowest + highest)
            before = -1.0
    return ToothApproach(y, share)
