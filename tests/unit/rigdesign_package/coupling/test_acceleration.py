"""Accelerations of the coupling loop on an affine iteration x -> M x + c with a known fixed point."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rigdesign.base.errors import NotConvergedError
from rigdesign.coupling import fixed_point
from rigdesign.coupling import fixed_point as acceleration
from rigdesign.coupling.fixed_point import (
    Acceleration,
    Anderson,
    PlainRelaxation,
    Residual,
    ScaledTolerance,
    numbering,
    ordered,
    scaled,
    scaled_change,
    unscaled,
)
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.state import CouplingState, OperatingPoint

MATRIX = np.array([[0.9, 0.3, 0.0], [0.0, -0.7, 0.2], [0.1, 0.0, 0.5]])
OFFSET = np.array([30.0, 60.0, 20.0])
START = np.array([300.0, 0.0, 5.0])
TOLERANCE = ScaledTolerance(1e-6)


def state(vector: np.ndarray) -> CouplingState:
    """Two temperatures [K] and a heat, in units of the vector."""
    rest: Any = {}
    return CouplingState(
        gear_temperature={"a": vector[0], "b": vector[1]}, centre_distance=rest, bearing_clearance=rest,
        bearing_heat=rest, wall_heat={"s": 10.0 * vector[2]}, oil_outlet=rest, oil_supply={}, mesh_torque=rest,
        axial_expansion=rest,
    )  # fmt: skip


def solve(
    monkeypatch: pytest.MonkeyPatch, way: Acceleration, offset: np.ndarray = OFFSET
) -> tuple[IterationResult, list[Residual]]:
    """The fixed point by an acceleration."""

    def run_iteration(_: object, given: CouplingState, *__: object, **___: object) -> Any:
        after = state(MATRIX @ scaled(given) + offset)
        return SimpleNamespace(
            coupling_state=given, after=after, bearing_heat=after.bearing_heat, wall_heat=after.wall_heat
        )

    monkeypatch.setattr(fixed_point, "run_iteration", run_iteration)
    monkeypatch.setattr(fixed_point, "heat_residual", lambda *_: 0.0)
    monkeypatch.setattr(acceleration, "next_state", lambda _, done, __: done.after)
    problem: Any = SimpleNamespace(
        rig=None, parts=None, freeze=frozenset(), initial=state(START),
        point=OperatingPoint(stage="made up", speed=1.0, torque=1.0),
    )  # fmt: skip
    last, residuals = fixed_point.solve_fixed_point(problem, way, TOLERANCE, state(START))
    exact = np.linalg.solve(np.eye(3) - MATRIX, offset)
    assert scaled(last.coupling_state) == pytest.approx(exact, abs=1e-4)
    return last, list(residuals)


def test_anderson_ends_after_as_many_differences_as_there_are_numbers(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Three secants span an affine iteration of three numbers: the fifth iteration starts at its fixed point."""
    _, residuals = solve(monkeypatch, Anderson(state(START)))
    assert len(residuals) == 5


def test_newtons_method_with_the_exact_inverse_needs_one_step(monkeypatch: pytest.MonkeyPatch) -> None:
    inverse = np.linalg.inv(np.eye(3) - MATRIX)
    _, residuals = solve(monkeypatch, Anderson(state(START), inverse=inverse))
    assert len(residuals) == 2


def test_differences_of_a_neighbour_serve_a_changed_case(monkeypatch: pytest.MonkeyPatch) -> None:
    first = Anderson(state(START))
    solve(monkeypatch, first)
    _, residuals = solve(monkeypatch, Anderson(state(START), known=first.differences), 1.1 * OFFSET)
    assert len(residuals) == 2


def test_differences_beyond_the_depth_are_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    way = Anderson(state(START), depth=2)
    _, residuals = solve(monkeypatch, way)
    assert len(residuals) > 5 and way.differences.states.shape == (3, 2)


def test_plain_relaxation_reports_its_history_where_it_is_too_slow(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(NotConvergedError, match="'made up' did not converge in 40 iterations") as raised:
        solve(monkeypatch, PlainRelaxation())
    history = raised.value.history
    assert history["stage"] == "made up" and len(history["residuals"]) == 40
    temperatures = [row["temperature_K"] for row in history["residuals"]]
    assert temperatures[-1] / temperatures[-2] == pytest.approx(
        np.abs(np.linalg.eigvals(MATRIX)).max(), rel=0.01
    )


def test_a_state_survives_its_vector_and_the_order_of_its_names() -> None:
    given = state(START)
    assert scaled(unscaled(scaled(given), given)) == pytest.approx(START, rel=1e-15)
    assert list(numbering(given)) == [
        ("gear_temperature", "a"),
        ("gear_temperature", "b"),
        ("wall_heat", "s"),
    ]
    turned = CouplingState(**{**vars(given), "gear_temperature": {"b": 0.0, "a": 300.0}})
    assert list(ordered(turned, given).gear_temperature) == ["a", "b"]
    assert scaled_change(given, state(START + np.array([0.0, 0.5, 2.0]))) == pytest.approx(2.0)
    # of 1 MW and 1e5 N m no more than a share is asked: 10 W and 1 N m are below what its losses repeat to
    large = replace(given, wall_heat={"s": 1e6}, mesh_torque={"m": 1e5})
    moved = replace(given, wall_heat={"s": 1e6 + 500.0}, mesh_torque={"m": 1e5 + 20.0})
    assert scaled_change(large, moved) == pytest.approx(0.5)
