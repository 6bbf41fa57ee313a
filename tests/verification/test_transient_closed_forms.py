"""Temperatures over time against closed forms.

Carslaw, Jaeger, Conduction of Heat in Solids, 2nd ed.: 2.7 (semi-infinite solid with a film), 3.11 (plate
with films).
"""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import erfc, erfcx

from tests.builders.two_blocks import law
from thermal.conditions.boundary import Adiabatic, BodySource, Film, Radiation
from thermal.conditions.streams import Stream, StreamNetwork, Supply, Volume, VolumeFilm
from thermal.conduction.capacity import HeatCapacity
from thermal.conduction.setup import Condition
from thermal.conduction.steady import ConductionSetup
from thermal.conduction.terms import ConductionProblem
from thermal.fe.mesh import CellName, NamedMesh, box_mesh
from thermal.films.law import STEFAN_BOLTZMANN
from thermal.transient.history import (
    InitialState,
    Observed,
    Probe,
    StepControl,
    ThermalStage,
    solve_transient,
)
from thermal.transient.time_steps import Stepper

ZERO = 273.15
SIDES = [f"{axis}_{end}" for axis in "yz" for end in ("min", "max")]


def adiabatic(names: Sequence[str]) -> list[Condition]:
    return [Adiabatic(surface=name) for name in names]


def cube() -> NamedMesh:
    return box_mesh((0.01, 0.01, 0.01), (1, 1, 1))


def cooled(h: float = 10.0) -> list[Condition]:
    return [Film(surface=n, kind="air", fluid_temperature=300.0, law=law(h)) for n in cube().surfaces]


TAU = 4e6 * 0.01 / (6.0 * 10.0)
"""Time constant of the cube in these films [s]."""


def test_a_lumped_body_cools_exponentially_and_the_tolerance_rules_the_error() -> None:
    errors = []
    for tolerance in (0.1, 0.01, 0.001):
        solution = solve_transient(
            ConductionSetup(cube(), {"box": 4e4}),
            {"box": 4e6},
            [ThermalStage(name="cool", duration=2000.0, conditions=cooled())],
            400.0,
            observed=Observed(probes=[Probe(name="mean", place="box")]),
            steps=StepControl(tolerance=tolerance),
        )
        exact = 300.0 + 100.0 * np.exp(-solution.times / TAU)
        errors.append(float(np.abs(solution.probes["mean"] - exact).max()))
        assert solution.errors.max() <= tolerance
        assert errors[-1] < 10.0 * tolerance
    assert errors[0] > 2.0 * errors[1] > 4.0 * errors[2]


def test_a_lumped_body_that_radiates_to_cold_space() -> None:
    """m c dT/dt = -eps sigma A T^4, so 1/T^3 grows linearly."""
    dark: list[Condition] = [
        Radiation(surface=n, emissivity=0.9, surroundings_temperature=1e-3) for n in cube().surfaces
    ]
    solution = solve_transient(
        ConductionSetup(cube(), {"box": 4e4}),
        {"box": 4e6},
        [ThermalStage(name="cool", duration=3000.0, conditions=dark)],
        1000.0,
        observed=Observed(probes=[Probe(name="mean", place="box")]),
        steps=StepControl(tolerance=0.02),
    )
    growth = 3.0 * 0.9 * STEFAN_BOLTZMANN * 6.0 / (4e6 * 0.01)
    exact = (1e-9 + growth * solution.times) ** (-1.0 / 3.0)
    assert solution.probes["mean"] == pytest.approx(exact, abs=0.3)
    assert exact[-1] < 600.0


def plate_centre(times: np.ndarray, biot: float, fourier_rate: float) -> np.ndarray:
    """Excess at the adiabatic face over the start excess, films on the other face."""
    total = np.zeros_like(times)
    for n in range(60):
        low, high = n * math.pi + 1e-9, (n + 0.5) * math.pi - 1e-9
        root = brentq(lambda z: z * math.sin(z) - biot * math.cos(z), low, high)
        weight = 4.0 * math.sin(root) / (2.0 * root + math.sin(2.0 * root))
        total += weight * np.exp(-(root**2) * fourier_rate * times)
    return total


@pytest.mark.parametrize("cell", ["tetra10", "hexahedron20"])
def test_a_plate_follows_its_series(cell: CellName) -> None:
    mesh = box_mesh((0.1, 0.02, 0.02), (6, 1, 1), cell=cell)
    film = Film(surface="x_max", kind="oil", fluid_temperature=400.0, law=law(800.0))
    stage = ThermalStage(name="warm", duration=1500.0, conditions=[film, *adiabatic(["x_min", *SIDES])])
    solution = solve_transient(
        ConductionSetup(mesh, {"box": 40.0}),
        {"box": 3.6e6},
        [stage],
        300.0,
        observed=Observed(probes=[Probe(name="far", place="x_min")]),
        steps=StepControl(tolerance=0.01),
    )
    later = solution.times > 20.0
    exact = 400.0 - 100.0 * plate_centre(solution.times[later], 800.0 * 0.1 / 40.0, 40.0 / 3.6e6 / 0.01)
    assert solution.probes["far"][later] == pytest.approx(exact, abs=0.06)
    assert exact.min() < 301.0
    assert exact.max() > 370.0


