"""What a rig with bending shafts leaves out of its lateral excitation."""

from types import SimpleNamespace
from typing import Any

from rigdesign import load_case
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop_system import loop_system
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import build_rig
from rigdesign.run.warnings import _only_for_bending, not_modelled
from tests.builders.paths import CASES
from tests.builders.twisting import twisting_rig


def items(**keys: object) -> list[str]:
    """Of the prototype with analytic teeth in its initial state."""
    values = {"drivetrain.mesh_stiffness": "iso_6336_scaled"} | {
        key.replace("__", "."): value for key, value in keys.items()
    }
    rig = build_rig(load_case(CASES / "uhcf_prototype").with_values(values), "standard")
    (point, *_) = held_points(rig)
    state = initial_state(rig, point)
    last = SimpleNamespace(
        models=mesh_models(rig, point, state),
        system=loop_system(rig, point, state, solve_bearings(rig, point, state)),
        fields={},
    )
    solved: Any = SimpleNamespace(
        case=rig.case, rig=rig, run=object(), points=[SimpleNamespace(point=point, last=last)]
    )
    return not_modelled(solved)


def test_unbalance_is_left_out_of_the_periodic_response_alone() -> None:
    found = [item for item in items() if "unbalance" in item]
    assert len(found) == 1
    assert "test_pinion, test_wheel" in found[0] and "in the periodic response" in found[0]
    assert "the time run, the events and the lateral vibration include them" in found[0]
    over_a_turn = items(numerics__response_period="revolution")
    assert not any("test_pinion, test_wheel" in item for item in over_a_turn)


def test_couplings_out_of_line_lack_their_alternating_forces_alone() -> None:
    assert not any("misaligned couplings" in item for item in items())
    bent = items(drivetrain__couplings__pinion_side__cold_offset_lateral="0.1 mm")
    assert any(
        "alternating forces of misaligned couplings" in item and "constant force" in item for item in bent
    )


def test_keys_that_only_bending_shafts_read_are_named_where_shafts_only_twist() -> None:
    """elastic_seats.toml gives there what case.toml gives, so it says that it does."""
    case = load_case(CASES / "uhcf_prototype" / "elastic_seats.toml")
    twisting, bending = (
        list(_only_for_bending(SimpleNamespace(case=case, rig=rig)))  # type: ignore[arg-type]
        for rig in (twisting_rig(case), build_rig(case, "quick"))
    )
    assert bending == []
    assert "gearboxes.test.housing.bearing_seats" in twisting[0]
    assert "gearboxes.test.gears.wheel.spline.radial_stiffness" in twisting[0]
    assert "without effect in this run" in twisting[0]
