"""Mesh laws of a rig from influence numbers: asked for by the case, of the cold gears, scaled as the case says."""

from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from dynamics.gear.pair import GearPair
from dynamics.tooth.mesh_force import static_cycle
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.part_name import MeshName
from rigdesign.case.loader import load_case
from rigdesign.case.model import Case
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.mesh_models import MeshModel, mesh_model
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig, build_rig
from rigdesign.rig.tooth_influence import Compliances, ToothInfluence
from tests.builders.loaded_mesh import influence_of

CASE, MESH, TORQUE = load_case("cases/fzg"), MeshName("test", "main"), 302.0


@dataclass(frozen=True, eq=False)
class AnalyticTeeth(ToothInfluence):
    """Analytic influence numbers in place of finite elements; the pairs they are asked for."""

    asked: list[GearPair] = field(default_factory=list)

    def compliances(self, pair: GearPair) -> Compliances:
        self.asked.append(pair)
        return influence_of(pair, 0, neighbour=0.4), influence_of(pair, 1, neighbour=0.4)


def model(rig: Rig) -> MeshModel:
    point = OperatingPoint(stage="test", speed=150.0, torque=TORQUE)
    return mesh_model(rig, MESH, point, initial_state(rig, point))


def standard(case: Case = CASE) -> Rig:
    return replace(build_rig(case, "standard"), tooth_influence=AnalyticTeeth())


def test_pairs_share_the_bodies_of_the_cold_gears() -> None:
    rig = standard()
    found = model(rig)
    assert isinstance(rig.tooth_influence, AnalyticTeeth)
    assert set(rig.tooth_influence.asked) == {rig.pairs[MESH]}
    assert found.law.body_compliance > 0.0
    force = TORQUE / found.pair.base_radii[0]
    cycle = static_cycle(found.law._replace(damping=0.0), force)
    assert found.law.mean_stiffness == pytest.approx(cycle.tangent_stiffness.mean(), rel=0.01)
    assert found.law.damping > 0.0


def test_stiffness_of_one_pair_has_the_whole_body_in_series() -> None:
    found = model(standard())
    law, pair = found.law, found.pair
    middle = 0.5 * (pair.path.start + pair.path.end)
    places = law.path_start + law.path_step * np.arange(law.stiffness.shape[1])
    own = np.interp(middle, places, law.stiffness.sum(axis=0))
    alone = 1.0 / (1.0 / own + law.body_compliance) / pair.face_width
    assert found.stiffness.at(np.array([middle]))[0] == pytest.approx(alone, rel=1e-6)


def test_stiffness_factor_takes_teeth_and_bodies() -> None:
    one, stiff = (
        model(standard(CASE.with_value("gearboxes.test.meshes.main.stiffness_factor", factor)))
        for factor in (1.0, 1.25)
    )
    np.testing.assert_allclose(stiff.law.stiffness, 1.25 * one.law.stiffness)
    assert stiff.law.body_compliance == pytest.approx(one.law.body_compliance / 1.25)
    assert stiff.law.mean_stiffness == pytest.approx(1.25 * one.law.mean_stiffness)


@pytest.mark.parametrize("fidelity", ["quick", "standard", "reference"])
@pytest.mark.parametrize("stated", [None, "influence_numbers", "weber_banaschek_0.8", "iso_6336_scaled"])
def test_every_fidelity_has_the_teeth_and_shafts_of_the_case(stated: str | None, fidelity: Fidelity) -> None:
    case = CASE if stated is None else CASE.with_value("drivetrain.mesh_stiffness", stated)
    rig = build_rig(case, fidelity)
    assert rig.mesh_stiffness == (stated or "influence_numbers")
    assert rig.shaft_model == "elastic"
    assert rig.tooth_influence.positions == (7 if fidelity == "quick" else 11)
