"""The variant of the prototype whose bearings stand on the meshed housing and whose test gears give on their seats.

Under a unit force between the flanks of the test gears, without the film, the approach grows by what the seats take.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.bearing_state import RunningState, isotropic_bearing
from dynamics.rotor.craig_bampton import approach_row
from dynamics.rotor.rotor_model import ElasticRig
from rigdesign import load_case
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES
from tests.builders.static_deflection import static_deflection

pytestmark = pytest.mark.slow
FOLDER = CASES / "uhcf_prototype"
MESH = "test.main"
BEARING = 1e8
"""Of every bearing, P2, Table 1 [N/m]."""


@cache
def variant() -> Rig:
    return build_rig(load_case(FOLDER / "elastic_seats.toml"), "standard")


def pressed(elastic: ElasticRig, bearings: Sequence[str]) -> tuple[float, np.ndarray]:
    """Approach of the flanks under 1 N [m], and the lateral forces of some bearings, (2 k,) [N]."""
    model = assemble_rig(elastic)
    row = approach_row(model, MESH)
    names = [bearing.name for bearing in elastic.drivetrain.bearings]
    state = RunningState(bearings={name: isotropic_bearing(BEARING) for name in names})
    deflection = static_deflection(model, state, row).deflection
    return float(row @ deflection), BEARING * np.concatenate(
        [model.ports[b][:2] @ deflection for b in bearings]
    )


def test_seats_of_the_gears_are_in_series_with_the_teeth() -> None:
    """Both gears shift on their seats by F / k_r along the line of action; spur teeth tilt neither."""
    elastic = variant().elastic.rig
    gears = {gear.name: gear for gear in elastic.drivetrain.gears}
    seats = [gears[f"test.{name}"].seat for name in ("pinion", "wheel")]
    stated = [gear.spline for gear in variant().case.gearboxes["test"].gears.values()]
    assert [seat.lateral for seat in seats if seat] == [
        spline.radial_stiffness for spline in stated if spline
    ]
    fast = [replace(gear, seat=None) for gear in gears.values()]
    stiff = replace(elastic, drivetrain=replace(elastic.drivetrain, gears=tuple(fast)))
    expected = sum(1.0 / seat.lateral for seat in seats if seat)
    assert pressed(elastic, ["test.pinion_front"])[0] - pressed(stiff, ["test.pinion_front"])[
        0
    ] == pytest.approx(expected, rel=1e-6)


def test_the_housing_is_in_series_with_its_bearings() -> None:
    """Approach more by the work of the bearing forces on the seats, f' H f; couplings redistribute little of them.

    Walls of 1e9 to 2e10 N/m take 0.5 to 10 % of what bearings of 1e8 N/m take.
    """
    elastic = variant().elastic.rig
    (support,) = elastic.supports
    seats = np.linalg.inv(support.stiffness)
    across = np.array([3 * i + j for i in range(len(support.bearings)) for j in (0, 1)])
    stiff, _ = pressed(replace(elastic, supports=()), support.bearings)
    soft, forces = pressed(elastic, support.bearings)
    work = forces @ seats[np.ix_(across, across)] @ forces
    assert soft - stiff == pytest.approx(work, rel=0.02)
    assert 0.005 < work / (forces @ forces / BEARING) < 0.1
