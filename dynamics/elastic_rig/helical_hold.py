"""Axial restraint of floating shafts by helical meshes.

A single-helical mesh alone gives none: it ties axial motion to rotation, so that under load a floating shaft moves
axially as it turns until the flanks lose contact. A restraint must resist the shift while the torque of the loop is
given, that is with the bracing coupling free to turn. Then shafts joined by two meshes of different lead (a pair of
opposite hands side by side) are held; a helical and a spur gear at the two ends of a shaft are not: position and twist
go together, and no force along x balances that of the helical teeth.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

FREE = 1e-9
"""Sum of squared row values below which a motion of rigid shafts counts as free, rows scaled to 1; and the share of a
floating group in such a motion below which it stands still."""


class HelicalTie(NamedTuple):
    """A mesh as a tie of two rigid bodies: approach radius_1 turn_1 - radius_2 turn_2 - thrust (u_1 - u_2).

    pinion, wheel : what turns and shifts with them; radii [m], turns in the running direction
    thrust : tan(base helix angle) over base radii, or tan(helix angle) over reference radii, positive for a right-hand
        pinion that turns about +x; 0 for a spur or double-helical mesh
    """

    pinion: str
    wheel: str
    radii: tuple[float, float]
    thrust: float


def turning_together(bodies: Collection[str], joints: Sequence[tuple[str, str]]) -> dict[str, int]:
    """Number of the group of each body that joints make turn as one; leave out the coupling that is twisted."""
    group = {body: i for i, body in enumerate(bodies)}
    for first, second in joints:
        keep, drop = group[first], group[second]
        group = {body: keep if i == drop else i for body, i in group.items()}
    return group


def not_held(
    turning: Mapping[str, int], floating: Sequence[Sequence[str]], ties: Sequence[HelicalTie]
) -> Iterator[Sequence[str]]:
    """Those of the floating groups that shift in a motion which no mesh resists.

    turning : group of each body that turns as one, the loop open where it is braced; floating : bodies that shift
    along x together and that neither bearing, coupling nor double-helical mesh locates
    """
    lines = {number: column for column, number in enumerate(dict.fromkeys(turning.values()))}
    sliding = {body: len(lines) + i for i, group in enumerate(floating) for body in group}
    radius = float(np.mean([tie.radii for tie in ties])) if ties else 1.0
    table = np.zeros((len(ties) + 1, len(lines) + len(floating)))
    for row, tie in zip(table, ties):
        for sign, body, arm in zip((1.0, -1.0), (tie.pinion, tie.wheel), tie.radii, strict=True):
            row[lines[turning[body]]] += sign * arm / radius
            if body in sliding:
                row[sliding[body]] -= sign * tie.thrust
    size = np.linalg.norm(table, axis=1, keepdims=True)
    table = np.divide(table, size, where=size > FREE, out=np.zeros_like(table))
    values, vectors = np.linalg.eigh(table.T @ table)
    shares = (vectors[len(lines) :, values <= FREE] ** 2).sum(axis=1)
    for group, share in zip(floating, shares, strict=True):
        if share > FREE:
            yield group
