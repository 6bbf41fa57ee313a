"""Schedules: energy, stages that jump, soak-back after the stop, observers, probes, refused input."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.builders.coupled_blocks import CAPACITY, CONDUCTIVITY, conditions, coupled_blocks, network
from tests.builders.two_blocks import law, renamed
from thermal.conditions.boundary import Adiabatic, BodySource, ConditionError, Film, PrescribedTemperature
from thermal.conditions.contact import Contact
from thermal.conditions.streams import Stream, StreamNetwork
from thermal.conduction.capacity import Conductivity, Storage
from thermal.conduction.setup import Condition
from thermal.conduction.steady import ConductionSetup, solve_steady
from thermal.errors import ThermalNotConverged
from thermal.fe.mesh import box_mesh, disjoint_union
from thermal.films.law import FilmCoefficient
from thermal.transient.history import (
    InitialState,
    Observed,
    Probe,
    StepControl,
    ThermalStage,
    TransientSolution,
    settling_time,
    solve_transient,
)

VARIABLE: dict[str, Conductivity] = {
    **CONDUCTIVITY,
    "base": lambda temperature: 40.0 * (1.0 - 1e-3 * (temperature - 300.0)),
}


@pytest.fixture(scope="module")
def setup() -> ConductionSetup:
    return ConductionSetup(coupled_blocks(), VARIABLE)


def off() -> list[Condition]:
    """Everything after the stop: no losses, the oil pump off, the held side warmer."""
    still = replace(
        network(),
        volumes=tuple(replace(v, power=0.0, plug_flow=False) for v in network().volumes),
        streams=(),
    )
    return [
        still if isinstance(c, StreamNetwork)
        else replace(c, temperature=350.0) if isinstance(c, PrescribedTemperature)
        else c
        for c in conditions()
        if not isinstance(c, BodySource)
    ]  # fmt: skip


def run(setup: ConductionSetup, observed: Observed = Observed()) -> TransientSolution:  # noqa: B008
    stages = [
        ThermalStage(name="run", duration=6000.0, conditions=conditions()),
        ThermalStage(name="stop", duration=900.0, conditions=off()),
    ]
    places = {"wall": "wall", "hottest": "base", "lid": "lid_z_max", "chamber": "chamber"}
    probes = [
        Probe(name=name, place=place, quantity="max" if name == "hottest" else "mean")
        for name, place in places.items()
    ]
    return solve_transient(
        setup,
        CAPACITY,
        stages,
        300.0,
        observed=replace(observed, probes=probes),
        steps=StepControl(tolerance=0.2),
    )


@pytest.fixture(scope="module")
def ran(setup: ConductionSetup) -> tuple[TransientSolution, dict[float, np.ndarray]]:
    seen: dict[float, np.ndarray] = {}
    solution = run(
        setup,
        Observed(
            at=[0.0, 1234.5, 6000.0, 6900.0],
            observer=lambda time, field, volumes: seen.__setitem__(time, field),
        ),
    )
    return solution, seen


def test_energy_is_conserved_with_everything_switched_on(ran) -> None:
    energy = ran[0].energy
    assert energy.closure < 1e-9
    assert energy.turnover > 1e5
    assert set(energy.gaps) == {0, 1, 2, "chamber", "wall oil", "collector"}
    assert energy.rows["wall", "loss"] == pytest.approx(15.0 * 6000.0)
    assert energy.rows["chamber", "power"] == pytest.approx(30.0 * 6000.0)
    total = sum(energy.rows.values()) - sum(energy.stored.values())
    assert total == pytest.approx(0.0, abs=1e-8 * energy.turnover)


def test_what_is_stored_is_the_heat_content_of_the_last_field(setup, ran) -> None:
    solution = ran[0]
    for body, capacity in CAPACITY.items():
        elements = setup.elements
        content = capacity * elements.volume(body) * (elements.body_mean(solution.temperature, body) - 300.0)
        assert solution.energy.stored[body] == pytest.approx(content, rel=1e-9)


@pytest.mark.parametrize("share", [-1.0, 0.5, 0.999])
def test_heat_that_is_stored_wrongly_is_no_solution(
    setup, share: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    right = Storage.heat_out
    monkeypatch.setattr(Storage, "heat_out", lambda self, field: share * right(self, field))
    stage = ThermalStage(name="run", duration=60.0, conditions=conditions())
    with pytest.raises(ThermalNotConverged):
        solve_transient(setup, CAPACITY, [stage], 300.0, steps=StepControl(tolerance=1.0))


def test_a_long_stage_ends_in_the_steady_state(setup, ran) -> None:
    steady = solve_steady(setup, conditions())
    assert_allclose(ran[1][6000.0], steady.temperature, atol=0.05)
    last = np.flatnonzero(ran[0].stages == 0)[-1]
    assert ran[0].times[last] == 6000.0
    assert ran[0].probes["chamber"][last] == pytest.approx(steady.volumes["chamber"], abs=0.02)


def test_observers_see_their_times_and_probes_every_step(setup, ran) -> None:
    solution, seen = ran
    assert list(seen) == [0.0, 1234.5, 6000.0, 6900.0]
    assert_allclose(seen[0.0][setup.elements.surfaces["lid_z_max"].nodes], 300.0)
    assert seen[6900.0].tobytes() == solution.temperature.tobytes()
    assert solution.times[0] == 0.0
    assert solution.times[-1] == 6900.0
    assert (np.diff(solution.times) > 0.0).all()
    for values in solution.probes.values():
        assert len(values) == len(solution.times)
    assert solution.probes["wall"][-1] == pytest.approx(
        setup.elements.body_mean(solution.temperature, "wall")
    )


def test_two_runs_are_equal_and_an_observer_changes_nothing_but_the_steps(setup) -> None:
    stage = ThermalStage(name="run", duration=60.0, conditions=conditions())

    def short(at: float) -> TransientSolution:
        return solve_transient(
            setup,
            CAPACITY,
            [stage],
            300.0,
            observed=Observed(at=[at], observer=lambda time, field, volumes: field.fill(0.0)),
            steps=StepControl(tolerance=0.2),
        )

    first, second, other = short(60.0), short(60.0), short(7.0)
    assert first.temperature.tobytes() == second.temperature.tobytes()
    assert first.energy == second.energy
    assert_allclose(other.temperature, first.temperature, atol=0.5)
    assert 7.0 in other.times


def test_the_housing_gets_warmer_after_the_stop() -> None:
    """A hot gear in an oil-cooled box: with the oil off, its heat soaks back."""
    gear = renamed(box_mesh((0.06, 0.06, 0.06), (2, 2, 2), name="gear"), "gear")
    box = renamed(box_mesh((0.02, 0.06, 0.06), (1, 3, 3), (0.06, 0.0, 0.0), "box"), "box")
    mesh = disjoint_union(gear, box)
    closed = {*mesh.surfaces} - {"gear_x_max", "box_x_min", "box_x_max", "box_y_min"}

    def stage(name: str, power: float, film: float) -> ThermalStage:
        listed: list[Condition] = [
            Contact(surface_a="gear_x_max", surface_b="box_x_min", kind="fit", law=law(150.0)),
            Film(surface="box_y_min", kind="air", fluid_temperature=300.0, law=law(10.0)),
            Film(surface="box_x_max", kind="oil", fluid_temperature=330.0, law=law(film)),
            BodySource(body="gear", power=power, kind="loss"),
            *(Adiabatic(surface=name) for name in sorted(closed)),
        ]
        return ThermalStage(name=name, duration=4000.0, conditions=listed)

    solution = solve_transient(
        ConductionSetup(mesh, {"gear": 45.0, "box": 45.0}),
        {"gear": 3.6e6, "box": 3.6e6},
        [stage("run", 150.0, 400.0), stage("stop", 0.0, 0.0)],
        300.0,
        observed=Observed(probes=[Probe(name="gear", place="gear"), Probe(name="box", place="box")]),
    )
    stop = int(np.flatnonzero(solution.times == 4000.0)[0])
    box_course, gear_course = solution.probes["box"], solution.probes["gear"]
    peak = stop + int(box_course[stop:].argmax())
    assert solution.times[peak] > 4000.0
    assert box_course[peak] > box_course[stop] + 5.0
    assert (np.diff(gear_course[stop:]) < 0.0).all()
    assert box_course[-1] < box_course[peak]


def test_a_prescribed_temperature_that_jumps_is_booked() -> None:
    mesh = box_mesh((0.1, 0.02, 0.02), (4, 1, 1))
    sides = [Adiabatic(surface=name) for name in mesh.surfaces if name != "x_min"]

    def stage(temperature: float) -> ThermalStage:
        held = PrescribedTemperature(surface="x_min", temperature=temperature)
        return ThermalStage(name=f"{temperature:g} K", duration=3000.0, conditions=[held, *sides])

    solution = solve_transient(
        ConductionSetup(mesh, {"box": 40.0}), {"box": 3.6e6}, [stage(400.0), stage(350.0)], 300.0
    )
    content = 3.6e6 * 4e-5 * 50.0
    assert solution.temperature == pytest.approx(350.0, abs=0.2)
    given = solution.energy.rows["x_min", "prescribed_temperature"]
    assert given == pytest.approx(content, rel=5e-3)
    assert solution.energy.closure < 1e-10


def test_nothing_happens_at_rest() -> None:
    mesh = box_mesh((0.1, 0.1, 0.1), (1, 1, 1))
    still = [Film(surface=n, kind="air", fluid_temperature=300.0, law=law(5.0, 0.25)) for n in mesh.surfaces]
    solution = solve_transient(
        ConductionSetup(mesh, {"box": 40.0}),
        {"box": 3.6e6},
        [ThermalStage(name="rest", duration=3600.0, conditions=still)],
        300.0,
    )
    assert_allclose(solution.temperature, 300.0, rtol=1e-12)
    assert solution.energy.closure == 0.0
    assert len(solution.times) < 20


def test_a_stage_without_any_way_for_the_heat_only_warms() -> None:
    mesh = box_mesh((0.1, 0.1, 0.1), (1, 1, 1))
    closed: list[Condition] = [BodySource(body="box", power=100.0, kind="loss")]
    closed += [Adiabatic(surface=name) for name in mesh.surfaces]
    stage = ThermalStage(name="warm", duration=360.0, conditions=closed)
    solution = solve_transient(ConductionSetup(mesh, {"box": 40.0}), {"box": 3.6e6}, [stage], 300.0)
    assert_allclose(solution.temperature, 300.0 + 100.0 * 360.0 / 3600.0, rtol=1e-9)


def test_warnings_of_film_laws_are_kept_once() -> None:
    mesh = box_mesh((0.1, 0.1, 0.1), (1, 1, 1))
    said = [
        Film(surface=n, kind="air", fluid_temperature=280.0, law=law(5.0, 0.0, "Ra = 3 is below 1e4"))
        for n in mesh.surfaces
    ]
    stage = ThermalStage(name="run", duration=100.0, conditions=said)
    assert solve_transient(ConductionSetup(mesh, {"box": 40.0}), {"box": 3.6e6}, [stage], 300.0).warnings == (
        "Ra = 3 is below 1e4",
    )


def test_settling_time() -> None:
    times = np.array([0.0, 10.0, 20.0, 30.0, 40.0])
    values = np.array([20.0, 90.0, 105.0, 101.0, 100.0])
    assert settling_time(times, values, 100.0, 4.0) == pytest.approx(22.5)
    assert settling_time(times, values, 100.0, 200.0) == 0.0
    assert settling_time(times, values, 50.0, 1.0) is None
    assert settling_time(times, values, 101.5, 11.6) == pytest.approx(10.0, abs=0.1)


def plain(**changes: object) -> ThermalStage:
    mesh = box_mesh((0.1, 0.1, 0.1), (1, 1, 1))
    films = [Film(surface=n, kind="air", fluid_temperature=280.0, law=law(5.0)) for n in mesh.surfaces]
    return replace(ThermalStage(name="run", duration=100.0, conditions=films), **changes)  # type: ignore[arg-type]


BAD = [
    ({"stages": []}, "schedule without a stage"),
    ({"stages": [plain(duration=0.0)]}, "stage 'run': duration = 0.0 s must be above 0 s"),
    ({"stages": [plain(duration=math.inf)]}, "duration = inf"),
    ({"stages": [plain(conditions=[])]}, "stage 'run': surfaces without a boundary condition"),
    ({"capacity": {}}, "none for body box"),
    ({"capacity": {"box": 1.0, "bx": 1.0}}, "unknown body bx"),
    ({"capacity": {"box": 0.0}}, r"heat capacity of body 'box' is 0.0 J/\(m3 K\); it must be positive"),
    ({"initial": -1.0}, "initial temperature must be finite and above 0 K"),
    ({"steps": StepControl(tolerance=0.0)}, "tolerance = 0.0 must be above 0"),
    ({"steps": StepControl(largest=-1.0)}, "largest step = -1.0 must be above 0"),
    ({"observed": Observed(at=[101.0])}, "outside of 0 to 100 s, the end of the schedule"),
    (
        {"observed": Observed(probes=[Probe(name="p", place="roof")])},
        "probe 'p': 'roof' is no surface, body or volume",
    ),
    (
        {"observed": Observed(probes=[Probe(name="p", place="box"), Probe(name="p", place="x_min")])},
        "two probes have the same name",
    ),
]


@pytest.mark.parametrize(("changes", "message"), BAD, ids=[message[:40] for _, message in BAD])
def test_bad_input_is_refused(changes: dict[str, object], message: str) -> None:
    arguments: dict[str, object] = {
        "setup": ConductionSetup(box_mesh((0.1, 0.1, 0.1), (1, 1, 1)), {"box": 40.0}),
        "capacity": {"box": 3.6e6},
        "stages": [plain()],
        "initial": 300.0,
    }
    with pytest.raises(ConditionError, match=message):
        solve_transient(**arguments | changes)  # type: ignore[arg-type]


def test_a_volume_that_nothing_reaches_is_refused_unless_it_stores_heat(setup: ConductionSetup) -> None:
    closed = replace(network(), streams=(Stream(source="cooler", target=None, mass_flow=0.01),), links=())
    volumes = tuple(replace(volume, plug_flow=False) for volume in network().volumes)
    lost = [replace(closed, volumes=volumes) if isinstance(c, StreamNetwork) else c for c in conditions()]
    stage = ThermalStage(name="run", duration=10.0, conditions=lost)
    with pytest.raises(ConditionError, match="no way for the heat of volume collector"):
        solve_transient(setup, CAPACITY, [stage], 300.0)
    kept = tuple(replace(volume, heat_capacity=10.0) for volume in volumes)
    stored = [replace(closed, volumes=kept) if isinstance(c, StreamNetwork) else c for c in conditions()]
    stage = ThermalStage(name="run", duration=10.0, conditions=stored)
    solution = solve_transient(
        setup, CAPACITY, [stage], InitialState(temperature=300.0, volumes={"collector": 333.0})
    )
    assert solution.volumes["collector"] == pytest.approx(333.0, rel=1e-9)


def test_a_film_that_jumps_with_the_wall_temperature_is_not_stepped_over() -> None:
    def jump(wall: float, fluid: float) -> FilmCoefficient:
        return law(5e4 if wall > 320.0 else 0.0)(wall, fluid)

    mesh = box_mesh((0.1, 0.1, 0.1), (1, 1, 1))
    jumping: list[Condition] = [
        Film(surface=n, kind="oil", fluid_temperature=280.0, law=jump) for n in mesh.surfaces
    ]
    jumping.append(BodySource(body="box", power=1000.0, kind="loss"))
    stage = ThermalStage(name="run", duration=400.0, conditions=jumping)
    with pytest.raises(ThermalNotConverged):
        solve_transient(ConductionSetup(mesh, {"box": 40.0}), {"box": 3.6e6}, [stage], 300.0)
