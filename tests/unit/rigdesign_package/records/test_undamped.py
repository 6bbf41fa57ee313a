"""Dwells on undamped resonances: what is refused, what is named, what is left alone."""

from dataclasses import replace

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.records.undamped import LIGHTLY, UNDAMPED, light_dwells, require_damping
from rigdesign.results.loads import DynamicLoads, ModeCrossing
from tests.builders.solved_loop import solved

RPM = 3500.0 * 3.141592653589793 / 30.0


def loads(damping: float, off: float = 0.0, *, excited: bool = True, kind: str = "mesh") -> DynamicLoads:
    """Those of the loop with one crossing near its test speed."""
    found = solved().loads
    assert found is not None
    crossing: ModeCrossing = replace(
        found.loop_crossings[0],
        kind=kind,
        order_of="test",
        harmonic=2,
        speed=RPM * (1.0 + off),
        damping_ratio=damping,
        excited=excited,
    )
    return replace(found, loop_crossings=(crossing,))


def test_a_dwell_on_an_undamped_resonance_is_refused_with_mode_value_limit_and_remedy() -> None:
    with pytest.raises(CaseError) as error:
        require_damping(solved().rig, loads(-0.0, 0.002))
    for part in (
        "stage test dwells at 3500 rpm", "order 2 of mesh test meets mode", "0.2 % away",
        "damping ratio is 0, limit 0.0001", "torsional_damping of splines",
    ):  # fmt: skip
        assert part in str(error.value)


@pytest.mark.parametrize(
    ("damping", "off", "excited", "kind"),
    [
        (2.0 * UNDAMPED, 0.0, True, "mesh"),
        (0.0, 0.02, True, "mesh"),
        (0.0, 0.0, False, "mesh"),
        (0.0, 0.0, True, "shaft"),
    ],
)
def test_a_little_damping_distance_or_a_mode_that_no_mesh_excites_is_no_fault(
    damping: float, off: float, excited: bool, kind: str
) -> None:
    require_damping(solved().rig, loads(damping, off, excited=excited, kind=kind))


def test_next_to_no_damping_is_found_and_that_of_the_shipped_rig_is_not() -> None:
    (found,) = light_dwells(solved().rig, loads(0.5 * LIGHTLY), LIGHTLY)
    assert found.stage == "test" and found.distance == pytest.approx(0.0, abs=1e-12)
    assert not list(light_dwells(solved().rig, loads(2.0 * LIGHTLY), LIGHTLY))
    shipped = solved().loads
    assert shipped is not None and not list(light_dwells(solved().rig, shipped, LIGHTLY))
