"""Growth of the teeth moves both flanks: half of the lost backlash comes off each of them."""

from dataclasses import replace

import pytest

from dynamics.gear.pair import GearPair
from rigdesign.case import load_case
from rigdesign.coupling.mesh_models import flank_expansion
from rigdesign.rig.model import build_rig


@pytest.fixture(scope="module")
def cold() -> GearPair:
    return build_rig(load_case("cases/uhcf_prototype"), "quick").pairs["test.main"]


def test_cold_teeth_have_not_grown(cold: GearPair) -> None:
    assert flank_expansion(cold, cold) == 0.0


def test_half_of_the_lost_backlash_is_approach_of_the_front_flank(cold: GearPair) -> None:
    """The middle of the play stays where it is: front contact comes as much earlier as back contact later."""
    warm = replace(cold, expansion=(1.2e-3, 0.9e-3))
    approach = flank_expansion(cold, warm)
    front, back = -approach, -warm.backlash_along_path - approach
    assert approach > 0.0
    assert front + back == pytest.approx(-cold.backlash_along_path, rel=1e-12)


def test_jammed_teeth_have_lost_no_more_than_their_backlash(cold: GearPair) -> None:
    jammed = replace(cold, expansion=(9e-3, 9e-3))
    assert jammed.backlash_along_path < 0.0
    assert flank_expansion(cold, jammed) == pytest.approx(0.5 * cold.backlash_along_path, rel=1e-12)
