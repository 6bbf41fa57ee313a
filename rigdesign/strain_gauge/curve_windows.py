"""A few numbers of the curve of a root gauge over the rolling angle of its tooth, for recorded and computed ones alike.

Angles count from the centroid of the loaded part of the curve, so that neither the index angle of a recording nor the
rotation at which a calculation begins is needed; a shift of the whole curve is not seen. All are strains above that
of the unloaded tooth: a lost zero, thermal output and centrifugal strain are in the strain of the unloaded tooth alone.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
LOADED = 0.2
"""Share of the highest strain from which the tooth counts as loaded: the part whose centroid is the zero angle."""
TOP = 0.1
"""Angle over which ``maximum`` is the mean of the highest strains, wherever they are [angular pitches]: as smooth as
the curve itself, where the single highest value jumps with samples and noise; some tenths of a per cent below it."""
FLANKS = (0.2, 0.5)
"""Distance from the centroid between which ``entry`` and ``exit`` are means [angular pitches]: the rise to the
maximum and the fall from it, where neighbouring pairs take over."""
AWAY = 2.0
"""Distance from the centroid beyond which neither the tooth nor its neighbours carry [angular pitches]."""
REACH = 1.2
"""Angle to both sides of the highest strain that belongs to the tooth [angular pitches]."""
STEPS = 400
"""Steps of an angular pitch in which the curve is interpolated, and places of a mean over a window."""


def curve_windows(angle: Array, strain: Array, pitch: float) -> Mapping[str, float]:
    """Entry, maximum, exit and unloaded strain of a curve.

    Parameters
    ----------
    angle : (n,) of the gear in the order in which the tooth goes through the mesh, increasing [rad]
    strain : (n,) [-]
    pitch : angle from tooth to tooth [rad]

    Returns
    -------
    ``unloaded``: median away from the tooth's own mesh and those of its neighbours, zero where the curve does not
    cover a pitch of it; ``entry``, ``maximum``, ``exit``: above it [-]. In a fillet that is pressed ``maximum`` is
    the lowest.
    """
    away = np.abs(angle - angle[np.argmax(np.abs(strain - np.median(strain)))]) > AWAY * pitch
    covered = float(np.gradient(angle)[away].sum())
    unloaded = float(np.median(strain[away])) if covered > pitch else 0.0
    above = strain - unloaded
    highest = int(np.argmax(np.abs(above)))
    sign = float(np.sign(above[highest]))
    step = pitch / STEPS
    around = np.arange(angle[highest] - REACH * pitch, angle[highest] + REACH * pitch, step)
    fine = sign * np.interp(around, angle, above)
    middle = _centroid(around, fine)
    low, high = FLANKS[0] * pitch, FLANKS[1] * pitch

    def mean(first: float, last: float) -> float:
        return sign * float(np.interp(np.linspace(first, last, STEPS), around, fine).mean())

    return {
        "entry": mean(middle - high, middle - low),
        "maximum": sign * float(np.sort(fine)[-round(TOP * STEPS) :].mean()),
        "exit": mean(middle + low, middle + high),
        "unloaded": unloaded,
    }


def _centroid(angle: Array, strain: Array) -> float:
    """Of the loaded part around the highest strain [rad]."""
    highest = int(np.argmax(strain))
    loaded = strain > LOADED * strain[highest]
    before = np.flatnonzero(~loaded[:highest])
    after = np.flatnonzero(~loaded[highest:])
    first = int(before[-1]) + 1 if before.size else 0
    last = highest + int(after[0]) if after.size else len(strain)
    total = float(strain[first:last].sum())
    return float((angle * strain)[first:last].sum()) / total if total else float(angle[highest])
