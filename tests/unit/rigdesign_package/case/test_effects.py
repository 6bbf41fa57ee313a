"""What a key moves, as it states it or a table above it does."""

from rigdesign.case.fields import Effect
from rigdesign.case.model import Case
from rigdesign.case.paths import effects_at
from rigdesign.studies.modified_rig import parts_of, through_heat


def test_a_key_adds_its_own_effect_to_that_of_its_table() -> None:
    limits, dangerous = effects_at(Case, "limits.dynamics.dangerous_force_share")
    assert limits == Effect(checks=(), solved=())
    assert dangerous == Effect(checks=("resonance limits",), solved=("curves",))


def test_what_a_key_does_not_say_its_table_says() -> None:
    assert parts_of("oils.mine.scuffing_load_stage") == ()
    assert through_heat("oils.mine.scuffing_load_stage")


def test_an_item_of_a_list_has_the_effects_of_its_keys_by_name_and_number() -> None:
    for item in ("dwell", "3"):
        assert parts_of(f"schedule.stages.{item}.duration") == ("time run",)


def test_every_kind_of_a_table_says_the_same_of_a_key() -> None:
    for key in ("axial_play", "locating", "friction_factor"):
        assert len(effects_at(Case, f"gearboxes.test.bearings.front.{key}")) == 1


def test_an_unknown_key_has_no_effect_of_its_own() -> None:
    assert effects_at(Case, "a.key.nobody.has.thought.of") == ()
