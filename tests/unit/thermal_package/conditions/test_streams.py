"""Volumes and streams against hand calculation, and the networks that are refused."""

import math
from dataclasses import replace
from decimal import Decimal, localcontext

import numpy as np
import pytest

from tests.builders.two_blocks import law
from thermal.conditions.boundary import Adiabatic, ConditionError, PrescribedTemperature
from thermal.conditions.streams import (
    SMALL,
    Stream,
    StreamNetwork,
    Supply,
    Volume,
    VolumeFilm,
    VolumeLink,
    check_networks,
    inlet_share,
    inlet_share_slope,
)
from thermal.conduction.setup import Condition, ConductionSetup
from thermal.conduction.steady import TemperatureSolution, solve_steady
from thermal.fe.mesh import NamedMesh, box_mesh

RATE = 0.02 * 2000.0
"""Heat capacity rate of the streams here [W/K]."""


@pytest.fixture(scope="module")
def slab() -> NamedMesh:
    """Heat flows along x only: the oiled side has one temperature."""
    return box_mesh((0.01, 0.2, 0.2), (1, 1, 1))


def oiled(network: StreamNetwork) -> list[Condition]:
    sides = [f"{axis}_{end}" for axis in "yz" for end in ("min", "max")]
    return [
        PrescribedTemperature(surface="x_min", temperature=450.0),
        network,
        *(Adiabatic(surface=name) for name in sides),
    ]


def passage(*, plug: bool, h: float = 900.0, power: float = 0.0) -> StreamNetwork:
    return StreamNetwork(
        specific_heat=2000.0,
        volumes=(Volume(name="film", plug_flow=plug, power=power),),
        supplies=(Supply(name="jet", temperature=360.0),),
        films=(VolumeFilm(surface="x_max", volume="film", kind="oil", law=law(h)),),
        streams=(
            Stream(source="jet", target="film", mass_flow=0.02),
            Stream(source="film", target=None, mass_flow=0.02),
        ),
    )


def solve(mesh: NamedMesh, network: StreamNetwork) -> TemperatureSolution:
    return solve_steady(ConductionSetup(mesh, {"box": 40.0}), oiled(network), tolerance=1e-11)


def wall_of(solution: TemperatureSolution) -> float:
    return next(row.mean_temperature for row in solution.balance.rows if row.surface == "x_max")


@pytest.mark.parametrize("h", [1.0, 900.0, 2e4])
def test_plug_flow_warms_up_exponentially(slab: NamedMesh, h: float) -> None:
    solution = solve(slab, passage(plug=True, h=h))
    wall = wall_of(solution)
    outlet = wall + (360.0 - wall) * math.exp(-h * 0.04 / RATE)
    assert solution.volumes["film"] == pytest.approx(outlet, abs=1e-8)
    oil = next(row for row in solution.balance.rows if row.surface == "x_max")
    assert oil.power == pytest.approx(-RATE * (outlet - 360.0), rel=1e-7)
    assert solution.balance.by_kind()["prescribed_temperature"] == pytest.approx(-oil.power, rel=1e-7)


def test_a_stirred_volume_leaves_with_the_temperature_its_films_feel(slab: NamedMesh) -> None:
    solution = solve(slab, passage(plug=False))
    wall, transfer = wall_of(solution), 900.0 * 0.04
    outlet = (RATE * 360.0 + transfer * wall) / (RATE + transfer)
    assert solution.volumes["film"] == pytest.approx(outlet, abs=1e-8)


def test_oil_that_is_injected_leaves_warmer_by_heat_and_power(slab: NamedMesh) -> None:
    solution = solve(slab, passage(plug=True, power=500.0))
    from_wall = -next(row.power for row in solution.balance.rows if row.surface == "x_max")
    assert from_wall > 100.0
    assert RATE * (solution.volumes["film"] - 360.0) == pytest.approx(from_wall + 500.0, rel=1e-8)


