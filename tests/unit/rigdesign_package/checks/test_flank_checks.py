"""Checks of the flanks: who is held against what, where the temperatures come from, and what is not rated."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.case.loader import changed_together
from rigdesign.case.model import Case
from rigdesign.checks import flanks, strength
from rigdesign.checks.assumptions import depends
from rigdesign.postprocessing.gear_loads import flank_ratings, rated_cycles, rated_loads
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.serialisation.teeth import flank_rating_row
from rigdesign.rig.model import Rig
from tests.builders.loads import StatedLoads, mesh_loads
from tests.builders.paths import CASES
from tests.builders.twisting import twisting_rig

OUTLETS = {"test.gear_oil": 405.0, "reference.gear_oil": 315.0}


@pytest.fixture(scope="module")
def prototype() -> Case:
    return load_case(CASES / "uhcf_prototype")


@pytest.fixture(scope="module")
def rig(prototype: Case) -> Rig:
    return twisting_rig(prototype)


def held(rig: Rig, *, torque: float = 180.0, loss: float = 500.0, response: bool = True) -> SolvedRig:
    """The rig held at a torque with a K_V of 1.1 in every mesh and a mesh loss each [W]; no housing is solved."""
    count = len(rig.mesh_names)
    losses = [
        SimpleNamespace(
            gearbox=name.split(".")[0],
            part=name.split(".")[1],
            loss=SimpleNamespace(kind="mesh", power=loss),
        )
        for name in rig.mesh_names
    ]
    state = SimpleNamespace(
        mesh_torque={name: torque * (1.0 if name.startswith("test") else -1.0) for name in rig.mesh_names},
        oil_outlet=OUTLETS, oil_supply={},
    )  # fmt: skip
    periodic = SimpleNamespace(dynamic_factor=np.full(count, 1.1), mean=np.full(count, torque))
    point: Any = SimpleNamespace(
        point=SimpleNamespace(stage="test", speed=1256.6, torque=torque),
        last=SimpleNamespace(
            response=periodic if response else None, coupling_state=state, fields={}, losses=losses
        ),
    )
    loads = StatedLoads(meshes=dict.fromkeys(rig.mesh_labels.values(), mesh_loads()))
    run: Any = SimpleNamespace()
    return SolvedRig(rig=rig, points=[point], run=run, loads=loads if response else None)


def checks(solved: SolvedRig) -> dict[str, Check]:
    return {check.id: check for check in (*flanks.load_checks(solved), *flanks.heat_checks(solved))}


def test_flanks_of_the_rig_have_a_safety_and_all_flanks_outlast_the_root(rig: Rig) -> None:
    found = checks(held(rig))
    assert {name for name in found if "pitting" in name} == {
        "flank.pitting_safety.reference.pinion",
        "flank.pitting_safety.reference.wheel",
    }
    roles = {name: check.role for name, check in found.items() if "over_specimen_root" in name}
    assert roles == {
        "flank.over_specimen_root.test.pinion": "specimen",
        "flank.over_specimen_root.test.wheel": "specimen",
        "flank.over_specimen_root.reference.pinion": "rig",
        "flank.over_specimen_root.reference.wheel": "rig",
    }


def test_the_flank_over_the_root_is_the_load_both_carry(rig: Rig) -> None:
    solved = held(rig)
    rating = next(flank_ratings(rig, solved.points, rig.mesh_names.index("reference.main")))
    assert rating.pitting is not None
    specimen = rig.mesh_names.index("test.main")
    roots = [strength.root_safety(solved, specimen, index) for index in (0, 1)]
    weakest = min(root[0] for root in roots if root is not None)
    check = checks(solved)["flank.over_specimen_root.reference.pinion"]
    assert check.value == pytest.approx(rating.pitting[0].safety ** 2 / weakest)
    assert "root of test.pinion" in check.reason


def test_gears_of_the_rig_last_for_all_specimens(rig: Rig) -> None:
    """One specimen is planned for; three of them triple the cycles of the rig's own gears."""
    three = twisting_rig(changed_together(rig.case, {"test_plan.specimens": 3}))
    for name, factor in (("test.main", 1.0), ("reference.main", 3.0)):
        mesh = rig.mesh_names.index(name)
        assert rated_cycles(three, mesh, 0) == pytest.approx(factor * rated_cycles(rig, mesh, 0))
    fewer, more = (checks(held(one))["flank.pitting_safety.reference.pinion"] for one in (rig, three))
    assert fewer.value is not None and more.value is not None
    assert more.value == pytest.approx(fewer.value * 3.0 ** (np.log(0.85) / np.log(200.0)), rel=1e-6)