def test_a_thick_wall_warms_like_a_semi_infinite_solid() -> None:
    k, capacity, h = 40.0, 3.6e6, 500.0
    mesh = box_mesh((0.4, 0.02, 0.02), (20, 1, 1))
    film = Film(surface="x_min", kind="oil", fluid_temperature=400.0, law=law(h))
    stage = ThermalStage(name="warm", duration=600.0, conditions=[film, *adiabatic(["x_max", *SIDES])])
    solution = solve_transient(
        ConductionSetup(mesh, {"box": k}),
        {"box": capacity},
        [stage],
        300.0,
        observed=Observed(
            probes=[Probe(name="wall", place="x_min"), Probe(name="depth", place=(0.04, 0.01, 0.01))]
        ),
        steps=StepControl(tolerance=0.01),
    )
    later = solution.times > 60.0
    t = solution.times[later]
    for name, depth in (("wall", 0.0), ("depth", 0.04)):
        s = depth / (2.0 * np.sqrt(k / capacity * t))
        g = h / k * np.sqrt(k / capacity * t)
        excess = erfc(s) - np.exp(-(s**2)) * erfcx(s + g)
        assert solution.probes[name][later] == pytest.approx(300.0 + 100.0 * excess, abs=0.1)


def test_steps_are_of_second_order_against_the_exponential() -> None:
    setup = ConductionSetup(cube(), {"box": 4e4})
    problem = ConductionProblem(setup, cooled())
    errors = []
    for n in (4, 8, 16):
        stepper = Stepper(HeatCapacity(setup.elements, {"box": 4e6}), 1e-13)
        field = np.full(len(setup.mesh.points), 400.0)
        for k in range(n):
            field = stepper.step(lambda time: problem, k * TAU / n, TAU / n, field, None).field
        errors.append(abs(float(field.mean()) - (300.0 + 100.0 / math.e)))
    orders = [math.log2(a / b) for a, b in pairwise(errors)]
    assert orders == pytest.approx([2.0, 2.0], abs=0.1)


def test_steps_keep_their_order_with_film_radiation_and_changing_conditions() -> None:
    mesh = box_mesh((0.02, 0.01, 0.01), (2, 1, 1))
    setup = ConductionSetup(mesh, {"box": 30.0})

    def problem(time: float) -> ConductionProblem:
        return ConductionProblem(
            setup,
            [
                Film(surface="x_min", kind="oil", fluid_temperature=350.0 + 0.4 * time, law=law(30.0, 0.25)),
                Radiation(surface="x_max", emissivity=0.9, surroundings_temperature=300.0),
                BodySource(body="box", power=0.8 + 0.4 * math.sin(time / 40.0), kind="loss"),
                *adiabatic(SIDES),
            ],
        )

    def end(n: int) -> np.ndarray:
        stepper = Stepper(HeatCapacity(setup.elements, {"box": 3.6e6}), 1e-12)
        field, slope = np.full(len(mesh.points), 320.0), None
        for k in range(n):
            made = stepper.step(problem, 240.0 * k / n, 240.0 / n, field, slope)
            field, slope = made.field, made.slope
        return field

    fields = [end(n) for n in (10, 20, 40)]
    changes = [float(np.abs(a - b).max()) for a, b in pairwise(fields)]
    assert 1.9 < math.log2(changes[0] / changes[1]) < 2.6
    assert changes[1] < 1e-3


def test_the_error_estimate_is_the_error_of_a_step() -> None:
    """For the cube in constant films one step after a smooth one: exact course known."""
    setup = ConductionSetup(cube(), {"box": 4e4})
    problem = ConductionProblem(setup, cooled())
    stepper = Stepper(HeatCapacity(setup.elements, {"box": 4e6}), 1e-13)
    start, rate = np.full(len(setup.mesh.points), 400.0), -100.0 / TAU
    for dt in (0.1 * TAU, 0.05 * TAU):
        made = stepper.step(lambda time: problem, 0.0, dt, start, np.full_like(start, rate))
        true = float(made.field.mean()) - (300.0 + 100.0 * math.exp(-dt / TAU))
        assert made.error == pytest.approx(abs(true), rel=0.2)


def test_a_volume_with_heat_capacity_follows_its_exponential() -> None:
    """Oil sump on a wall held at one temperature by a short time constant: m c dV/dt = G (T_in - V) + P."""
    network = StreamNetwork(
        specific_heat=2000.0,
        volumes=(Volume(name="sump", power=400.0, heat_capacity=8000.0),),
        supplies=(Supply(name="jet", temperature=350.0),),
        films=(VolumeFilm(surface="x_min", volume="sump", kind="oil", law=law(0.0)),),
        streams=(
            Stream(source="jet", target="sump", mass_flow=0.02),
            Stream(source="sump", target=None, mass_flow=0.02),
        ),
    )
    conditions: list[Condition] = [network, *adiabatic(["x_max", *SIDES])]
    solution = solve_transient(
        ConductionSetup(cube(), {"box": 40.0}),
        {"box": 4e6},
        [ThermalStage(name="run", duration=600.0, conditions=conditions)],
        InitialState(temperature=300.0, volumes={"sump": 310.0}),
        observed=Observed(probes=[Probe(name="sump", place="sump")]),
        steps=StepControl(tolerance=0.005),
    )
    exact = 360.0 - 50.0 * np.exp(-solution.times / 200.0)
    assert solution.probes["sump"] == pytest.approx(exact, abs=0.03)
    assert solution.energy.stored["sump"] == pytest.approx(8000.0 * (solution.volumes["sump"] - 310.0))
    assert solution.temperature == pytest.approx(300.0)
