"""Dwells on undamped resonances: what is refused, what is named, what is left alone."""

from dataclasses import replace

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.postprocessing.curves import LEAST_GAIN
from rigdesign.postprocessing.dynamics import numbered
from rigdesign.postprocessing.nearest_resonance import (
    LIGHTLY,
    UNDAMPED,
    held_crossings,
    light_dwells,
    require_damping,
)
from rigdesign.results.loads import ModeCrossing
from tests.builders.solved_loop import solved

RPM = 3500.0 * 3.141592653589793 / 30.0


def crossings(damping: float, off: float = 0.0, *, kind: str = "mesh") -> tuple[ModeCrossing, ...]:
    """One of the loop near its test speed."""
    found = solved().loads
    assert found is not None
    crossing: ModeCrossing = replace(
        found.loop_crossings[0],
        kind=kind,
        order_of="test",
        harmonic=2,
        speed=RPM * (1.0 + off),
        damping_ratio=damping,
    )
    return (crossing,)


def test_a_dwell_on_an_undamped_resonance_is_refused_with_mode_value_limit_and_remedy() -> None:
    with pytest.raises(CaseError) as error:
        require_damping(solved().rig, crossings(-0.0, 0.002))
    for part in (
        "stage test dwells at 3500 rpm", "order 2 of mesh test meets mode", "0.2 % away",
        "damping ratio is 0, limit 0.0001", "torsional_damping of splines",
    ):  # fmt: skip
        assert part in str(error.value)


def test_a_mode_that_grows_is_no_resonance_without_damping() -> None:
    """Its damping ratio keeps its sign, and more damping of the meshes is no remedy."""
    with pytest.raises(CaseError) as error:
        require_damping(solved().rig, (*crossings(0.0), *crossings(-0.012, 0.005)))
    text = str(error.value)
    assert "on an unstable mode" in text and "damping ratio is -0.012" in text
    assert "internal damping of shafts" in text and "damping of the meshes" not in text


def test_crossings_before_the_dynamic_work_are_those_of_the_loads_up_to_the_highest_dwell() -> None:
    found = solved()
    assert found.run is not None and found.loads is not None
    early = held_crossings(found.rig, found.run.test)
    assert early and set(early) <= set(found.loads.loop_crossings)
    assert max(one.speed for one in early) <= 1.02 * RPM


@pytest.mark.parametrize(
    ("damping", "off", "kind"),
    [(2.0 * UNDAMPED, 0.0, "mesh"), (0.0, 0.02, "mesh"), (0.0, 0.0, "shaft")],
)
def test_a_little_damping_distance_or_an_order_of_a_shaft_is_no_fault(
    damping: float, off: float, kind: str
) -> None:
    require_damping(solved().rig, crossings(damping, off, kind=kind))


def test_a_mode_that_no_mesh_excites_is_no_crossing_of_its_order() -> None:
    loads = solved().loads
    assert loads is not None
    meshes = [crossing for crossing in loads.loop_crossings if crossing.kind == "mesh"]
    assert all(crossing.gain >= LEAST_GAIN for crossing in meshes)
    reached = max(crossing.frequency for crossing in meshes)
    gain = {
        number: max(mode.mesh_gain)
        for number, mode in numbered(loads.modes)
        if 0.0 < mode.frequency < reached
    }
    assert {crossing.mode for crossing in meshes} == {
        number for number, most in gain.items() if most >= LEAST_GAIN
    } | {crossing.mode for crossing in meshes if crossing.frequency == reached}
    assert min(gain.values()) < LEAST_GAIN


def test_next_to_no_damping_is_found_and_that_of_the_shipped_rig_is_not() -> None:
    (found,) = light_dwells(solved().rig, crossings(0.5 * LIGHTLY), LIGHTLY)
    assert found.stage == "test" and found.distance == pytest.approx(0.0, abs=1e-12)
    assert not list(light_dwells(solved().rig, crossings(2.0 * LIGHTLY), LIGHTLY))
    shipped = solved().loads
    assert shipped is not None and not list(light_dwells(solved().rig, shipped.loop_crossings, LIGHTLY))
