"""Rows of a mesh in six degrees of freedom: they see nothing of a rig that moves as one, so that its forces balance."""

import numpy as np
import pytest

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.craig_bampton import ROWS, approach_row, mesh_directions, wrench_rows
from tests.builders.elastic_rig import motion_of_all
from tests.unit.dynamics_package.rotor.test_mesh_rows import CASES, turned_rig


@pytest.mark.parametrize(("sense", "angle", "helix"), CASES)
def test_a_rig_that_moves_as_a_whole_shows_in_no_row(sense: int, angle: float, helix: float) -> None:
    """By virtual work the forces on the rows put neither force nor moment on the foundation."""
    model = assemble_rig(turned_rig(sense, angle, helix))
    rng = np.random.default_rng(7)
    for mesh in ("test", "reference"):
        rows = wrench_rows(model, mesh)
        for _ in range(3):
            motion = motion_of_all(model, rng.normal(size=3), rng.normal(size=3))
            for name, row in zip(ROWS, rows, strict=True):
                assert row @ motion == pytest.approx(0.0, abs=1e-12), name


@pytest.mark.parametrize(("sense", "angle", "helix"), CASES)
@pytest.mark.parametrize("face", ["front", "back"])
def test_tilt_is_what_the_approach_grows_by_over_the_face(
    sense: int, angle: float, helix: float, face: str
) -> None:
    model = assemble_rig(turned_rig(sense, angle, helix))
    for mesh in ("test", "reference"):
        at = [approach_row(model, mesh, face, position) for position in (0.0, 0.004)]  # type: ignore[arg-type]
        tilt = wrench_rows(model, mesh)[ROWS.index(f"{face} tilt")]
        z_per_x = -sense * np.sign(helix) if helix else 1.0
        assert tilt * z_per_x * 0.004 == pytest.approx(at[1] - at[0], abs=1e-15)


def test_slide_is_that_of_the_pitch_point() -> None:
    """Both flanks at the pitch point: the material of the pinion over that of the wheel across the normal."""
    model = assemble_rig(turned_rig(1, 0.4, 0.0))
    rows = dict(zip(ROWS, wrench_rows(model, "test"), strict=True))
    connection = model.rig.mesh("test")
    directions = mesh_directions(model.rig, "test")
    sine, cosine = np.sin(directions.pressure_angle), np.cos(directions.pressure_angle)
    across = sine * directions.passing - cosine * directions.centre_line
    motion = np.random.default_rng(1).normal(size=model.size)
    pinion, wheel = model.rows(connection.pinion) @ motion, model.rows(connection.wheel) @ motion
    senses = [
        model.rig.placement(model.rig.drivetrain.gear(gear).shaft).sense
        for gear in (connection.pinion, connection.wheel)
    ]
    velocity = []
    middle = 0.5 * sum(model.freedoms.place(gear).x for gear in (connection.pinion, connection.wheel))
    for body, sense, sign, radius, gear in zip(
        (pinion, wheel),
        senses,
        (1.0, -1.0),
        directions.radii,
        (connection.pinion, connection.wheel),
        strict=True,
    ):
        arm = sign * radius * directions.centre_line
        arm[0] = middle - model.freedoms.place(gear).x
        spin = np.array([sense * body[3], body[4], body[5]])
        velocity.append(body[:3] + np.cross(spin, arm))
    expected = across @ (velocity[0] - velocity[1])
    rolls = [radius * sine for radius in directions.radii]
    seen = {name: row @ motion for name, row in rows.items()}
    assert seen["pinion turn"] * rolls[0] - seen["wheel turn"] * rolls[1] + seen["slide"] == pytest.approx(
        expected
    )
