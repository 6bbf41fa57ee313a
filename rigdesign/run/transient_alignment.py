"""Alignment over the thermal course: bearings, bores, axes and couplings at every time, and their worst moments."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from rigdesign.case.model import Case
from rigdesign.coupling.alignment import ALIGNMENT, CouplingEnd, CouplingPlace, coupling_places
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.transient import WorstMoment
from rigdesign.rig.model import Rig
from rigdesign.transient.branch import Branch

FloatArray = NDArray[np.float64]
Misalignment = Literal[
    "bearing_tilt", "bore_out_of_round", "axis_inclination", "axis_skew", "coupling_offset", "coupling_angle"
]
MISALIGNMENTS: tuple[Misalignment, ...] = get_args(Misalignment)
UNITS: Mapping[Misalignment, tuple[str, float]] = {
    "bearing_tilt": ("mrad", 1e3),
    "bore_out_of_round": ("-", 1.0),
    "axis_inclination": ("um", 1e6),
    "axis_skew": ("um", 1e6),
    "coupling_offset": ("mm", 1e3),
    "coupling_angle": ("mrad", 1e3),
}
"""Unit in the result and its number per SI."""


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
    """Quantity -> place -> (n,) values of a branch in the units of the result.

    branches : of all gearboxes; one of the same name tells of the other shaft of a coupling
    """
    found: dict[Misalignment, dict[str, FloatArray]] = {
        quantity: {
            place: UNITS[quantity][1] * np.array([entry[quantity][place] for entry in branch.alignment])
            for place in branch.alignment[0][quantity]
        }
        for quantity in ALIGNMENT
    }
    places = [place for place in coupling_places(rig) if place.gearbox == branch.gearbox]
    motions = {place.name: _coupling(place, branch, branches) for place in places}
    found["coupling_offset"] = {
        name: UNITS["coupling_offset"][1] * np.hypot(m[:, 0], m[:, 1]) for name, m in motions.items()
    }
    found["coupling_angle"] = {
        name: UNITS["coupling_angle"][1] * np.hypot(m[:, 2], m[:, 3]) for name, m in motions.items()
    }
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
) -> Iterator[WorstMoment]:
    """Largest misalignment of every kind over some branches; of couplings one for each."""
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
            limit = limit_of(solved.case, quantity, peak.place)
            yield WorstMoment(
                quantity=quantity,
                value=peak.value,
                unit=UNITS[quantity][0],
                place=peak.place,
                steady=_steady(solved, quantity, group),
                limit=None if limit is None else UNITS[quantity][1] * limit,
                planned=planned,
                time_s=float(peak.branch.times[peak.at]),
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
    rows = {
        "bearing_tilt": [row["tilt_mrad"] for expansion in solved.expansion for row in expansion.bores],
        "bore_out_of_round": [
            row["out_of_round_share"] for expansion in solved.expansion for row in expansion.bores
        ],
        "axis_inclination": [
            abs(row["inclination_um"]) for expansion in solved.expansion for row in expansion.axes
        ],
        "axis_skew": [abs(row["skew_um"]) for expansion in solved.expansion for row in expansion.axes],
    }
    if quantity in rows:
        return max(rows[quantity], default=None)
    key = "offset_hot_mm" if quantity == "coupling_offset" else "angle_hot_mrad"
    coupled = (
        row for expansion in solved.expansion for row in expansion.couplings if row["coupling"] == coupling
    )
    return max((row[key] for row in coupled), default=None)
