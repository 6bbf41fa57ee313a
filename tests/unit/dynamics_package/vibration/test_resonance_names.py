"""Peaks of the torque over speed get the name of what their mesh excites, and of nothing else."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.rating.dynamic_factor import Resonance
from dynamics.rotor.torsional_modes import LoopMode
from dynamics.vibration.response_curve import ResponseCurve
from rigdesign.postprocessing.resonances import name_of

TEETH = 99
RPM = math.pi / 30.0


def mode(name: str, frequency: float, gain: float, damping_ratio: float = 0.02) -> LoopMode:
    return LoopMode(
        frequency=frequency,
        damping_ratio=damping_ratio,
        name=name,
        energy={},
        mesh_gain=np.array([0.0, gain]),
    )


def named(
    modes: list[LoopMode], rpm: float = 2400.0, orders: tuple[float, ...] = (60.0, 20.0, 5.0, 1.0)
) -> Any:
    """Name of a peak of mesh 1 at 2400 rpm (mesh frequency 3960 Hz) on a grid of 20 rpm."""
    speeds = np.arange(2300.0, 2501.0, 20.0) * RPM
    harmonics = np.array([[180.0, *orders], [180.0, *orders]])
    points: Any = tuple(SimpleNamespace(speed=speed, harmonics=harmonics) for speed in speeds)
    peak = Resonance(
        mesh=1,
        speed=rpm * RPM,
        factor=1.3,
        amplitude=60.0,
        force_share=0.3,
        amplification=3.0,
        lift_off_share=0.0,
    )
    return name_of(peak, ResponseCurve(points=points, failed=()), 1, TEETH, modes)


def test_the_mode_that_the_mesh_excites_most_gives_the_name() -> None:
    found = named([mode("weak", 3960.0, 0.2), mode("strong", 3950.0, 1.5), mode("second", 7900.0, 1.6)])
    assert found == ("strong", 3950.0, 1)


def test_a_mode_the_mesh_does_not_excite_gives_none() -> None:
    name, frequency, order = named([mode("far shaft", 3960.0, 0.001)])
    assert (name, order) == ("no single mode", 1)
    assert frequency == pytest.approx(3960.0)


def test_a_mode_far_beyond_its_line_width_gives_none() -> None:
    assert named([mode("elsewhere", 5000.0, 2.0)])[0] == "no single mode"
    assert named([mode("beside", 4300.0, 2.0)])[0] == "near beside"
    assert named([mode("broad", 4300.0, 2.0, damping_ratio=0.1)])[0] == "broad"


def test_an_order_that_is_not_there_names_nothing() -> None:
    """Order 4 meets a mode, but hardly any of the torque is of that order."""
    assert named([mode("fourth", 4 * 3960.0, 2.0)], orders=(60.0, 20.0, 5.0, 1.0))[0] == "no single mode"
    assert named([mode("fourth", 4 * 3960.0, 2.0)], orders=(10.0, 5.0, 5.0, 9.0)) == ("fourth", 4 * 3960.0, 4)
