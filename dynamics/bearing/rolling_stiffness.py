"""Load distribution, displacement and linearised stiffness of a rolling bearing or a preloaded pair.

Rings stay round; they move against each other by a radial and an axial displacement. Every rolling element is pressed
by what the displacement takes off its space and gives its force back along its contact angle; the sum over the
elements (the sum that Sjoevall's integral stands for) balances the load. The elastic energy is a convex function of
the displacement, so a damped Newton iteration finds it from anywhere; its second derivative is the stiffness.
Balls change their contact angle with the load, rollers keep theirs. Source: T. A. Harris, Rolling Bearing Analysis,
chapters 6 and 7; ISO/TS 16281 without tilting.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from dynamics.bearing.protocol import BearingError, BearingNotConvergedError
from dynamics.bearing.rolling_contact import ContactLaw
from dynamics.bearing.rolling_elements import RollingElements

FloatArray = NDArray[np.float64]

MOST_ITERATIONS = 100
ACCURACY = 1e-9
"""Residual force over the load at which the iteration ends."""


@dataclass(frozen=True, kw_only=True)
class RowOfElements:
    """One row of rolling elements with its contact law.

    clearance : radial internal clearance as it runs, negative as radial preload [m]
    axial_offset : axial approach of the rings before any load, the preload of a pair [m]
    direction : +1 takes positive axial displacement up, -1 the other
    """

    elements: RollingElements
    law: ContactLaw
    clearance: float = 0.0
    axial_offset: float = 0.0
    direction: int = 1


@dataclass(frozen=True, kw_only=True)
class BearingStiffness:
    """Displacement and tangent stiffness at a load.

    radial_displacement, axial_displacement : inner against outer ring, clearance included [m]
    radial, axial : d(force) / d(displacement), the other displacement held [N/m]
    lateral : across the load in the radial plane [N/m]
    coupling : d(radial force) / d(axial displacement) [N/m]
    radial_load, axial_load : carried [N]; the axial one is above what was asked where the bearing is held axially
    largest_element_load : [N]
    loaded_elements : number that carry load
    held_axially : the axial load is less than the radial one induces; the bearing was taken as held by its partner
        with no end play
    """

    radial_displacement: float
    axial_displacement: float
    radial: float
    axial: float
    lateral: float
    coupling: float
    radial_load: float
    axial_load: float
    largest_element_load: float
    loaded_elements: int
    held_axially: bool


def bearing_stiffness(row: RowOfElements, radial: float, axial: float) -> BearingStiffness:
    """Stiffness of a single bearing under a radial and an axial load, not negative [N].

    Raises
    ------
    BearingError : axial load on a bearing of cylindrical rollers, whose flanges have no stiffness here
    BearingNotConvergedError : no displacement carries the load
    """
    if row.elements.roller and row.elements.contact_angle == 0.0 and axial > 0.0:
        raise BearingError(
            f"bearing stiffness: axial load = {axial:.6g} N: rollers without contact angle carry it by their flanges; "
            "give the radial load alone"
        )
    angled = row.elements.contact_angle > 0.0
    if angled:
        held = _solve((row,), radial, 0.0, free_axially=False)
        if held.axial_load > axial:
            return held
    free = axial > 0.0 or row.clearance < 0.0
    return _solve((row,), radial, axial, free_axially=free and not (row.elements.roller and not angled))


def preload_offset(row: RowOfElements, preload: float) -> float:
    """Axial approach [m] at which ``preload`` [N] presses the rings of one bearing of a pair together.

    Raises BearingError for a row without contact angle, which cannot be preloaded axially.
    """
    if row.elements.contact_angle == 0.0:
        raise BearingError(
            f"preload = {preload:.6g} N: a bearing without contact angle is not preloaded axially; preload an "
            "angular contact or tapered roller pair"
        )
    if preload <= 0.0:
        return 0.0

    def excess(approach: float) -> float:
        return float(_balance((row,), 0.0, approach).force[1]) - preload

    approach: float = brentq(excess, 0.0, 0.05 * row.elements.diameter, xtol=1e-13)
    return approach


def preloaded_pair(row: RowOfElements, preload: float, radial: float, axial: float) -> BearingStiffness:
    """Stiffness of two equal bearings set against each other with an axial preload [N] under a load of the pair [N].

    The rings are rigid against tilting: face to face and back to back are the same.

    Raises BearingError for a row without contact angle, BearingNotConvergedError where no displacement carries the load
    """
    offset = preload_offset(row, preload)
    pair = tuple(
        RowOfElements(
            elements=row.elements,
            law=row.law,
            clearance=row.clearance,
            axial_offset=offset,
            direction=direction,
        )
        for direction in (1, -1)
    )
    return _solve(pair, radial, axial, free_axially=True)


@dataclass(frozen=True)
class _Balance:
    """Energy, force (radial, axial) and its derivative at a displacement, with what the elements carry."""

    energy: float
    force: FloatArray
    tangent: FloatArray
    lateral: float
    element_loads: FloatArray


def _balance(rows: tuple[RowOfElements, ...], radial: float, axial: float) -> _Balance:
    energy, lateral = 0.0, 0.0
    force, tangent = np.zeros(2), np.zeros((2, 2))
    loads = []
    for row in rows:
        count = row.elements.count
        azimuth = 2.0 * math.pi / count * np.arange(count)
        cosine = np.cos(azimuth)
        shift = row.direction * axial + row.axial_offset
        approach, radial_share, axial_share, length = _approach(row, radial * cosine, shift)
        pressed = np.maximum(approach, 0.0)
        exponent = row.law.exponent
        load = row.law.stiffness * pressed**exponent
        slope = exponent * row.law.stiffness * pressed ** (exponent - 1.0)
        geometric = load / length
        energy += float(np.sum(load * pressed)) / (exponent + 1.0)
        along = load * radial_share
        force += (float(along @ cosine), row.direction * float(np.sum(load * axial_share)))
        k_rr = slope * radial_share**2 + geometric * axial_share**2
        k_ra = (slope - geometric) * radial_share * axial_share
        k_aa = slope * axial_share**2 + geometric * radial_share**2
        tangent[0, 0] += float(k_rr @ cosine**2)
        tangent[0, 1] += row.direction * float(k_ra @ cosine)
        tangent[1, 1] += float(np.sum(k_aa))
        lateral += float(k_rr @ np.sin(azimuth) ** 2)
        loads.append(load)
    tangent[1, 0] = tangent[0, 1]
    return _Balance(energy, force, tangent, lateral, np.concatenate(loads))


def _approach(
    row: RowOfElements, radial: FloatArray, axial: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Approach of the raceways at each element [m], its direction (radial, axial) and the length that turns it [m]."""
    angle = row.elements.contact_angle
    if row.elements.roller:
        ones = np.ones_like(radial)
        approach = (radial - 0.5 * row.clearance) * math.cos(angle) + axial * math.sin(angle)
        return approach, ones * math.cos(angle), ones * math.sin(angle), ones * math.inf
    distance = row.law.groove_distance
    across = distance * math.cos(angle) - 0.5 * row.clearance + radial
    along = distance * math.sin(angle) + axial
    length = np.hypot(across, along)
    return length - distance, across / length, along / length, length


