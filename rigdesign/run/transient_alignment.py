"""Alignment over the thermal history: bearings, bores, axes and couplings at every time, and their worst moments."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from rigdesign.case.model import Case
from rigdesign.coupling.alignment import ALIGNMENT, CouplingEnd, CouplingPlace, coupling_places
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.transient import Extreme
from rigdesign.rig.model import Rig
from rigdesign.transient.branch import Branch

FloatArray = NDArray[np.float64]
Misalignment = Literal[
    "bearing_tilt", "bore_out_of_round", "axis_inclination", "axis_skew", "coupling_offset", "coupling_angle"
]
MISALIGNMENTS: tuple[Misalignment, ...] = get_args(Misalignment)


@dataclass(frozen=True)
class Peak:
    """The largest value of a misalignment and when it is there."""

    value: float
    place: str
    branch: Branch
    at: int


def misalignments(
    rig: Rig, branch: Branch, branches: Sequence[Branch]
) -> dict[Misalignment, dict[str, FloatArray]]:
    """Quantity -> place -> (n,) values of a branch: angles [rad], offsets and deviations [m], shares [-].

    branches : of all gearboxes; one of the same name holds the other shaft of a coupling
    """
    found: dict[Misalignment, dict[str, FloatArray]] = {
        quantity: {
            place: np.array([entry[quantity][place] for entry in branch.alignment])
            for place in branch.alignment[0][quantity]
        }
        for quantity in ALIGNMENT
    }
    places = [place for place in coupling_places(rig) if place.gearbox == branch.gearbox]
    motions = {place.name: _coupling(place, branch, branches) for place in places}
    found["coupling_offset"] = {name: np.hypot(m[:, 0], m[:, 1]) for name, m in motions.items()}
    found["coupling_angle"] = {name: np.hypot(m[:, 2], m[:, 3]) for name, m in motions.items()}
    return found


def _coupling(place: CouplingPlace, branch: Branch, branches: Sequence[Branch]) -> FloatArray:
    """(n, 4) offset in y and z [m] and angle in y and z [rad] at the times of a branch."""
    motion = _end(place.first, branch, branches) - _end(place.second, branch, branches)
    motion[:, :2] += place.offset
    return motion


def _end(end: CouplingEnd, branch: Branch, branches: Sequence[Branch]) -> FloatArray:
    """(n, 4) shift and slope of a shaft end; of another gearbox between the times of its own branch."""
    own = next((b for b in branches if (b.gearbox, b.name) == (end.gearbox, branch.name)), None)
    if own is None:
        return np.zeros((len(branch.times), 4))
    axes = [entry[end.shaft] for entry in own.axes]
    motion = np.array([(*axis.shift(end.x), *axis.slope) for axis in axes])
    if own is branch:
        return motion
    return np.column_stack([np.interp(branch.times, own.times, column) for column in motion.T])


def worst_misalignments(
    solved: SolvedRig, branches: Sequence[Branch], every: Sequence[Branch], planned: bool
) -> Iterator[Extreme]:
    """Largest misalignment of every kind over some branches; of couplings one for each.

    branches : of which the largest is wanted; every : of all gearboxes, for the other shafts of the couplings
    planned : whether the case plans these branches
    """
    rig = solved.rig
    found = [(branch, misalignments(rig, branch, every)) for branch in branches]
    for quantity in MISALIGNMENTS:
        peaks = [
            Peak(float(values.max()), place, branch, int(values.argmax()))
            for branch, entries in found
            for place, values in entries[quantity].items()
        ]
        coupled = quantity.startswith("coupling_")
        groups = (
            dict.fromkeys(peak.place for peak in peaks) if coupled else dict.fromkeys([""] if peaks else [])
        )
        for group in groups:
            peak = max((p for p in peaks if not coupled or p.place == group), key=lambda p: p.value)
            yield Extreme(
                quantity=quantity,
                value=peak.value,
                place=peak.place,
                steady=_steady(solved, quantity, group),
                limit=limit_of(solved.case, quantity, peak.place),
                planned=planned,
                time=float(peak.branch.times[peak.at]),
                branch=peak.branch.name,
                phase=peak.branch.phases[peak.branch.phase[peak.at]].name,
            )


def limit_of(case: Case, quantity: Misalignment, place: str) -> float | None:
    """Limit of a misalignment [SI]; that of a coupling is its own."""
    if quantity in ("coupling_offset", "coupling_angle"):
        assert case.drivetrain is not None
        coupling = case.drivetrain.couplings[place]
        return coupling.radial_offset_maximum if quantity == "coupling_offset" else coupling.angle_maximum
    found: float | None = getattr(case.limits.alignment, f"{quantity}_maximum")
    return found


def _steady(solved: SolvedRig, quantity: Misalignment, coupling: str) -> float | None:
    """Largest steady value of the held stages, of one coupling where it is one's."""
    if quantity in ("coupling_offset", "coupling_angle"):
        states = [one.warm for warm in solved.warm for one in warm.couplings if one.coupling == coupling]
        found = [state.radial_offset if quantity == "coupling_offset" else state.angle for state in states]
    elif quantity in ("bearing_tilt", "bore_out_of_round"):
        bores = [bore for warm in solved.warm for bore in warm.bores]
        found = [bore.tilt if quantity == "bearing_tilt" else bore.out_of_round_share for bore in bores]
    else:
        meshes = [axes for warm in solved.warm for axes in warm.axes]
        found = [abs(axes.inclination if quantity == "axis_inclination" else axes.skew) for axes in meshes]
    return max(found, default=None)
