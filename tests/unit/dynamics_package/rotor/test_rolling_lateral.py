"""Rolling bearing under a load vector: axes of the rig, axial direction, damping, refusals."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from dynamics.rotor.bearing import (
    Bearing,
    BearingError,
    BearingOperation,
    LateralCoefficients,
    LateralOperation,
    OilSupply,
)
from dynamics.rotor.rolling import RollingBearing
from dynamics.rotor.rolling_catalogue import catalogue_bearing
from dynamics.rotor.rolling_row import RowOfElements, contact_law, ring_load
from dynamics.rotor.rolling_state import rolling_lateral
from dynamics.rotor.rolling_stiffness import bearing_stiffness

LOADS = [("6208", 800.0), ("7208 B", 4000.0), ("30208", -2000.0), ("NU 208", 0.0), ("6208", -800.0)]


def row(designation: str, clearance: float = 0.0) -> RowOfElements:
    elements = catalogue_bearing(designation).elements
    return RowOfElements(elements=elements, law=contact_law(elements), clearance=clearance)


def at(bearing: RowOfElements, force: tuple[float, float], **more: Any) -> LateralCoefficients:
    return rolling_lateral(bearing, LateralOperation(force=force, **more))


def test_the_state_of_any_bearing_is_asked_alike() -> None:
    bearing: Bearing = RollingBearing(data=catalogue_bearing("6208"), clearance=10e-6)
    oil = OilSupply(
        inlet_temperature=323.15, flow=1e-5, viscosity=lambda t: 0.02, density=860.0, heat_capacity=1950.0
    )
    state = bearing.operating_state(BearingOperation(load=2500.0, axial_load=500.0, speed=300.0, oil=oil))
    found = state.lateral_coefficients(LateralOperation(force=(-2000.0, 1500.0), axial_force=500.0))
    alone = bearing_stiffness(row("6208", 10e-6), 2500.0, 500.0)
    assert found.regime == "elastic"
    assert found.position == pytest.approx(alone.radial_displacement * np.array([-0.8, 0.6]), rel=1e-9)
    assert found.axial_stiffness == pytest.approx(alone.axial, rel=1e-9)
    towards, across = np.array([-0.8, 0.6]), np.array([-0.6, -0.8])
    assert towards @ found.stiffness @ towards == pytest.approx(alone.radial, rel=1e-9)
    assert across @ found.stiffness @ across == pytest.approx(alone.lateral, rel=1e-9)
    assert across @ found.stiffness @ towards == pytest.approx(0.0, abs=1e-6 * alone.radial)
    moments = sorted(np.linalg.eigvalsh(found.tilting_stiffness))
    assert moments == pytest.approx(sorted([alone.tilting, alone.tilting_lateral]), rel=1e-6)


@pytest.mark.parametrize(("designation", "axial"), LOADS)
def test_all_directions_are_the_derivative_of_what_the_rings_carry(designation: str, axial: float) -> None:
    """Load along y, so that elements stand alike; the axis of the bearing (its z) is x of the rig."""
    bearing = replace(row(designation), direction=-1 if axial < 0.0 else 1)
    found = at(row(designation), (2000.0, 0.0), axial_force=axial)
    alone = bearing_stiffness(row(designation), 2000.0, abs(axial))
    place = np.array([found.position[0], 0.0, bearing.direction * alone.axial_displacement, 0.0, 0.0])
    carried = ring_load((bearing,), place).load
    assert carried[:2] == pytest.approx([2000.0, 0.0], abs=1e-3)
    if axial:
        assert carried[2] == pytest.approx(axial, rel=1e-6)
    order = [2, 0, 1, 3, 4]
    steps = np.array([1e-9, 1e-9, 1e-9, 1e-8, 1e-8])
    columns = []
    for index, step in enumerate(steps):
        ahead, behind = (
            ring_load((bearing,), place + sign * step * np.eye(5)[index]).load for sign in (1.0, -1.0)
        )
        columns.append((ahead - behind) / (2.0 * step))
    whole = np.array(columns).T[np.ix_(order, order)]
    scale = np.abs(found.node_stiffness).max()
    assert found.node_stiffness == pytest.approx(whole, rel=2e-4, abs=1e-6 * scale)
    assert found.stiffness == pytest.approx(found.node_stiffness[1:3, 1:3])


def test_the_load_turns_its_axes() -> None:
    """Eight elements, an eighth of a turn: the bearing stands alike."""
    bearing = replace(row("6208"), elements=replace(row("6208").elements, count=8))
    first, second = (
        at(bearing, (2000.0, 0.0)),
        at(bearing, (2000.0 * math.sqrt(0.5), 2000.0 * math.sqrt(0.5))),
    )
    about = np.array([[1.0, -1.0], [1.0, 1.0]]) * math.sqrt(0.5)
    scale = np.abs(first.stiffness).max()
    assert second.stiffness == pytest.approx(about @ first.stiffness @ about.T, abs=1e-9 * scale)
    assert second.position == pytest.approx(about @ first.position)


def test_sense_does_not_matter() -> None:
    first, second = (at(row("6208"), (1000.0, 500.0), sense=sense) for sense in (1, -1))
    assert second.node_stiffness == pytest.approx(first.node_stiffness)
    assert first.stiffness[0, 1] == pytest.approx(first.stiffness[1, 0])


def test_axial_direction_turns_the_coupling() -> None:
    """An angular contact bearing set the other way round couples radial and axial displacement with the other sign."""
    first, second = (at(row("7208 B"), (1000.0, 0.0), axial_force=force) for force in (2000.0, -2000.0))
    assert second.node_stiffness[0, 1] == pytest.approx(-first.node_stiffness[0, 1], rel=1e-6)
    assert first.node_stiffness[0, 1] > 0.0
    assert second.stiffness == pytest.approx(first.stiffness, rel=1e-6)


def test_structural_damping_is_the_callers() -> None:
    plain, damped = (at(row("NU 208"), (0.0, -3000.0), structural_damping=s) for s in (0.0, 1e-5))
    assert not plain.node_damping.any()
    assert damped.damping == pytest.approx(1e-5 * plain.stiffness)
    assert damped.node_damping == pytest.approx(1e-5 * plain.node_stiffness)


def test_flanges_of_rollers_have_no_stiffness() -> None:
    found = at(row("NU 208"), (3000.0, 0.0), axial_force=500.0)
    assert found.axial_stiffness == 0.0
    assert found.stiffness[0, 0] > 0.0


def test_nothing_holds_rings_without_load_and_preload() -> None:
    with pytest.raises(BearingError, match=r"clearance of 10 um.*preload"):
        at(row("6208", 10e-6), (0.0, 0.0))
    assert at(row("NU 208", -10e-6), (0.0, 0.0)).stiffness[0, 0] > 1e7