def _solve(
    rows: tuple[RowOfElements, ...], radial: float, axial: float, *, free_axially: bool
) -> BearingStiffness:
    """Damped Newton iteration on the energy less the work of the load."""
    target = np.array([radial, axial if free_axially else 0.0])
    scale = float(np.linalg.norm(target))
    place = _start(rows[0], radial, axial, free_axially)
    state = _balance(rows, *place)
    active = np.array([True, free_axially])
    for _ in range(MOST_ITERATIONS):
        residual = np.where(active, target - state.force, 0.0)
        if float(np.linalg.norm(residual)) <= ACCURACY * max(scale, 1e-3):
            return _result(state, place, held=not free_axially and _angled(rows))
        place, state = _step(rows, place, state, residual, target, active)
    raise BearingNotConvergedError(
        f"bearing stiffness: no displacement carries {radial:.6g} N radial and {axial:.6g} N axial, residual "
        f"{float(np.linalg.norm(residual)):.3g} N; correct load, clearance or the rolling elements"
    )


def _step(
    rows: tuple[RowOfElements, ...],
    place: FloatArray,
    state: _Balance,
    residual: FloatArray,
    target: FloatArray,
    active: NDArray[np.bool_],
) -> tuple[FloatArray, _Balance]:
    tangent = state.tangent + 1e-9 * max(float(np.trace(state.tangent)), 1.0) * np.eye(2)
    step = np.zeros(2)
    chosen = np.ix_(active, active)
    step[active] = np.linalg.solve(tangent[chosen], residual[active])
    longest = 0.02 * rows[0].elements.diameter
    share = min(1.0, longest / max(float(np.max(np.abs(step))), 1e-30))
    value = state.energy - float(target @ place)
    descent = float(residual @ step)
    rounding = 1e-13 * (state.energy + abs(float(target @ place)))
    for _ in range(30):
        trial = place + share * step
        there = _balance(rows, *trial)
        if there.energy - float(target @ trial) <= value - 1e-4 * share * descent + rounding:
            break
        share *= 0.5
    return trial, there


def _start(row: RowOfElements, radial: float, axial: float, free_axially: bool) -> FloatArray:
    """Displacements at which the most loaded elements carry about the load."""
    law, count = row.law, row.elements.count
    angle = row.elements.contact_angle
    needed = (max(5.0 * radial / (count * math.cos(angle)), 0.0) / law.stiffness) ** (1.0 / law.exponent)
    start = 0.5 * max(row.clearance, 0.0) + needed if radial > 0.0 else 0.0
    along = 0.0
    if free_axially and axial > 0.0:
        sine = max(math.sin(angle), 0.2)
        along = (axial / (count * sine) / law.stiffness) ** (1.0 / law.exponent) / sine
        if angle == 0.0 and law.groove_distance > 0.0:
            gap = max(row.clearance, 0.0)
            along += math.sqrt(max(gap * law.groove_distance, 0.0))
    return np.array([start, along])


def _angled(rows: tuple[RowOfElements, ...]) -> bool:
    return len(rows) == 1 and rows[0].elements.contact_angle > 0.0


def _result(state: _Balance, place: FloatArray, *, held: bool) -> BearingStiffness:
    return BearingStiffness(
        radial_displacement=float(place[0]),
        axial_displacement=float(place[1]),
        radial=float(state.tangent[0, 0]),
        axial=float(state.tangent[1, 1]),
        lateral=state.lateral,
        coupling=float(state.tangent[0, 1]),
        radial_load=float(state.force[0]),
        axial_load=max(float(state.force[1]), 0.0),
        largest_element_load=float(np.max(state.element_loads)),
        loaded_elements=int(np.count_nonzero(state.element_loads > 0.0)),
        held_axially=held,
    )