def test_many_stirred_volumes_in_a_row_are_a_plug_flow() -> None:
    outlets = []
    for n in (4, 8, 16):
        mesh = box_mesh((0.01, 0.2, 0.2), (1, 1, n))
        strips = {}
        facets = mesh.surfaces["x_max"]
        middle = mesh.points[facets[:, :3], 2].mean(axis=1)
        for k in range(n):
            strips[f"strip {k}"] = facets[(middle > 0.2 * k / n) & (middle < 0.2 * (k + 1) / n)]
        surfaces = {name: nodes for name, nodes in mesh.surfaces.items() if name != "x_max"} | strips
        network = StreamNetwork(
            specific_heat=2000.0,
            volumes=tuple(Volume(name=f"cell {k}") for k in range(n)),
            supplies=(Supply(name="jet", temperature=360.0),),
            films=tuple(
                VolumeFilm(surface=f"strip {k}", volume=f"cell {k}", kind="oil", law=law(900.0))
                for k in range(n)
            ),
            streams=(
                Stream(source="jet", target="cell 0", mass_flow=0.02),
                *(Stream(source=f"cell {k}", target=f"cell {k + 1}", mass_flow=0.02) for k in range(n - 1)),
                Stream(source=f"cell {n - 1}", target=None, mass_flow=0.02),
            ),
        )
        solution = solve_steady(
            ConductionSetup(replace(mesh, surfaces=surfaces), {"box": 4e4}), oiled(network)
        )
        outlets.append(solution.volumes[f"cell {n - 1}"])
    exact = 450.0 - 90.0 * math.exp(-900.0 * 0.04 / RATE)
    errors = exact - np.array(outlets)
    assert errors[-1] == pytest.approx(0.0, abs=1.0)
    assert errors[:-1] / errors[1:] == pytest.approx(2.0, abs=0.2)


def test_two_volumes_in_a_loop_without_outflow(slab: NamedMesh) -> None:
    """Mist between wall and room, mixed by a fan: three conductances in series."""
    network = StreamNetwork(
        specific_heat=1000.0,
        volumes=(Volume(name="near"), Volume(name="far")),
        supplies=(Supply(name="room", temperature=300.0),),
        films=(VolumeFilm(surface="x_max", volume="near", kind="mist", law=law(50.0)),),
        streams=(
            Stream(source="near", target="far", mass_flow=0.003),
            Stream(source="far", target="near", mass_flow=0.003),
        ),
        links=(VolumeLink(a="room", b="far", conductance=4.0),),
    )
    solution = solve(slab, network)
    heat = 150.0 / (0.01 / (40.0 * 0.04) + 1.0 / (50.0 * 0.04) + 1.0 / 3.0 + 1.0 / 4.0)
    assert solution.volumes["far"] == pytest.approx(300.0 + heat / 4.0, rel=1e-9)
    assert solution.volumes["near"] == pytest.approx(300.0 + heat / 4.0 + heat / 3.0, rel=1e-9)


def test_share_of_the_inlet_is_smooth_where_the_series_takes_over() -> None:
    for n in (1e-9, 1e-4, 9.999e-4, 1.001e-3, 0.1, 1.0, 5.0, 50.0, 800.0):
        h = 1e-4 * n
        slope = (inlet_share(n + h) - inlet_share(n - h)) / (2.0 * h)
        assert inlet_share_slope(n) == pytest.approx(slope, rel=1e-4, abs=1e-3 if n < 0.01 else 0.0)
        film = inlet_share(n) + (1.0 - inlet_share(n)) * math.exp(-n)
        assert film == pytest.approx(-math.expm1(-n) / n, rel=1e-9)
    assert inlet_share(9.9999e-4) == pytest.approx(inlet_share(1.00001e-3), abs=1e-8)


def changed(**fields: object) -> StreamNetwork:
    return replace(passage(plug=True), **fields)  # type: ignore[arg-type]


FILM = Volume(name="film")
STREAMS = passage(plug=True).streams
BAD = [
    (changed(specific_heat=0.0), "specific_heat = 0 must be above 0"),
    (changed(volumes=(FILM, FILM)), "'film' occurs twice"),
    (changed(volumes=(replace(FILM, power=math.nan),)), "film: power = nan is no finite number"),
    (changed(volumes=(replace(FILM, heat_capacity=-1.0),)), "film: heat_capacity = -1 must be at least 0"),
    (changed(supplies=(Supply(name="jet", temperature=-1.0),)), "jet: temperature = -1 must be above 0"),
    (changed(streams=(STREAMS[0],)), "0.02 kg/s in and 0 kg/s out; make the mass flows equal"),
    (
        changed(streams=(STREAMS[0], replace(STREAMS[1], mass_flow=0.03))),
        "'film': 0.02 kg/s in and 0.03 kg/s out",
    ),
    (
        changed(streams=(replace(STREAMS[0], source="jett"), STREAMS[1])),
        "unknown place 'jett'; known: film, jet",
    ),
    (changed(streams=(replace(STREAMS[0], mass_flow=0.0), STREAMS[1])), "mass_flow = 0 must be above 0"),
    (changed(streams=(replace(STREAMS[0], source="film"), STREAMS[1])), "needs two different places"),
    (changed(streams=()), "plug flow without inflow"),
    (changed(links=(VolumeLink(a="film", b="film", conductance=1.0),)), "needs a volume and another place"),
    (
        changed(links=(VolumeLink(a="film", b="jet", conductance=-1.0),)),
        "conductance = -1 must be at least 0",
    ),
    (
        changed(films=(VolumeFilm(surface="x_max", volume="fim", kind="oil", law=law(1.0)),)),
        "unknown place 'fim'",
    ),
]


