"""Checks of the loaded contact: where they hold, their limits, edges in words."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.gear.flank import PARALLEL
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.tooth.mesh_cycle import MeshCycle
from dynamics.tooth.points import FaceGrid
from rigdesign.case import Case, load_case
from rigdesign.checks import contact
from rigdesign.checks.registry import RuleFamily
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.teeth import EdgeContact, LoadedContact
from tests.builders.loaded_mesh import influence_of
from tests.builders.loads import StatedLoads, mesh_loads
from tests.builders.paths import CASES
from tests.builders.twisting import twisting_rig

LIMITS = "limits.flanks."


@cache
def shipped() -> Case:
    return load_case(CASES / "uhcf_prototype")


@cache
def cycle(mesh: str, n_face: int = 1) -> MeshCycle:
    """Loaded contact of a mesh of the prototype on analytic influence numbers."""
    pair = twisting_rig(shipped()).pairs[mesh]
    gears = (influence_of(pair, 0, neighbour=0.4), influence_of(pair, 1, neighbour=0.4))
    loaded = LoadedMesh(pair=pair, gears=gears, grid=FaceGrid.over(pair.face_width, n_face), n_positions=32)
    return loaded.cycle(180.0 / pair.base_radii[0])


def record(mesh: str) -> LoadedContact:
    roots: Any = ()
    return LoadedContact(
        stage="test",
        torque=180.0,
        flank="front",
        axes=PARALLEL,
        cycle=cycle(mesh),
        unloaded_contact_ratio=1.0,
        roots=roots,
    )


LEVELS = {"run-in": 1.0, "test": 1.21, "overload": 1.44}
"""K_V of the held stages; the second speaks for the rig."""


def solved(case: Case) -> SolvedRig:
    rig = twisting_rig(case)
    points: Any = [
        SimpleNamespace(
            point=SimpleNamespace(stage=stage, speed=1256.6, torque=200.0 if stage == "test" else 180.0),
            last=SimpleNamespace(
                response=SimpleNamespace(dynamic_factor=np.full(2, level), mean=np.full(2, 180.0))
            ),
        )
        for stage, level in LEVELS.items()
    ]
    meshes = {rig.mesh_labels[name]: mesh_loads() for name in rig.mesh_names}
    run: Any = SimpleNamespace()
    return SolvedRig(rig=rig, points=points, run=run, loads=StatedLoads(meshes=meshes))


@pytest.fixture
def loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same loaded contact in every mesh at every held stage but the first, which carries nothing."""

    def held(solved: SolvedRig, point: Any, mesh: int) -> Any:
        if point.point.stage == "run-in":
            return None
        turned = cycle(solved.rig.mesh_names[mesh])
        return SimpleNamespace(cycle=turned, edges=EdgeContact.of(turned, "front"))

    monkeypatch.setattr(SolvedRig, "held_contact", held)


def checks(case: Case) -> dict[str, Check]:
    return {check.id: check for check in contact.checks(solved(case))}


def stated(**limits: str) -> Case:
    case = shipped()
    for key, value in limits.items():
        case = case.with_value(LIMITS + key, value)
    return case


@pytest.mark.usefixtures("loaded")
def test_a_stated_limit_holds_for_every_mesh_and_takes_the_root_of_the_dynamic_factor() -> None:
    """That of the stage with the highest pressure, which is not the one that speaks for the rig."""
    case = stated(contact_pressure_maximum="1000 MPa")
    assert solved(case).test.point.stage == "test"
    found = checks(case)
    assert set(found) == {"flank.contact_pressure.test", "flank.contact_pressure.reference"}
    check = found["flank.contact_pressure.test"]
    assert check.value == pytest.approx(1e-6 * cycle("test.main").flank_pressure * 1.2)
    assert (check.limit, check.role, check.verdict) == (1000.0, "specimen", "fail")
    assert "simulated K_V 1.440, stage overload; limit as stated" in check.reason
    wide = checks(stated(contact_pressure_maximum="5 GPa"))["flank.contact_pressure.test"]
    assert (wide.verdict, wide.value) == ("pass", check.value)


@pytest.mark.usefixtures("loaded")
def test_without_a_stated_limit_gears_of_the_rig_have_the_pitting_strength(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It is a strength at the pitch point: a broken rule warns."""
    rating = SimpleNamespace(pitting=(SimpleNamespace(strength=600e6), SimpleNamespace(strength=300e6)))
    monkeypatch.setattr(SolvedRig, "flank_ratings", lambda solved, mesh: (rating,))
    found = checks(shipped())
    assert set(found) == {"flank.contact_pressure.reference"}
    check = found["flank.contact_pressure.reference"]
    assert check.limit == pytest.approx(300.0 / shipped().limits.flanks.pitting_safety_minimum)  # type: ignore[operator]
    assert check.value is not None and check.limit is not None
    assert check.status == "advisory" and check.value > check.limit
    assert "300 MPa of wheel by ISO 6336-2" in check.reason


@pytest.mark.usefixtures("loaded")
def test_edges_are_held_only_against_a_stated_limit() -> None:
    found = checks(stated(contact_pressure_maximum="1 GPa", edge_pressure_maximum="1 MPa"))
    check = found["flank.edge_pressure.test"]
    assert check.verdict == "fail"
    assert check.value == pytest.approx(1.2e-6 * record("test.main").edges.tip_pressure)
    assert check.reason.startswith("tip edge of pinion and wheel, up to ")
    assert check.reason.endswith("stage overload")
    assert not any("edge" in identity for identity in checks(stated(contact_pressure_maximum="1 GPa")))


def test_analytic_teeth_have_nothing_to_hold() -> None:
    found = checks(stated(contact_pressure_maximum="1500 MPa", edge_pressure_maximum="2 GPa"))
    assert len(found) == 4
    assert {check.verdict for check in found.values()} == {"open"}
    assert {check.reason for check in found.values()} == {"the teeth are analytic: no loaded contact"}


@pytest.mark.parametrize("family", [contact.PRESSURE, contact.EDGE])
def test_contact_follows_the_warm_axes_of_the_housing(family: RuleFamily) -> None:
    assert "housing" in family.moved_by


def test_edges_of_a_contact_are_those_of_its_corners() -> None:
    """Ideal flanks of a short path: both corners carry, and what they share is what the path does not."""
    edges, found = record("test.main").edges, cycle("test.main")
    carried = np.where(found.edge_contact, found.points.weight * found.force, 0.0).sum(axis=(1, 2))
    assert edges.tip_share == pytest.approx(carried.max() / found.mesh_force)
    assert edges.tip_pressure == pytest.approx(float(found.pressure[found.edge_contact].max()))
    assert edges.end_pressures is None and edges.end_ratio is None


def test_ends_of_an_even_face_carry_as_its_middle() -> None:
    even = replace(record("test.main"), cycle=cycle("test.main", 5)).edges
    assert even.end_ratio == pytest.approx(1.0, rel=0.2)
    assert even.end_pressures is not None
    assert even.end_pressures[0] == pytest.approx(even.end_pressures[1])
