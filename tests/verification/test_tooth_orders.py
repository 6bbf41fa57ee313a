"""What single teeth leave in the spectrum of a revolution: nothing, sidebands, or their own orders."""

import numpy as np
import pytest

from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.steady_motion import (
    PeriodicResponse,
    TimeSettings,
    period_length,
    periodic_by_time,
)
from tests.builders.mesh import BASE_RADIUS_1, BASE_RADIUS_2, chain, spur_law

TEETH = 20
"""Few teeth keep the turn short."""


def law(**changes: object) -> MeshLaw:
    pitch = 2.0 * np.pi * BASE_RADIUS_1 / TEETH
    base = spur_law(n_slices=1)
    scaled = base._replace(
        base_pitch=pitch, teeth_1=TEETH, teeth_2=TEETH, base_radius_2=BASE_RADIUS_1,
        path_start=base.path_start * 99 / TEETH, path_step=base.path_step * 99 / TEETH, damping=4e3,
    )  # fmt: skip
    return scaled._replace(**changes)  # type: ignore[arg-type]


def orders(laws: MeshLaw) -> tuple[np.ndarray, PeriodicResponse]:
    """Amplitudes of the dynamic torque over the orders of the pinion shaft, and the response."""
    system = chain(2, joint=(1e6, 100.0), bearing=0.02)
    response = periodic_by_time(
        system,
        [laws],
        speed=900.0,
        load=LoopLoad(torque=100.0),
        settings=TimeSettings(period="revolution", tolerance=1e-5, longest_time=6.0),
    )
    assert response.steady, response.warnings
    return 2.0 * np.abs(np.fft.rfft(response.torque[0])) / response.torque.shape[1], response


def test_equal_teeth_give_mesh_orders_only() -> None:
    amplitude, _ = orders(law())
    mesh = np.zeros(len(amplitude), bool)
    mesh[::TEETH] = True
    assert amplitude[TEETH] > 5.0
    assert amplitude[~mesh].max() < 1e-6 * amplitude[TEETH]


def test_one_pitch_error_gives_first_order_sidebands() -> None:
    n_path = law().stiffness.shape[1]
    deviation = np.zeros((TEETH, n_path))
    deviation[4] = 3e-6
    amplitude, _ = orders(law(deviation_1=deviation))
    without, _ = orders(law())
    sidebands = amplitude[[TEETH - 1, TEETH + 1]]
    # one of the two may lie near a zero of the loop
    assert np.linalg.norm(sidebands) > 5e-4 * amplitude[TEETH]
    assert sidebands.min() > 1e3 * without[[TEETH - 1, TEETH + 1]].max()
    assert amplitude[1] > 1e3 * without[1]


def test_the_error_comes_once_per_turn_where_its_tooth_meshes() -> None:
    n_path = law().stiffness.shape[1]
    deviation = np.zeros((TEETH, n_path))
    deviation[4] = 3e-6
    _, response = orders(law(deviation_1=deviation))
    _, smooth = orders(law())
    change = np.abs(response.torque[0] - np.interp(response.angle_1[0], smooth.angle_1[0], smooth.torque[0]))
    angle = np.mod(response.angle_1[0], 2.0 * np.pi) * TEETH / (2.0 * np.pi)
    assert 2.5 < angle[np.argmax(change)] < 6.0


def test_wheel_tooth_shows_on_the_hunting_cycle_only() -> None:
    assert period_length([law()], [1.0], "mesh") == pytest.approx(1.0 / TEETH)
    assert period_length([law()], [1.0], "revolution") == 1.0
    assert period_length([law()._replace(teeth_2=24)], [1.0], "hunting_cycle") == 6.0
    assert period_length([spur_law(base_radius_2=BASE_RADIUS_2)], [1.0], "hunting_cycle") == 34.0