@pytest.mark.parametrize(("bad", "message"), BAD, ids=[message[:40] for _, message in BAD])
def test_bad_networks_are_refused(bad: StreamNetwork, message: str) -> None:
    with pytest.raises(ConditionError, match=message):
        check_networks([bad])


def test_a_volume_without_a_heat_path_is_named(slab: NamedMesh) -> None:
    lost = StreamNetwork(specific_heat=1.0, volumes=(Volume(name="pocket", power=3.0),))
    with pytest.raises(ConditionError, match=r"no way for the heat of volume pocket: .*no supply reaches it"):
        solve_steady(ConductionSetup(slab, {"box": 40.0}), [*oiled(passage(plug=True)), lost])


def test_a_body_that_only_feels_a_lost_volume_is_named(slab: NamedMesh) -> None:
    lost = StreamNetwork(
        specific_heat=1.0,
        volumes=(Volume(name="pocket", power=3.0),),
        films=(VolumeFilm(surface="x_max", volume="pocket", kind="air", law=law(5.0)),),
    )
    closed = [Adiabatic(surface=name) for name in slab.surfaces if name != "x_max"]
    with pytest.raises(ConditionError, match="no way for the heat of body box and volume pocket"):
        solve_steady(ConductionSetup(slab, {"box": 40.0}), [lost, *closed])


def test_a_volume_may_not_have_the_name_of_a_body(slab: NamedMesh) -> None:
    named = StreamNetwork(specific_heat=1.0, volumes=(Volume(name="box"),))
    with pytest.raises(ConditionError, match="'box' has the name of a surface or body"):
        solve_steady(ConductionSetup(slab, {"box": 40.0}), [*oiled(passage(plug=True)), named])


def test_a_film_may_feel_its_supply_in_part() -> None:
    """Oil half warmed up at the wall: Q = h A (T_wall - (T_in + T_out)/2) = m c (T_out - T_in), by hand."""
    mesh = box_mesh((0.1, 0.1, 0.1), (1, 1, 1))
    network = StreamNetwork(
        specific_heat=2000.0,
        volumes=(Volume(name="oil"),),
        supplies=(Supply(name="feed", temperature=300.0),),
        streams=(
            Stream(source="feed", target="oil", mass_flow=0.001),
            Stream(source="oil", target=None, mass_flow=0.001),
        ),
        films=(
            VolumeFilm(surface="x_max", volume="oil", kind="oil", law=law(400.0), supply="feed", supply_share=0.5),
        ),
    )  # fmt: skip
    conditions = [
        PrescribedTemperature(surface="x_min", temperature=400.0),
        *(Adiabatic(surface=name) for name in ("y_min", "y_max", "z_min", "z_max")),
        network,
    ]
    solution = solve_steady(ConductionSetup(mesh, {"box": 50.0}), conditions)
    conductance = 1.0 / (1.0 / 5.0 + 1.0 / 4.0)
    power = 100.0 / (1.0 / conductance + 0.5 / 2.0)
    assert solution.volumes["oil"] == pytest.approx(300.0 + power / 2.0, abs=1e-6)
    assert solution.balance.closure < 1e-9
    with pytest.raises(ConditionError, match=r"supply_share = 0\.5 must lie"):
        check_networks([replace(network, films=(replace(network.films[0], supply=None),))])
    with pytest.raises(ConditionError, match="unknown place 'oil'"):
        check_networks([replace(network, films=(replace(network.films[0], supply="oil"),))])


@pytest.mark.parametrize("units", [1e-6, 0.999 * SMALL, 1.001 * SMALL, 0.3, 5.0])
def test_mean_of_a_plug_flow_weighs_its_inlet_exactly(units: float) -> None:
    """The temperature falls as exp(-N x): mean (1 - e) / N, outlet e = exp(-N); in fifty digits."""
    with localcontext() as digits:
        digits.prec = 50
        n = Decimal(units)

        def weight(n: Decimal) -> Decimal:
            outlet = (-n).exp()
            return ((1 - outlet) / n - outlet) / (1 - outlet)

        step = n * Decimal("1e-12")
        exact, slope = weight(n), (weight(n + step) - weight(n - step)) / (2 * step)
    assert inlet_share(units) == pytest.approx(float(exact), rel=1e-12)
    assert inlet_share_slope(units) == pytest.approx(float(slope), rel=1e-8)