def test_root_and_flank_take_their_factors_from_one_place(rig: Rig) -> None:
    """K_Fbeta 1.1 of the reference gear belongs to a larger K_Hbeta; K_V is that of the simulation."""
    mesh = rig.mesh_names.index("reference.main")
    load = next(rated_loads(rig, held(rig).points, mesh))
    assert (load.root.K_V, load.contact.dynamic) == (1.1, 1.1)
    assert load.root.K_Fbeta == 1.1 < load.contact.face_load < 1.13
    assert load.root.K_Falpha > 1.0 and load.contact.transverse > 1.0


def test_without_a_housing_the_bulk_temperature_is_that_of_the_document(rig: Rig) -> None:
    """140 degC + 7400 (0.5 kW/(99.5 x 7 mm2))^0.72 by hand, injection: 1.2/1.2."""
    mesh = rig.mesh_names.index("test.main")
    rating = next(flank_ratings(rig, held(rig).points, mesh))
    assert rating.bulk_temperature - 273.15 == pytest.approx(140.0 + 7400.0 * (0.5 / 696.5) ** 0.72)
    assert rating.oil_temperature - 273.15 == pytest.approx(140.0)
    row = flank_rating_row(rating)
    assert row["contact_degC"] > row["bulk_degC"] > 140.0
    assert min(row["film_ratio"].values()) == row["film_ratio_least"]
    assert "C" not in row["film_ratio"]  # the pitch point of the test gears lies outside of the path


def test_less_torque_is_safer_everywhere(rig: Rig) -> None:
    full, half = checks(held(rig)), checks(held(rig, torque=90.0, loss=250.0))
    for name in full:
        if "over_specimen_root" in name:
            continue  # both grow, the flank with the square of its safety: the share stays
        first, second = full[name].value, half[name].value
        assert first is not None and second is not None and second > first


def test_the_stated_scuffing_temperature_goes_before_the_load_stage(rig: Rig) -> None:
    mesh = rig.mesh_names.index("test.main")
    stated = next(flank_ratings(rig, held(rig).points, mesh))
    assert stated.scuffing_temperature == pytest.approx(273.15 + 220.0)
    box = rig.case.gearboxes["test"]
    oil = box.oil.model_copy(update={"scuffing_temperature": None, "scuffing_load_stage": 10.0})
    boxes = dict(rig.case.gearboxes) | {"test": box.model_copy(update={"oil": oil})}
    other = replace(rig, case=rig.case.model_copy(update={"gearboxes": boxes}))
    by_stage = next(flank_ratings(other, held(other).points, mesh))
    viscosity = 1e3 * rig.oils["MIL-PRF-23699"].dynamic_viscosity(363.15)
    assert by_stage.scuffing_temperature == pytest.approx(
        273.15 + 80.0 + 2.25 * 0.8 * viscosity**-0.05 * 100.0
    )
    unknown = oil.model_copy(update={"scuffing_load_stage": None})
    boxes = boxes | {"test": box.model_copy(update={"oil": unknown})}
    silent = replace(rig, case=rig.case.model_copy(update={"gearboxes": boxes}))
    check = checks(held(silent))["flank.scuffing_safety.test"]
    assert check.verdict == "open" and "scuffing_load_stage" in check.reason
    assert checks(held(silent))["flank.film_ratio.test"].value is not None


def test_given_losses_and_missing_limits_are_said(rig: Rig) -> None:
    given = checks(held(rig, response=False))
    assert {check.verdict for check in given.values() if check.limit is not None} == {"open"}
    assert "losses are given" in given["flank.scuffing_safety.test"].reason
    limits = rig.case.limits.model_copy(
        update={"flanks": rig.case.limits.flanks.model_copy(update={"film_ratio_minimum": None})}
    )
    silent = replace(rig, case=rig.case.model_copy(update={"limits": limits}))
    assert checks(held(silent))["flank.film_ratio.test"].reason == "the case states no limit"


def test_the_margin_over_the_root_depends_on_the_gears_of_both_boxes(prototype: Case, rig: Rig) -> None:
    found = checks(held(rig))
    path = "gearboxes.test.meshes.main.face_load_factor"
    assert depends(prototype, found["flank.over_specimen_root.reference.pinion"], path)
    assert not depends(prototype, found["flank.pitting_safety.reference.pinion"], path)
    oil = "gearboxes.test.oil.scuffing_temperature"
    assert depends(prototype, found["flank.scuffing_safety.test"], oil)
    assert not depends(prototype, found["flank.film_ratio.test"], oil)
