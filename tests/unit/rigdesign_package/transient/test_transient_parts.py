"""Parts of the thermal history: phases, conditions between two points, oil as unknown, soak, checks."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case import load_case
from rigdesign.case.model import Case
from rigdesign.checks.transient import checks as transient_checks
from rigdesign.coupling.state import OperatingPoint
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.thermal import Extreme, HistoryExtremes
from rigdesign.rig.model import build_rig
from rigdesign.transient.heating import blended
from rigdesign.transient.oil import at_least
from rigdesign.transient.phases import Phase, event_phases, running_phases, schedule_phases
from rigdesign.transient.soak import Soak, first_broken, shortest, soak_of
from tests.builders.paths import CASES
from tests.builders.two_blocks import law
from thermal.conditions.boundary import BodySource, Film, SurfaceSource
from thermal.conditions.streams import Stream, StreamNetwork, Supply, Volume, VolumeFilm, check_networks

BASE = (CASES / "uhcf_prototype" / "case.toml").as_posix()
RPM = np.pi / 30.0


def case_with(tmp_path: Path, text: str = "") -> Case:
    file = tmp_path / "case.toml"
    file.write_text(f'extends = "{BASE}"\nname = "course"\n{text}')
    return load_case(file)


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Case:
    return case_with(tmp_path_factory.mktemp("case"), '[transient]\nwarm_up = "2 h"\nstop_time = "20 s"\n')


def test_the_planned_history_is_the_schedule_with_warm_up_and_soak_back(case: Case) -> None:
    phases = schedule_phases(case)
    names = [phase.name for phase in phases]
    assert names == [
        "warm_up", "bracing to full_torque", "test", "relief to to_standstill", "oil_run_on", "soak_back",
    ]  # fmt: skip
    by_name = dict(zip(names, phases, strict=True))
    assert by_name["warm_up"].duration == 7200.0 and by_name["warm_up"].speed(10.0) == 0.0
    assert by_name["test"].duration == case.test_plan.time and by_name["test"].held
    assert by_name["bracing to full_torque"].duration == pytest.approx(10.5)
    assert [phase.oil for phase in phases] == [True] * 5 + [False]


def test_speed_and_torque_change_evenly_between_the_ends_of_a_stage(case: Case) -> None:
    """Half-way through the run-up from 750 to 12,000 rpm (2 s to 10 s of the ramp): 6375 rpm on half torque."""
    ramp = running_phases(case)[0]
    assert ramp.speed(6.0) == pytest.approx(6375.0 * RPM)
    before, after, share = ramp.between(6.0)
    torque = (1.0 - share) * before.point.torque + share * after.point.torque
    assert torque == pytest.approx(90.0)
    assert ramp.speed(ramp.duration) == pytest.approx(12000.0 * RPM)
    assert [knot.time for knot in ramp.knots] == sorted(knot.time for knot in ramp.knots)


def test_events_start_where_they_happen(case: Case) -> None:
    dwell = next(phase for phase in running_phases(case) if phase.held)
    stop = event_phases(case, "emergency_stop", dwell)
    assert [(p.name, p.oil) for p in stop] == [
        ("emergency_stop", True), ("oil_run_on", True), ("soak_back", False),
    ]  # fmt: skip
    assert stop[0].speed(0.0) == dwell.speed(0.0) and stop[0].speed(20.0) == 0.0
    loss = event_phases(case, "oil_loss", dwell)
    assert [(p.name, p.oil) for p in loss] == [
        ("oil_loss", False), ("emergency_stop", False), ("soak_back", False),
    ]  # fmt: skip
    assert loss[0].speed(5.0) == dwell.speed(0.0)
    cold = event_phases(case, "cold_start", dwell)
    assert [p.name for p in cold] == ["bracing to full_torque", "test"]


def test_a_falling_speed_belongs_to_the_stage_it_comes_from(case: Case) -> None:
    """A given loss follows the speed of its stage; towards standstill that of the stage before."""
    ramp = running_phases(case)[-1]
    inner = [knot.point for knot in ramp.knots if 0.0 < knot.point.speed < 750.0 * RPM * 0.999]
    assert inner and {point.stage for point in inner} == {"to_start_torque"}


def network(flow: float, past: float, temperature: float, share: float) -> StreamNetwork:
    streams = [Stream(source="feed", target="oil", mass_flow=flow)]
    if past:
        streams.append(Stream(source="feed", target="oil", mass_flow=past, kind="past"))
    return StreamNetwork(
        specific_heat=2000.0,
        volumes=(Volume(name="oil", power=100.0 * flow),),
        supplies=(Supply(name="feed", temperature=temperature),),
        films=(
            VolumeFilm(
                surface="wall", volume="oil", kind="oil", law=law(100.0 * share), supply="feed", supply_share=share
            ),
        ),
        streams=(*streams, Stream(source="oil", target=None, mass_flow=flow + past)),
    )  # fmt: skip


def test_conditions_between_two_points_are_in_proportion() -> None:
    first = [
        Film(surface="a", kind="air", fluid_temperature=300.0, law=law(10.0)),
        network(1.0, 0.0, 300.0, 0.5),
    ]
    second = [
        Film(surface="a", kind="air", fluid_temperature=320.0, law=law(30.0)),
        network(1.0, 2.0, 340.0, 1.0),
        SurfaceSource(surface="rim", power=400.0, kind="mesh_loss"),
        BodySource(body="gear", power=40.0, kind="windage"),
    ]
    found = blended(first, second, 0.25)
    film, oil, rim, gear = found
    assert isinstance(film, Film) and isinstance(oil, StreamNetwork)
    assert film.fluid_temperature == 305.0 and film.law(350.0, 305.0).value == pytest.approx(15.0)
    assert (rim.power, gear.power) == (100.0, 10.0)  # type: ignore[union-attr]
    assert oil.supplies[0].temperature == 310.0
    assert oil.films[0].supply_share == 0.625
    assert oil.films[0].law(350.0, 305.0).value == pytest.approx(62.5)
    assert [s.mass_flow for s in oil.streams] == [1.0, 1.5, 0.5]
    check_networks([oil])
    assert blended(second, first, 0.75)[2].power == 100.0  # type: ignore[union-attr]


def test_a_film_without_partner_is_refused() -> None:
    film = Film(surface="a", kind="air", fluid_temperature=300.0, law=law(10.0))
    with pytest.raises(KeyError, match="no partner"):
        blended([film], [], 0.5)


def test_still_air_is_a_floor_without_the_warnings_of_the_law_below_it() -> None:
    slow = at_least(law(2.0, warning="too slow"), 5.0)(350.0, 300.0)
    assert (slow.value, slow.formula, slow.warnings) == (5.0, "still_film", ())
    fast = at_least(law(50.0, warning="fast"), 5.0)(350.0, 300.0)
    assert (fast.value, fast.warnings) == (50.0, ("fast",))


def branch(case: Case, name: str, backlash: list[float], phases: tuple[Phase, ...]) -> Any:
    """A history whose backlash [m] is given: one time in the warm-up for each but the last three."""
    others = {key: {"x": 1.0} for key in ("seal_gap", "axial_play", "bearing_clearance", "tip_clearance")}
    held = [phase.name for phase in phases].index("test")
    numbers = [0] * (len(backlash) - 3) + [held - 1, held, held]
    history = SimpleNamespace(
        gearbox="test", name=name, phases=phases, times=np.arange(len(backlash)) * 600.0,
        phase=np.array(numbers), clearances=[{**others, "backlash": {"test.main": value}} for value in backlash],
    )  # fmt: skip
    history.ends = lambda phase: len(backlash) - 1
    return history


def test_soak_is_the_shortest_warm_up_that_holds(case: Case) -> None:
    """Limit 20 um: a cold start falls to 15 um, the planned warm-up of ten steps holds, six are enough."""
    planned = schedule_phases(case)
    running = running_phases(case)
    good = branch(case, "schedule", [100e-6] * 11 + [25e-6, 30e-6], planned)
    cold = branch(case, "cold_start", [100e-6, 15e-6, 30e-6], running)
    tried: list[int] = []

    def trial(step: int) -> bool:
        tried.append(step)
        return step >= 6

    soak = soak_of(case, good, cold, trial)
    assert soak.soak_time_s == 3600.0 and "15.0 um" in soak.reason
    assert len(tried) <= 4
    holding = branch(case, "cold_start", [100e-6, 25e-6, 30e-6], running)
    assert soak_of(case, good, holding, trial).soak_time_s == 0.0
    assert soak_of(case, good, None, trial).soak_time_s == 7200.0


def test_soak_says_when_no_warm_up_helps(case: Case) -> None:
    planned = schedule_phases(case)
    dip = branch(case, "schedule", [100e-6] * 5 + [15e-6, 30e-6], planned)
    soak = soak_of(case, dip, None, lambda step: True)
    assert soak.soak_time_s is None and "after the planned warm-up of 2.0 h" in soak.reason
    lasting = branch(case, "schedule", [100e-6] * 5 + [15e-6, 15e-6], planned)
    soak = soak_of(case, lasting, None, lambda step: True)
    assert soak.soak_time_s is None and "no warm-up mends that" in soak.reason
    assert first_broken(case, branch(case, "schedule", [100e-6] * 6, planned)) is None


def test_shortest_finds_the_first_that_holds() -> None:
    for first in range(1, 9):
        found = shortest(list(range(9)), lambda step, first=first: step >= first)
        assert found == first


def extreme(quantity: str, value: float, limit: float | None, planned: bool = True) -> Extreme:
    return Extreme(
        quantity=quantity, value=value, time=7200.0, place="x", branch="schedule", phase="test",
        steady=None, limit=limit, planned=planned,
    )  # fmt: skip


def checks_over_time(case: Case, history: HistoryExtremes) -> dict[str, Check]:
    solved = SolvedRig(rig=build_rig(case, "quick"), points=(), history=history)
    return {check.id: check for check in transient_checks(solved)}


def test_checks_hold_the_worst_planned_moment(case: Case) -> None:
    history = HistoryExtremes(
        extremes=(
            extreme("backlash", 3e-5, 2e-5), extreme("seal_gap", 2e-4, 3e-4), extreme("axial_play", 2e-4, None),
            extreme("housing_temperature", 373.15, 453.15), extreme("gear_temperature", 433.15, None),
            extreme("backlash", 1e-5, 2e-5, planned=False),
        ),
        soak=(
            Soak(gearbox="test", stage="test", soak_time_s=3600.0, reason="r"),
            Soak(gearbox="other", stage="test", soak_time_s=None, reason="none"),
        ),
    )  # fmt: skip
    checks = checks_over_time(case, history)
    assert {key: check.verdict for key, check in checks.items()} == {
        "transient.backlash": "pass",
        "transient.seal_gap": "fail",
        "transient.axial_play": "not applicable",
        "transient.housing_temperature": "pass",
        "transient.soak.test": "pass",
        "transient.soak.other": "open",
    }
    assert checks["transient.housing_temperature"].distance == pytest.approx(80.0 / 160.0)
    warm = checks_over_time(case.with_value("ambient.temperature", "40 degC"), history)
    assert warm["transient.housing_temperature"].distance == pytest.approx(80.0 / 160.0)
    assert checks["transient.soak.test"].distance == pytest.approx(0.5)
    assert checks["transient.soak.test"].unit == "h"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('[transient]\nwarm_up = "0 h"\n', "transient.warm_up"),
        ('[transient]\ndwell = 3\n', "transient.dwell"),
        ('[transient]\nevents = ["fire"]\n', "transient.events"),
        ('[transient]\nevents = ["oil_loss", "oil_loss"]\n', "listed twice"),
        ('[transient]\nsettled_share = 0.7\n', "transient.settled_share"),
        ('[transient]\nwarmup = "1 h"\n', "warm_up"),
        ('[transient.probes.lid]\ngearbox = "tset"\nplace = "housing"\n', 'did you mean "test"'),
        ('[transient.probes.lid]\ngearbox = "reference"\nplace = "housing"\n', "has no housing"),
        ('[transient.probes.lid]\ngearbox = "test"\nplace = "outer_wram"\n', 'did you mean "outer_warm"'),
    ],
)  # fmt: skip
def test_bad_input_is_refused_by_path(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(CaseError, match=said):
        case_with(tmp_path, text)


def test_knots_are_operating_points(case: Case) -> None:
    """Equal points are computed once: they are equal as keys."""
    ramp = running_phases(case)[0]
    assert ramp.knots[-1].point == OperatingPoint(stage="full_torque", speed=12000.0 * RPM, torque=180.0)
    assert replace(ramp.knots[0].point) == ramp.knots[0].point
